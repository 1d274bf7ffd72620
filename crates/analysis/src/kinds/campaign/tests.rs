//! Campaigns on severities in closed form.

use std::f64::consts::PI;

use serde_json::{Value, json};

use super::answer::campaign;
use super::more::more_designs;
use crate::error::Violation;
use crate::kinds::campaign::resolve::{ComparedModel, resolve_campaign};
use crate::model::ModelFacts;
use crate::request::CampaignRequest;
use crate::resolved::ResolvedCampaign;
use crate::result::{Campaign, DifferenceVerdict, LimitsMet, Point};

/// Request of two speeds, with `changes` to its fields.
fn request(changes: Value) -> Value {
    let mut request = json!({
        "model": "m", "modes_per_speed": 8, "speeds": {"values": [100.0, 200.0], "unit": "hz"},
        "scene": {
            "damping": {"modal_ratio": 0.005}, "mistuning": {"spread": 0.01, "seed": 3},
            "casing": {"clearance": {"leading": 0.3, "trailing": 0.2}, "lobes": {"count": 2, "amplitude": 0.1, "width_rad": 0.3}},
            "contact": {}
        },
    });
    for (field, value) in changes.as_object().unwrap() {
        request[field] = value.clone();
    }
    request
}

fn resolve(changes: Value) -> Result<ResolvedCampaign, Vec<Violation>> {
    let request: CampaignRequest = serde_json::from_value(request(changes)).unwrap();
    let facts = ModelFacts::of_ten_sectors(4);
    let compared = request.compared_model.as_ref().map(|_| other_model("mm"));
    resolve_all(request, facts, compared)
}

fn resolve_all(
    request: CampaignRequest,
    facts: ModelFacts,
    compared: Option<ComparedModel>,
) -> Result<ResolvedCampaign, Vec<Violation>> {
    let mut designs = resolve_campaign(request, facts, compared)?;
    while designs.check_next() {}
    designs.finish()
}

/// Model of seven sectors and fewer contact nodes.
fn other_model(length: &str) -> ComparedModel {
    let mut facts = ModelFacts { sectors: 7, ..ModelFacts::of_ten_sectors(2) };
    length.clone_into(&mut facts.units.length);
    ComparedModel { facts, sensors: Vec::new() }
}

fn clearance(name: &str, from: f64, to: f64) -> Value {
    let ends = ["/scene/casing/clearance/leading", "/scene/casing/clearance/trailing"];
    json!({"name": name, "at": ends, "change": "add", "from": from, "to": to})
}

fn point(index: u32, status: &str, severity: f64) -> Point {
    let responses = if status == "completed" {
        json!([{"sensor": {"contact_node": 0, "component": "radial"}, "mean": 0.0, "rms": 0.0, "half_peak_to_peak": severity}])
    } else {
        json!([])
    };
    let point = json!({
        "index": index, "speed_rad_s": 1.0, "status": status, "steps_per_revolution": 1, "steps": 1,
        "smallest_stable_steps_per_revolution": 1, "contact_share": 0.0, "responses": responses, "wall_time_s": 0.5, "version": "0",
    });
    serde_json::from_value(point).unwrap()
}

/// Copy of `point` that had not settled.
fn on_its_way(mut point: Point) -> Point {
    let settling = json!({"verdict": "not_settled", "largest_change": 0.2});
    point.settling = serde_json::from_value(settling).unwrap();
    point
}

/// Points of the simulations from `first` on, with this severity of (values, speed).
fn points(campaign: &ResolvedCampaign, first: u32, severity: impl Fn(&[f64], u32) -> f64) -> Vec<Point> {
    let of = |index: u32| {
        let values = &campaign.settings.designs[index as usize / 2];
        point(index, "completed", severity(values, index % 2))
    };
    (first..campaign.simulations()).map(of).collect()
}

fn answer(asked: &ResolvedCampaign, points: &[Point]) -> Campaign {
    campaign(asked, &ModelFacts::of_ten_sectors(4).units, points)
}

/// Runs the campaign with all designs that it adds; returns it with its points.
fn to_its_end(
    mut campaign: ResolvedCampaign,
    severity: impl Fn(&[f64], u32) -> f64 + Copy,
) -> (ResolvedCampaign, Vec<Point>) {
    let mut found = points(&campaign, 0, severity);
    while let Some(more) = more_designs(&campaign, &found) {
        found.extend(points(&more, campaign.simulations(), severity));
        campaign = more;
    }
    (campaign, found)
}

#[test]
fn sensitivities_are_those_of_ishigamis_function_at_the_worst_speed() {
    let parameter = |name: &str| json!({"name": name, "at": ["/scene/casing/lobes/amplitude"], "change": "multiply", "from": 0.1, "to": 1.0});
    let parameters = json!([parameter("x"), parameter("y"), parameter("z")]);
    let asked =
        resolve(json!({"parameters": parameters, "design": {"kind": "indices", "size": 512, "seed": 4}}))
            .unwrap();
    assert_eq!((asked.designs(), asked.simulations()), (512 * 5, 512 * 5 * 2));
    let ishigami = |values: &[f64], speed: u32| {
        let [x, y, z] = [values[0], values[1], values[2]].map(|value| 2.0 * PI * (value - 0.1) / 0.9 - PI);
        20.0 * f64::from(speed) + x.sin() + 7.0 * y.sin().powi(2) + 0.1 * z.powi(4) * x.sin()
    };
    let all = points(&asked, 0, ishigami);
    let found = answer(&asked, &all);
    let sensitivities = found.sensitivities.unwrap();
    // Ishigami and Homma, 1990.
    let exact = [(0.313_905, 0.557_589), (0.442_411, 0.442_411), (0.0, 0.243_684)];
    for (found, (first, total)) in sensitivities.parameters.iter().zip(exact) {
        assert!((found.first_order - first).abs() < 3.0 * found.first_order_error, "{found:?}");
        assert!((found.total - total).abs() < 3.0 * found.total_error, "{found:?}");
    }
    assert!((sensitivities.mean - 23.5).abs() < 0.5 && sensitivities.blocks == 512);
    assert!(found.designs.iter().all(|design| design.outcome.worst_speed_rad_s == Some(400.0 * PI)));
    assert_eq!(found.spent.steps, u64::from(asked.simulations()));
    // While it runs: of complete blocks only, whatever came first.
    let half = answer(&asked, &all[..256 * 5 * 2 + 7]);
    assert_eq!(half.sensitivities.unwrap().blocks, 256);
}

/// Severity 1 − clearance + a normal deviation of 0.05: for a limit of 0.7, thresholds are 0.3 ± 0.05, cut off at four deviations.
#[test]
fn designs_are_added_where_the_threshold_is_undecided() {
    let tolerance = json!({"name": "tolerance", "at": ["/scene/damping/modal_ratio"], "change": "multiply", "distribution": "normal",
        "mean": 1.0, "standard_deviation": 0.05, "from": 0.8, "to": 1.2});
    let threshold = json!({"parameter": "clearance", "probability": 0.9, "within": 0.01, "batch": 32});
    let asked = |threshold: &Value| {
        resolve(json!({
            "parameters": [clearance("clearance", 0.0, 1.0), tolerance], "design": {"kind": "sobol", "size": 32},
            "limit": 0.7, "threshold": threshold,
        }))
    };
    let severity = |values: &[f64], speed: u32| 1.0 - values[0] + (values[1] - 1.0) - 0.1 * f64::from(speed);
    let exact = 0.3 + 0.05 * 1.281_551_6;
    let (ended, found) = to_its_end(asked(&threshold).unwrap(), severity);
    let told = answer(&ended, &found).threshold.unwrap();
    let (low, high) = (told.from.unwrap(), told.to.unwrap());
    assert!(low < exact && exact < high && high - low <= 0.02, "{told:?}, exact {exact}");
    assert_eq!((told.met_within, told.decided as usize), (Some(true), ended.designs()));
    assert!(
        (told.mean.unwrap() - 0.3).abs() < 0.02 && (told.standard_deviation.unwrap() - 0.05).abs() < 0.02,
        "{told:?}"
    );
    assert!((32..=700).contains(&ended.designs()), "{}", ended.designs());
    // Nearly all that were added lie where the answer was open.
    let added = &ended.settings.designs[32..];
    let near = added.iter().filter(|values| (values[0] - exact).abs() < 0.15).count();
    assert!(near * 10 >= added.len() * 8, "{near} of {}", added.len());
    // Evenly spread, as many designs leave the answer open twice as far.
    let mut spread = asked(&json!({"parameter": "clearance", "probability": 0.9})).unwrap();
    spread.settings.designs.clear();
    let even: Vec<Vec<f64>> = (0..ended.designs())
        .map(|index| {
            let point = rubmap_numerics::sampling::sobol_point(index, 2, 0);
            super::designs::quantiles(&point, spread.distributions.iter().flatten())
        })
        .collect();
    let spread = spread.with_designs(even);
    let told = answer(&spread, &points(&spread, 0, severity)).threshold.unwrap();
    assert!(told.to.unwrap() - told.from.unwrap() > 1.5 * (high - low), "{told:?}");
    // Never more than allowed.
    let few = json!({"parameter": "clearance", "probability": 0.9, "within": 0.001, "batch": 32, "most_designs": 100});
    let (ended, found) = to_its_end(asked(&few).unwrap(), severity);
    assert_eq!((ended.designs(), answer(&ended, &found).threshold.unwrap().met_within), (100, Some(false)));
}

/// Share of right answers of campaigns that end with one, whatever their first designs: of 40 with a confidence of 95 %, 38 should be
/// right, less three deviations of 1.4 and the error of an approximation for many designs.
#[test]
fn answers_of_few_designs_are_honest() {
    for (size, spread, probability, within, batch) in [(8, 0.05, 0.8, 0.05, 4), (32, 0.02, 0.95, 0.02, 32)] {
        let tolerance = json!({"name": "tolerance", "at": ["/scene/damping/modal_ratio"], "change": "multiply", "distribution": "normal",
            "mean": 1.0, "standard_deviation": spread, "from": 0.7, "to": 1.3});
        let threshold = json!({"parameter": "clearance", "probability": probability, "within": within, "batch": batch, "most_designs": 300});
        let exact = 0.3 + spread * rubmap_numerics::sampling::quantile::standard_normal(probability);
        let (mut ended, mut right) = (0, 0);
        for seed in 0..40 {
            let asked = resolve(json!({
                "parameters": [clearance("clearance", 0.0, 1.0), tolerance], "design": {"kind": "latin_hypercube", "size": size, "seed": seed},
                "limit": 0.7, "threshold": threshold, "speeds": {"values": [100.0, 200.0], "unit": "hz"},
            }));
            let severity = |values: &[f64], _: u32| 1.0 - values[0] + (values[1] - 1.0);
            let (campaign, found) = to_its_end(asked.unwrap(), severity);
            let told = answer(&campaign, &found).threshold.unwrap();
            if told.met_within == Some(true) {
                ended += 1;
                right += u32::from(told.from.unwrap() <= exact && exact <= told.to.unwrap());
            }
        }
        assert!(ended >= 35, "{ended}");
        assert!(right + 6 >= ended, "{right} of {ended}");
    }
}

/// Threshold where nothing else varies: it is enclosed ever more narrowly.
#[test]
fn a_single_parameter_is_enclosed() {
    let threshold = json!({"parameter": "clearance", "within": 1e-6, "batch": 9});
    let mut parameter = clearance("clearance", 0.0, 1.0);
    parameter["levels"] = 5.into();
    let asked = resolve(
        json!({"parameters": [parameter], "design": {"kind": "grid"}, "limit": 0.7, "threshold": threshold}),
    );
    let severity = |values: &[f64], _: u32| 1.0 / (1.0 + values[0]);
    let (ended, found) = to_its_end(asked.unwrap(), severity);
    let told = answer(&ended, &found).threshold.unwrap();
    assert!((told.value.unwrap() - (1.0 / 0.7 - 1.0)).abs() < 1e-6, "{told:?}");
    // Each round leaves a tenth.
    assert!(ended.designs() <= 5 + 6 * 9 && told.met_within == Some(true), "{}", ended.designs());
}

/// Damping beyond 1 that a tolerance may bring is refused, though none of the given designs has it.
#[test]
fn designs_that_may_be_added_are_held_against_the_model() {
    let damping = json!({"name": "d", "at": ["/scene/damping/modal_ratio"], "from": 0.08, "to": 20.0});
    let threshold = json!({"parameter": "clearance", "within": 0.01, "batch": 8, "most_designs": 40});
    let asked = json!({
        "parameters": [clearance("clearance", 0.0, 1.0), damping], "design": {"kind": "list", "points": [[0.0, 0.1], [0.1, 0.1]]},
        "limit": 0.7, "threshold": threshold,
    });
    let refused = resolve(asked).unwrap_err();
    assert_eq!((refused.len(), refused[0].pointer.as_str()), (1, "/parameters/1"), "{refused:?}");
}

/// Severity that rises again and crosses a limit three times: there is no single value, and nothing is simulated twice.
#[test]
fn a_limit_that_is_crossed_again_is_said_to_be() {
    let threshold = json!({"parameter": "clearance", "within": 1e-3, "batch": 8});
    let asked = resolve(json!({
        "parameters": [clearance("clearance", 0.0, 1.0)], "design": {"kind": "sobol", "size": 64}, "limit": 0.7, "threshold": threshold,
    }));
    let severity =
        |values: &[f64], _: u32| 1.0 - values[0] + if (0.4..0.5).contains(&values[0]) { 0.5 } else { 0.0 };
    let (ended, found) = to_its_end(asked.unwrap(), severity);
    let told = answer(&ended, &found).threshold.unwrap();
    assert_eq!((told.met_within, told.value, ended.designs()), (Some(false), None, 64));
    let (from, to) = (told.from.unwrap(), told.to.unwrap());
    assert!(from < 0.3 && from > 0.28 && to > 0.5 && to < 0.52, "{told:?}");
    assert!(told.message.contains("more than once"), "{}", told.message);
}

/// Threshold far from the one first design, which meets the limit as most designs do: the first batch covers the whole range.
#[test]
fn a_threshold_far_from_the_first_designs_is_found() {
    let threshold = json!({"parameter": "clearance", "within": 1e-3, "batch": 8});
    let asked = resolve(json!({
        "parameters": [clearance("clearance", 0.0, 1.0)], "design": {"kind": "list", "points": [[0.9]]}, "limit": 0.85, "threshold": threshold,
    }));
    let severity = |values: &[f64], _: u32| 1.0 - values[0];
    let (ended, found) = to_its_end(asked.unwrap(), severity);
    let told = answer(&ended, &found).threshold.unwrap();
    assert!(told.met_within == Some(true) && (told.value.unwrap() - 0.15).abs() < 1e-3, "{told:?}");
}

/// Campaign whose added designs are all unknown: it ends, and says why.
#[test]
fn nothing_is_added_where_nothing_settles() {
    let threshold = json!({"parameter": "clearance", "within": 1e-3, "batch": 4});
    let asked = resolve(json!({
        "parameters": [clearance("clearance", 0.0, 1.0)], "design": {"kind": "sobol", "size": 4}, "limit": 0.5, "threshold": threshold,
    }))
    .unwrap();
    let severity = |values: &[f64], _: u32| 1.0 - values[0];
    let mut found = points(&asked, 0, severity);
    let longer = more_designs(&asked, &found).unwrap();
    found.extend(points(&longer, asked.simulations(), severity).into_iter().map(on_its_way));
    assert_eq!(more_designs(&longer, &found), None);
    let message = answer(&longer, &found).threshold.unwrap().message;
    assert!(message.contains("4 of 8 finished designs are left out"), "{message}");
}

#[test]
fn what_is_not_known_is_not_counted() {
    let points_ = json!([[0.0], [0.1], [0.2], [0.3], [0.4]]);
    let parameter = json!({"name": "clearance", "at": ["/scene/casing/clearance/leading"], "change": "add"});
    let asked = resolve(json!({
        "parameters": [parameter], "design": {"kind": "list", "points": points_}, "limit": 1.0, "threshold": {"parameter": "clearance"},
    }))
    .unwrap();
    let ends = [
        // Both below; one above and one not there yet; one diverged, one below; one failed, one below; one below, one on its way.
        point(0, "completed", 0.2),
        point(1, "completed", 0.9),
        point(3, "completed", 1.1),
        point(4, "diverged", 0.0),
        point(5, "completed", 0.1),
        point(6, "failed", 0.0),
        point(7, "completed", 0.1),
        point(8, "completed", 0.1),
        on_its_way(point(9, "completed", 0.2)),
    ];
    let found = answer(&asked, &ends);
    let meets: Vec<_> = found.designs.iter().map(|design| design.outcome.meets_limit).collect();
    assert_eq!(meets, [Some(true), Some(false), Some(false), None, None]);
    let severities: Vec<_> = found.designs.iter().map(|design| design.outcome.severity).collect();
    assert_eq!(severities, [Some(0.9), None, None, None, None]);
    let outcomes = found.designs.iter().map(|design| &design.outcome);
    let counts: Vec<_> = outcomes
        .map(|outcome| (outcome.finished, outcome.diverged, outcome.failed, outcome.not_settled))
        .collect();
    assert_eq!(counts, [(2, 0, 0, 0), (1, 0, 0, 0), (2, 1, 0, 0), (2, 0, 1, 0), (2, 0, 0, 1)]);
    // The second exceeds the limit, too; but of those that are not finished only such are known.
    assert_eq!(found.threshold.unwrap().decided, 2);
    assert_eq!(
        (found.sensitivities, found.designs[0].outcome.by_speed.clone()),
        (None, vec![Some(0.2), Some(0.9)])
    );
}

#[test]
fn what_makes_no_campaign_is_refused_at_its_field() {
    let one = || json!([clearance("clearance", 0.0, 1.0)]);
    let sobol = || json!({"kind": "sobol", "size": 8});
    let wrong = [
        (json!({"parameters": [], "design": sobol()}), "/parameters"),
        (json!({"parameters": one(), "design": {"kind": "sobol"}}), "/design/size"),
        (json!({"parameters": one(), "design": {"kind": "grid", "size": 3}}), "/design/size"),
        (json!({"parameters": one(), "design": {"kind": "grid"}}), "/parameters/0/levels"),
        (json!({"parameters": one(), "design": {"kind": "sobol", "size": 10_001}}), "/design"),
        (
            json!({"parameters": one(), "design": {"kind": "list", "points": [[1.0, 2.0]]}}),
            "/design/points/0",
        ),
        (json!({"parameters": one(), "design": sobol(), "threshold": {"parameter": "clearance"}}), "/limit"),
        (
            json!({"parameters": one(), "design": sobol(), "limit": 1.0, "threshold": {"parameter": "x"}}),
            "/threshold/parameter",
        ),
        (json!({"parameters": one(), "design": sobol(), "severity": "wear"}), "/severity"),
        (
            json!({"parameters": [clearance("meets_limit", 0.0, 1.0)], "design": sobol()}),
            "/parameters/0/name",
        ),
        (
            json!({"parameters": [clearance("amplitude_mm", 0.0, 1.0)], "design": sobol()}),
            "/parameters/0/name",
        ),
        (json!({"parameters": [clearance("a/b", 0.0, 1.0)], "design": sobol()}), "/parameters/0/name"),
        (
            json!({"parameters": one(), "design": sobol(), "limit": 1.0, "threshold": {"parameter": "clearance", "within": 0.1, "most_designs": 7}}),
            "/threshold/most_designs",
        ),
        (
            json!({"parameters": one(), "design": sobol(), "limit": 1.0, "speeds": {"from": 100.0, "to": 200.0, "count": 101, "unit": "hz"},
                "threshold": {"parameter": "clearance", "within": 0.1}}),
            "/threshold/most_designs",
        ),
        (
            json!({"parameters": [{"name": "c", "at": ["/scene/casing/clearance/leading"], "distribution": "normal", "mean": 0.3, "standard_deviation": 0.01}],
                "design": sobol(), "limit": 1.0, "threshold": {"parameter": "c", "within": 0.1}}),
            "/parameters/0/from",
        ),
        (json!({"parameters": one(), "design": sobol(), "stress": {}}), "/stress"),
        (
            json!({"parameters": [clearance("c", 0.0, 1.0), clearance("c", 0.0, 1.0)], "design": sobol()}),
            "/parameters/1/name",
        ),
        (
            json!({"parameters": [{"name": "s", "at": ["/scene/mistuning/seed"], "from": 0.0, "to": 3.0}], "design": sobol()}),
            "/parameters/0",
        ),
        (
            json!({"parameters": [{"name": "s", "at": ["/scene/friction/coefficient"], "from": 0.0, "to": 3.0}], "design": sobol()}),
            "/parameters/0/at/0",
        ),
        // The scene is sound, the design is not.
        (
            json!({"parameters": [{"name": "d", "at": ["/scene/damping/modal_ratio"], "from": 0.5, "to": 2.0}], "design": sobol()}),
            "/parameters/0",
        ),
        (
            json!({"parameters": [{"name": "n", "at": ["/scene/casing/lobes/count"], "distribution": "values", "values": [2.0, 3.5]}],
            "design": {"kind": "grid"}}),
            "/parameters/0",
        ),
    ];
    for (changes, pointer) in wrong {
        let found: Vec<_> =
            resolve(changes.clone()).unwrap_err().into_iter().map(|violation| violation.pointer).collect();
        assert!(found.contains(&pointer.to_owned()), "{changes}: {found:?}");
    }
    let seeds = json!({"name": "seed", "at": ["/scene/mistuning/seed"], "distribution": "whole", "from": 1.0, "to": 5.0});
    let asked = resolve(json!({"parameters": [seeds], "design": {"kind": "grid"}})).unwrap();
    assert_eq!(asked.settings.designs.concat(), [1.0, 2.0, 3.0, 4.0, 5.0]);
    let kept = serde_json::to_value(&asked).unwrap();
    assert_eq!(ResolvedCampaign::stored(serde_json::from_value(kept).unwrap()).unwrap(), asked);
}

/// Severities x + 0.1 and 1.5x of the two models at the first speed, less at the second: design by design they differ by 0.5x − 0.1.
#[test]
fn models_are_compared_design_by_design() {
    let asked = resolve(json!({
        "parameters": [clearance("clearance", 0.0, 1.0)], "design": {"kind": "sobol", "size": 64}, "limit": 0.6, "compared_model": "n",
    }))
    .unwrap();
    assert_eq!((asked.simulations(), asked.compared_model()), (64 * 2 * 2, Some("n")));
    let of = |index: u32| {
        let x = asked.settings.designs[index as usize / 4][0];
        let own = if index % 4 < 2 { x + 0.1 } else { 1.5 * x };
        point(index, "completed", own - 0.05 * f64::from(index % 2))
    };
    let all: Vec<Point> = (0..asked.simulations()).map(of).collect();
    let found = answer(&asked, &all);
    let xs: Vec<f64> = asked.settings.designs.concat();
    let differences = xs.iter().map(|x| 0.5 * x - 0.1);
    let mean = differences.clone().sum::<f64>() / 64.0;
    let variance = differences.map(|difference| (difference - mean).powi(2)).sum::<f64>() / 63.0;
    let comparison = found.comparison.unwrap();
    let told = comparison.severity.unwrap();
    assert!((told.mean - mean).abs() < 1e-12 && told.pairs == 64, "{told:?}");
    assert!((told.standard_error.unwrap() - (variance / 64.0).sqrt()).abs() < 1e-12);
    // The true mean is 0.15: the interval has it, and leaves out 0.
    assert!(
        told.from.unwrap() < 0.15 && told.to.unwrap() > 0.15 && told.verdict == DifferenceVerdict::Greater
    );
    assert_eq!(comparison.by_speed.len(), 2);
    assert!((comparison.by_speed[1].unwrap().mean - mean).abs() < 1e-12);
    let met = |met: fn(f64) -> (bool, bool), wanted| xs.iter().filter(|x| met(**x) == wanted).count() as u32;
    let both = |x: f64| (x + 0.1 <= 0.6, 1.5 * x <= 0.6);
    let expected = LimitsMet {
        both: met(both, (true, true)),
        only_model: met(both, (true, false)),
        only_compared: met(both, (false, true)),
        neither: met(both, (false, false)),
    };
    assert_eq!(comparison.limit, Some(expected));
    assert!(expected.only_model > 0 && expected.only_compared == 0);
    let mirrored: Vec<Point> = all
        .iter()
        .map(|point| self::point(point.index ^ 2, "completed", point.responses[0].half_peak_to_peak))
        .collect();
    let less = answer(&asked, &mirrored).comparison.unwrap();
    assert_eq!(less.severity.unwrap().verdict, DifferenceVerdict::Smaller);
    assert!(
        (less.severity.unwrap().mean + mean).abs() < 1e-12 && less.message.contains("less severe"),
        "{less:?}"
    );
    // One design tells no error, and designs that are known with one model only no difference.
    let one = answer(&asked, &all[..4]).comparison.unwrap().severity.unwrap();
    assert_eq!((one.pairs, one.standard_error, one.verdict), (1, None, DifferenceVerdict::Undecided));
    assert_eq!(answer(&asked, &all[..2]).comparison.unwrap().severity, None);
}

/// Designs added for the first model's threshold, and mixed points of indices: neither count in the mean difference.
#[test]
fn designs_that_lean_on_others_are_not_compared() {
    let threshold = json!({"parameter": "clearance", "within": 1e-3, "batch": 8});
    let parameters = json!([clearance("clearance", 0.0, 1.0), clearance("other", 0.0, 1.0)]);
    let asked = resolve(json!({
        "parameters": parameters, "design": {"kind": "indices", "size": 8}, "limit": 0.5, "threshold": threshold, "compared_model": "n",
    }))
    .unwrap();
    let of = |asked: &ResolvedCampaign, index: u32| {
        let values = &asked.settings.designs[index as usize / 4];
        let other = if index % 4 < 2 { 0.0 } else { 1e-5 };
        point(index, "completed", values[0] + 0.01 * values[1] + other)
    };
    let all: Vec<Point> = (0..asked.simulations()).map(|index| of(&asked, index)).collect();
    let longer = more_designs(&asked, &all).unwrap();
    assert_eq!((longer.settings.added, longer.designs()), (8, 8 * 4 + 8));
    let all: Vec<Point> = (0..longer.simulations()).map(|index| of(&longer, index)).collect();
    let comparison = answer(&longer, &all).comparison.unwrap();
    let told = comparison.severity.unwrap();
    assert_eq!(told.pairs, 16);
    // The difference is 1e-5 in all designs, but severities are known only to 1e-3 of their size.
    assert!((told.mean - 1e-5).abs() < 1e-12 && told.from.unwrap() > 0.9e-5, "{told:?}");
    assert_eq!(told.verdict, DifferenceVerdict::Undecided);
    assert!(comparison.sensitivities.is_some() && comparison.threshold.is_some());
}

#[test]
fn what_cannot_be_compared_is_refused() {
    let request = |changes: Value| -> CampaignRequest {
        let mut all = json!({"parameters": [clearance("c", 0.0, 1.0)], "design": {"kind": "sobol", "size": 2}, "compared_model": "n"});
        for (field, value) in changes.as_object().unwrap() {
            all[field] = value.clone();
        }
        serde_json::from_value(self::request(all)).unwrap()
    };
    let facts = ModelFacts::of_ten_sectors(4);
    let refused = |request: CampaignRequest, compared: &ComparedModel| {
        let found = resolve_all(request, facts.clone(), Some(compared.clone())).unwrap_err();
        found.into_iter().map(|violation| (violation.pointer, violation.message)).collect::<Vec<_>>()
    };
    let units = refused(request(json!({})), &other_model("m"));
    assert!(units[0].0 == "/compared_model" && units[0].1.contains("t-m-s-N"), "{units:?}");
    let same = refused(request(json!({"compared_model": "m"})), &other_model("mm"));
    assert_eq!(same[0].0, "/compared_model");
    // Contact node 3 is there in the first model only.
    let sensor = json!({"contact_node": 3, "component": "radial"});
    let mut other = other_model("mm");
    other.sensors = vec![serde_json::from_value(sensor.clone()).unwrap()];
    let sensors = refused(request(json!({"sensors": [sensor]})), &other);
    assert!(sensors[0].0.starts_with("/sensors/0") && sensors[0].1.contains("compared"), "{sensors:?}");
}

/// Designs share a table of heights, whose curves are made once; those that change it have a table each.
#[test]
fn designs_share_measured_heights_unless_they_change_them() {
    let angles: Vec<f64> = (0..1000).map(|k| f64::from(k) * std::f64::consts::TAU / 1000.0).collect();
    let heights: Vec<f64> = angles.iter().map(|angle| 0.1 * (2.0 * angle).cos()).collect();
    let table = json!({"angles_rad": angles, "chord": [0.0, 1.0], "heights": [heights, heights]});
    let mut scene = request(json!({}))["scene"].clone();
    scene["casing"]["measured"] = table;
    let asked = |parameter: Value, size: u32| {
        let design = json!({"kind": "latin_hypercube", "size": size, "seed": 1});
        resolve(json!({"scene": scene, "parameters": [parameter], "design": design}))
    };
    let moving = json!({"name": "one", "at": ["/scene/casing/measured/heights/0/5"], "change": "add", "from": -1e-4, "to": 1e-4});
    assert_eq!(asked(clearance("c", 0.0, 0.1), 600).unwrap().designs(), 600);
    assert_eq!(asked(moving.clone(), 20).unwrap().designs(), 20);
    let refused = asked(moving, 600).unwrap_err();
    assert_eq!(refused[0].pointer, "/parameters/0/at");
    assert!(refused[0].message.contains("1000000"), "{}", refused[0].message);
}
