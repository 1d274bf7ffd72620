//! Whether linear theory still holds at a speed: what moved, turned and strained, over what it must stay small against.

use crate::model::ReducedSector;
use crate::resolved::ResolvedSweep;
use crate::result::{PointStress, Validity, ValidityCheck, ValidityMeasure, ValidityVerdict};
use rubmap_wheel::dynamics::casing::arc_lengths;
use rubmap_wheel::dynamics::integrate::Excursion;

/// A plate that bends by half its thickness carries some tenths of its load as a membrane, which linear bending does not know; by its
/// thickness about as much as by bending.
const OVER_THICKNESS: [f64; 2] = [0.5, 1.0];
/// A cantilever that deflects by a twentieth of its length is right to a fraction of a percent, by a tenth to about one.
const OVER_CHORD: [f64; 2] = [0.05, 0.1];
/// rad: small rotations add strains of φ²/2, 0.5 % and 2 %, more than any elastic strain of a metal.
const ROTATION: [f64; 2] = [0.1, 0.2];
/// Materials are linear up to about nine tenths of the yield strength, and not beyond it.
const OVER_YIELD: [f64; 2] = [0.9, 1.0];
/// At 1 neighbouring tips meet, and nothing here stops them.
const APPROACH: [f64; 2] = [0.5, 1.0];
/// The casing is looked up where a tip would be at rest: a twentieth of a lobe is 18° of its phase, a seventh 51°.
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
    let lobes = request.scene.touched_lobes().map(|lobes| f64::from(lobes.count));
    let lobe = radius.zip(lobes).map(|(radius, lobes)| std::f64::consts::TAU * radius / lobes);
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
    Validity { verdict, checks }
}
