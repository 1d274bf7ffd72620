//! Interaction map: level and spectra over speed, engine-order lines, critical speeds, linear prediction.

use super::cells::{cells, rpm};
use super::drawing::Drawing;
use super::frame::Frame;
use super::heat::{self, Heat};
use super::layer::{Layer, Mark, Marks, Upright, Uprights};
use super::level::LevelColour;
use super::map_view::{QUIETEST, VerticalAxis, View};
use super::merged::MOST;
use super::sketch::{Axis, Panel, Sketch};
use super::style::{Colour, Dash, Look, Pen, Symbol};
use super::svg::{Element, group, line, text};
use super::window::Window;
use super::{hatching, heading, level, map_lines, margin, marks, sectors, settling_strip, validity};
use rubmap_analysis::request::AutoOr;
use rubmap_analysis::result::{
    Campbell, CriticalSpeed, CriticalSpeeds, InteractionMap, StiffeningVerdict, Verdict,
};
use serde_json::json;

/// Upper left corner and size of the map.
const CORNER: (f64, f64) = (92.0, 365.0);
const SIZE: (f64, f64) = (946.0, 490.0);

/// Least height of the drawing; a long key makes it higher.
const LEAST: f64 = 1000.0;

/// Draws an interaction map or a window of it, with its critical speeds and the linear prediction where they are given.
///
/// Colour is the single-sided amplitude on a logarithmic scale of three decades below the loudest of the window; the mean is left out.
/// Spectral lines have a least height, the loudest wins. Speeds without result are hatched. Where linear theory is doubtful or left, a strip
/// says so.
///
/// The colours of the figure are the logarithms of amplitudes to the base of 10; `customdata` holds for every cell the amplitude itself, its
/// frequency in Hz (with frequencies on the vertical axis: its engine order), and the speed in rad/s. `layout.meta.amplitude` says how to
/// show it linearly.
pub fn interaction_map<'a>(
    map: &'a InteractionMap,
    critical: Option<&CriticalSpeeds>,
    campbell: Option<&Campbell>,
    axis: VerticalAxis,
    window: Window,
    level_colour: LevelColour,
) -> Drawing<'a> {
    seen_in(Frame::Rotating, map, critical, campbell, axis, window, level_colour)
}

/// Draws a map whose rows are in the fixed frame (`rubmap_analysis::run::fixed_frame_row`), or a window of it: where lines of the spectra
/// are seen from beside the wheel, whichever way their waves travel. The level is that of the sensor, which turns with the wheel;
/// engine orders of the rotating frame and what the linear prediction says of them have no place.
pub fn fixed_frame_map<'a>(
    map: &'a InteractionMap,
    critical: Option<&CriticalSpeeds>,
    axis: VerticalAxis,
    window: Window,
    level_colour: LevelColour,
) -> Drawing<'a> {
    seen_in(Frame::Fixed, map, critical, None, axis, window, level_colour)
}

fn seen_in<'a>(
    frame: Frame,
    map: &'a InteractionMap,
    critical: Option<&CriticalSpeeds>,
    campbell: Option<&Campbell>,
    axis: VerticalAxis,
    window: Window,
    level_colour: LevelColour,
) -> Drawing<'a> {
    let cells = cells(&map.speeds_rad_s);
    let view = View::new(map, &cells, campbell, (axis, frame), &window, (CORNER, SIZE));
    let loudest = heat::loudest(map, &window);
    // A map without motion is as quiet as the colours go.
    let range = (QUIETEST * loudest.unwrap_or(1.0), loudest.unwrap_or(1.0));
    let unit = map.sensor.unit(&map.units);
    let heat = Heat { map, cells: cells.clone(), view, most: MOST };
    let speeds = view.diagram.x.values;
    let (wanted, away) = if view.axis == VerticalAxis::EngineOrder { (12.0, 58.0) } else { (10.0, 64.0) };
    let y = Axis::linear(view.axis_words(), view.diagram.y.values, wanted).away(away);
    let panel = Panel::new(CORNER, SIZE, Axis::speeds(speeds, 9.0), y).domain(0.0, 0.7).key_below();
    let mut panel = panel.amplitudes(format!("amplitude, {unit}"), range, loudest.map(|_| 62.0));
    let mut level = level::panel(map, &cells, speeds, level_colour).domain(0.76, 1.0);
    let both_ways = (view.frame == Frame::Fixed).then(|| BOTH_WAYS.to_owned());
    let paragraphs = [words(map)].into_iter().chain(both_ways).collect();
    let mut sketch = Sketch::new("interaction_map", title(map, view.frame), paragraphs).high(760);
    sketch.warning = map.stiffening.and_then(StiffeningVerdict::warning).map(str::to_owned);
    sketch.more.extend(validity::without_thickness(map).then(|| validity::WITHOUT_THICKNESS.to_owned()));
    sketch.more.extend(heat.merged());
    sketch.foot = Some(foot(map, sketch.width));
    sketch.least = LEAST;
    let sketch = sketch
        .meta("sensor", map.sensor)
        .meta("units", json!({"x": "rpm", "y": y_unit(&view), "amplitude": unit}))
        .meta("speeds_rpm", cells.iter().map(|cell| cell.rpm).collect::<Vec<f64>>())
        .meta("speed_indices", cells.iter().map(|cell| cell.index).collect::<Vec<usize>>())
        .meta("column_speed_indices", heat.loudest_speeds())
        .meta("amplitude", json!({"z": "log10", "linear": "customdata[row][column][0]", "range": range}));
    panel.push(hatching::definition());
    panel.push(map_lines::background(map, &cells, &view.diagram));
    panel.push(heat);
    map_lines::engine_orders(map, &view).into_iter().for_each(|curve| panel.push(curve));
    let sectors = wheel(critical, campbell);
    panel.push(map_lines::right_axis(map, &view, sectors));
    let mut panel = panel.right("ND", map_lines::driven_diameters(map, &view, sectors));
    let natural = campbell.map_or_else(Vec::new, |campbell| map_lines::natural_frequencies(campbell, &view));
    let labels = map_lines::labels(critical, &natural, &view);
    natural.into_iter().for_each(|curve| panel.push(curve));
    if let Some(critical) = critical {
        add_critical_speeds(critical, level_colour, &mut panel, &mut level);
        map_lines::add_crossings(critical, &view, &mut panel);
    }
    panel.push(labels);
    if let Some(campbell) = campbell {
        map_lines::explain_natural(campbell, &mut panel);
    }
    map_lines::explain_orders(&mut panel);
    if level_colour == LevelColour::Utilisation {
        margin::explain(map, &cells, &mut panel);
    }
    validity::explain(map, &cells, &mut panel);
    map_lines::explain_hatching(map, &cells, &view, &mut panel);
    sketch.with(panel).with(level).with(level::strips(map, &cells, speeds).domain(0.705, 0.745)).into()
}

/// Number of sectors of the wheel, if a reduction determines it.
fn wheel(critical: Option<&CriticalSpeeds>, campbell: Option<&Campbell>) -> Option<u32> {
    let of_campbell = campbell.map(|campbell| &campbell.reduction);
    sectors::sectors(critical.map(|critical| &critical.reduction).or(of_campbell)?)
}

fn y_unit(view: &View) -> &'static str {
    match (view.axis, view.frame) {
        (VerticalAxis::EngineOrder, Frame::Rotating) => "engine_order",
        (VerticalAxis::EngineOrder, Frame::Fixed) => "rotational_frequency",
        (VerticalAxis::Frequency, _) => "Hz",
    }
}

/// Adds the critical speeds in view: lines through both panels, marks at the level of each, and their key below the map.
fn add_critical_speeds(
    critical: &CriticalSpeeds,
    by: LevelColour,
    panel: &mut Panel<'_>,
    level: &mut Panel<'_>,
) {
    let has_utilisation = by == LevelColour::Utilisation;
    let seen = critical.critical_speeds.iter();
    let seen: Vec<&CriticalSpeed> =
        seen.filter(|speed| panel.diagram.x.contains(rpm(speed.speed_rad_s))).collect();
    for (is_resolved, name, words, dash) in [
        (true, "critical speed", "critical speed", Dash::Dashed),
        (false, "critical, not resolved", "critical speed, peak not resolved", Dash::Sparse),
    ] {
        let found = || seen.iter().filter(|speed| speed.resolved == is_resolved);
        let pen = Pen::new(Colour::warning(), dash, 1.2).on_screen(dash, 1.4);
        let upright = |speed: &&CriticalSpeed| Upright {
            x: rpm(speed.speed_rad_s),
            label: marks::critical_words(speed, has_utilisation),
            more: marks::known_to(speed),
        };
        let lines: Vec<Upright> = found().map(upright).collect();
        let peak = |speed: &&CriticalSpeed| {
            let place = (rpm(speed.speed_rad_s), speed.rms);
            let mark = Mark::new(place, marks::critical_words(speed, has_utilisation));
            Mark { more: marks::known_to(speed), index: Some(speed.index as usize), ..mark }
        };
        let look = if is_resolved { Look::filled } else { Look::open };
        let look = look(Symbol::TriangleDown, (5.0, 11.0), Colour::warning());
        if !lines.is_empty() {
            let sample = Pen { width: 1.5, ..pen.clone() }.draw(line((0.0, 0.0), (24.0, 0.0)));
            panel.wide_sample(sample, 24.0, words);
        }
        let top = level.diagram.top;
        panel.push(Uprights { name: name.to_owned(), lines, pen, top, class: "critical-speed" });
        level.push(Layer::Shown(Marks::new(name, look, found().map(peak))));
    }
    if has_utilisation && seen.iter().any(|speed| speed.utilisation.is_some()) {
        panel.note("U utilisation");
    }
    if seen.iter().any(|speed| speed.settling == Verdict::NotSettled) {
        panel.note("* not settled");
    }
}

/// Title: the sensor of the map, its nodal diameter, and the frame.
fn title(map: &InteractionMap, frame: Frame) -> String {
    let nodal_diameter = map.nodal_diameter.map(|i| format!(", nodal diameter {i} only")).unwrap_or_default();
    let seen = match frame {
        Frame::Rotating => "",
        Frame::Fixed => " in the fixed frame",
    };
    format!("Interaction map{seen}: {}{nodal_diameter}", map.sensor)
}

/// Note below the title of a map in the fixed frame.
const BOTH_WAYS: &str = "nodal diameter n at engine order k is at k + n and |k − n|: which way its wave travels, spectra do not tell · \
                                    amplitudes are √N times a blade's";

/// Paragraph below the title: how the map was computed.
fn words(map: &InteractionMap) -> String {
    let settings = &map.settings;
    let computed = map.amplitude.iter().flatten().count();
    let mut words = vec![format!("{computed} of {} speeds", map.speeds_rad_s.len())];
    let integration = &settings.integration;
    let window = integration.window_revolutions;
    words.push(match integration.revolutions {
        AutoOr::Fixed(revolutions) => format!("{revolutions} revolutions, the last {window} shown"),
        AutoOr::Auto => {
            format!("revolutions until it repeats, at most {}, {window} shown", integration.most_revolutions)
        }
    });
    if let Some(damping) = &settings.scene.damping {
        words.push(format!("modal damping {} %", 100.0 * damping.modal_ratio));
    }
    if let Some(lobes) = settings.scene.casing.as_ref().and_then(|casing| casing.lobes.as_ref()) {
        words.push(format!("{} lobes of {} {}", lobes.count, lobes.amplitude, map.units.length));
    }
    if settings.scene.contact.is_none() {
        words.push("no contact".to_owned());
    }
    words.join(" · ")
}

/// Line below the key: colours of the strip of steady states, and in the corner the origin of the numbers.
fn foot(map: &InteractionMap, width: f64) -> Element {
    let words = heading::origin(&map.settings.model, &map.version);
    let origin = text(width - 16.0, 8.0, "end", &words).set("fill", "#999999").set("font-size", "10");
    group().child(settling_strip::legend(map, CORNER.0, 0.0)).child(origin)
}
