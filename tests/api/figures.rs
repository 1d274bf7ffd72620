//! Figures for Plotly: their numbers are those of the same result in another form, and every route that draws has them.

use std::f64::consts::TAU;

use serde_json::{Value, json};

use super::app::{Api, TestApp, modal_analysis_of};
use super::case_studies::case_of;
use super::formats::{get, job, table, worn_sweep};
use super::model;
use super::npz::Npz;

async fn figure(api: &Api, path: &str) -> Value {
    let joint = if path.contains('?') { '&' } else { '?' };
    get(api, &format!("/v1/jobs/{path}{joint}format=plotly"), &[]).await.good().json()
}

async fn arrays(api: &Api, path: &str) -> Npz {
    Npz::read(get(api, &format!("/v1/jobs/{path}?format=npz"), &[]).await.good().body())
}

fn numbers(value: &Value) -> Vec<f64> {
    let list = value.as_array().unwrap_or_else(|| panic!("{value}"));
    list.iter().map(|value| value.as_f64().unwrap_or(f64::NAN)).collect()
}

/// Trace of this name.
fn trace<'a>(figure: &'a Value, name: &str) -> &'a Value {
    let traces = figure["data"].as_array().unwrap();
    traces.iter().find(|trace| trace["name"] == name).unwrap_or_else(|| panic!("no {name}: {figure}"))
}

/// Asserts that two numbers are equal but for single precision.
#[track_caller]
fn assert_near(a: f64, b: f64) {
    assert!((a - b).abs() <= 1e-6 * b.abs(), "{a} {b}");
}

#[tokio::test]
async fn a_map_has_the_numbers_of_its_arrays() {
    let app = TestApp::start().await;
    let api = &app.api;
    let sweep = worn_sweep(api, &api.model(model::package(1.0)).await).await;
    let path = format!("{sweep}/interaction-map");
    let (shown, file) = (figure(api, &path).await, arrays(api, &path).await);
    let (speeds, orders) = (file.array("speeds_rad_s").reals(), file.array("engine_orders").reals());
    let amplitude = file.array("amplitude").reals();
    let cells = &shown["data"][0];
    let (x, y) = (numbers(&cells["x"]), numbers(&cells["y"]));
    // The figure leaves out the mean.
    assert_eq!((x.len(), y.len()), (speeds.len(), orders.len() - 1));
    for (column, speed) in speeds.iter().enumerate() {
        assert_near(x[column], speed * 60.0 / TAU);
        for (row, order) in y.iter().enumerate() {
            assert_near(*order, orders[row + 1]);
            let told = numbers(&cells["customdata"][row][column]);
            assert_near(told[0], amplitude[column * orders.len() + row + 1]);
            assert_near(told[1], order * speed / TAU);
            assert_near(told[2], *speed);
        }
    }
    let loudest = cells["z"].as_array().unwrap().iter().flat_map(numbers).fold(f64::NEG_INFINITY, f64::max);
    let moving = amplitude.chunks(orders.len()).flat_map(|row| &row[1..]).fold(0.0, |m: f64, a| m.max(*a));
    assert_near(10f64.powf(loudest), moving);
    let level = trace(&shown, "level");
    let points = api.get(&format!("/v1/jobs/{path}")).await.body["points"].take();
    for (shown, point) in numbers(&level["y"]).into_iter().zip(points.as_array().unwrap()) {
        assert_near(shown, point["responses"][0]["rms"].as_f64().unwrap());
    }
    assert_eq!(numbers(&shown["layout"]["meta"]["speeds_rpm"]), numbers(&level["x"]));
    // The query selects parts and sheets.
    let part = figure(api, &format!("{path}?sensor=1&nodal_diameter=2&axis=frequency&speeds=1-3")).await;
    assert_eq!(part["data"][0]["x"].as_array().unwrap().len(), 3);
    assert_eq!(part["layout"]["meta"]["units"]["y"], "Hz");
    let sheet = figure(api, &format!("{path}?nodal_diameters=0-2&colour=utilisation")).await;
    assert_eq!(sheet["layout"]["meta"]["nodal_diameters"], json!([0, 1, 2]));
    assert!(sheet["layout"]["yaxis3"].is_object());
    api.get(&format!("/v1/jobs/{path}?sensors=0-1&format=plotly")).await.problem(400, "invalid-parameter");
    app.stop().await;
}

/// Waves of nodal diameter n at engine order k are seen at k ± n, of all at one place the largest.
#[tokio::test]
async fn a_map_in_the_fixed_frame_has_the_lines_where_they_are_seen() {
    let app = TestApp::start().await;
    let api = &app.api;
    let sweep = worn_sweep(api, &api.model(model::package(1.0)).await).await;
    let file = arrays(api, &format!("{sweep}/spectra/3")).await;
    let (orders, rows) = (file.array("engine_orders").reals(), file.array("nodal_diameters").reals());
    // The shape is that of the first sensor.
    let diameters = file.array("nodal_diameters").shape[1];
    let rows: Vec<&[f64]> = rows.chunks(orders.len()).take(diameters).collect();
    for only in [None, Some(1)] {
        let chosen = only.map(|n| format!("&nodal_diameter={n}")).unwrap_or_default();
        let shown = figure(api, &format!("{sweep}/interaction-map?frame=fixed{chosen}")).await;
        let cells = &shown["data"][0];
        let y = numbers(&cells["y"]);
        assert_eq!(*y.last().unwrap(), orders.last().unwrap() + (rows.len() - 1) as f64);
        for (row, seen) in y.iter().enumerate() {
            let mut expected: f64 = 0.0;
            for (n, amplitudes) in rows.iter().enumerate().filter(|(n, _)| only.is_none_or(|only| only == *n))
            {
                for (order, amplitude) in orders.iter().zip(*amplitudes).filter(|(order, _)| **order > 0.0) {
                    let waves = [order + n as f64, (order - n as f64).abs()];
                    if waves.iter().any(|wave| (wave - seen).abs() < 1e-9) {
                        expected = expected.max(*amplitude);
                    }
                }
            }
            assert_near(numbers(&cells["customdata"][row][3])[0], expected);
        }
    }
    app.stop().await;
}

#[tokio::test]
async fn spectra_and_critical_speeds_have_the_numbers_of_their_tables() {
    let app = TestApp::start().await;
    let api = &app.api;
    let sweep = worn_sweep(api, &api.model(model::package(1.0)).await).await;
    let (shown, file) =
        (figure(api, &format!("{sweep}/spectra/3")).await, arrays(api, &format!("{sweep}/spectra/3")).await);
    let (orders, rows) = (file.array("engine_orders").reals(), file.array("nodal_diameters").reals());
    let meta = &shown["layout"]["meta"];
    assert_eq!(meta["speed_index"], 3);
    let mut drawn = 0;
    for diameter in 0..4 {
        let name = format!("nodal diameter {diameter}");
        let Some(trace) =
            shown["data"].as_array().unwrap().iter().find(|trace| trace["name"] == name.as_str())
        else {
            continue;
        };
        for (order, amplitude) in numbers(&trace["x"]).into_iter().zip(numbers(&trace["y"])) {
            let column = orders.iter().position(|other| *other == order).unwrap();
            assert_eq!(amplitude, rows[diameter * orders.len() + column], "{name}, {order}");
            drawn += 1;
        }
    }
    assert!(drawn > 0);

    let csv = get(api, &format!("/v1/jobs/{sweep}/critical-speeds?format=csv"), &[]).await.good();
    let rows = table(csv.text());
    let column = |name: &str| rows[0].iter().position(|title| title.starts_with(name)).unwrap();
    let shown = figure(api, &format!("{sweep}/critical-speeds")).await;
    let peaks = shown["data"].as_array().unwrap().iter().filter(|trace| trace.get("error_x").is_some());
    let mut peaks: Vec<(f64, f64)> =
        peaks.flat_map(|trace| numbers(&trace["x"]).into_iter().zip(numbers(&trace["y"]))).collect();
    peaks.sort_by(|a, b| a.0.total_cmp(&b.0));
    let listed = rows[1..].iter().map(|row| {
        let number = |name: &str| row[column(name)].parse::<f64>().unwrap();
        (number("speed_rpm"), 1e-3 * number("rms_um"))
    });
    let mut listed: Vec<(f64, f64)> = listed.collect();
    listed.sort_by(|a, b| a.0.total_cmp(&b.0));
    assert_eq!(peaks.len(), listed.len());
    for (peak, listed) in peaks.iter().zip(&listed) {
        assert_near(peak.0, listed.0);
        assert_near(peak.1, listed.1);
    }
    app.stop().await;
}

#[tokio::test]
async fn histories_forces_and_modes_have_the_numbers_of_their_documents() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let mut request = case_of(&model);
    request["record"] = json!({"revolutions": [0, 2]});
    let case = job(api, "/v1/case-studies", &request).await;
    let found = api.get(&format!("/v1/jobs/{case}/histories")).await.body;
    let shown = figure(api, &format!("{case}/histories")).await;
    assert_eq!(numbers(&shown["data"][0]["y"]), numbers(&found["sensors"][0]["displacement"]));
    let samples = found["samples_per_revolution"].as_f64().unwrap();
    assert_near(shown["data"][0]["x"][0].as_f64().unwrap(), 1.0 / samples);
    for quantity in ["velocity", "force", "contact", "energy", "trajectories"] {
        let shown = figure(api, &format!("{case}/histories?quantity={quantity}")).await;
        assert!(shown["layout"]["title"]["text"].is_string() && shown["data"].is_array(), "{quantity}");
    }

    let sweep = worn_sweep(api, &model).await;
    let found = api.get(&format!("/v1/jobs/{sweep}/forces")).await.body;
    let shown = figure(api, &format!("{sweep}/forces")).await;
    for (speed, row) in found["rows"].as_array().unwrap().iter().enumerate() {
        for (node, force) in numbers(&row["peak_force"]).into_iter().enumerate() {
            assert_near(shown["data"][0]["z"][node][speed].as_f64().unwrap(), force);
        }
    }

    let modal = job(api, "/v1/modal-analyses", &modal_analysis_of(&model)).await;
    let found = api.get(&format!("/v1/jobs/{modal}/campbell")).await.body;
    let shown = figure(api, &format!("{modal}/campbell")).await;
    let first: Vec<f64> =
        found["frequencies_hz"].as_array().unwrap().iter().map(|row| row[1][0].as_f64().unwrap()).collect();
    // Curves of a family have one name, in ascending nodal diameter.
    let mut of_family = shown["data"].as_array().unwrap().iter().filter(|trace| trace["name"] == "family 1");
    assert_eq!(numbers(&of_family.nth(1).unwrap()["y"]), first);
    app.stop().await;
}
