//! Checks of bodies against the contract: everything that is wrong with their structure is reported at once, in users' words.

use std::path::Path;

use serde_json::{Value, json};

use super::app::{Answer, Api, TestApp, sweep_of};
use super::model;

async fn post_text(api: &Api, path: &str, body: Vec<u8>) -> Answer {
    let request = api.request("POST", path).header("content-type", "application/json").body(body);
    Answer::of(request.send().await.unwrap()).await
}

/// Pointers and details of a problem's items.
#[track_caller]
fn items(answer: &Answer, kind: &str) -> Vec<(String, String)> {
    let text = |item: &Value, name: &str| item[name].as_str().unwrap_or_default().to_owned();
    answer.problem(422, kind).iter().map(|item| (text(item, "pointer"), text(item, "detail"))).collect()
}

#[tokio::test]
async fn all_structural_errors_come_at_once_in_words() {
    let app = TestApp::start().await;
    let mut request = sweep_of("m");
    request["colour"] = json!("red");
    request["refine"] = json!("yes");
    request["max_engine_order"] = json!(5_000_000_000_u64);
    request["sweep"] = json!({"up": null});
    request["speeds"]["unit"] = json!("furlongs");
    request["speeds"]["count"] = json!(2.5);
    request["scene"]["casing"]["clearance"] = json!([0.3, 0.2]);
    request["scene"]["casing"]["lobes"] =
        json!({"leeding": 1, "count": [2], "amplitude": "0.4", "width_rad": null});
    request["scene"]["contact"] = json!({"stiffness": 1e6});
    request["scene"]["damping"] = json!({});
    request["integration"]["scheme"] = json!("exact");
    request["integration"]["steps_per_revolution"] = json!("many");
    request["sensors"] = json!([{"contact_node": -1, "component": 7}]);
    let answer = app.api.post("/v1/sweeps", &request).await;
    let pairs = |pairs: &[(&str, &str)]| -> Vec<(String, String)> {
        pairs.iter().map(|&(pointer, detail)| (pointer.to_owned(), detail.to_owned())).collect()
    };
    let mut found = items(&answer, "invalid-request");
    found.sort();
    let mut expected = pairs(&[
        (
            "/colour",
            "this field does not exist here; those here are accuracy, blade_thickness, budget, control_speeds, fields, integration, \
          limits, max_engine_order, model, modes_per_speed, name, notes, operation, peak_prominence, record, refine, \
          reproducible, scene, sensors, speeds, sweep, tags",
        ),
        ("/refine", "expected true or false, or null, not the text \"yes\""),
        ("/max_engine_order", "expected a whole number from 1 to 1000, not 5000000000"),
        ("/sweep", "expected one of independent, up, down, not an object"),
        ("/speeds/unit", "expected one of rad_s, rpm, hz, not the text \"furlongs\""),
        ("/speeds/count", "expected a whole number from 1 to 10000, or null, not 2.5"),
        (
            "/scene/casing/clearance",
            "expected an object with any of the fields given, leading, trailing, values, not a list",
        ),
        (
            "/scene/casing/lobes/leeding",
            "this field does not exist here; those here are along_chord, amplitude, count, \
          phase_rad, width_rad",
        ),
        ("/scene/casing/lobes/count", "expected a whole number from 1 to 100, not a list"),
        ("/scene/casing/lobes/amplitude", "expected a number, not the text \"0.4\""),
        ("/scene/casing/lobes/width_rad", "expected a number, not null"),
        ("/scene/contact/stiffness", "this field does not exist here; there are no fields here"),
        ("/scene/damping/modal_ratio", "this field is missing; expected a number"),
        (
            "/integration/scheme",
            "expected one of auto, central_differences, exact_modal, massless_boundary, not the text \
          \"exact\"",
        ),
        (
            "/integration/steps_per_revolution",
            "expected \"auto\", or a whole number from 1 to 10000000, not the text \
          \"many\"",
        ),
        ("/sensors/0/contact_node", "expected a whole number from 0 to 4294967295, or null, not -1"),
        ("/sensors/0/component", "expected one of radial, tangential, axial, normal, or null, not 7"),
    ]);
    expected.sort();
    assert_eq!(found, expected);
    let detail = answer.text("/detail");
    assert!(detail.contains("/colour: this field") && detail.contains("; /"), "{detail}");
    app.stop().await;
}

#[tokio::test]
async fn fields_that_are_alike_are_suggested_and_doubled_ones_refused() {
    let app = TestApp::start().await;
    let body =
        br#"{"model": "m", "model": "n", "speeds": [{"unit": "hz", "unit": "hz", "valeus": [1]}], "scene": {
        "casing": {"clearance": {"leeding": 0.3, "a/b~c": 1}}}}"#;
    let answer = post_text(&app.api, "/v1/sweeps", body.to_vec()).await;
    let expected = [
        ("/model", "this field is given twice; give it once"),
        ("/speeds/0/unit", "this field is given twice; give it once"),
        ("/speeds/0/valeus", "this field does not exist here; did you mean `values`?"),
        ("/scene/casing/clearance/leeding", "this field does not exist here; did you mean `leading`?"),
        (
            "/scene/casing/clearance/a~1b~0c",
            "this field does not exist here; those here are given, leading, trailing, values",
        ),
    ];
    assert_eq!(items(&answer, "invalid-request"), expected.map(|(a, b)| (a.to_owned(), b.to_owned())));
    app.stop().await;
}

/// Serde would take fields by position and unit variants as objects too; the contract does not.
#[tokio::test]
async fn what_only_serde_would_take_is_refused() {
    let app = TestApp::start().await;
    for (pointer, value, refused_at) in [
        ("/scene", json!([]), "/scene"),
        ("/speeds", json!([null, null, null, [1], "hz"]), "/speeds/0"),
        ("/speeds", json!([[null, null, null, [1], "hz"]]), "/speeds/0"),
        ("/scene/casing/lobes", json!([2, 0.4, 0.35, 0]), "/scene/casing/lobes"),
        ("/speeds/unit", json!({"hz": null}), "/speeds/unit"),
    ] {
        let mut request = sweep_of("m");
        *request.pointer_mut(pointer).unwrap() = value;
        let answer = app.api.post("/v1/sweeps", &request).await;
        assert_eq!(answer.pointers(422, "invalid-request")[0], refused_at, "{}", answer.body);
    }
    app.stop().await;
}

/// Answers are short: whatever is wrong with a request of whatever size, the answer says how much more is wrong.
#[tokio::test]
async fn answers_are_short() {
    let app = TestApp::start().await;
    let model = app.api.model(model::package(1.0)).await;
    let long = "é".repeat(900_000);
    let many = |text: &str| text.repeat(1_800_000 / text.len());
    let list = |entry: &str| format!("[{}0]", many(entry));
    let sweep = |name: &str, value: &str| {
        let mut request = sweep_of(&model).to_string();
        request.truncate(request.len() - 1);
        format!("{request},{name:?}:{value}}}")
    };
    let all = 100_000;
    for (body, shown, at_least) in [
        (sweep("sensors", &list("0,")), 20, 64),
        (sweep("accuracy", &list("0,")), 1, 1),
        (sweep(&long, "1"), 1, 1),
        (sweep("budget", &format!("{{{}\"seconds\":1}}", many("\"second\":1,"))), 20, all),
        (format!("{{\"model\":\"{long}\"}}"), 3, 3),
        (format!("{{\"speeds\":{},\"model\":\"m\",\"scene\":{{}}}}", list("0,")), 20, all),
        (format!("{{\"scene\":{{\"engine_order_excitation\":{}}}}}", list("{},")), 20, all),
    ] {
        let answer = post_text(&app.api, "/v1/sweeps", body.into_bytes()).await;
        let items = answer.problem(422, answer.text("/type").rsplit(':').next().unwrap());
        assert_eq!(items.len(), shown, "{}", answer.body);
        assert!(answer.body.to_string().len() < 10_000, "{}", answer.body);
        if at_least > shown {
            let last = items[19]["detail"].as_str().unwrap();
            let more: usize =
                last.strip_prefix("and ").unwrap().strip_suffix(" more").unwrap().parse().unwrap();
            assert!(19 + more >= at_least, "{last}");
        }
    }
    // What is wrong with the model in mind, as well.
    let mut request = sweep_of(&model);
    request["sensors"] = json!(vec![json!({"contact_node": 99, "component": "radial"}); 30]);
    let items = app.api.post("/v1/sweeps", &request).await.problem(422, "invalid-request");
    assert_eq!((items.len(), &items[19]), (20, &json!({"detail": "and 11 more"})));
    app.api.get(&format!("/v1/models/{}", "m".repeat(5000))).await.problem(404, "model-not-found");
    let answer = app.api.get(&format!("/v1/jobs/{}", "j".repeat(5000))).await;
    answer.problem(404, "job-not-found");
    assert!(answer.text("/detail").len() < 100, "{}", answer.body);
    app.stop().await;
}

#[tokio::test]
async fn depth_does_no_harm() {
    let app = TestApp::start().await;
    let deep = 900_000;
    for (open, close) in [("[", "]"), ("{\"scene\":", "}")] {
        let deep = deep / open.len();
        for body in [
            format!("{}1{}", open.repeat(deep), close.repeat(deep)),
            format!("{{\"model\":{}1{}}}", open.repeat(deep), close.repeat(deep)),
        ] {
            let answer = post_text(&app.api, "/v1/sweeps/plan", body.into_bytes()).await;
            assert_eq!(answer.status, 422, "{}", answer.body);
        }
        let unfinished = open.repeat(deep).into_bytes();
        post_text(&app.api, "/v1/sweeps/plan", unfinished).await.problem(400, "malformed-json");
    }
    app.stop().await;
}

/// Requests of the corpus whose structure is sound pass: their model does not exist here, and the answer says only that.
#[tokio::test]
async fn the_corpus_of_sound_requests_passes() {
    let app = TestApp::start().await;
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus/sweep");
    let mut sound = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        let answer = post_text(&app.api, "/v1/sweeps/plan", std::fs::read(&path).unwrap()).await;
        let pointers: Vec<&Value> =
            answer.body["errors"].as_array().unwrap().iter().map(|item| &item["pointer"]).collect();
        let passes = pointers == ["/model"] && answer.text("/detail").contains("there is no model");
        // Fields by position are no JSON objects, though serde would take them.
        if ["ran-", "long-", "failed-"].iter().any(|kind| name.starts_with(kind))
            && name != "ran-by-position.json"
        {
            assert!(passes, "{name}: {}", answer.body);
            sound += 1;
        } else if !name.starts_with("refused-") {
            assert!(!passes && [400, 422].contains(&answer.status.as_u16()), "{name}: {}", answer.body);
        }
    }
    assert!(sound > 30, "{sound}");
    app.stop().await;
}

/// Example of a value that a schema admits, with all its fields.
fn example(schema: &Value, schemas: &Value) -> Value {
    if let Some(name) = schema["$ref"].as_str() {
        return example(&schemas[name.rsplit('/').next().unwrap()], schemas);
    }
    if let Some(choices) = schema["oneOf"].as_array() {
        return example(&choices[0], schemas);
    }
    let r#type = if schema["type"].is_array() { &schema["type"][0] } else { &schema["type"] };
    match r#type.as_str().unwrap() {
        "object" if schema["additionalProperties"].is_object() => {
            json!({"m": example(&schema["additionalProperties"], schemas)})
        }
        "object" => {
            assert_eq!(schema["additionalProperties"], false, "unknown fields would be taken: {schema}");
            let fields = schema["properties"].as_object().into_iter().flatten();
            fields.map(|(name, schema)| (name.clone(), example(schema, schemas))).collect()
        }
        "array" => {
            let entries = schema["minItems"].as_u64().unwrap_or(1).max(1) as usize;
            json!(vec![example(&schema["items"], schemas); entries])
        }
        "string" => schema["enum"].get(0).cloned().unwrap_or(json!("m")),
        "boolean" => json!(false),
        "integer" => schema.get("minimum").cloned().unwrap_or(json!(1)),
        "number" => schema.get("minimum").cloned().unwrap_or(json!(0.5)),
        other => panic!("{other}"),
    }
}

/// Asserts that the check of bodies knows all keywords of the contract: it would not check others.
fn keywords_are_known(schema: &Value) {
    const KNOWN: [&str; 20] = [
        "$ref",
        "oneOf",
        "type",
        "format",
        "enum",
        "description",
        "default",
        "example",
        "properties",
        "required",
        "additionalProperties",
        "propertyNames",
        "items",
        "minItems",
        "maxItems",
        "maxLength",
        "minimum",
        "maximum",
        "exclusiveMinimum",
        "exclusiveMaximum",
    ];
    for keyword in schema.as_object().unwrap().keys() {
        assert!(KNOWN.contains(&keyword.as_str()), "{keyword} in {schema}");
    }
}

fn all_schemas<'a>(schema: &'a Value, schemas: &'a Value, seen: &mut Vec<&'a Value>) {
    seen.push(schema);
    if let Some(name) = schema["$ref"].as_str() {
        all_schemas(&schemas[name.rsplit('/').next().unwrap()], schemas, seen);
    }
    let choices = schema["oneOf"].as_array().into_iter().flatten();
    let fields = schema["properties"].as_object().into_iter().flat_map(|fields| fields.values());
    let named = schema.get("additionalProperties").filter(|values| values.is_object());
    for below in choices.chain(fields).chain(schema.get("items")).chain(named) {
        all_schemas(below, schemas, seen);
    }
}

fn all_pointers(value: &Value, pointer: &str, found: &mut Vec<String>) {
    found.push(pointer.to_owned());
    match value {
        Value::Object(fields) => {
            fields.iter().for_each(|(name, value)| all_pointers(value, &format!("{pointer}/{name}"), found));
        }
        Value::Array(entries) => {
            let entries = entries.iter().enumerate();
            entries.for_each(|(index, value)| all_pointers(value, &format!("{pointer}/{index}"), found));
        }
        _ => {}
    }
}

/// Replaces every part of every body by values of every type: none is refused in Rust's words, and refusals point to the part.
#[tokio::test]
async fn no_place_of_any_body_speaks_rust() {
    let app = TestApp::start().await;
    let document = serde_json::to_value(rubmap::http::document()).unwrap();
    let schemas = &document["components"]["schemas"];
    let wrong = [
        json!(null),
        json!(true),
        json!("auto"),
        json!({}),
        json!([]),
        json!([[]]),
        json!(-1),
        json!(0),
        json!(0.5),
        json!(1e300),
        json!(u64::MAX),
        json!({"up": null}),
        json!({"no": 1}),
    ];
    let rust = [
        "invalid type",
        "invalid value",
        "invalid length",
        "unknown variant",
        "unknown field",
        "missing field",
        "duplicate field",
        "struct",
        "u32",
        "u64",
        "f64",
        "usize",
        "sequence",
        "..=",
    ];
    for path in [
        "/v1/sweeps/plan",
        "/v1/branches/plan",
        "/v1/run-ups/plan",
        "/v1/modal-analyses/plan",
        "/v1/studies",
        "/v1/case-studies",
        "/v1/models/plan",
    ] {
        let schema = &document["paths"][path]["post"]["requestBody"]["content"]["application/json"]["schema"];
        let mut seen = Vec::new();
        all_schemas(schema, schemas, &mut seen);
        seen.into_iter().for_each(keywords_are_known);
        let sound = example(schema, schemas);
        let mut pointers = Vec::new();
        all_pointers(&sound, "", &mut pointers);
        assert!(pointers.len() > 15, "{pointers:?}");
        for pointer in &pointers {
            for value in &wrong {
                let mut body = sound.clone();
                *body.pointer_mut(pointer).unwrap() = value.clone();
                let answer = app.api.post(path, &body).await;
                assert!([200, 422].contains(&answer.status.as_u16()), "{pointer} {value}: {}", answer.body);
                let whole = answer.body["detail"].as_str().unwrap_or_default();
                let said = rust.iter().find(|word| whole.contains(**word));
                assert_eq!(said, None, "{path} {pointer} {value}: {whole}");
                for item in answer.body["errors"].as_array().into_iter().flatten() {
                    let detail = item["detail"].as_str().unwrap();
                    let said = rust.iter().find(|word| detail.contains(**word));
                    assert_eq!(said, None, "{path} {pointer} {value}: {detail}");
                    if detail.starts_with("expected") {
                        assert!(
                            item["pointer"].as_str().unwrap().starts_with(pointer),
                            "{pointer} {value}: {item}"
                        );
                    }
                }
            }
        }
    }
    app.stop().await;
}
