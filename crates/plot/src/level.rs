//! Level of the response over speed, above the map.

use super::axis::significant;
use super::cells::{Cell, within};
use super::diagram::Diagram;
use super::layer::{Area, Areas, Curve, Layer, Mark, Marks, Reach};
use super::map_view::missing_words;
use super::settling_strip::{self, Standing};
use super::sketch::{Axis, Panel};
use super::style::{Colour, Dash, Look, Pen, Symbol};
use super::svg::{Element, group};
use super::{margin, validity};
use rubmap_analysis::result::{InteractionMap, ValidityVerdict, Verdict};

const LEFT: f64 = 92.0;
const WIDTH: f64 = 946.0;
const TOP: f64 = 212.0;
const HEIGHT: f64 = 130.0;
const VALIDITY_TOP: f64 = 343.5;
const VALIDITY_HEIGHT: f64 = 7.0;
const STRIP_TOP: f64 = 352.0;
const STRIP_HEIGHT: f64 = 9.0;

/// Colouring of the level of a map.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LevelColour {
    /// Plain curve without colours.
    Plain,
    /// Largest utilisation at each speed, as colours below the curve; labels of critical speeds have theirs.
    Utilisation,
}

/// Root mean square of the map's sensor about its mean, at the speed with this index.
fn rms(map: &InteractionMap, index: usize) -> Option<f64> {
    let point = map.points.iter().find(|point| point.index as usize == index)?;
    let response = point.responses.iter().find(|response| response.sensor == map.sensor)?;
    response.rms.is_finite().then_some(response.rms)
}

/// Speed in view with its level, if it has one.
struct Seen {
    cell: Cell,
    rms: Option<f64>,
}

/// Panel of the level over a range of speeds, and below its frame strips with the verdicts on linear theory and on the steady state.
pub(super) fn panel(
    map: &InteractionMap,
    cells: &[Cell],
    speeds: (f64, f64),
    by: LevelColour,
) -> Panel<'static> {
    let is_seen = |cell: &&Cell| (speeds.0..=speeds.1).contains(&cell.rpm);
    let seen = cells.iter().filter(is_seen).map(|cell| Seen { cell: *cell, rms: rms(map, cell.index) });
    let seen: Vec<Seen> = seen.collect();
    let highest = seen.iter().filter_map(|seen| seen.rms).fold(0.0, f64::max);
    let top = if highest > 0.0 { 1.12 * highest } else { 1.0 };
    let title = format!("level, {} rms", map.sensor.unit(&map.units));
    let y = Axis::linear(title, (0.0, top), 4.0).away(58.0).with_zero();
    // The map below has the ticks of the speeds.
    let x = Axis::speeds(speeds, 9.0).ticks(Vec::new());
    let mut panel = Panel::new((LEFT, TOP), (WIDTH, HEIGHT), x, y);
    if by == LevelColour::Utilisation {
        let upwards = |cell: &Cell| Some(Some((0.0, rms(map, cell.index)?)));
        for areas in margin::areas(map, within(cells, speeds), upwards) {
            panel.push(areas);
        }
    }
    panel.push(curve(map, &seen));
    // Dots shrink with the number of speeds: dots that touch add nothing to the curve.
    let radius = (0.25 * WIDTH / cells.len().max(1) as f64).clamp(0.8, 2.6);
    panel.push(dots(map, &seen, radius, &panel.diagram));
    if let Some(strip) = validity::strip(map, cells, &panel.diagram, (VALIDITY_TOP, VALIDITY_HEIGHT)) {
        panel.push(strip);
    }
    panel.push(settling_strip::strip(map, cells, &panel.diagram, STRIP_TOP, STRIP_HEIGHT));
    for standing in Standing::ALL {
        if let Some(marks) = standings(map, &seen, standing) {
            panel.push(Layer::Shown(marks));
        }
    }
    for verdict in validity::MARKED {
        panel.push(Layer::Shown(verdicts(map, &seen, verdict)));
    }
    panel
}

/// Panel of the figure alone: strips with the steady state of every speed and, above, the verdict on linear theory.
pub(super) fn strips(map: &InteractionMap, cells: &[Cell], speeds: (f64, f64)) -> Panel<'static> {
    let names = vec![(0.5, "settled".to_owned()), (1.5, "linear".to_owned())];
    let x = Axis::speeds(speeds, 9.0);
    let mut panel =
        Panel::new((LEFT, STRIP_TOP), (WIDTH, STRIP_HEIGHT), x, Axis::names("", (0.0, 2.0), names))
            .shown_only();
    let area = |cell: &Cell, row: f64, words: &str| Area {
        across: (cell.from.max(speeds.0), cell.to.min(speeds.1)),
        upwards: Some((row + 0.1, row + 0.9)),
        words: format!("{:.0} rpm: {words}", cell.rpm),
    };
    let seen = within(cells, speeds);
    for standing in Standing::ALL {
        let of = seen.iter().filter(|cell| Standing::of(map, cell.index) == standing);
        let areas = of.map(|cell| area(cell, 0.0, standing.words())).collect();
        panel.push(Areas {
            name: standing.words(),
            areas,
            fill: standing.colour().to_owned(),
            class: "standing",
        });
    }
    for verdict in validity::MARKED {
        let of = seen.iter().filter_map(|cell| {
            let found = validity::point(map, cell.index)?.validity.as_ref()?;
            let words = validity::reason(found).filter(|_| found.verdict == verdict)?;
            Some(area(cell, 1.0, &words))
        });
        let fill = validity::colour(verdict).unwrap_or_default().to_owned();
        panel.push(Areas { name: validity::words(verdict), areas: of.collect(), fill, class: "validity" });
    }
    panel
}

/// Curve of the level, with error bars where errors were estimated.
fn curve(map: &InteractionMap, seen: &[Seen]) -> Curve {
    let places = seen.iter().map(|Seen { cell, rms }| Some((cell.rpm, (*rms)?)));
    let curve = Curve::new("level", places, Pen::new(Colour::curve(), Dash::Solid, 1.6));
    let errors = map.errors.as_ref().filter(|errors| !errors.points.is_empty());
    let errors = errors.into_iter().flat_map(|errors| {
        seen.iter().map(|Seen { cell, rms }| {
            rms.zip(errors.of(cell.index as u32))
                .map_or(Reach::even(f64::NAN), |(rms, error)| Reach::of_factor(rms, error))
        })
    });
    Curve { errors: errors.collect(), ..curve }
}

/// Dots of this radius at the levels, in the colours of the verdicts on linear theory.
fn dots(map: &InteractionMap, seen: &[Seen], radius: f64, diagram: &Diagram) -> Element {
    let dots = seen.iter().filter_map(|Seen { cell, rms }| {
        let (x, y) = diagram.inside(cell.rpm, (*rms)?)?;
        let verdict = validity::point(map, cell.index).and_then(|point| point.validity_verdict());
        let colour = verdict.and_then(validity::colour);
        let dot = Element::new("circle").number("cx", x).number("cy", y);
        let dot = dot.number("r", colour.map_or(radius, |_| radius.max(2.0)));
        let paper = Colour::curve().paper;
        Some(dot.set("fill", colour.unwrap_or(&paper)).title(&words(map, cell, (*rms)?)))
    });
    group().children(dots)
}

/// Marks of the speeds of one standing: at their level, or on the axis if they have none. Gaps show pending speeds.
fn standings(map: &InteractionMap, seen: &[Seen], standing: Standing) -> Option<Marks> {
    let (symbol, size, colour) = match standing {
        Standing::Settled(Verdict::Periodic) => (Symbol::Circle, 4.0, Colour::curve()),
        Standing::Settled(Verdict::Subharmonic) => (Symbol::Square, 6.0, Colour::of("#009e73")),
        Standing::Settled(Verdict::Aperiodic) => (Symbol::Diamond, 7.0, Colour::of("#cc79a7")),
        Standing::Settled(Verdict::NotSettled) => (Symbol::TriangleUp, 8.0, Colour::of("#e69f00")),
        Standing::Missing => (Symbol::Cross, 7.0, Colour::neutral("black")),
        Standing::Pending => return None,
    };
    let of = seen.iter().filter(|seen| Standing::of(map, seen.cell.index) == standing);
    let mark = |Seen { cell, rms }: &Seen| {
        let told = match rms {
            Some(rms) => format!("{}, {}", words(map, cell, *rms), standing.words()),
            None => missing_words(map, cell),
        };
        Mark { index: Some(cell.index), ..Mark::new((cell.rpm, rms.unwrap_or(0.0)), told) }
    };
    let look = Look::filled(symbol, (0.5 * size, size), colour);
    Some(Marks::new(standing.words(), look, of.map(mark)))
}

/// Rings about the speeds at which linear theory has this verdict.
fn verdicts(map: &InteractionMap, seen: &[Seen], verdict: ValidityVerdict) -> Marks {
    let symbol = if verdict == ValidityVerdict::Beyond { Symbol::Crossed } else { Symbol::Circle };
    let mark = |Seen { cell, rms }: &Seen| {
        let found = validity::point(map, cell.index)?.validity.as_ref();
        let reason = validity::reason(found.filter(|found| found.verdict == verdict)?)?;
        Some(Mark::new((cell.rpm, (*rms)?), format!("{:.0} rpm: {reason}", cell.rpm)))
    };
    let look = Look::open(symbol, (6.0, 12.0), Colour::warning());
    Marks::new(validity::words(verdict), look, seen.iter().filter_map(mark))
}

/// Words for the level of a speed, with the verdict on linear theory there.
fn words(map: &InteractionMap, cell: &Cell, rms: f64) -> String {
    let point = validity::point(map, cell.index);
    let reason = point.and_then(|point| validity::reason(point.validity.as_ref()?));
    let reason = reason.map_or_else(String::new, |reason| format!(", {reason}"));
    format!("{:.0} rpm: {} {} rms{reason}", cell.rpm, significant(rms), map.sensor.unit(&map.units))
}
