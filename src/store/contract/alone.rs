//! Contract of the store for one process: one query after the other.

use serde_json::json;

use super::{
    begin, facts, keep, labels, model_id, point, queue, queue_request, result, sweep, sweep_on, upload,
};
use crate::analysis::kinds::document::Document;
use crate::analysis::kinds::kind::{Leg, ResolvedJob};
use crate::analysis::kinds::modal_analysis::CAMPBELL;
use crate::analysis::kinds::sweep::{CRITICAL_SPEEDS, ERRORS, HISTORIES};
use crate::analysis::kinds::{branches, run_up};
use crate::analysis::resolved::ResolvedSweep;
use crate::analysis::result::{Chosen, Point, PointStatus, SpeedResult, Trial, VerdictWord};
use crate::analysis::run::{Calibration, Estimate, ReducedSector};
use crate::kinds::JobKind;
use crate::store::dialect::Dialect;
use crate::store::idempotency::Answer;
use crate::store::jobs::{Begun, Failure, FailureCause, Insertion, JobDeletion, JobFilter, JobId, NewJob};
use crate::store::labels::{LabelChanges, Labels};
use crate::store::limits::{LimitReached, Limits};
use crate::store::models::{Deletion, ModelFilter};
use crate::store::results::StoredDocument;
use crate::store::status::JobStatus;
use crate::store::testing::stores;
use crate::store::{Backlog, Store};

pub(in crate::store) fn answer(owner: &str, key: &str) -> Answer {
    let (owner, key) = (owner.to_owned(), key.to_owned());
    let (fingerprint, location) = ("f".to_owned(), format!("/v1/models/{}", model_id('a')));
    Answer { owner, key, fingerprint, status: 202, location, body: "{}".to_owned() }
}

#[tokio::test]
async fn models_belong_to_those_who_uploaded_them() {
    for store in stores().await {
        let names = async |filter: ModelFilter| -> Vec<char> {
            let found = store.models(filter, 3).await.unwrap();
            found.iter().filter_map(|model| model.id.chars().next()).collect()
        };
        let of = |owner: &str| ModelFilter { owner: Some(owner.to_owned()), ..ModelFilter::default() };
        assert!(upload(&store, "eve", 'a', &labels("Größe 1", &["rare"])).await);
        assert!(!upload(&store, "eve", 'a', &labels("Again", &[])).await);
        assert!(upload(&store, "eve", 'b', &labels("big_wheel", &["a rare", "Rare"])).await);
        assert!(upload(&store, "adam", 'a', &labels("Mine", &["own"])).await);
        assert!(upload(&store, "adam", 'c', &Labels::default()).await);

        assert_eq!(names(ModelFilter::default()).await, ['c', 'b', 'a']);
        assert_eq!(names(of("eve")).await, ['b', 'a']);
        assert!(names(of("nobody")).await.is_empty());
        let newest = store.model(&model_id('c'), None).await.unwrap().unwrap();
        assert_eq!((newest.size_bytes, newest.facts.name.as_str()), (7, "Package c"));
        assert_eq!(
            names(ModelFilter { before: Some(newest.number), ..ModelFilter::default() }).await,
            ['b', 'a']
        );
        // Case is ignored for the letters a to z alone, and no character is a wildcard.
        for (name, found) in [
            ("gRÖSSE", &[][..]),
            ("GRöße", &['a']),
            ("BIG_", &['b']),
            ("b%g", &[]),
            ("package C", &['c']),
            ("Package a", &[]),
        ] {
            let filter = ModelFilter { name: Some(name.to_owned()), ..ModelFilter::default() };
            assert_eq!(names(filter).await, found, "{name}");
        }
        for (tag, found) in [("rare", &['a'][..]), ("Rare", &['b']), ("own", &[])] {
            let filter = ModelFilter { tag: Some(tag.to_owned()), ..ModelFilter::default() };
            assert_eq!(names(filter).await, found, "{tag}");
        }
        let changes = LabelChanges {
            name: Some(None),
            tags: Some(vec!["new".to_owned()]),
            notes: Some(Some("n".to_owned())),
        };
        assert!(store.label_model(&model_id('a'), Some("adam"), changes).await.unwrap());
        assert!(
            !store.label_model(&model_id('b'), Some("adam"), LabelChanges::default()).await.unwrap(),
            "of another"
        );
        let theirs = store.model(&model_id('a'), Some("adam")).await.unwrap().unwrap().labels;
        let expected = Labels { name: None, tags: vec!["new".to_owned()], notes: Some("n".to_owned()) };
        assert_eq!(theirs, expected);
        let mine = store.model(&model_id('a'), Some("eve")).await.unwrap().unwrap().labels;
        assert_eq!(mine, labels("Größe 1", &["rare"]));

        assert!(store.insert_answer(&answer("eve", "k")).await.unwrap());
        let job = queue(&store, "adam", 'a', 1, &Labels::default()).await;
        let delete = async |owner| store.delete_model(&model_id('a'), owner).await.unwrap();
        assert_eq!(delete(Some("adam")).await, Deletion::InUse(1));
        assert_eq!(delete(None).await, Deletion::InUse(1));
        assert_eq!(delete(Some("eve")).await, Deletion::Deleted, "it is not her job");
        assert_eq!(delete(Some("eve")).await, Deletion::Unknown);
        assert_eq!(store.answer("eve", "k").await.unwrap(), None, "she may upload it with the same key");
        assert!(store.package_path(&model_id('a')).exists());
        store.dismiss_job(job).await.unwrap();
        assert_eq!(delete(Some("adam")).await, Deletion::Deleted);
        assert!(!store.package_path(&model_id('a')).exists());
        assert_eq!(names(ModelFilter::default()).await, ['c', 'b']);
        store.remove_leftovers().await;
        assert!(store.package_path(&model_id('b')).exists());
    }
}

#[tokio::test]
async fn jobs_are_listed_as_they_are_asked_for() {
    for store in stores().await {
        upload(&store, "eve", 'a', &Labels::default()).await;
        upload(&store, "adam", 'b', &Labels::default()).await;
        let mut jobs = Vec::new();
        for (owner, letter, name, tags) in [
            ("eve", 'a', "Überlast 50%", &["rare"][..]),
            ("eve", 'b', "overload", &["Rare", "x"]),
            ("adam", 'b', "Under_load", &["a rare"]),
        ] {
            jobs.push(queue(&store, owner, letter, 2, &labels(name, tags)).await);
        }
        let [first, second, third] = jobs[..] else { panic!("{jobs:?}") };
        assert!(begin(&store, third).await);
        let text = |text: &str| Some(text.to_owned());
        let all = JobFilter::default;
        for (filter, found) in [
            (all(), vec![third, second, first]),
            (JobFilter { owner: text("eve"), ..all() }, vec![second, first]),
            (JobFilter { status: Some(JobStatus::Running), ..all() }, vec![third]),
            (JobFilter { kind: JobKind::named("study"), ..all() }, vec![]),
            (JobFilter { model: Some(model_id('b')), ..all() }, vec![third, second]),
            (JobFilter { name: text("LOAD"), ..all() }, vec![third, second]),
            (JobFilter { name: text("0%"), ..all() }, vec![first]),
            (JobFilter { name: text("über"), ..all() }, vec![]),
            (JobFilter { name: text("ÜbER"), ..all() }, vec![first]),
            (JobFilter { tag: text("rare"), ..all() }, vec![first]),
            (JobFilter { before: Some(third), tag: text("Rare"), ..all() }, vec![second]),
        ] {
            let listed = store.jobs(filter.clone(), 5).await.unwrap();
            assert_eq!(listed.iter().map(|job| job.id).collect::<Vec<_>>(), found, "{filter:?}");
        }
        assert_eq!(store.jobs(all(), 1).await.unwrap()[0].id, third);
        let renamed = LabelChanges { name: Some(text("other")), ..LabelChanges::default() };
        assert!(store.label_job(second, renamed).await.unwrap());
        assert_eq!(store.job(second).await.unwrap().unwrap().labels, labels("other", &["Rare", "x"]));
        assert!(!store.label_job(JobId::new(), LabelChanges::default()).await.unwrap());
        let backlog = Backlog { jobs_accepted: 2, jobs_running: 1, speeds_unfinished: 6 };
        assert_eq!(store.backlog().await.unwrap(), backlog);
        store.probe().await.unwrap();
        store.probe().await.unwrap();
    }
}

#[tokio::test]
async fn a_job_of_one_kind_stays_with_the_processors_that_began_it() {
    for store in stores().await {
        upload(&store, "", 'a', &Labels::default()).await;
        let job = async |one_kind| {
            queue_request(&store, "", &*sweep_on('a', 2, one_kind), &Labels::default()).await
        };
        let (any, one) = (job(false).await, job(true).await);
        let kind = async |job| store.job(job).await.unwrap().unwrap().vectors;
        for (job, on, begun) in [
            (any, "here", Begun::Yes),
            (one, "here", Begun::Yes),
            (any, "here", Begun::Yes),
            (one, "there", Begun::Elsewhere("here".to_owned())),
            (one, "here", Begun::Yes),
        ] {
            assert_eq!(store.begin_job(job, on).await.unwrap(), begun);
            assert_eq!(kind(job).await.as_deref(), Some("here"));
        }
        for (job, on) in [(any, "there"), (one, "here")] {
            let mut speed = result(0);
            speed.point.vectors = Some(on.to_owned());
            keep(&store, job, &speed).await;
        }
        assert_eq!(kind(any).await.as_deref(), Some("several"));
        assert_eq!(kind(one).await.as_deref(), Some("here"));

        // On SQLite, another kind of machine restarts the job; on a server, its own kind may come back.
        store.restart_outdated().await.unwrap();
        let left = async |job| store.finished_speeds(job).await.unwrap().len();
        let is_alone = store.dialect == Dialect::Sqlite;
        assert_eq!((left(any).await, left(one).await), (1, usize::from(!is_alone)));
        let begun = if is_alone { Begun::Yes } else { Begun::Elsewhere("here".to_owned()) };
        assert_eq!(store.begin_job(one, "there").await.unwrap(), begun);
        store.dismiss_job(one).await.unwrap();
        assert_eq!(store.begin_job(one, "there").await.unwrap(), Begun::Unwanted);
    }
}

#[tokio::test]
async fn legs_are_kept_with_the_course_after_them() {
    let leg = |text: &str, course: Option<&str>| Leg {
        text: text.to_owned(),
        beside: None,
        ended: None,
        course: course.map(ToOwned::to_owned),
    };
    for store in stores().await {
        upload(&store, "eve", 'a', &Labels::default()).await;
        let job = queue(&store, "eve", 'a', 1, &Labels::default()).await;
        let names = branches::LEGS;
        let keep = async |index, leg: &Leg| store.keep_leg(job, names, index, leg).await.unwrap();
        let kept = async || store.parts(job, names.leg).await.unwrap().0;
        assert_eq!(kept().await, 0);
        keep(0, &leg("[1]", Some("{\"at\": 1}"))).await;
        keep(1, &leg("[22]", Some("{\"at\": 2}"))).await;
        // A slower process stores the leg again.
        keep(0, &leg("[3]", Some("{\"at\": 3}"))).await;
        let text = async |document| store.document(job, document).await.unwrap();
        assert_eq!(kept().await, 2);
        assert_eq!(text(Document::part(names.leg, 0)).await.as_deref(), Some("[1]"));
        assert_eq!(text(Document::only(names.course)).await.as_deref(), Some("{\"at\": 2}"));
        assert_eq!(store.job(job).await.unwrap().unwrap().stored_bytes, 7);
        keep(2, &leg("[4]", None)).await;
        // The document beside a leg comes and stays with it.
        for (text, spectra) in [("[5]", "[55]"), ("[6]", "[66]")] {
            let (beside, ended) = (Some(spectra.to_owned()), Some(PointStatus::Diverged));
            let leg = Leg { beside, ended, ..leg(text, Some("{}")) };
            store.keep_leg(job, run_up::LEGS, 0, &leg).await.unwrap();
        }
        let speeds = store.job(job).await.unwrap().unwrap().speeds;
        assert_eq!((speeds.finished, speeds.diverged, speeds.failed), (1, 1, 0));
        assert_eq!(text(Document::part(run_up::LEGS.leg, 0)).await.as_deref(), Some("[5]"));
        assert_eq!(text(Document::part(run_up::SPECTRA, 0)).await.as_deref(), Some("[55]"));
        assert_eq!(store.parts(job, run_up::SPECTRA).await.unwrap(), (1, 4));
        assert_eq!((kept().await, text(Document::only(names.course)).await), (3, None));
    }
}

#[tokio::test]
async fn a_job_from_its_beginning_to_its_end() {
    for store in stores().await {
        upload(&store, "", 'a', &Labels::default()).await;
        let job = queue(&store, "", 'a', 4, &Labels::default()).await;
        let waiting = store.job(job).await.unwrap().unwrap();
        assert_eq!((waiting.status, waiting.speeds.total), (JobStatus::Accepted, 4));
        assert_eq!(
            (waiting.request.get(), waiting.started_at.clone()),
            (sweep('a', 4).get::<ResolvedSweep>(), None)
        );
        assert_eq!(waiting.facts, Some(facts("m")));
        assert!(begin(&store, job).await);

        for (percent, expected) in [(40, 40), (30, 40), (120, 99)] {
            store.record_progress(job, percent, "sweeping").await.unwrap();
            assert_eq!(store.job(job).await.unwrap().unwrap().progress, expected);
        }
        let range = json!({"free": 1.0, "contact": 2.0});
        let plan = |steps: u64| -> Estimate {
            let plan = json!({"steps": steps, "computing_time_s": range, "wall_time_s": range, "workers": 2,
                "memory_bytes": 7});
            serde_json::from_value(plan).unwrap()
        };
        store.record_plan(job, &plan(1)).await.unwrap();
        store.record_plan(job, &plan(2)).await.unwrap();
        let modes = json!({"kind": "modes", "modes_per_speed": 30, "error": 0.5, "reason": "r", "tried": []});
        let choice: Chosen = serde_json::from_value(modes).unwrap();
        store.record_choice(job, &choice).await.unwrap();
        let running = store.job(job).await.unwrap().unwrap();
        assert_eq!((running.plan.clone(), running.choice.clone()), (Some(plan(1)), Some(choice)));

        let bare = |status| SpeedResult {
            point: point(if status == "failed" { 1 } else { 0 }, status),
            spectra: None,
            wear: None,
            contact: None,
            end_state: None,
        };
        assert_eq!(keep(&store, job, &result(3)).await, Some(1));
        assert_eq!(keep(&store, job, &result(3)).await, Some(1), "it is there already");
        assert_eq!(store.end_state(job, 3).await.unwrap(), result(3).end_state);
        assert_eq!(keep(&store, job, &bare("diverged")).await, Some(2));
        assert_eq!(keep(&store, job, &bare("failed")).await, Some(3));
        assert_eq!(keep(&store, JobId::new(), &result(0)).await, None);
        let counts = store.job(job).await.unwrap().unwrap().speeds;
        assert_eq!((counts.finished, counts.diverged, counts.failed), (3, 1, 1));
        assert_eq!(store.finished_speeds(job).await.unwrap().into_iter().collect::<Vec<_>>(), [0, 1, 3]);
        assert!(store.is_speed_finished(job, 3).await.unwrap());
        assert!(!store.is_speed_finished(job, 2).await.unwrap());
        let points = store.points(job).await.unwrap();
        assert_eq!(points.iter().map(|point| point.index).collect::<Vec<_>>(), [0, 1, 3]);
        let read = store.speed_result(job, 3).await.unwrap().unwrap();
        assert_eq!(read, SpeedResult { end_state: None, ..result(3) });
        assert!(store.speed_result(job, 2).await.unwrap().is_none());
        let contacts = store.contacts(job, |point, contact| Some((point.index, contact.clone()))).await;
        assert_eq!(contacts.unwrap(), [(3, (3, result(3).contact.unwrap()))]);
        let row = store.map_row(job, 3, |spectra| Some(spectra.sensors[0].nodal_diameters[0].clone())).await;
        assert_eq!(row.unwrap(), Some(vec![3.0, 1e-300]));
        assert!(store.map_row(job, 2, |_| None).await.is_err());
        // Engine orders, amplitudes, and one nodal diameter, of two lines each.
        assert_eq!(store.largest_spectra(job).await.unwrap(), 48);
        let revised = Point { message: Some("revised".to_owned()), ..result(3).point };
        store.revise_points(job, std::slice::from_ref(&revised)).await.unwrap();
        assert_eq!(store.points(job).await.unwrap(), [&points[..2], &[revised.clone()][..]].concat());

        store.keep_document(job, Document::part(HISTORIES, 3), "[\"ü\"]", None).await.unwrap();
        store.keep_document(job, Document::part(HISTORIES, 3), "[]", None).await.unwrap();
        let documents = [(ERRORS, "[1]".to_owned()), (Document::part(CRITICAL_SPEEDS, 1), "[2]".to_owned())];
        assert_eq!(store.job(job).await.unwrap().unwrap().verdict, None);
        store.record_verdict(job, VerdictWord::Undecided).await.unwrap();
        store.record_verdict(job, VerdictWord::Act).await.unwrap();
        assert!(store.complete_job(job, &documents, None).await.unwrap());
        assert!(!store.complete_job(job, &documents, None).await.unwrap());
        let listed = store.documents(job).await.unwrap();
        let listed: Vec<Document<'_>> = listed.iter().map(StoredDocument::document).collect();
        assert_eq!(listed, [Document::part(CRITICAL_SPEEDS, 1), ERRORS, Document::part(HISTORIES, 3)]);
        assert_eq!(store.document_parts(job, HISTORIES).await.unwrap(), [3]);
        assert!(store.document_parts(job, "campbell").await.unwrap().is_empty());
        assert_eq!(store.document(job, ERRORS).await.unwrap().as_deref(), Some("[1]"));
        assert_eq!(store.document_bytes(job, Document::part(HISTORIES, 3)).await.unwrap(), Some(6));
        assert_eq!(store.document_bytes(job, CAMPBELL).await.unwrap(), None);
        store.revise_points(job, &[result(3).point]).await.unwrap();
        assert_eq!(store.points(job).await.unwrap()[2], revised, "a job that has ended is not revised");
        assert_eq!(store.end_state(job, 0).await.unwrap(), None);
        let done = store.job(job).await.unwrap().unwrap();
        assert_eq!((done.status, done.progress, done.phase.as_str()), (JobStatus::Successful, 100, ""));
        assert!(done.finished_at.is_some() && done.stored_bytes > 12);
        let listed = store.jobs(JobFilter::default(), 9).await.unwrap();
        let of_job = listed.iter().find(|head| head.id == job).unwrap();
        assert_eq!([done.verdict, of_job.verdict], [Some(VerdictWord::Act); 2]);
        assert_eq!(store.dismiss_job(job).await.unwrap(), Some(JobStatus::Successful));
        assert_eq!(store.dismiss_job(JobId::new()).await.unwrap(), None);

        assert_eq!(store.delete_job(job).await.unwrap(), JobDeletion::Deleted);
        store.purge().await.unwrap();
        assert!(
            store.points(job).await.unwrap().is_empty() && store.documents(job).await.unwrap().is_empty()
        );
    }
}

#[tokio::test]
async fn a_job_that_failed_says_why() {
    for store in stores().await {
        upload(&store, "", 'a', &Labels::default()).await;
        let job = queue(&store, "", 'a', 1, &Labels::default()).await;
        let message = "clearance is 0.1 mm".to_owned();
        let failure = Failure { cause: FailureCause::Model, message, violations: Vec::new() };
        let advance = async |next, failure| store.advance_job(job, next, failure).await.unwrap();
        assert_eq!(advance(JobStatus::Failed, Some(&failure)).await, Some(JobStatus::Failed));
        assert_eq!(advance(JobStatus::Running, None).await, Some(JobStatus::Failed));
        assert_eq!(store.job(job).await.unwrap().unwrap().failure, Some(failure));
        assert!(!begin(&store, job).await);
    }
}

#[tokio::test]
async fn limits_and_keys_refuse_what_is_too_much() {
    for store in stores().await {
        upload(&store, "eve", 'a', &Labels::default()).await;
        let insert = async |request: &dyn ResolvedJob, limits, answer: Option<&Answer>| {
            let labels = &Labels::default();
            let new = NewJob { id: JobId::new(), owner: "eve", request, posted: None, labels, facts: None };
            store.insert_job(new, limits, answer).await
        };
        let limits = Limits { queued_speeds: Some(5), ..Limits::default() };
        let some = sweep('a', 3);
        // The request lacks its facts, which the table of jobs refuses; nothing of it stays.
        assert!(insert(&*some, limits, Some(&answer("eve", "k"))).await.is_err());
        assert_eq!(store.answer("eve", "k").await.unwrap(), None);
        queue(&store, "eve", 'a', 3, &Labels::default()).await;
        let reached = LimitReached::QueuedSpeeds { queued: 3, asked: 3, limit: 5 };
        assert_eq!(insert(&*some, limits, None).await.unwrap(), Insertion::Limit(reached));
        let of_none = sweep('x', 1);
        assert_eq!(insert(&*of_none, limits, None).await.unwrap(), Insertion::UnknownModel);
        assert!(store.insert_answer(&answer("eve", "k")).await.unwrap());
        assert!(!store.insert_answer(&answer("eve", "k")).await.unwrap());
        assert!(store.insert_answer(&answer("adam", "k")).await.unwrap());
        assert_eq!(insert(&*some, limits, Some(&answer("eve", "k"))).await.unwrap(), Insertion::KeyTaken);
        assert_eq!(store.answer("eve", "k").await.unwrap(), Some(answer("eve", "k")));

        let add = async |limits| {
            let upload = store.new_upload().await.unwrap().into_temp_path();
            std::fs::write(&upload, "package").unwrap();
            let whose = ("eve", limits);
            store.insert_model(whose, &model_id('b'), &facts("b"), &Labels::default(), &upload).await.unwrap()
        };
        let one = Limits { models: Some(1), ..Limits::default() };
        assert_eq!(add(one).await.unwrap_err(), LimitReached::Models { models: 1, limit: 1 });
        let bytes = Limits { stored_bytes: Some(13), ..Limits::default() };
        assert_eq!(
            add(bytes).await.unwrap_err(),
            LimitReached::StoredBytes { stored: 7, more: 7, limit: 13 }
        );
        assert!(add(Limits { stored_bytes: Some(14), models: Some(2), ..Limits::default() }).await.is_ok());
    }
}

/// Calibration in which all costs are `cost`.
pub(in crate::store) fn calibration(cost: f64) -> Calibration {
    let step = json!({"fixed": cost, "per_product": cost, "per_transform": cost});
    let mut effects = json!({});
    loop {
        let calibration = json!({"without_contact": step, "free": step, "contact": step, "effects": effects,
            "spectra": cost, "stress": cost});
        match serde_json::from_value(calibration) {
            Ok(calibration) => return calibration,
            // The error names the next effect whose costs are missing.
            Err(error) => {
                let missing = error.to_string().split(' ').next_back().unwrap().to_owned();
                assert!(effects.get(&missing).is_none(), "{error}");
                effects[missing] = json!({"free": cost, "contact": cost});
            }
        }
    }
}

pub(in crate::store) fn reduced(modes_per_speed: u32) -> ReducedSector {
    let stiffening = json!({"verdict": "absent", "linear_ratio": 0.0, "quadratic_ratio": 0.0,
        "frequency_error": 0.0, "message": "none"});
    let report = json!({
        "modes_per_speed": modes_per_speed, "unknowns": [7], "wheel_unknowns": 40,
        "largest_mode_residual": 1e-9, "modes": 60, "counted_modes": 60, "full_model": [],
        "basis_tolerance": 1e-5, "stiffening": stiffening, "wall_time_s": 1.5, "version": "0.1.0",
    });
    let interpolation =
        json!({"verdict": "Absent", "linear_ratio": 0.0, "quadratic_ratio": 0.0, "frequency_error": 0.0});
    let wheel = json!({"sectors": 10, "contact": [], "speeds_rad_s": [0.0], "harmonics": [],
        "interpolation": interpolation, "comparison": []});
    let units = json!({"length": "m", "force": "N", "time": "s", "mass": "kg"});
    serde_json::from_value(json!({"units": units, "wheel": wheel, "report": report})).unwrap()
}

#[tokio::test]
async fn what_can_be_computed_again_is_kept_with_its_model() {
    for store in stores().await {
        for cost in [1.0, 2.0] {
            store.insert_calibration("eight", &calibration(cost)).await.unwrap();
        }
        assert_eq!(store.calibration("eight").await.unwrap(), Some(calibration(2.0)));
        assert_eq!(store.calibration("four").await.unwrap(), None);

        upload(&store, "", 'a', &Labels::default()).await;
        let (model, job) = (model_id('a'), queue(&store, "", 'a', 1, &Labels::default()).await);
        for modes in [30, 20, 20] {
            store.insert_reduction(job, &model, modes, &reduced(modes)).await.unwrap();
        }
        store.insert_reduction(job, &model_id('x'), 20, &reduced(20)).await.unwrap();
        let kept = store.reduction(&model, 20).await.unwrap().unwrap();
        assert_eq!(kept.report.modes_per_speed, 20);
        assert!(store.reduction(&model_id('x'), 20).await.unwrap().is_none());
        assert_eq!(store.stored_reductions().await.unwrap().len(), 2);
        let reports = store.reduction_reports(&model).await.unwrap();
        assert_eq!(reports.iter().map(|report| report.modes_per_speed).collect::<Vec<_>>(), [20, 30]);

        let key = "0".repeat(64);
        let trial = |unknowns: u32| -> Trial {
            let cost = json!({"set_up_s": 0.0, "per_revolution_s": 0.0, "repetitions": 1});
            let trial = json!({"point": point(0, "completed"), "unknowns": unknowns, "lines": [], "levels": [],
                "history": [], "samples_per_revolution": 0, "sensitivity": null, "cost": cost});
            serde_json::from_value(trial).unwrap()
        };
        for unknowns in [1, 2] {
            store.insert_trial(job, &key, &model, &trial(unknowns)).await.unwrap();
        }
        store.insert_trial(job, &"1".repeat(64), &model_id('x'), &trial(1)).await.unwrap();
        assert_eq!(store.trial(&key).await.unwrap(), Some(trial(2)));
        assert_eq!(store.trial(&"1".repeat(64)).await.unwrap(), None);
        store.remove_leftovers().await;
        assert!(store.trial(&key).await.unwrap().is_some(), "it is of this version");

        store.dismiss_job(job).await.unwrap();
        assert_eq!(store.delete_model(&model, None).await.unwrap(), Deletion::Deleted);
        assert!(store.trial(&key).await.unwrap().is_none());
        assert!(store.stored_reductions().await.unwrap().is_empty());
    }
}

/// Texts that might break a query, such as SQL or wildcards, are plain text.
#[tokio::test]
async fn text_is_text() {
    for store in stores().await {
        for text in ["'; drop table jobs; --", "\\", "%_", "𝛺 \u{7f}", "\"", "$1"] {
            assert!(ask(&store, text).await.is_empty(), "{text}");
        }
    }
}

async fn ask(store: &Store, text: &str) -> Vec<crate::store::jobs::JobHead> {
    let text = Some(text.to_owned());
    let filter = JobFilter { name: text.clone(), tag: text.clone(), owner: text, ..JobFilter::default() };
    store.jobs(filter, 1).await.unwrap()
}

#[tokio::test]
async fn a_text_with_a_nul_is_kept_or_refused_as_such() {
    for store in stores().await {
        upload(&store, "", 'a', &Labels::default()).await;
        let notes = LabelChanges { notes: Some(Some("a\0b".to_owned())), ..LabelChanges::default() };
        match store.label_model(&model_id('a'), None, notes).await {
            Ok(_) => assert_eq!(store.dialect, Dialect::Sqlite),
            Err(error) => assert!(error.is_no_text() && !error.may_pass(), "{error}"),
        }
    }
}
