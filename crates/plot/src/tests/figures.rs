//! Properties of figures: their numbers are those of the results, and the page decides its own style.

use std::collections::BTreeSet;

use serde_json::{Value, json};

use super::drawings::{credentials, mm};
use super::figure_gallery::all;
use super::fixtures::{contact, recorded, spectra, worn};
use super::pens::figure;
use super::stresses::{of_sweep, stressed_map};
use super::studies::{RUNS, study};
use super::{SPEEDS_RPM, backbones, critical, map, modes};
use crate::{ForceQuantity, Frame, HaighColour, HistoryQuantity, LevelColour, VerticalAxis, Window};
use rubmap_analysis::result::{BackboneCurve, Quantity};

/// Finds the trace of this name.
pub(super) fn trace<'a>(figure: &'a Value, name: &str) -> &'a Value {
    let traces = figure["data"].as_array().unwrap();
    traces.iter().find(|trace| trace["name"] == name).unwrap_or_else(|| panic!("no {name}: {figure}"))
}

/// Traces of a name, in their order.
fn traces<'a>(figure: &'a Value, name: &str) -> impl Iterator<Item = &'a Value> {
    figure["data"].as_array().unwrap().iter().filter(move |trace| trace["name"] == name)
}

pub(super) fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|value| value.as_f64().unwrap_or(f64::NAN)).collect()
}

#[test]
fn colours_of_the_page_are_left_to_the_page() {
    for (name, figure) in all() {
        let figure = json!(figure);
        let layout = figure["layout"].as_object().unwrap();
        assert!(layout["meta"]["kind"].is_string(), "{name}");
        for (attribute, value) in layout {
            assert!(
                !attribute.contains("bgcolor") && attribute != "font" && attribute != "template",
                "{name}"
            );
            if attribute.contains("axis") {
                let colours = ["color", "gridcolor", "linecolor", "zerolinecolor", "tickcolor"];
                assert!(colours.iter().all(|colour| value.get(colour).is_none_or(Value::is_null)), "{name}");
            }
        }
        assert!(layout.get("width").is_none(), "{name}");
    }
}

/// Nodal diameters beyond the kinds of dashes have marks: no two of 28 look alike, and all are named.
#[test]
fn backbone_curves_of_many_nodal_diameters_look_different() {
    let mut found = backbones();
    let first = found.curves[0].clone();
    found.curves = (0..28).map(|nodal_diameter| BackboneCurve { nodal_diameter, ..first.clone() }).collect();
    let figure = json!(figure::backbones(&found));
    let look = |i: u32| {
        let named = trace(&figure, &format!("nodal diameter {i}"));
        let symbol = if i < 4 { String::new() } else { named["marker"]["symbol"].to_string() };
        format!("{} {symbol}", named["line"]["dash"])
    };
    let looks: BTreeSet<String> = (0..28).map(look).collect();
    assert_eq!(looks.len(), 28, "{looks:?}");
    let marked = traces(&figure, "family 1").filter(|trace| trace["mode"] == "markers");
    let marks: Vec<usize> = marked.map(|trace| numbers(&trace["x"]).len()).collect();
    assert_eq!(marks, [4; 24]);
}

/// Changes that the harmonics do not resolve are drawn as none, and larger ones as they are.
#[test]
fn a_backbone_curve_of_round_off_is_straight() {
    let mut found = backbones();
    for point in &mut found.curves[1].points {
        point.change_percent *= 1e-5;
    }
    let figure = json!(figure::backbones(&found));
    assert!(numbers(&trace(&figure, "family 2")["x"]).iter().all(|change| *change == 0.0));
    assert!(numbers(&trace(&figure, "family 1")["x"]).iter().any(|change| *change > 5.0));
}

/// Amplitudes in the row of `map()`: 0.01 at engine order 1 and 0.5 at 2; its third speed diverged.
#[test]
fn cells_have_the_amplitudes_of_the_map() {
    let whole = Window::default();
    let figure = json!(figure::interaction_map(
        &map(),
        None,
        None,
        VerticalAxis::EngineOrder,
        whole,
        LevelColour::Plain
    ));
    let cells = &figure["data"][0];
    let (x, y) = (numbers(&cells["x"]), numbers(&cells["y"]));
    assert!(x.iter().zip(SPEEDS_RPM).all(|(x, rpm)| (x - rpm).abs() < 1e-6), "{x:?}");
    assert_eq!(y, [0.5, 1.0, 1.5, 2.0, 2.5, 3.0], "the mean is no row");
    for (row, logarithm, amplitude) in [(1, -2.0, 0.01), (3, 0.5f64.log10(), 0.5), (0, 5e-4f64.log10(), 0.0)]
    {
        let values = numbers(&cells["z"][row]);
        assert!(values[2].is_nan(), "a speed without a result is a gap");
        assert!((values[4] - logarithm).abs() < 1e-6, "{values:?}");
        let told = numbers(&cells["customdata"][row][4]);
        let expected = [amplitude, y[row] * SPEEDS_RPM[4] / 60.0, super::rad_s(SPEEDS_RPM[4])];
        assert!(
            told.iter().zip(expected).all(|(told, value)| (told - value).abs() <= 1e-6 * value),
            "{told:?}"
        );
    }
    let level = trace(&figure, "level");
    assert_eq!(level["x"][2], Value::Null);
    assert!((level["y"][3].as_f64().unwrap() - 0.4).abs() < 1e-12);
    assert_eq!(trace(&figure, "not settled")["customdata"], json!([3]));
    let missing = trace(&figure, "no result");
    assert_eq!(missing["customdata"], json!([2]));
    assert_eq!(missing["hovertext"], json!(["12000 rpm: grew beyond &lt;bounds&gt;"]));
    assert_eq!(figure["layout"]["meta"]["speed_indices"], json!([0, 1, 2, 3, 4]));
}

/// Frequencies on the vertical axis: 0.5 mm at engine order 2 lie at 10,000 / 60 · 2 Hz.
#[test]
fn frequencies_are_engine_orders_times_the_speed() {
    let whole = Window::default();
    let figure = json!(figure::interaction_map(
        &map(),
        None,
        None,
        VerticalAxis::Frequency,
        whole,
        LevelColour::Plain
    ));
    let cells = &figure["data"][0];
    let y = numbers(&cells["y"]);
    for (column, rpm) in [(0, SPEEDS_RPM[0]), (4, SPEEDS_RPM[4])] {
        let row = y.iter().position(|hz| (hz - rpm / 30.0).abs() < 2.0).unwrap();
        let told = numbers(&cells["customdata"][row][column]);
        assert!((told[0] - 0.5).abs() < 1e-6 && (told[1] - 2.0).abs() < 0.02, "{told:?}");
    }
}

/// Map of 1,000 speeds by 1,000 engine orders, one amplitude of which is the largest.
#[test]
fn a_large_map_is_thinned_by_its_largest() {
    let mut large = map();
    let rpm = |i: u32| super::rad_s(1000.0 + f64::from(i));
    large.speeds_rad_s = (0..1000).map(rpm).collect();
    large.engine_orders = (0..=1000).map(|bin| 0.05 * f64::from(bin)).collect();
    large.amplitude = vec![Some(vec![1e-3; 1001]); 1000];
    large.amplitude[777].as_mut().unwrap()[333] = 0.7;
    large.points.clear();
    for axis in [VerticalAxis::EngineOrder, VerticalAxis::Frequency] {
        let figure = figure::interaction_map(&large, None, None, axis, Window::default(), LevelColour::Plain);
        let text = serde_json::to_vec(&figure).unwrap();
        assert!(text.len() < 8 << 20, "{} bytes", text.len());
        let figure: Value = serde_json::from_slice(&text).unwrap();
        let cells = &figure["data"][0];
        let (x, y) = (numbers(&cells["x"]), numbers(&cells["y"]));
        assert!(x.len() <= 500 && y.len() <= 201, "{} {}", x.len(), y.len());
        let found = cells["customdata"].as_array().unwrap().iter().flat_map(|row| row.as_array().unwrap());
        let found = found.filter(|told| (told[0].as_f64().unwrap() - 0.7).abs() < 1e-6).count();
        assert!((1..=3).contains(&found), "{found}");
        let title = figure["layout"]["title"]["subtitle"]["text"].as_str().unwrap();
        assert!(title.contains("are one<br>cell") || title.contains("are one cell"), "{title}");
        let indices = figure["layout"]["meta"]["column_speed_indices"].as_array().unwrap();
        assert!(indices.contains(&json!(777)) && indices.len() == x.len());
    }
    let sheet = figure::map_sheet(&vec![large; 30], Window::default(), LevelColour::Plain);
    let text = serde_json::to_vec(&sheet).unwrap();
    assert!(text.len() < 12 << 20, "{} bytes", text.len());
}

/// Panels of a sheet share their legend: a click hides a name in all of them.
#[test]
fn maps_of_a_sheet_share_their_legend() {
    let sheet = json!(figure::map_sheet(&vec![map(); 3], Window::default(), LevelColour::Plain));
    let traces = sheet["data"].as_array().unwrap();
    let lobes: Vec<&Value> =
        traces.iter().filter(|trace| trace["name"] == "engine orders of lobes").collect();
    assert_eq!(lobes.len(), 3);
    assert!(lobes.iter().all(|trace| trace["legendgroup"] == "engine orders of lobes"));
    assert!(lobes[1..].iter().all(|trace| trace["showlegend"] == false), "named once");
    assert_eq!((&lobes[0]["showlegend"], &lobes[2]["xaxis"]), (&Value::Null, &json!("x3")));
    assert_eq!(sheet["layout"]["xaxis3"]["matches"], "x");
    assert_eq!(sheet["layout"]["annotations"][2]["text"], "all nodal diameters");
}

#[test]
fn peaks_have_the_errors_of_the_table() {
    let figure = json!(figure::critical_speeds(&critical()));
    let peak = trace(&figure, "critical speed");
    assert!((peak["x"][0].as_f64().unwrap() - SPEEDS_RPM[1]).abs() < 1e-6);
    assert!((peak["error_x"]["array"][0].as_f64().unwrap() - 1000.0).abs() < 1e-6);
    assert_eq!(peak["customdata"], json!([1]));
    assert_eq!(trace(&figure, "peak not resolved")["customdata"], json!([3]));
    let driven = trace(&figure, "driven by the lobes, (i, j)");
    assert!((driven["x"][0].as_f64().unwrap() - 12_500.0).abs() < 1e-6);
}

/// Lines of nodal diameter 2 at engine order 4 are seen at 6 and at 2 in the fixed frame.
#[test]
fn spectra_are_where_they_are_seen() {
    let figure = |frame| json!(figure::spectrum(&spectra(6), &credentials(), &mm(), 0, frame));
    let seen = |trace: &Value| {
        let largest = numbers(&trace["y"]).iter().position(|y| (y - 0.3).abs() < 1e-12).unwrap();
        (trace["x"][largest].as_f64().unwrap(), trace["hovertext"][largest].as_str().unwrap().to_owned())
    };
    let rotating = seen(trace(&figure(Frame::Rotating), "nodal diameter 2"));
    assert_eq!(rotating.0, 4.0);
    let hz = 4.0 * credentials().speed_rad_s / std::f64::consts::TAU;
    assert!(rotating.1.replace(',', "").contains(&format!(" {hz:.1} Hz")), "{rotating:?}");
    let fixed = figure(Frame::Fixed);
    assert_eq!(seen(trace(&fixed, "nodal diameter 2")).0, 6.0);
    // Both directions of travel are shown and hidden together; open marks are those against the rotation.
    let is_backward =
        |one: &&Value| one["name"] == "nodal diameter 2" && one["marker"]["symbol"] == "triangle-up-open";
    assert_eq!(seen(fixed["data"].as_array().unwrap().iter().find(is_backward).unwrap()).0, 2.0);
}

/// Engine orders of the rotating frame are at other orders in the fixed one: neither their lines nor crossings at them are drawn.
#[test]
fn the_fixed_frame_has_no_engine_orders_of_the_wheel() {
    let names = |figure: Value| -> Vec<String> {
        let named = figure["data"].as_array().unwrap().iter();
        named.filter_map(|trace| trace["name"].as_str().map(str::to_owned)).collect()
    };
    let (map, critical, whole) = (map(), critical(), Window::default());
    for axis in [VerticalAxis::EngineOrder, VerticalAxis::Frequency] {
        let plain = LevelColour::Plain;
        let rotating = figure::interaction_map(&map, Some(&critical), None, axis, whole, plain);
        let fixed = json!(figure::fixed_frame_map(&map, Some(&critical), axis, whole, plain));
        assert!(fixed["data"][0]["hovertemplate"].as_str().unwrap().contains("multiple of Ω"));
        let only_rotating =
            ["driven (i, j)", "engine orders of lobes", "linear (i, j, n)", "other engine orders"];
        let (rotating, fixed) = (names(json!(rotating)), names(fixed));
        let mut gone: Vec<&String> = rotating.iter().filter(|name| !fixed.contains(name)).collect();
        gone.sort();
        assert_eq!(gone, only_rotating);
    }
}

/// Ten nodal diameters, each a resonance at its own engine order: marks at those orders only, and at most eight entries.
#[test]
fn dense_spectra_mark_peaks_and_name_the_largest() {
    let mut dense = spectra(10);
    for (n, row) in dense.sensors[0].nodal_diameters.iter_mut().enumerate() {
        let away = |bin: usize| (bin as f64 - 4.0 * n as f64) / 2.0;
        row.iter_mut()
            .enumerate()
            .for_each(|(bin, value)| *value = 0.01 * (1.0 + n as f64) / (1.0 + away(bin).powi(2)));
    }
    let figure = json!(figure::spectrum(&dense, &credentials(), &mm(), 0, Frame::Rotating));
    let traces = figure["data"].as_array().unwrap();
    let listed: Vec<&str> = traces
        .iter()
        .filter(|one| one["showlegend"] != json!(false))
        .filter_map(|one| one["name"].as_str())
        .collect();
    assert_eq!(listed.iter().filter(|name| name.starts_with("nodal diameter ")).count(), 6, "{listed:?}");
    assert!(listed.contains(&"other nodal diameters") && listed.len() <= 8, "{listed:?}");
    for n in 4..10 {
        let name = json!(format!("nodal diameter {n}"));
        let marks = traces.iter().find(|one| one["name"] == name && one["mode"] == json!("markers")).unwrap();
        assert_eq!(numbers(&marks["x"]), [n as f64]);
    }
}

#[test]
fn histories_keep_their_extremes() {
    let long = recorded([10, 50], 512);
    let figure = json!(figure::speed_histories(&long, HistoryQuantity::Force, 0));
    let force = &long.contact.as_ref().unwrap().force;
    for (blade, nodes) in force.iter().enumerate() {
        let drawn = numbers(&trace(&figure, &format!("blade {blade}"))["y"]);
        let largest = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
        assert!(drawn.len() < nodes[0].len() && largest(&drawn) == largest(&nodes[0]), "{blade}");
    }
}

#[test]
fn cells_of_contact_and_wear_have_the_largest() {
    let map = contact(10);
    let figure = json!(figure::force_map(&map, ForceQuantity::Peak));
    let row = &map.rows[1].as_ref().unwrap().peak_force;
    for (node, force) in row.iter().enumerate() {
        assert!((figure["data"][0]["z"][node][1].as_f64().unwrap() - force).abs() < 1e-4);
        assert_eq!(figure["data"][0]["z"][node][2], Value::Null);
    }
    let worn = worn(2000, 10);
    let figure = json!(figure::wear_map(&worn, &credentials(), &mm()));
    for node in 0..10 {
        let drawn = numbers(&figure["data"][0]["z"][node]);
        let deepest = worn.depths.iter().map(|rod| rod[node]).fold(0.0, f64::max);
        assert!(drawn.len() <= 500 && (drawn.iter().copied().fold(0.0, f64::max) - deepest).abs() < 1e-6);
    }
}

#[test]
fn cycles_are_where_their_stress_is() {
    let stress = of_sweep(&stressed_map());
    let figure = json!(figure::haigh(&stress, HaighColour::Utilisation));
    let markers: Vec<&Value> =
        figure["data"].as_array().unwrap().iter().filter(|trace| trace["mode"] == "markers").collect();
    let count: usize = markers.iter().map(|trace| numbers(&trace["x"]).len()).sum();
    let cycles = stress.speeds.iter().map(|speed| speed.stress.cycles.len()).sum::<usize>();
    assert_eq!(count, cycles);
    let goodman = figure["data"]
        .as_array()
        .unwrap()
        .iter()
        .find(|trace| trace["name"].as_str().is_some_and(|name| name.starts_with("Goodman")));
    let (_, factor) = rubmap_analysis::result::drawn_stress_unit(&stress.units);
    let strengths = &stress.strengths[0];
    let end = numbers(&goodman.unwrap()["x"])[2];
    assert!((end - factor * strengths.ultimate.unwrap()).abs() < 1e-9 * end, "{end}");
}

#[test]
fn runs_of_a_study_have_their_errors() {
    let found = study(&RUNS, false);
    let figure = json!(figure::work_precision(&found, 0, Quantity::Amplitude));
    let drawn: usize = figure["data"]
        .as_array()
        .unwrap()
        .iter()
        .filter(|trace| trace["mode"] == "markers+text")
        .map(|trace| numbers(&trace["y"]).len())
        .sum();
    let known = found.speeds[0].runs.iter().filter(|run| {
        run.errors.as_ref().and_then(|errors| errors.of(Quantity::Amplitude)).is_some_and(|error| error > 0.0)
    });
    assert_eq!(drawn, known.count());
    assert!(drawn > 0);
}

/// Natural frequencies of `modes()`: 400 + 5 s + i Hz.
#[test]
fn campbell_lines_are_the_frequencies() {
    let figure = json!(figure::campbell(&modes()));
    let of_family: Vec<_> = traces(&figure, "family 1").map(|trace| numbers(&trace["y"])).collect();
    assert_eq!(of_family[1], [401.0, 406.0, 411.0, 416.0, 421.0]);
    // One colour a family, other dashes for every nodal diameter, both of which the legend explains.
    let looks = |name: &str| {
        let of = |trace: &Value| (trace["line"]["color"].clone(), trace["line"]["dash"].clone());
        traces(&figure, name).map(of).collect::<Vec<_>>()
    };
    let (first, second) = (looks("family 1"), looks("family 2"));
    assert!(first.iter().all(|(colour, _)| *colour == "#0072b2"), "{first:?}");
    assert!(second.iter().all(|(colour, _)| *colour == "#d55e00"), "{second:?}");
    assert_eq!(first.iter().map(|look| &look.1).collect::<Vec<_>>(), ["solid", "dash", "dot"]);
    assert_eq!(looks("nodal diameter 1")[0].1, "dash");
    let fixed = json!(figure::campbell_fixed_frame(&modes()));
    let seen = traces(&fixed, "family 1").map(|trace| numbers(&trace["y"])).nth(1).unwrap();
    let against = (401.0 - SPEEDS_RPM[0] / 60.0).abs();
    assert!((seen[0] - against).abs() < 1e-9, "{seen:?}");
}

/// Empty results give a message and no trace.
#[test]
fn nothing_to_draw_is_said() {
    let mut still = spectra(3);
    still.sensors[0].amplitude.fill(0.0);
    still.sensors[0].nodal_diameters.iter_mut().for_each(|row| row.fill(0.0));
    let of = |sensor| json!(figure::spectrum(&still, &credentials(), &mm(), sensor, Frame::Rotating));
    for figure in [of(0), of(7), json!(figure::map_sheet(&[], Window::default(), LevelColour::Plain))] {
        assert_eq!(figure["data"], json!([]));
        assert!(figure["layout"]["annotations"][0]["text"].as_str().unwrap().len() > 10);
    }
}
