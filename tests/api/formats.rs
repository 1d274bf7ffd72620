//! Results as JSON, CSV, npz, SVG, PNG and figures: the form of the answer, its content, parts of results, speeds in other units.

use reqwest::StatusCode;
use reqwest::header::HeaderMap;
use serde_json::{Value, json};

use super::app::{Answer, Api, TestApp, modal_analysis_of, sweep_of};
use super::model;
use super::npz::Npz;

/// Answer as it comes.
pub(super) struct Raw {
    status: StatusCode,
    headers: HeaderMap,
    body: Vec<u8>,
}

impl Raw {
    fn header(&self, name: &str) -> &str {
        self.headers.get(name).map_or("", |value| value.to_str().unwrap())
    }

    pub(super) fn body(&self) -> &[u8] {
        &self.body
    }

    pub(super) fn text(&self) -> &str {
        std::str::from_utf8(&self.body).unwrap()
    }

    pub(super) fn json(&self) -> Value {
        serde_json::from_slice(&self.body).unwrap()
    }

    #[track_caller]
    pub(super) fn good(self) -> Self {
        assert_eq!(self.status, 200, "{}", String::from_utf8_lossy(&self.body));
        self
    }
}

pub(super) async fn get(api: &Api, path: &str, headers: &[(&str, &str)]) -> Raw {
    let mut request = api.request("GET", path);
    for (name, value) in headers {
        request = request.header(*name, *value);
    }
    let response = request.send().await.unwrap();
    let (status, headers) = (response.status(), response.headers().clone());
    Raw { status, headers, body: response.bytes().await.unwrap().to_vec() }
}

/// Lines and columns of a table without quotes.
pub(super) fn table(csv: &str) -> Vec<Vec<&str>> {
    let lines: Vec<&str> = csv.strip_suffix("\r\n").unwrap().split("\r\n").collect();
    let rows: Vec<Vec<&str>> = lines.iter().map(|line| line.split(',').collect()).collect();
    assert!(rows.iter().all(|row| row.len() == rows[0].len()), "{csv}");
    rows
}

/// Runs a sweep with two sensors and a coating to a good end.
pub(super) async fn worn_sweep(api: &Api, model: &str) -> String {
    let mut request = sweep_of(model);
    request["scene"]["abradable"] = json!({"modulus": 2e4, "yield_stress": 20.0, "hardening": 500.0, "thickness": 2.0, "rods_around": 90});
    request["sensors"] = json!([
        {"contact_node": 0, "component": "radial"},
        {"contact_node": 1, "sector": 2, "component": "tangential"},
    ]);
    let id = api.sweep(&request).await;
    let job = api.finish(&id).await;
    assert_eq!(job["status"], "successful", "{job}");
    id
}

pub(super) async fn job(api: &Api, path: &str, request: &Value) -> String {
    let id = api.post(path, request).await.text("/id");
    assert_eq!(api.finish(&id).await["status"], "successful");
    id
}

const FORMS: [(&str, &str); 6] = [
    ("json", "application/json"),
    ("csv", "text/csv; charset=utf-8"),
    ("npz", "application/x-npz"),
    ("svg", "image/svg+xml"),
    ("png", "image/png"),
    ("plotly", "application/vnd.plotly.v1+json"),
];

/// Asserts that an answer has the form that it claims.
fn assert_reads(form: &str, raw: &Raw) {
    match form {
        "json" => assert!(raw.json().is_object()),
        "csv" => assert!(table(raw.text()).len() > 1),
        "npz" => assert!(Npz::read(&raw.body).names().len() > 4),
        "svg" => {
            let drawing = roxmltree::Document::parse(raw.text()).unwrap();
            assert_eq!(drawing.root_element().tag_name().name(), "svg");
        }
        "plotly" => {
            let figure = raw.json();
            assert_eq!(figure.as_object().unwrap().keys().collect::<Vec<_>>(), ["data", "layout"]);
            assert!(
                !figure["data"].as_array().unwrap().is_empty()
                    && figure["layout"]["meta"]["kind"].is_string()
            );
        }
        _ => {
            assert!(raw.body.starts_with(b"\x89PNG\r\n\x1a\n"));
            // The width stands at the begin of the first chunk.
            assert_eq!(raw.body[16..20], 640u32.to_be_bytes());
        }
    }
}

#[tokio::test]
async fn every_result_comes_in_every_form() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let sweep = worn_sweep(api, &model).await;
    let modal = job(api, "/v1/modal-analyses", &modal_analysis_of(&model)).await;
    let study = job(api, "/v1/studies", &super::studies::study_of(&model)).await;
    for path in [
        format!("/v1/models/{model}/section"),
        format!("/v1/models/{model}/section?view=cyclic&sweep={sweep}"),
        format!("{sweep}/interaction-map"),
        format!("{sweep}/interaction-map?sensor=1&nodal_diameter=2&axis=frequency"),
        format!("{sweep}/interaction-map?frame=fixed&nodal_diameter=1"),
        format!("{sweep}/critical-speeds?sensor=1"),
        format!("{sweep}/spectra/3"),
        format!("{sweep}/spectra/3?sensor=1&frame=fixed"),
        format!("{sweep}/wear/3"),
        format!("{modal}/campbell"),
        format!("{modal}/campbell?frame=fixed"),
        format!("{modal}/interference?lobes=3&from=100&to=200"),
        format!("{study}/work-precision?speed=1&quantity=history"),
        format!("{study}/work-precision?over=step"),
        format!("{study}/histories?speed=1&sensor=1"),
    ] {
        let path = if path.starts_with('/') { path } else { format!("/v1/jobs/{path}") };
        let joint = if path.contains('?') { '&' } else { '?' };
        for (form, content_type) in FORMS {
            let asked = format!("{path}{joint}format={form}&width=640");
            let raw = get(api, &asked, &[]).await.good();
            assert_eq!(raw.header("content-type"), content_type, "{asked}");
            assert!(raw.headers.get_all("vary").iter().any(|value| value == "accept"), "{asked}");
            assert_reads(form, &raw);
            // The header asks for the same form, which the query overrides.
            let media_type = content_type.split(';').next().unwrap();
            let accepted =
                get(api, &format!("{path}{joint}width=640"), &[("accept", media_type)]).await.good();
            assert!(accepted.body == raw.body, "{asked}");
            let both = get(api, &asked, &[("accept", "text/html")]).await.good();
            assert_eq!(both.header("content-type"), content_type);
            // A client that has the drawing gets no second copy.
            let tag = raw.header("etag");
            assert!(tag.starts_with('"') && tag == accepted.header("etag"), "{asked}");
            for list in [tag, &format!("\"other\", W/{tag}"), "*"] {
                let unchanged = get(api, &asked, &[("if-none-match", list)]).await;
                assert_eq!((unchanged.status.as_u16(), unchanged.header("etag")), (304, tag), "{asked}");
                assert!(unchanged.body.is_empty());
            }
            let changed = get(api, &format!("{asked}&units=rpm"), &[("if-none-match", tag)]).await.good();
            assert_ne!(changed.header("etag"), tag);
        }
        for accept in ["*/*", "text/html, */*;q=0.1", "application/json;q=0.5, text/csv;q=0.4"] {
            let raw = get(api, &path, &[("accept", accept)]).await.good();
            assert_eq!(raw.header("content-type"), "application/json", "{path}");
        }
        let request = api.request("GET", &path).header("accept", "text/html, image/jpeg");
        let answer = Answer::of(request.send().await.unwrap()).await;
        let items = answer.problem(406, "not-acceptable");
        assert_eq!(items[0]["parameter"], "Accept");
        assert!(answer.text("/detail").contains("image/png"), "{}", answer.body);
        let unknown = api.get(&format!("{path}{joint}format=pdf")).await;
        assert_eq!(unknown.problem(400, "invalid-parameter")[0]["parameter"], "format");
    }
    app.stop().await;
}

#[tokio::test]
async fn the_contract_names_the_forms_that_a_route_has() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let mut request = sweep_of(&model);
    request["record"] = json!({"histories": {"speeds": [0], "quantities": ["state"]}});
    let sweep = job(api, "/v1/sweeps", &request).await;
    let contract = api.get("/openapi.json").await.body;
    for (route, id, query) in [
        ("/v1/models/{id}/section", &model, ""),
        ("/v1/models/{id}/mesh", &model, ""),
        ("/v1/models/{id}/modes", &model, ""),
        ("/v1/jobs/{id}/interaction-map", &sweep, ""),
        ("/v1/jobs/{id}/critical-speeds/wheel", &sweep, ""),
        ("/v1/jobs/{id}/verdict", &sweep, ""),
        ("/v1/jobs/{id}/level", &sweep, ""),
        ("/v1/jobs/{id}/fields", &sweep, "speed=0&engine_order=2"),
    ] {
        let parameters = contract["paths"][route]["get"]["parameters"].as_array().unwrap();
        let referred = |part: &'_ Value| match part["$ref"].as_str() {
            Some(path) => contract.pointer(&path[1..]).unwrap().clone(),
            None => part.clone(),
        };
        let format = parameters.iter().map(referred).find(|parameter| parameter["name"] == "format").unwrap();
        let named = format["schema"]["enum"].as_array().unwrap();
        for form in ["json", "csv", "npz", "svg", "png", "plotly", "vtu", "vtp", "pvd"] {
            let asked = format!("{}?format={form}&{query}", route.replace("{id}", id));
            let raw = get(api, &asked, &[]).await;
            let refused = raw.status == 400 && raw.text().contains("format: expected one of");
            assert_eq!(!refused, named.iter().any(|word| word == form), "{asked}: {}", raw.status);
            assert_ne!(raw.status, 406, "{asked}");
        }
    }
    app.stop().await;
}

#[tokio::test]
async fn what_is_selected_is_a_part_of_the_whole() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let sweep = worn_sweep(api, &model).await;
    let map = format!("/v1/jobs/{sweep}/interaction-map");
    let whole = [api.get(&map).await.body, api.get(&format!("{map}?sensor=1")).await.body];
    assert_eq!(whole[0]["speed_indices"], json!([0, 1, 2, 3, 4, 5]));
    // Speeds are 300, 420, … 900 rad/s; engine orders 0, 1/4, … 8.
    let rows = |map: &Value, speeds: &[usize], columns: &[usize]| -> Value {
        speeds
            .iter()
            .map(|&speed| {
                columns.iter().map(|&column| map["amplitude"][speed][column].clone()).collect::<Value>()
            })
            .collect()
    };
    let columns: Vec<usize> = (4..=8).chain([14]).collect();
    for speeds in ["0-1,4", "4, 1, 0", "290-430rad_s,4", "2800-4100rpm,4", "46-67.5hz,4"] {
        let part = api.get(&format!("{map}?speeds={speeds}&orders=1-2,3.5&sensor=1")).await.body;
        assert_eq!(part["speed_indices"], json!([0, 1, 4]), "{speeds}");
        assert_eq!(part["speeds_rad_s"], json!([300.0, 420.0, 780.0]));
        assert_eq!(part["engine_orders"], json!([1.0, 1.25, 1.5, 1.75, 2.0, 3.5]));
        assert_eq!(part["amplitude"], rows(&whole[1], &[0, 1, 4], &columns));
        let indices: Vec<&Value> =
            part["points"].as_array().unwrap().iter().map(|point| &point["index"]).collect();
        assert_eq!(indices, [0, 1, 4]);
        assert_eq!(part["sensor"], whole[1]["sensor"]);
    }
    let several = api.get(&format!("{map}?sensors=0-1&speeds=2-3&orders=0-8")).await.body;
    let all: Vec<usize> = (0..33).collect();
    assert_eq!(several["amplitude"], json!([rows(&whole[0], &[2, 3], &all), rows(&whole[1], &[2, 3], &all)]));
    assert_eq!(several["sensors"], json!([whole[0]["sensor"], whole[1]["sensor"]]));
    assert!(several.get("sensor").is_none());
    let one = api.get(&format!("{map}?sensors=1&speeds=2")).await.body;
    assert_eq!(one["amplitude"], json!([rows(&whole[1], &[2], &all)]));

    let numbers = |value: &Value| -> Vec<f64> {
        value
            .as_array()
            .unwrap()
            .iter()
            .flat_map(|row| row.as_array().unwrap())
            .map(|x| x.as_f64().unwrap())
            .collect()
    };
    let bits = |values: Vec<f64>| values.into_iter().map(f64::to_bits).collect::<Vec<_>>();
    let file = Npz::read(&get(api, &format!("{map}?format=npz"), &[]).await.good().body);
    assert_eq!(file.array("amplitude").shape, [6, 33]);
    assert_eq!(bits(file.array("amplitude").reals()), bits(numbers(&whole[0]["amplitude"])));
    assert_eq!(file.array("speeds_rad_s").reals(), [300.0, 420.0, 540.0, 660.0, 780.0, 900.0]);
    let file =
        Npz::read(&get(api, &format!("{map}?format=npz&sensors=0,1&speeds=4-5&orders=0-1"), &[]).await.body);
    assert_eq!(file.array("amplitude").shape, [2, 2, 5]);
    let parts = whole.iter().flat_map(|map| numbers(&rows(map, &[4, 5], &[0, 1, 2, 3, 4])));
    assert_eq!(bits(file.array("amplitude").reals()), bits(parts.collect()));
    assert_eq!(file.array("speed_indices").whole(), [4, 5]);
    assert_eq!(file.array("status").texts(), ["completed", "completed"]);
    let sensor: Value = serde_json::from_str(&file.array("sensors").texts()[1]).unwrap();
    assert_eq!(sensor, whole[1]["sensor"]);

    let csv = get(api, &format!("{map}?format=csv&sensors=0-1&speeds=1&orders=0-0.5"), &[]).await.good();
    let rows_of = table(csv.text());
    let head = ["sensor", "index", "speed_rpm", "status", "order_0_um", "order_0.25_um", "order_0.5_um"];
    assert_eq!(rows_of[0], head);
    assert_eq!((rows_of[2][0], rows_of[2][1], rows_of[2][3]), ("1", "1", "completed"));
    let micrometres = 1e3 * whole[1]["amplitude"][1][1].as_f64().unwrap();
    for (cell, wanted) in
        [(rows_of[2][2], 420.0 * 60.0 / std::f64::consts::TAU), (rows_of[2][5], micrometres)]
    {
        assert!((cell.parse::<f64>().unwrap() - wanted).abs() < 1e-12 * wanted, "{cell} is not {wanted}");
    }

    let spectra = format!("/v1/jobs/{sweep}/spectra/2");
    let whole = api.get(&spectra).await.body;
    let part = api.get(&format!("{spectra}?sensors=1&orders=0.5,7.5-8")).await.body;
    assert_eq!(part["spectra"]["engine_orders"], json!([0.5, 7.5, 7.75, 8.0]));
    let of = |line: &Value| json!([line[2], line[30], line[31], line[32]]);
    let (found, sensor) = (&part["spectra"]["sensors"], &whole["spectra"]["sensors"][1]);
    assert_eq!(found.as_array().unwrap().len(), 1);
    assert_eq!(found[0]["amplitude"], of(&sensor["amplitude"]));
    assert_eq!(found[0]["nodal_diameters"][2], of(&sensor["nodal_diameters"][2]));
    let file =
        Npz::read(&get(api, &format!("{spectra}?format=npz&sensors=1&orders=0.5"), &[]).await.good().body);
    assert_eq!(
        (&file.array("amplitude").shape[..], &file.array("nodal_diameters").shape[..]),
        (&[1, 1][..], &[1, 3, 1][..])
    );
    assert_eq!(file.array("speed_rad_s").reals(), [540.0]);
    app.stop().await;
}

#[tokio::test]
async fn speeds_come_in_other_units_as_well() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let sweep = worn_sweep(api, &model).await;
    let rpm = 60.0 / std::f64::consts::TAU;
    let near = |value: &Value, wanted: f64| {
        let value = value.as_f64().unwrap();
        assert!((value - wanted).abs() < 1e-9 * wanted, "{value} is not {wanted}");
    };
    for path in ["interaction-map", "interaction-map?sensors=0"] {
        let joint = if path.contains('?') { '&' } else { '?' };
        let map = api.get(&format!("/v1/jobs/{sweep}/{path}{joint}units=rpm")).await.body;
        near(&map["speeds_rpm"][0], 300.0 * rpm);
        near(&map["points"][1]["speed_rpm"], 420.0 * rpm);
        assert_eq!(map["speeds_rad_s"][0], 300.0);
        assert_eq!(map["settings"]["speeds"]["unit"], "rad_s", "settings stay as they are");
    }
    let spectra = api.get(&format!("/v1/jobs/{sweep}/spectra/0?units=hz")).await.body;
    near(&spectra["point"]["speed_hz"], 300.0 / std::f64::consts::TAU);
    // A table has every speed once.
    let peaks = api.get(&format!("/v1/jobs/{sweep}/critical-speeds")).await.body;
    for (units, unit, factor) in [
        ("", "rpm", rpm),
        ("&units=rpm", "rpm", rpm),
        ("&units=rad_s", "rad_s", 1.0),
        ("&units=hz", "hz", rpm / 60.0),
    ] {
        let csv = format!("/v1/jobs/{sweep}/critical-speeds?format=csv{units}");
        let csv = get(api, &csv, &[]).await.good();
        let rows = table(csv.text());
        let head = [format!("speed_{unit}"), format!("speed_error_{unit}")];
        assert_eq!(rows[0][1..3], head, "{units}");
        assert!(rows.len() > 1);
        let level = rows[0].iter().position(|name| *name == "rms_um").unwrap();
        for (row, peak) in rows[1..].iter().zip(peaks["critical_speeds"].as_array().unwrap()) {
            near(&json!(row[1].parse::<f64>().unwrap()), factor * peak["speed_rad_s"].as_f64().unwrap());
            near(&json!(row[level].parse::<f64>().unwrap()), 1e3 * peak["rms"].as_f64().unwrap());
        }
    }
    let file = get(api, &format!("/v1/jobs/{sweep}/interaction-map?format=npz&units=rpm"), &[]).await.good();
    near(&json!(Npz::read(&file.body).array("speeds_rpm").reals()[5]), 900.0 * rpm);
    let same = get(api, &format!("/v1/jobs/{sweep}/critical-speeds?units=rad_s"), &[]).await.good().json();
    assert_eq!(same, api.get(&format!("/v1/jobs/{sweep}/critical-speeds")).await.body);
    app.stop().await;
}

#[tokio::test]
async fn nonsense_is_refused_in_words() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let sweep = worn_sweep(api, &model).await;
    for (query, parameter) in [
        ("interaction-map?speeds=9-1", "speeds"),
        ("interaction-map?speeds=99999999", "speeds"),
        ("interaction-map?speeds=0-18446744073709551616", "speeds"),
        ("interaction-map?speeds=", "speeds"),
        ("interaction-map?speeds=1e-3-1e4rpm", "speeds"),
        ("interaction-map?speeds=0,,1", "speeds"),
        ("interaction-map?orders=nan", "orders"),
        ("interaction-map?orders=-1", "orders"),
        ("interaction-map?orders=0.1", "orders"),
        ("interaction-map?sensors=2", "sensors"),
        ("interaction-map?sensors=0&sensor=0", "sensors"),
        ("interaction-map?sensors=0-1&format=svg", "sensors"),
        ("interaction-map?speeds=1&format=svg", "speeds"),
        ("interaction-map?nodal_diameter=1&nodal_diameters=1", "nodal_diameters"),
        ("interaction-map?nodal_diameters=0-1", "nodal_diameters"),
        ("interaction-map?nodal_diameters=0-3&format=svg", "nodal_diameters"),
        ("interaction-map?nodal_diameters=0-1&frame=fixed&format=svg", "frame"),
        ("interaction-map?format=png&width=0", "width"),
        ("interaction-map?format=png&width=4001", "width"),
        ("interaction-map?format=png&width=1e9", "width"),
        ("interaction-map?format=PNG", "format"),
        ("interaction-map?units=knots", "units"),
        ("spectra/0?orders=inf", "orders"),
        ("spectra/0?sensors=5", "sensors"),
        ("spectra/0?sensor=5", "sensor"),
        ("spectra/0?frame=bent", "frame"),
    ] {
        let answer = api.get(&format!("/v1/jobs/{sweep}/{query}")).await;
        assert_eq!(answer.problem(400, "invalid-parameter")[0]["parameter"], parameter, "{query}");
    }
    let many = "0,".repeat(600);
    let answer = api.get(&format!("/v1/jobs/{sweep}/interaction-map?speeds={many}0")).await;
    answer.problem(400, "invalid-parameter");
    api.get(&format!("/v1/jobs/{sweep}/wear/6")).await.problem(404, "speed-not-found");
    let bare = api.sweep(&sweep_of(&model)).await;
    api.finish(&bare).await;
    api.get(&format!("/v1/jobs/{bare}/wear/0")).await.problem(409, "result-unavailable");
    app.stop().await;
}

/// Columns that came later stand at the end, and are there for models that say nothing of stress, too.
#[tokio::test]
async fn utilisation_is_absent_without_stress_and_that_is_said() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let sweep = worn_sweep(api, &model).await;
    let modal = job(api, "/v1/modal-analyses", &modal_analysis_of(&model)).await;
    for path in ["critical-speeds", "critical-speeds/wheel"] {
        let csv = get(api, &format!("/v1/jobs/{sweep}/{path}?format=csv"), &[]).await.good();
        let rows = table(csv.text());
        let last =
            |row: &[&str]| row[row.len() - 3..].iter().map(|cell| (*cell).to_owned()).collect::<Vec<_>>();
        assert_eq!(last(&rows[0]), ["utilisation", "validity", "validity_lacking"], "{path}");
        let ranked = api.get(&format!("/v1/jobs/{sweep}/{path}?rank=utilisation")).await;
        assert_eq!(ranked.problem(400, "invalid-parameter")[0]["parameter"], "rank");
        assert!(rows.len() > 1 && rows[1..].iter().all(|row| last(row)[0].is_empty()), "{path}");
    }
    let raw = get(api, &format!("/v1/jobs/{sweep}/interaction-map?format=npz"), &[]).await.good();
    let file = Npz::read(&raw.body);
    let speeds = file.array("speeds_rad_s").reals().len();
    for name in ["utilisation", "largest_von_mises"] {
        let values = file.array(name).reals();
        assert!(values.len() == speeds && values.iter().all(|value| value.is_nan()), "{name}");
    }
    assert_eq!(file.array("validity").texts().len(), speeds);
    let map = format!("/v1/jobs/{sweep}/interaction-map?format=svg&colour=utilisation");
    assert!(get(api, &map, &[]).await.good().text().contains("no utilisation is known"));
    for (path, status, kind) in [
        (format!("{sweep}/stress"), 404, "stress-not-recorded"),
        (format!("{sweep}/stress?speed=1&format=png"), 404, "stress-not-recorded"),
        (format!("{sweep}/stress?speed=99999"), 404, "speed-not-found"),
        (format!("{sweep}/stress?colour=mean"), 400, "invalid-parameter"),
        (format!("{modal}/stress"), 409, "wrong-job-kind"),
        ("00000000-0000-0000-0000-000000000000/stress".to_owned(), 404, "job-not-found"),
    ] {
        api.get(&format!("/v1/jobs/{path}")).await.problem(status, kind);
    }
    app.stop().await;
}

#[tokio::test]
async fn what_may_change_has_no_tag_and_what_is_missing_no_number() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let id = api.sweep(&super::app::long_sweep_of(&model, 400)).await;
    api.follow(&id, |job| job["speeds"]["finished"].as_u64() > Some(0)).await;
    let map = format!("/v1/jobs/{id}/interaction-map");
    let raw = get(api, &format!("{map}?format=npz"), &[("if-none-match", "*")]).await.good();
    assert_eq!(raw.header("etag"), "");
    let file = Npz::read(&raw.body);
    let (status, amplitude) = (file.array("status").texts(), file.array("amplitude").reals());
    assert_eq!(status.len(), 400);
    let rows: Vec<&[f64]> = amplitude.chunks(amplitude.len() / 400).collect();
    for (status, row) in status.iter().zip(rows) {
        assert!(row.iter().all(|x| x.is_nan() != (status == "completed")), "{status}");
    }
    assert!(status.iter().any(|status| status == "completed") && status.iter().any(String::is_empty));
    get(api, &format!("{map}?format=png"), &[]).await.good();
    api.get(&format!("/v1/jobs/{id}/critical-speeds?format=svg")).await.problem(409, "result-not-ready");
    api.delete(&format!("/v1/jobs/{id}")).await;
    api.finish(&id).await;
    assert!(get(api, &map, &[]).await.good().header("etag").starts_with('"'));
    let answer = Answer::of(
        api.request("GET", &format!("/v1/jobs/{id}/critical-speeds"))
            .header("if-none-match", "*")
            .send()
            .await
            .unwrap(),
    );
    answer.await.problem(409, "result-unavailable");
    app.stop().await;
}

#[tokio::test]
async fn a_section_has_the_nodes_of_the_package_and_the_clearance_of_a_sweep() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let sweep = api.sweep(&sweep_of(&model)).await;
    let path = format!("/v1/models/{model}/section");
    let bare = api.get(&path).await.body;
    let kinds: Vec<&Value> = bare["nodes"].as_array().unwrap().iter().map(|node| &node["kind"]).collect();
    assert_eq!(kinds, ["low", "internal", "contact", "contact", "high"]);
    assert_eq!(bare["nodes"][4]["position"], json!([50.0, std::f64::consts::FRAC_PI_2, 0.0]));
    assert!(bare["contact"][0].get("clearance").is_none());
    let cased = api.get(&format!("{path}?sweep={sweep}")).await.body;
    assert_eq!(
        (&cased["contact"][0]["clearance"], &cased["contact"][1]["clearance"]),
        (&json!(0.30), &json!(0.25))
    );
    let csv = get(api, &format!("{path}?format=csv"), &[]).await.good();
    assert_eq!(table(csv.text())[0], ["id", "kind", "r_mm", "theta_rad", "z_mm"]);
    let other = api.model(model::package(2.0)).await;
    for sweep in [&format!("/v1/models/{other}/section?sweep={sweep}"), &format!("{path}?sweep=nonsense")] {
        assert_eq!(api.get(sweep).await.problem(400, "invalid-parameter")[0]["parameter"], "sweep");
    }
    api.get("/v1/models/nonsense/section").await.problem(404, "model-not-found");
    app.stop().await;
}

#[tokio::test]
async fn a_sheet_and_a_window_are_drawn() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let sweep = worn_sweep(api, &model).await;
    let path = format!("/v1/jobs/{sweep}/interaction-map?format=svg");
    let whole = get(api, &path, &[]).await.good();
    for query in ["&nodal_diameters=0-2", "&speeds=1-3&orders=0-4", "&nodal_diameters=1&speeds=4000-8000rpm"]
    {
        let drawing = get(api, &format!("{path}{query}"), &[]).await.good();
        assert!(roxmltree::Document::parse(drawing.text()).is_ok());
        assert!(drawing.body != whole.body && drawing.header("etag") != whole.header("etag"), "{query}");
        // The file is drawn once, and then comes as it was.
        assert!(get(api, &format!("{path}{query}"), &[]).await.body == drawing.body);
    }
    app.stop().await;
}

/// Program that reads the map as an array and as a table, which both must be equal to the bit.
const READ_BY_PYTHON: &str = "
import sys, numpy, pandas
for name in sys.argv[1:]:
    arrays = numpy.load(name + '.npz', allow_pickle=False)
    table = pandas.read_csv(name + '.csv', float_precision='round_trip')
    assert len(table) > 0 and all(arrays[key].size >= 0 for key in arrays), name
    if name.endswith('map'):
        assert numpy.array_equal(arrays['amplitude'], table.filter(like='order_').to_numpy())
        assert numpy.array_equal(arrays['speeds_rpm'], table['speed_rpm'])
        assert str(arrays['version']) and 'mm' in str(arrays['units'])
";

/// Reads results by the programs that they are for, where these are installed: in `RUBMAP_PYTHON`, or else `python3`.
#[tokio::test]
async fn numpy_and_pandas_read_them() {
    let python = std::env::var("RUBMAP_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let run = |arguments: &[&str]| std::process::Command::new(&python).args(arguments).output();
    if !run(&["-c", "import numpy, pandas"]).is_ok_and(|output| output.status.success()) {
        eprintln!("skipped: {python} has no numpy and pandas");
        return;
    }
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let sweep = worn_sweep(api, &model).await;
    let modal = job(api, "/v1/modal-analyses", &modal_analysis_of(&model)).await;
    let study = job(api, "/v1/studies", &super::studies::study_of(&model)).await;
    let folder = tempfile::tempdir().unwrap();
    let mut arguments = vec!["-c".to_owned(), READ_BY_PYTHON.to_owned()];
    for (name, path) in [
        ("map", format!("/v1/jobs/{sweep}/interaction-map")),
        ("critical-speeds", format!("/v1/jobs/{sweep}/critical-speeds")),
        ("spectra", format!("/v1/jobs/{sweep}/spectra/1")),
        ("wear", format!("/v1/jobs/{sweep}/wear/1")),
        ("campbell", format!("/v1/jobs/{modal}/campbell")),
        ("work-precision", format!("/v1/jobs/{study}/work-precision")),
        ("histories", format!("/v1/jobs/{study}/histories")),
        ("section", format!("/v1/models/{model}/section")),
    ] {
        for form in ["csv", "npz"] {
            let raw = get(api, &format!("{path}?format={form}&units=rpm"), &[]).await.good();
            std::fs::write(folder.path().join(format!("{name}.{form}")), raw.body).unwrap();
        }
        arguments.push(folder.path().join(name).to_str().unwrap().to_owned());
    }
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let output = run(&arguments).unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    app.stop().await;
}
