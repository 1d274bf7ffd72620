//! Marks and words for speeds at which linear theory is doubtful or left.

use super::axis::significant;
use super::cells::{Cell, within};
use super::diagram::Diagram;
use super::sketch::Panel;
use super::svg::{Element, group, rectangle};
use rubmap_analysis::result::{InteractionMap, Point, Validity, ValidityMeasure, ValidityVerdict};

const DOUBTFUL: &str = "#d9720c";
const BEYOND: &str = "#8b0f14";

/// Fill of areas where linear theory is doubtful, once [`definition`] is in the drawing.
const HATCHED: &str = "url(#doubtful)";

/// Verdicts that are marked.
pub(super) const MARKED: [ValidityVerdict; 2] = [ValidityVerdict::Doubtful, ValidityVerdict::Beyond];

/// Words for a verdict.
pub(super) fn words(verdict: ValidityVerdict) -> &'static str {
    match verdict {
        ValidityVerdict::Linear => "linear theory holds",
        ValidityVerdict::NotChecked => "linear theory not checked",
        ValidityVerdict::Doubtful => "linear theory doubtful",
        ValidityVerdict::Beyond => "beyond linear theory",
    }
}

/// Words for a verdict that was given without some of the deciding measures.
pub(super) fn words_without(verdict: ValidityVerdict, lacking: &[ValidityMeasure]) -> &'static str {
    match verdict {
        ValidityVerdict::Linear if !lacking.is_empty() => "linear theory holds as far as is known",
        verdict => words(verdict),
    }
}

/// Deciding measures that were not evaluated at some of the speeds, each once, with the reason.
pub(super) fn lacking(map: &InteractionMap) -> Vec<String> {
    let mut found = Vec::new();
    for lack in map.points.iter().filter_map(|point| point.validity.as_ref()).flat_map(|found| &found.lacking)
    {
        let words = format!("{}: {}", measure(lack.what), lack.reason);
        if !found.contains(&words) {
            found.push(words);
        }
    }
    found
}

/// Whether displacement over thickness, the measure that most often decides, is lacking at some of the speeds.
pub(super) fn without_thickness(map: &InteractionMap) -> bool {
    let measures = map.points.iter().flat_map(Point::validity_lacking);
    measures.into_iter().any(|what| what == ValidityMeasure::DisplacementOverThickness)
}

/// Note where linear theory is judged without the blade's thickness.
pub(super) const WITHOUT_THICKNESS: &str = "linear theory is judged without the blade's thickness";

/// Colour of a verdict that is marked.
pub(super) fn colour(verdict: ValidityVerdict) -> Option<&'static str> {
    match verdict {
        ValidityVerdict::Linear | ValidityVerdict::NotChecked => None,
        ValidityVerdict::Doubtful => Some(DOUBTFUL),
        ValidityVerdict::Beyond => Some(BEYOND),
    }
}

/// Words for a measure of validity.
pub(super) fn measure(what: ValidityMeasure) -> &'static str {
    match what {
        ValidityMeasure::ExcessEnergy => "excess energy of the bent blade over its linear energy",
        ValidityMeasure::SecondOrderGap => "second-order motion of a tip over its clearance",
        ValidityMeasure::OutsideCoordinates => "share of the tips' motion outside the coordinates of bending",
        ValidityMeasure::DisplacementOverThickness => {
            "largest displacement of a tip over the blade's thickness"
        }
        ValidityMeasure::DisplacementOverChord => {
            "largest displacement of a tip over the length of the contact line"
        }
        ValidityMeasure::Rotation => "largest rotation of the contact line, rad",
        ValidityMeasure::StressOverYield => "largest stress over yield strength",
        ValidityMeasure::NeighbourApproach => "approach of neighbouring blades over their distance",
        ValidityMeasure::ContactOverLobe => {
            "tangential displacement of a tip over the length in which lobes change"
        }
    }
}

/// Words for a verdict with the measure that decides; none where linear theory holds.
pub(super) fn reason(validity: &Validity) -> Option<String> {
    colour(validity.verdict)?;
    let check = validity.checks.first()?;
    let limit = match validity.verdict {
        ValidityVerdict::Beyond => check.beyond_above?,
        _ => check.doubtful_above,
    };
    let bends = validity.checks.iter().any(|check| check.what == ValidityMeasure::OutsideCoordinates);
    let words = match validity.verdict {
        ValidityVerdict::Doubtful if bends => "doubtful: the scene may simulate too little",
        ValidityVerdict::Beyond if bends => "beyond what the scene simulates",
        verdict => words(verdict),
    };
    let scaled = if check.scaled_from.is_some() { ", scaled from another motion" } else { "" };
    Some(format!(
        "{words}: {} is {}, above {}{scaled}",
        measure(check.what),
        significant(check.value),
        significant(limit)
    ))
}

/// Point of the speed with this index.
pub(super) fn point(map: &InteractionMap, index: usize) -> Option<&Point> {
    map.points.iter().find(|point| point.index as usize == index)
}

/// Strip, `height` high from `top` on, over the speeds at which linear theory is doubtful or left; none if there are none in view.
pub(super) fn strip(
    map: &InteractionMap,
    cells: &[Cell],
    diagram: &Diagram,
    (top, height): (f64, f64),
) -> Option<Element> {
    let (low, high) = diagram.x.values;
    let marked = within(cells, (low, high)).iter().filter_map(|cell| {
        let validity = point(map, cell.index)?.validity.as_ref()?;
        let (from, to) = (diagram.x.place(cell.from.max(low)), diagram.x.place(cell.to.min(high)));
        let area = rectangle(from, top, to - from, height).set("class", "validity");
        let fill = fill(validity.verdict)?;
        Some(area.set("fill", fill).title(&format!("{:.0} rpm: {}", cell.rpm, reason(validity)?)))
    });
    let marked: Vec<Element> = marked.collect();
    (!marked.is_empty()).then(|| group().child(definition()).children(marked))
}

/// Fill of an area with this verdict, distinct without colours as well.
fn fill(verdict: ValidityVerdict) -> Option<&'static str> {
    colour(verdict).map(|colour| if verdict == ValidityVerdict::Doubtful { HATCHED } else { colour })
}

fn definition() -> Element {
    let pattern = Element::new("pattern")
        .set("id", "doubtful")
        .set("width", "6")
        .set("height", "6")
        .set("patternUnits", "userSpaceOnUse")
        .set("patternTransform", "rotate(45)")
        .child(rectangle(0.0, 0.0, 6.0, 6.0).set("fill", "#fbe3c8"))
        .child(rectangle(0.0, 0.0, 3.0, 6.0).set("fill", DOUBTFUL));
    Element::new("defs").child(pattern)
}

/// Adds the verdicts of the strip that are in view to the key of a panel.
pub(super) fn explain(map: &InteractionMap, cells: &[Cell], panel: &mut Panel<'_>) {
    let seen = within(cells, panel.x.range).iter();
    let seen: Vec<_> = seen.filter_map(|cell| point(map, cell.index)?.validity_verdict()).collect();
    for verdict in MARKED.into_iter().filter(|verdict| seen.contains(verdict)) {
        if let Some(fill) = fill(verdict) {
            let patch = rectangle(0.0, -6.0, 20.0, 12.0).set("fill", fill);
            panel.wide_sample(patch, 20.0, words(verdict));
        }
    }
    if without_thickness(map) {
        panel.note(WITHOUT_THICKNESS);
    }
}
