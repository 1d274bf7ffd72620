//! Validity of linear theory at a speed: ratios of displacement, rotation and strain to their limits.

use crate::effects::casing::shape::Shape;
use crate::model::ReducedSector;
use crate::resolved::ResolvedSweep;
use crate::result::{PointStress, Validity, ValidityCheck, ValidityLack, ValidityMeasure, ValidityVerdict};
use rubmap_wheel::dynamics::casing::arc_lengths;
use rubmap_wheel::dynamics::integrate::Excursion;

/// Limits of displacement over thickness. A plate that bends by half its thickness carries some tenths of its load as a membrane, which
/// linear bending neglects; by its thickness about as much as by bending.
const OVER_THICKNESS: [f64; 2] = [0.5, 1.0];
/// Limits of displacement over chord. A cantilever that deflects by a twentieth of its length is right to a fraction of a percent, by a
/// tenth to about one percent.
const OVER_CHORD: [f64; 2] = [0.05, 0.1];
/// Limits of rotation, rad: small rotations add strains of φ²/2, 0.5 % and 2 %, more than any elastic strain of a metal.
const ROTATION: [f64; 2] = [0.1, 0.2];
/// Limits of stress over yield strength. Materials are linear up to about nine tenths of the yield strength, and not beyond it.
const OVER_YIELD: [f64; 2] = [0.9, 1.0];
/// Limits of the approach of neighbouring tips: at 1 they meet, and no contact between them is simulated.
const APPROACH: [f64; 2] = [0.5, 1.0];
/// Limits of tangential displacement over lobe: the casing is evaluated where a tip would be at rest; a twentieth of a lobe is 18° of its
/// phase, a seventh 51°.
const OVER_LOBE: [f64; 2] = [0.05, 1.0 / 7.0];

/// Judges a completed run by the `excursion` of its tips over the window and, if it was recorded, its stress.
pub(super) fn judge(
    excursion: &Excursion,
    stress: Option<&PointStress>,
    reduced: &ReducedSector,
    request: &ResolvedSweep,
) -> Validity {
    let contact = &reduced.wheel.contact;
    let positions: Vec<[f64; 3]> = contact.iter().map(|node| node.position).collect();
    let chord = arc_lengths(&positions).last().copied().filter(|&chord| chord > 0.0);
    let radius = positions.iter().map(|position| position[0]).reduce(f64::min);
    let period = request.scene.touched_shape().and_then(Shape::period_rad);
    let lobe = radius.zip(period).map(|(radius, period)| period * radius);
    let over = |value: f64, length: Option<f64>| length.filter(|&length| length > 0.0).map(|l| value / l);
    let over_yield = stress.and_then(|stress| stress.largest_over_yield);
    let measured = [
        (
            ValidityMeasure::DisplacementOverThickness,
            over(excursion.displacement, reduced.tip_thickness),
            OVER_THICKNESS,
        ),
        (ValidityMeasure::DisplacementOverChord, over(excursion.displacement, chord), OVER_CHORD),
        (ValidityMeasure::Rotation, chord.map(|_| excursion.rotation), ROTATION),
        (ValidityMeasure::StressOverYield, over_yield, OVER_YIELD),
        (
            ValidityMeasure::NeighbourApproach,
            (reduced.wheel.sectors > 1).then_some(excursion.approach),
            APPROACH,
        ),
        (ValidityMeasure::ContactOverLobe, over(excursion.tangential, lobe), OVER_LOBE),
    ];
    let check = |(what, value, [doubtful_above, beyond_above]): (_, Option<f64>, [f64; 2])| {
        let value = value.filter(|value| value.is_finite())?;
        Some(ValidityCheck { what, value, doubtful_above, beyond_above })
    };
    let mut checks: Vec<ValidityCheck> = measured.into_iter().filter_map(check).collect();
    let share = |check: &ValidityCheck| check.value / check.beyond_above;
    let order = |a: &ValidityCheck, b: &ValidityCheck| {
        b.verdict().cmp(&a.verdict()).then(share(b).total_cmp(&share(a)))
    };
    checks.sort_by(order);
    let verdict = checks.first().map_or(ValidityVerdict::Linear, ValidityCheck::verdict);
    let asked = request.stress_outside().is_some();
    Validity { verdict, checks, lacking: lacking(reduced.tip_thickness, chord, stress, asked) }
}

/// Decisive quantities that are not known, given the thickness of the blade at its tip, the length of the contact line, and the stress, if
/// it was `asked` for.
fn lacking(
    thickness: Option<f64>,
    chord: Option<f64>,
    stress: Option<&PointStress>,
    asked: bool,
) -> Vec<ValidityLack> {
    let of_line = chord.is_none().then_some("the contact line is one point");
    let of_stress = match stress {
        None if asked => Some("stress is not known at this speed"),
        None => Some("the sweep records no stress (`record.stress`)"),
        Some(stress) if stress.largest_over_yield.is_none() => {
            Some("no element set has a yield strength (`yield_strength` in the package)")
        }
        Some(_) => None,
    };
    let of_thickness = thickness
        .is_none()
        .then_some("the package has no mesh, or none that shows how thick the blade is at its tip");
    let all = [
        (ValidityMeasure::DisplacementOverThickness, of_thickness),
        (ValidityMeasure::DisplacementOverChord, of_line),
        (ValidityMeasure::Rotation, of_line),
        (ValidityMeasure::StressOverYield, of_stress),
    ];
    let known = all.into_iter().filter_map(|(what, reason)| Some((what, reason?)));
    known.map(|(what, reason)| ValidityLack { what, reason: reason.to_owned() }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_known_is_named() {
        let stress = |over_yield: Option<f64>| -> PointStress {
            serde_json::from_value(serde_json::json!({
                "largest": {"von_mises": 1.0, "node": 1, "position": [1.0, 2.0, 3.0], "sector": 0, "revolution": 1.0},
                "largest_static": 1.0, "largest_over_yield": over_yield, "cycles": [],
                "excluded_radius": 1.0, "excluded_nodes": 0, "followed_nodes": 1,
            }))
            .unwrap()
        };
        let (judged, bare) = (stress(Some(0.5)), stress(None));
        let named = |lacking: Vec<ValidityLack>| {
            lacking.into_iter().map(|lack| (lack.what, lack.reason)).collect::<Vec<_>>()
        };
        let no_mesh = "the package has no mesh, or none that shows how thick the blade is at its tip";
        let thickness = (ValidityMeasure::DisplacementOverThickness, no_mesh.to_owned());
        let of_stress = |reason: &str| (ValidityMeasure::StressOverYield, reason.to_owned());
        assert_eq!(named(lacking(Some(1.0), Some(1.0), Some(&judged), true)), []);
        assert_eq!(
            named(lacking(None, Some(1.0), None, false)),
            [thickness, of_stress("the sweep records no stress (`record.stress`)")]
        );
        assert_eq!(
            named(lacking(Some(1.0), Some(1.0), Some(&bare), true)),
            [of_stress("no element set has a yield strength (`yield_strength` in the package)")]
        );
        assert_eq!(
            named(lacking(Some(1.0), Some(1.0), None, true)),
            [of_stress("stress is not known at this speed")]
        );
        assert_eq!(lacking(Some(1.0), None, Some(&judged), true).len(), 2);
    }

    #[test]
    fn what_earlier_versions_stored_is_read() {
        let old = r#"{"verdict":"linear","checks":[]}"#;
        let read: Validity = serde_json::from_str(old).unwrap();
        assert_eq!((read.lacking.len(), serde_json::to_string(&read).unwrap()), (0, old.to_owned()));
    }
}
