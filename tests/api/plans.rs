//! Plans: what a job would do and cost, before it runs.

use rubmap::store::Store;
use serde_json::{Value, json};

use super::app::{Api, TestApp, modal_analysis_of, sweep_of};
use super::branches::branches_of;
use super::campaigns::campaign_of;
use super::case_studies::case_of;
use super::model;
use super::run_ups::run_ups_of;
use super::studies::study_of;

/// Names of the effects of a plan that are on.
fn effects_on(plan: &Value) -> Vec<&str> {
    let effects = plan["effects"].as_array().unwrap().iter();
    let on = effects.filter(|effect| effect["on"] == true);
    on.inspect(|effect| assert!(effect["adds"].is_string(), "{effect}"))
        .map(|effect| effect["name"].as_str().unwrap())
        .collect()
}

#[tokio::test]
async fn a_plan_starts_nothing_and_foretells_the_sweep() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let request = sweep_of(&model);
    let answer = api.post("/v1/sweeps/plan", &request).await;
    assert_eq!(answer.status, 200, "{}", answer.body);
    let plan = answer.body;
    assert_eq!(effects_on(&plan), ["damping", "casing", "contact"]);
    // Two lobes on four sectors.
    assert_eq!(
        plan["symmetry"],
        json!({"repeats": 2, "moving_nodal_diameters": [0, 2], "resting_nodal_diameters": [1]})
    );
    assert_eq!(
        (&plan["contact_pairs"], &plan["speeds"], &plan["workers"]),
        (&json!(8), &json!(6), &json!(2))
    );
    assert_eq!(plan["settings"]["sensors"].as_array().unwrap().len(), 2, "the request is resolved");
    assert_eq!(plan["reduction"], "to be computed");
    // N(n_b + 3k) with one stiffness instead of three.
    assert_eq!(plan["reduced_unknowns_at_most"], 4 * (6 + 3));
    assert_eq!((&plan["points"], &plan["estimate"]), (&json!([]), &Value::Null));
    assert_eq!(api.get("/v1/jobs").await.body["jobs"], json!([]));
    assert_eq!(api.get(&format!("/v1/models/{model}")).await.body["reductions"], json!([]));

    let id = api.sweep(&request).await;
    assert_eq!(api.finish(&id).await["status"], "successful");
    let plan = api.post("/v1/sweeps/plan", &request).await.body;
    assert_eq!(plan["reduction"], "stored");
    let planned: Vec<_> = plan["points"].as_array().unwrap().iter().map(|point| &point["index"]).collect();
    assert_eq!(planned, [0, 3, 5], "slowest, middle and fastest");
    let map = api.get(&format!("/v1/jobs/{id}/interaction-map")).await.body;
    for point in plan["points"].as_array().unwrap() {
        assert_eq!(point["integrated_unknowns"], plan["reduced_unknowns_at_most"]);
        let ran = &map["points"][point["index"].as_u64().unwrap() as usize];
        for field in ["speed_rad_s", "scheme", "steps_per_revolution", "steps"] {
            assert_eq!(point[field], ran[field], "{field}");
        }
        let time = &point["computing_time_s"];
        assert!(time["free"].as_f64() > Some(0.0) && time["contact"].as_f64() >= time["free"].as_f64());
        assert!(point["memory_bytes"].as_u64() > Some(1000));
        // Lobes of 0.4 over a clearance that falls to 0.25.
        assert!((point["interference"].as_f64().unwrap() - 0.15).abs() < 1e-3, "{point}");
    }
    // The results have the planned cost beside the cost that was spent.
    let critical = api.get(&format!("/v1/jobs/{id}/critical-speeds")).await.body;
    assert_eq!(map["plan"], critical["plan"]);
    assert_eq!(map["plan"]["steps"], plan["estimate"]["steps"]);
    assert_eq!(map["spent"], critical["spent"]);
    assert_eq!(map["spent"]["steps"], plan["estimate"]["steps"], "one step fits all speeds here");
    let times = map["points"].as_array().unwrap().iter().map(|point| point["wall_time_s"].as_f64().unwrap());
    assert!((map["spent"]["computing_time_s"].as_f64().unwrap() - times.sum::<f64>()).abs() < 1e-9);
    // Time from the first to the last speed is another thing, and two workers make it shorter.
    assert!(map["spent"].get("wall_time_s").is_none() && map["plan"]["computing_time_s"].is_object());
    app.stop().await;
}

/// Peaks are refined by default where there are speeds enough to show them, and where speeds can be added.
#[tokio::test]
async fn a_plan_bounds_the_speeds_that_are_added() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let planned = async |change: &dyn Fn(&mut Value)| {
        let mut request = sweep_of(&model);
        change(&mut request);
        api.post("/v1/sweeps/plan", &request).await.body
    };
    let speeds = |count: u32| move |request: &mut Value| request["speeds"]["count"] = count.into();
    for (count, added) in [(19, Value::Null), (20, json!(50)), (60, json!(60))] {
        let plan = planned(&speeds(count)).await;
        assert_eq!((&plan["speeds"], &plan["added_speeds_at_most"]), (&json!(count), &added), "{plan}");
        assert_eq!(plan["settings"]["refine"], added != Value::Null);
    }
    for (field, value) in
        [("refine", json!(false)), ("sweep", json!("up")), ("budget", json!({"seconds": 60.0}))]
    {
        let change = |request: &mut Value| {
            speeds(30)(request);
            request[field] = value.clone();
            if field == "budget" {
                request.as_object_mut().unwrap().remove("modes_per_speed");
            }
        };
        let plan = planned(&change).await;
        assert_eq!((&plan["speeds"], &plan["added_speeds_at_most"]), (&json!(30), &Value::Null), "{plan}");
    }
    let limited = planned(&|request| request["limits"] = json!({"tip_motion": 1.0})).await;
    assert_eq!(limited["settings"]["control_speeds"], 5);
    app.stop().await;
}

#[tokio::test]
async fn what_cannot_be_is_refused_or_said() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let mut request = sweep_of(&model);
    request["speeds"] = json!([{"from": 300.0, "to": 900.0, "count": 0, "unit": "rad_s"}]);
    let pointers = api.post("/v1/sweeps/plan", &request).await.pointers(422, "invalid-request");
    assert_eq!(pointers, ["/speeds/0/count"]);
    let pointers = api
        .post("/v1/modal-analyses/plan", &modal_analysis_of("0000"))
        .await
        .pointers(422, "invalid-request");
    assert_eq!(pointers, ["/model"]);

    let id = api.post("/v1/modal-analyses", &modal_analysis_of(&model)).await.text("/id");
    assert_eq!(api.finish(&id).await["status"], "successful");
    let plan = api.post("/v1/modal-analyses/plan", &modal_analysis_of(&model)).await.body;
    assert_eq!((&plan["reduction"], &plan["speeds"]), (&json!("stored"), &json!(7)));
    assert_eq!((&plan["nodal_diameters"], effects_on(&plan)), (&json!(3), Vec::new()));
    assert!(plan["computing_time_s"].as_f64() > Some(0.0));

    // A property of one speed only is reported for that speed.
    let mut request = sweep_of(&model);
    request["scene"]["initial"] = json!({"nodal_diameter": 0, "family": 1, "amplitude": 2.0});
    let plan = api.post("/v1/sweeps/plan", &request).await.body;
    assert!(plan["points"][0]["message"].as_str().unwrap().contains("inside the casing"), "{plan}");
    app.stop().await;
}

/// Asserts that `change` made to a sweep is refused at `pointer`, by the plan and by the job in the same words.
async fn refused_alike(api: &Api, model: &str, pointer: &str, change: impl Fn(&mut Value)) {
    let mut request = sweep_of(model);
    change(&mut request);
    let planned = api.post("/v1/sweeps/plan", &request).await;
    assert_eq!(planned.pointers(422, "invalid-request"), [pointer], "{}", planned.body);
    let asked = api.post("/v1/sweeps", &request).await;
    assert_eq!(asked.problem(422, "invalid-request"), planned.problem(422, "invalid-request"));
}

#[tokio::test]
async fn a_plan_refuses_what_a_job_does() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    // Tips at a radius of 64.
    let lobes = "/scene/casing/lobes";
    refused_alike(api, &model, &format!("{lobes}/amplitude"), |request| {
        request["scene"]["casing"]["lobes"]["amplitude"] = 500.0.into();
    })
    .await;
    refused_alike(api, &model, &format!("{lobes}/width_rad"), |request| {
        request["scene"]["casing"]["lobes"]["width_rad"] = 6.0.into();
    })
    .await;
    refused_alike(api, &model, "/scene/casing/clearance/trailing", |request| {
        request["scene"]["casing"]["clearance"]["trailing"] = 65.0.into();
    })
    .await;
    refused_alike(api, &model, "/scene/orbit/radius", |request| {
        request["scene"]["orbit"] = json!({"radius": 7.0});
    })
    .await;
    refused_alike(api, &model, "/integration/steps_per_revolution", |request| {
        request["scene"]["casing"]["lobes"]["width_rad"] = 2e-3.into();
        request["integration"]["steps_per_revolution"] = 1000.into();
    })
    .await;
    refused_alike(api, &model, "/peak_prominence", |request| request["peak_prominence"] = 1.5.into()).await;
    assert_eq!(api.get("/v1/jobs").await.body["jobs"], json!([]), "nothing was queued");

    // The reduction alone tells this, at once when it is stored.
    let id = api.post("/v1/modal-analyses", &modal_analysis_of(&model)).await.text("/id");
    assert_eq!(api.finish(&id).await["status"], "successful");
    refused_alike(api, &model, "/integration/steps_per_revolution", |request| {
        request["integration"]["scheme"] = "central_differences".into();
        request["integration"]["steps_per_revolution"] = 40.into();
    })
    .await;
    refused_alike(api, &model, "/integration/kept_modes", |request| {
        request["integration"]["scheme"] = "massless_boundary".into();
        request["integration"]["kept_modes"] = 1000.into();
    })
    .await;
    app.stop().await;
}

/// Every kind bounds the work of checking and planning a request before it begins: what is beyond is refused at its field.
#[tokio::test]
async fn every_kind_bounds_the_work_of_its_plan() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let mut cases = Vec::new();
    for (kind, body) in [("sweeps", sweep_of(&model)), ("modal-analyses", modal_analysis_of(&model))] {
        let mut request = body;
        request["speeds"] = json!({"from": 300.0, "to": 900.0, "count": 10_001, "unit": "rad_s"});
        cases.push((kind, request, "/speeds/count"));
    }
    let mut request = case_of(&model);
    request["integration"]["revolutions"] = 50_000.into();
    request["record"] = json!({"revolutions": [0, 50_000]});
    cases.push(("case-studies", request, "/record/revolutions"));
    let mut request = study_of(&model);
    request["integration"]["revolutions"] = 50_000.into();
    request["history_revolutions"] = 50_000.into();
    cases.push(("studies", request, "/grid"));
    let mut request = branches_of(&model);
    request["most_points"] = 10_001.into();
    cases.push(("branches", request, "/most_points"));
    let mut request = run_ups_of(&model);
    request["speed"] = json!({"unit": "rad_s", "from": 1000.0, "to": 60_000.0, "rates": [2000.0]});
    request["angle_tolerance_rad"] = json!(1e-8);
    cases.push(("run-ups", request, "/speed/rates/0"));
    let mut request = campaign_of(&model);
    let angles: Vec<f64> = (0..20_000).map(|k| f64::from(k) * std::f64::consts::TAU / 20_000.0).collect();
    let heights: Vec<f64> = angles.iter().map(|angle| 0.01 * (2.0 * angle).cos()).collect();
    request["scene"]["casing"]["measured"] =
        json!({"angles_rad": angles, "chord": [0.0, 1.0], "heights": [heights, heights]});
    request["parameters"] = json!([{"name": "height", "at": ["/scene/casing/measured/heights/0/5"], "change": "add", "from": 0.0, "to": 0.01}]);
    request["design"] = json!({"kind": "latin_hypercube", "size": 26, "seed": 1});
    cases.push(("campaigns", request, "/parameters/0/at"));
    for (kind, request, pointer) in cases {
        let refused = api.post(&format!("/v1/{kind}"), &request).await;
        assert_eq!(refused.pointers(422, "invalid-request"), [pointer], "{kind}: {}", refused.body);
    }
    app.stop().await;
}

/// Results that rest on K(Ω) of a deformed geometry report how far they can be trusted, wherever their numbers are shown.
#[tokio::test]
async fn unsound_stiffening_is_said_wherever_its_numbers_are() {
    let app = TestApp::start().await;
    let api = &app.api;
    let sound = api.model(model::package(1.0)).await;
    let plan = api.post("/v1/sweeps/plan", &sweep_of(&sound)).await.body;
    assert!(plan.get("warnings").is_none(), "{plan}");

    let model = api.model(model::deformed_package()).await;
    let facts = api.get(&format!("/v1/models/{model}")).await;
    assert_eq!(facts.body["stiffening"]["verdict"], "suspect");
    assert!(facts.text("/stiffening/message").contains("Preliminary"));
    let mut request = sweep_of(&model);
    request["scene"]["centrifugal_stiffening"] = true.into();
    let plan = api.post("/v1/sweeps/plan", &request).await;
    assert!(plan.text("/warnings/0").contains("Preliminary"), "{}", plan.body);
    let plan = api.post("/v1/modal-analyses/plan", &modal_analysis_of(&model)).await;
    assert!(plan.text("/warnings/0").contains("Preliminary"), "{}", plan.body);

    let id = api.sweep(&request).await;
    let job = api.finish(&id).await;
    assert_eq!(job["status"], "successful", "{job}");
    let path = format!("/v1/jobs/{id}");
    let map = api.get(&format!("{path}/interaction-map")).await.body;
    assert_eq!(map["stiffening"], "unsound");
    for point in map["points"].as_array().unwrap() {
        assert_eq!(point["stiffening"], "unsound", "{point}");
    }
    let spectra = api.get(&format!("{path}/spectra/0")).await.body;
    assert_eq!(spectra["point"]["stiffening"], "unsound");
    let critical = api.get(&format!("{path}/critical-speeds")).await.body;
    assert_eq!(critical["reduction"]["stiffening"]["verdict"], "unsound");
    let plan = api.post("/v1/sweeps/plan", &request).await;
    assert!(plan.text("/warnings/0").contains("not positive definite"), "{}", plan.body);

    // At rest there is nothing to interpolate.
    request["scene"]["centrifugal_stiffening"] = false.into();
    let plan = api.post("/v1/sweeps/plan", &request).await.body;
    assert!(plan.get("warnings").is_none(), "{plan}");
    let id = api.sweep(&request).await;
    api.finish(&id).await;
    let map = api.get(&format!("/v1/jobs/{id}/interaction-map")).await.body;
    assert!(map.get("stiffening").is_none() && map["points"][0].get("stiffening").is_none());
    app.stop().await;
}

#[tokio::test]
async fn a_machine_is_measured_once() {
    let data = tempfile::tempdir().unwrap();
    let mut kept = Vec::new();
    for _ in 0..2 {
        let app = TestApp::start_on(data.path()).await;
        let model = app.api.model(model::package(1.0)).await;
        let plan = app.api.post("/v1/sweeps/plan", &sweep_of(&model)).await;
        let of = |field: &str| plan.body["machine"][field].clone();
        let machine = format!(
            "{}, {} processors, {}",
            of("processor").as_str().unwrap(),
            of("processors"),
            of("vectors").as_str().unwrap()
        );
        app.stop().await;
        let store = Store::open(data.path()).await.unwrap();
        kept.push(store.calibration(&machine).await.unwrap().unwrap());
        store.close().await;
    }
    // No two measurements give the same nanoseconds.
    assert_eq!(kept[0], kept[1]);
}

#[tokio::test]
async fn a_plan_of_a_generation_makes_no_model() {
    let app = TestApp::start().await;
    let api = &app.api;
    let answer = api.post("/v1/models/plan", &json!({"preset": "small", "sectors": 7})).await;
    assert_eq!(answer.status, 200, "{}", answer.body);
    let plan = answer.body;
    assert_eq!(plan["settings"]["sectors"], 7);
    let [nodes, dofs, bytes] = ["nodes", "dofs", "memory_bytes"].map(|field| plan[field].as_u64().unwrap());
    // The nodes at the bore are clamped, all others have three.
    assert!(dofs < 3 * nodes && dofs > 5 * nodes / 2 && bytes > 8 * dofs, "{plan}");
    let refused = api.post("/v1/models/plan", &json!({"sectors": 0})).await;
    assert_eq!(refused.status, 422);
    assert_eq!(refused.body["errors"][0]["pointer"], "/sectors");
    assert_eq!(api.get("/v1/jobs").await.body["jobs"], json!([]));
}
