//! Interaction map: level and spectra over speed, engine-order lines, critical speeds, linear prediction.

use super::axis::{Scale, logarithmic_ticks, ticks};
use super::cells::{Cell, cells, rpm};
use super::colour::on_dark;
use super::diagram::Diagram;
use super::frame::Frame;
use super::key::Flow;
use super::labels::Labels;
use super::level::LevelColour;
use super::map_view::{DRIVEN, VerticalAxis, View, is_missing, lobes};
use super::svg::{Element, INK, document, group, line, rectangle, text, upright};
use super::window::Window;
use super::{colour_bar, hatching, heading, heat, level, margin, marks, sectors, settling_strip, validity};
use rubmap_analysis::request::AutoOr;
use rubmap_analysis::result::{
    Campbell, CriticalSpeed, CriticalSpeeds, InteractionMap, StiffeningVerdict, Verdict,
};
use rubmap_wheel::response::waves::fold;

const WIDTH: f64 = 1180.0;
const HEIGHT: f64 = 1000.0;
const LEFT: f64 = 92.0;
const PLOT_WIDTH: f64 = 946.0;
const LEVEL_TOP: f64 = 212.0;
const LEVEL_HEIGHT: f64 = 130.0;
const VALIDITY_TOP: f64 = 343.5;
const VALIDITY_HEIGHT: f64 = 7.0;
const STRIP_TOP: f64 = 352.0;
const STRIP_HEIGHT: f64 = 9.0;
const MAP_TOP: f64 = 365.0;
const MAP_HEIGHT: f64 = 490.0;

/// Colour of warnings.
const WARNING: &str = "#b01f20";

/// Draws an interaction map or a window of it, with its critical speeds and the linear prediction where they are given.
///
/// Colour is the single-sided amplitude on a logarithmic scale of three decades below the loudest of the window; the mean is left out.
/// Each spectral line is drawn at least five units high, the loudest wins. Speeds without result are hatched. Where linear theory is
/// doubtful or left, a strip says so.
pub(super) fn interaction_map(
    map: &InteractionMap,
    critical: Option<&CriticalSpeeds>,
    campbell: Option<&Campbell>,
    axis: VerticalAxis,
    window: Window,
    level_colour: LevelColour,
) -> String {
    draw_in((axis, Frame::Rotating), map, critical, campbell, window, level_colour)
}

/// Draws a map whose rows are in the fixed frame (`rubmap_analysis::run::fixed_frame_row`), or a window of it: where lines of the spectra
/// are seen from beside the wheel, whichever way their waves travel. The level is that of the sensor, which turns with the wheel;
/// engine orders of the rotating frame and what the linear prediction says of them have no place.
pub(super) fn fixed_frame_map(
    map: &InteractionMap,
    critical: Option<&CriticalSpeeds>,
    axis: VerticalAxis,
    window: Window,
    level_colour: LevelColour,
) -> String {
    draw_in((axis, Frame::Fixed), map, critical, None, window, level_colour)
}

fn draw_in(
    seen: (VerticalAxis, Frame),
    map: &InteractionMap,
    critical: Option<&CriticalSpeeds>,
    campbell: Option<&Campbell>,
    window: Window,
    level_colour: LevelColour,
) -> String {
    let cells = cells(&map.speeds_rad_s);
    let place = ((LEFT, MAP_TOP), (PLOT_WIDTH, MAP_HEIGHT));
    let view = View::new(map, &cells, campbell, seen, &window, place);
    let level =
        level::diagram(map, &cells, view.diagram.x.values, (LEFT, LEVEL_TOP), (PLOT_WIDTH, LEVEL_HEIGHT));
    let loudest = heat::loudest(map, &window);
    let mut labels = Labels::inside(&view.diagram);
    let crossings = critical.map(|critical| view.crossings(critical, &mut labels));
    let mut content = vec![hatching::definition(), head(map, view.frame)];
    content.push(level::draw(map, &cells, &level, level_colour));
    content.extend(validity::strip(map, &cells, &level, (VALIDITY_TOP, VALIDITY_HEIGHT)));
    content.push(settling_strip::strip(map, &cells, &level, STRIP_TOP, STRIP_HEIGHT));
    content.push(view.amplitudes(map, &cells, loudest));
    if let Some(loudest) = loudest {
        content.push(amplitude_bar(
            &view.scale(loudest),
            view.diagram.right() + 62.0,
            map.sensor.unit(&map.units),
        ));
    }
    content.push(engine_orders(&view, map, wheel(critical, campbell)));
    content.extend(campbell.map(|campbell| view.natural_frequencies(campbell, &mut labels)));
    content.extend(crossings);
    content.extend(
        critical.map(|critical| critical_speeds(critical, &level, level_colour)).into_iter().flatten(),
    );
    content.push(level.frame());
    content.push(view.diagram.frame());
    content.extend(axes(&view));
    let flow = key(map, &cells, &view, (critical, campbell), level_colour);
    // A long key makes the drawing higher.
    let height = f64::max(HEIGHT, flow.bottom() + 42.0);
    content.extend([flow.draw(), settling_strip::legend(map, LEFT, height - 18.0), origin(map, height)]);
    document(&title(map, view.frame), WIDTH, height, content)
}

/// Number of sectors of the wheel, if a reduction determines it.
pub(super) fn wheel(critical: Option<&CriticalSpeeds>, campbell: Option<&Campbell>) -> Option<u32> {
    let of_campbell = campbell.map(|campbell| &campbell.reduction);
    sectors::sectors(critical.map(|critical| &critical.reduction).or(of_campbell)?)
}

/// Draws the lines of engine orders and the labels of the right axis: engine orders in a map of frequencies, otherwise the nodal diameters
/// that the engine orders drive.
fn engine_orders(view: &View, map: &InteractionMap, wheel: Option<u32>) -> Element {
    let (mut lines, ends) = view.engine_orders(map);
    let lobes = lobes(map);
    let crowded = ends.len() as f64 * 14.0 > MAP_HEIGHT;
    let mut said = false;
    for (order, end) in ends {
        let excited = order.is_multiple_of(lobes);
        if crowded && !excited {
            continue;
        }
        let words = match (view.axis, wheel) {
            (VerticalAxis::Frequency, _) if end.0 < view.diagram.right() - 0.5 => {
                lines = lines.child(View::label_inside(end, order, excited));
                continue;
            }
            (VerticalAxis::Frequency, _) => order,
            (VerticalAxis::EngineOrder, Some(wheel)) => fold(order, wheel),
            (VerticalAxis::EngineOrder, None) => continue,
        };
        said = true;
        lines = lines.child(
            text(end.0 + 6.0, end.1 + 4.0, "start", &words.to_string())
                .set("class", "right-axis")
                .set("font-size", "11")
                .set("font-weight", if excited { "bold" } else { "normal" })
                .set("fill", if excited { INK } else { "#777777" }),
        );
    }
    let title = match view.axis {
        VerticalAxis::EngineOrder => "nodal diameter that engine order k drives",
        VerticalAxis::Frequency => "engine order k, f = kΩ/2π",
    };
    let middle = MAP_TOP + 0.5 * MAP_HEIGHT;
    lines.children(said.then(|| upright(view.diagram.right() + 40.0, middle, "middle", title)))
}

fn axes(view: &View) -> [Element; 2] {
    let diagram = &view.diagram;
    let x = diagram.x_axis(&ticks(diagram.x.values, 9.0), "rotational speed Ω, rpm");
    let (wanted, away) = match view.axis {
        VerticalAxis::EngineOrder => (12.0, 58.0),
        VerticalAxis::Frequency => (10.0, 64.0),
    };
    let y = diagram.y_axis(&ticks(diagram.y.values, wanted), view.axis_words(), away);
    [x, y]
}

fn critical_speeds(critical: &CriticalSpeeds, level: &Diagram, by: LevelColour) -> Vec<Element> {
    let mut shown: Vec<(f64, &CriticalSpeed)> =
        in_view(critical, level).map(|speed| (level.x.place(rpm(speed.speed_rad_s)), speed)).collect();
    shown.sort_by(|a, b| a.0.total_cmp(&b.0));
    marks::critical(&shown, level.right(), (LEVEL_TOP, MAP_TOP + MAP_HEIGHT), by == LevelColour::Utilisation)
}

/// Critical speeds within the diagram.
fn in_view<'a>(
    critical: &'a CriticalSpeeds,
    diagram: &'a Diagram,
) -> impl Iterator<Item = &'a CriticalSpeed> {
    critical.critical_speeds.iter().filter(|speed| diagram.x.contains(rpm(speed.speed_rad_s)))
}

fn amplitude_bar(amplitudes: &Scale, left: f64, unit: &str) -> Element {
    let ticks = logarithmic_ticks(amplitudes.values);
    colour_bar::draw(amplitudes, left, &ticks, &format!("amplitude, {unit}"))
}

/// Title: the sensor of the map, its nodal diameter, and the frame.
pub(super) fn title(map: &InteractionMap, frame: Frame) -> String {
    let nodal_diameter = map.nodal_diameter.map(|i| format!(", nodal diameter {i} only")).unwrap_or_default();
    let seen = match frame {
        Frame::Rotating => "",
        Frame::Fixed => " in the fixed frame",
    };
    format!("Interaction map{seen}: {}{nodal_diameter}", map.sensor)
}

/// Note below the title of a map in the fixed frame.
pub(super) const BOTH_WAYS: &str = "nodal diameter n at engine order k is at k + n and |k − n|: which way its wave travels, spectra do not tell · \
                                    amplitudes are √N times a blade's";

/// Paragraph below the title: how the map was computed.
pub(super) fn words(map: &InteractionMap) -> String {
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

fn head(map: &InteractionMap, frame: Frame) -> Element {
    let warning = map.stiffening.and_then(StiffeningVerdict::warning);
    let title = title(map, frame);
    let computed = words(map);
    let lines = [Some((computed.as_str(), "#555555"))]
        .into_iter()
        .chain([(frame == Frame::Fixed).then_some((BOTH_WAYS, "#555555"))])
        .chain([warning.map(|words| (words, WARNING))]);
    let line = |(i, (words, colour)): (usize, (&str, &str))| {
        text(LEFT, 51.0 + 17.0 * i as f64, "start", words).set("fill", colour)
    };
    group()
        .child(text(LEFT, 30.0, "start", &title).set("font-size", "18").set("font-weight", "bold"))
        .children(lines.flatten().enumerate().map(line))
}

/// Origin of the numbers, in the corner.
fn origin(map: &InteractionMap, height: f64) -> Element {
    let words = heading::origin(&map.settings.model, &map.version);
    text(WIDTH - 16.0, height - 10.0, "end", &words).set("fill", "#999999").set("font-size", "10")
}

/// Key of the marks that occur, below the map.
fn key(
    map: &InteractionMap,
    cells: &[Cell],
    view: &View,
    (critical, campbell): (Option<&CriticalSpeeds>, Option<&Campbell>),
    level_colour: LevelColour,
) -> Flow {
    let dark = |width: f64| rectangle(0.0, -8.0, width, 16.0).set("fill", "#101010");
    let red = || line((0.0, 0.0), (24.0, 0.0)).set("stroke", "#d62728").set("stroke-width", "1.5");
    let mut flow = Flow::new(LEFT, WIDTH - 20.0, MAP_TOP + MAP_HEIGHT + 66.0);
    if let Some(critical) = critical {
        let shown: Vec<&CriticalSpeed> = in_view(critical, &view.diagram).collect();
        if shown.iter().any(|speed| speed.resolved) {
            flow = flow.entry(red().set("stroke-dasharray", "7 4"), 24.0, "critical speed");
        }
        if shown.iter().any(|speed| !speed.resolved) {
            let dots = red().set("stroke-dasharray", marks::UNRESOLVED);
            flow = flow.entry(dots, 24.0, "critical speed, peak not resolved");
        }
        if level_colour == LevelColour::Utilisation && shown.iter().any(|speed| speed.utilisation.is_some()) {
            flow = flow.entry(group(), 0.0, "U utilisation");
        }
        if shown.iter().any(|speed| speed.settling == Verdict::NotSettled) {
            flow = flow.entry(group(), 0.0, "* not settled");
        }
        let (linear, driven) = view.has_crossings(critical);
        if driven {
            let mark = marks::diamond((8.0, 0.0), DRIVEN, "black");
            flow = flow.entry(group().child(dark(16.0)).child(mark), 16.0, "driven by the lobes, (i, j)");
        }
        if linear {
            let ring = marks::ring((8.0, 0.0), "white");
            let words = "linear criterion (i, j, n) at k = i·n";
            flow = flow.entry(group().child(dark(16.0)).child(ring), 16.0, words);
        }
    }
    let harmonics = campbell.and_then(|campbell| campbell.frequencies_hz.first()).map_or(0, Vec::len);
    if harmonics > 0 {
        let shown = (0..harmonics).filter(|i| harmonics <= 12 || *i == 0 || i + 1 == harmonics);
        let shown: Vec<usize> = shown.collect();
        let width = 30.0 * shown.len() as f64;
        let numbers = shown.into_iter().enumerate().map(|(place, i)| {
            let (x, colour) = (30.0 * place as f64, on_dark(i, harmonics));
            let stroke = line((x + 4.0, 0.0), (x + 14.0, 0.0)).set("stroke", &colour);
            let number = text(x + 17.0, 4.0, "start", &i.to_string()).set("fill", &colour);
            group().child(stroke.set("stroke-width", "1.6")).child(number.set("font-size", "11"))
        });
        let mark = group().child(dark(width)).children(numbers);
        flow = flow.entry(mark, width, "natural frequencies of nodal diameter i");
    }
    flow = View::explained(flow, map, &view.engine_orders(map).1);
    if level_colour == LevelColour::Utilisation {
        flow = margin::explained(flow, map, cells);
    }
    flow = validity::explained(flow, map, cells, &view.diagram);
    let (low, high) = view.diagram.x.values;
    let seen = |cell: &&Cell| cell.to > low && cell.from < high;
    if cells.iter().filter(seen).any(|cell| is_missing(map, cell)) {
        flow = flow.entry(hatching::mark(), 20.0, "no result");
    } else if view.reaches_beyond(map) {
        flow = flow.entry(hatching::mark(), 20.0, "beyond the spectra");
    }
    flow
}
