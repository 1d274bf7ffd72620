//! Validity of linear theory at a speed: ratios of displacement, rotation and strain to their limits.

use crate::effects::casing::shape::Shape;
use crate::model::ReducedSector;
use crate::resolved::ResolvedSweep;
use crate::result::{PointStress, Validity, ValidityCheck, ValidityLack, ValidityMeasure, ValidityVerdict};
use rubmap_wheel::dynamics::casing::arc_lengths;
use rubmap_wheel::dynamics::integrate::Excursion;

/// Limit of a measure: doubtful above the first, beyond linear theory above the second, if there is one. Displacement and rotation of the tip
/// guess by geometry and have none: a blade that bends freely is linear far beyond its thickness, so they can raise a doubt and prove nothing.
type Limits = (f64, Option<f64>);

/// Limit of displacement over thickness. A plate with held edges that bends by half its thickness carries some tenths of its load as a
/// membrane, which linear bending neglects.
const OVER_THICKNESS: Limits = (0.5, None);
/// Least thickness of a blade at its tip over the length of its contact line: thinner ones are neither milled nor cast.
const THINNEST: f64 = 1.0 / 500.0;
/// Limit of displacement over chord. A cantilever that deflects by a twentieth of its length is right to a fraction of a percent, by a tenth
/// to about one percent.
const OVER_CHORD: Limits = (0.05, None);
/// Limit of rotation, rad: small rotations add strains of φ²/2, 0.5 %, more than any elastic strain of a metal.
const ROTATION: Limits = (0.1, None);
/// Limit of rotation of blades that stiffen, rad: their energy is exact to the fourth order, and the fifth is φ³ of the linear one, 1 %.
const ROTATION_OF_STIFFENING: Limits = (0.2, None);
/// Share of a motion outside the coordinates of blades that bend far beyond which the answer is mostly that of linear theory.
pub(crate) const MOST_OUTSIDE: f64 = 1.0 / 3.0;
/// Limits of the share of the tips' motion that the coordinates of blades that bend far do not carry: forces of second and third order are off
/// by about as much. More may be outside where that alone would be linear.
const OUTSIDE_COORDINATES: Limits = (0.1, Some(MOST_OUTSIDE));
/// Limits of stress over yield strength. Materials are linear up to about nine tenths of the yield strength, and not beyond it.
const OVER_YIELD: Limits = (0.9, Some(1.0));
/// Limits of the approach of neighbouring tips: at 1 they meet, and no contact between them is simulated.
const APPROACH: Limits = (0.5, Some(1.0));
/// Limits of tangential displacement over lobe: the casing is evaluated where a tip would be at rest; a twentieth of a lobe is 18° of its
/// phase, a seventh 51°.
const OVER_LOBE: Limits = (0.05, Some(1.0 / 7.0));

/// Limits of the excess energy |κ| of the relaxed blade: stiffness changes by as much, and frequencies by half of it. 1 % of a frequency is what
/// finite elements and clamps leave open anyway; 5 % is wider than a resonance, so that critical speeds lie elsewhere.
const EXCESS_ENERGY: Limits = (0.02, Some(0.1));
/// Limits of the second-order motion of a tip over its clearance: clearances are not known better than to some percent, and a tenth of one
/// changes where and how hard a blade touches.
const SECOND_ORDER_GAP: Limits = (0.02, Some(0.1));

/// Checks that guess by geometry.
pub(super) fn geometric(validity: &Validity) -> impl Iterator<Item = &ValidityCheck> {
    validity.checks.iter().filter(|check| is_geometric(check.what))
}

fn is_geometric(what: ValidityMeasure) -> bool {
    use ValidityMeasure::{DisplacementOverChord, DisplacementOverThickness, Rotation};
    matches!(what, DisplacementOverThickness | DisplacementOverChord | Rotation)
}

/// Thickness of the blade at its tip: that of the request, otherwise that of the mesh.
pub(super) fn thickness(reduced: &ReducedSector, request: &ResolvedSweep) -> Option<f64> {
    request.blade_thickness.or(reduced.tip_thickness)
}

/// Whether geometry raises a doubt about a speed, or cannot say anything for want of a thickness: of a scene in which blades do not stiffen.
pub(super) fn is_open(validity: &Validity, request: &ResolvedSweep) -> bool {
    let in_doubt = geometric(validity).any(ValidityCheck::is_doubtful) || is_unseen(&validity.lacking);
    in_doubt && !request.scene.blades_stiffen()
}

fn is_unseen(lacking: &[ValidityLack]) -> bool {
    lacking.iter().any(|lack| lack.what == ValidityMeasure::DisplacementOverThickness)
}

/// Validity with measures in the place of guesses by geometry, each with the speed that it was scaled from, if it was.
pub(super) fn beside(
    validity: &Validity,
    (excess, excess_from): (f64, Option<u32>),
    gap: Option<(f64, Option<u32>)>,
) -> Validity {
    let check = |what, value: f64, (doubtful_above, beyond_above): Limits, scaled_from| ValidityCheck {
        what,
        value,
        doubtful_above,
        beyond_above,
        scaled_from,
    };
    let mut checks = vec![check(ValidityMeasure::ExcessEnergy, excess, EXCESS_ENERGY, excess_from)];
    checks.extend(
        gap.map(|(value, from)| check(ValidityMeasure::SecondOrderGap, value, SECOND_ORDER_GAP, from)),
    );
    checks.extend(validity.checks.iter().filter(|check| !is_geometric(check.what)));
    let lacking = validity.lacking.iter().filter(|lack| !is_geometric(lack.what));
    conclude(checks, lacking.cloned().collect())
}

/// Validity whose measures are lacking for a reason; guesses by geometry stay.
pub(super) fn unmeasured(validity: &Validity, reason: &str) -> Validity {
    let mut lacking = validity.lacking.clone();
    lacking.push(ValidityLack { what: ValidityMeasure::ExcessEnergy, reason: reason.to_owned() });
    conclude(validity.checks.clone(), lacking)
}

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
    let is_bent = request.scene.blades_stiffen();
    let thickness = thickness(reduced, request);
    let over_chord = over(excursion.displacement, chord);
    let linear =
        [thickness.map(|length| OVER_THICKNESS.0 * length), chord.map(|length| OVER_CHORD.0 * length)];
    let linear = linear.into_iter().flatten().reduce(f64::min).unwrap_or(0.0);
    let outside_limits = outside_limits(linear / excursion.displacement);
    let rotation_limit = if is_bent { ROTATION_OF_STIFFENING } else { ROTATION };
    let over_yield = stress.and_then(|stress| stress.largest_over_yield);
    let measured = [
        (
            ValidityMeasure::OutsideCoordinates,
            request.bending_coordinates().map(|_| excursion.outside_coordinates),
            outside_limits,
        ),
        (
            ValidityMeasure::DisplacementOverThickness,
            over(excursion.displacement, thickness).filter(|_| !is_bent),
            OVER_THICKNESS,
        ),
        (ValidityMeasure::DisplacementOverChord, over_chord.filter(|_| !is_bent), OVER_CHORD),
        (ValidityMeasure::Rotation, chord.map(|_| excursion.rotation), rotation_limit),
        (ValidityMeasure::StressOverYield, over_yield, OVER_YIELD),
        (
            ValidityMeasure::NeighbourApproach,
            (reduced.wheel.sectors > 1).then_some(excursion.approach),
            APPROACH,
        ),
        (ValidityMeasure::ContactOverLobe, over(excursion.tangential, lobe), OVER_LOBE),
    ];
    let check = |(what, value, (doubtful_above, beyond_above)): (_, Option<f64>, Limits)| {
        let value = value.filter(|value| value.is_finite())?;
        Some(ValidityCheck { what, value, doubtful_above, beyond_above, scaled_from: None })
    };
    let checks = measured.into_iter().filter_map(check).collect();
    let asked = request.stress_outside().is_some();
    let thick_enough = is_bent || thickness.is_some() || over_chord.is_some_and(is_slight);
    conclude(checks, lacking(thick_enough, chord, stress, asked))
}

/// Limits of the share of motion outside the coordinates, where geometry lets a displacement be linear that is `linear` times the one there was.
fn outside_limits(linear: f64) -> Limits {
    let linear = if linear.is_nan() { 0.0 } else { linear.min(1.0) };
    let (doubtful, beyond) = OUTSIDE_COORDINATES;
    (doubtful.max(linear), beyond.map(|beyond| beyond.max(linear * beyond / doubtful)))
}

/// Whether a displacement over the chord is harmless however thin the blade is.
fn is_slight(over_chord: f64) -> bool {
    over_chord <= OVER_THICKNESS.0 * THINNEST
}

/// Validity by its `checks`, the worst of which comes first and decides, unless something that would decide is `lacking`.
fn conclude(mut checks: Vec<ValidityCheck>, lacking: Vec<ValidityLack>) -> Validity {
    let share = |check: &ValidityCheck| check.value / check.beyond_above.unwrap_or(check.doubtful_above);
    let order = |a: &ValidityCheck, b: &ValidityCheck| {
        b.verdict().cmp(&a.verdict()).then(share(b).total_cmp(&share(a)))
    };
    checks.sort_by(order);
    let by_checks = checks.first().map_or(ValidityVerdict::Linear, ValidityCheck::verdict);
    let at_least = if is_unseen(&lacking) { ValidityVerdict::NotChecked } else { ValidityVerdict::Linear };
    Validity { verdict: by_checks.max(at_least), checks, lacking }
}

/// Decisive quantities that are not known, given whether the blade is `thick_enough` or its thickness known, the length of the contact line,
/// and the stress, if it was `asked` for.
fn lacking(
    thick_enough: bool,
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
    let of_thickness = (!thick_enough)
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
        assert_eq!(named(lacking(true, Some(1.0), Some(&judged), true)), []);
        assert_eq!(
            named(lacking(false, Some(1.0), None, false)),
            [thickness, of_stress("the sweep records no stress (`record.stress`)")]
        );
        assert_eq!(
            named(lacking(true, Some(1.0), Some(&bare), true)),
            [of_stress("no element set has a yield strength (`yield_strength` in the package)")]
        );
        assert_eq!(
            named(lacking(true, Some(1.0), None, true)),
            [of_stress("stress is not known at this speed")]
        );
        assert_eq!(lacking(true, None, Some(&judged), true).len(), 2);
    }

    #[test]
    fn geometry_alone_is_never_beyond_and_what_cannot_be_seen_is_not_checked() {
        let thickness = ValidityMeasure::DisplacementOverThickness;
        let check = |what, value, (doubtful_above, beyond_above): Limits| ValidityCheck {
            what,
            value,
            doubtful_above,
            beyond_above,
            scaled_from: None,
        };
        let verdict = |checks: Vec<ValidityCheck>, lacking| conclude(checks, lacking).verdict;
        let unseen = || lacking(false, Some(1.0), None, false);
        assert_eq!(verdict(vec![check(thickness, 0.4, OVER_THICKNESS)], Vec::new()), ValidityVerdict::Linear);
        for value in [0.6, 3.0, 3.9e13] {
            let judged = verdict(vec![check(thickness, value, OVER_THICKNESS)], Vec::new());
            assert_eq!(judged, ValidityVerdict::Doubtful, "{value}");
        }
        let chord = |value| check(ValidityMeasure::DisplacementOverChord, value, OVER_CHORD);
        assert_eq!(verdict(vec![chord(0.01)], unseen()), ValidityVerdict::NotChecked);
        assert_eq!(verdict(vec![chord(0.5)], unseen()), ValidityVerdict::Doubtful);
        // Blades that meet are beyond linear theory, however little else is known.
        let meeting = check(ValidityMeasure::NeighbourApproach, 1.1, APPROACH);
        let judged = conclude(vec![chord(0.5), meeting], unseen());
        assert_eq!((judged.verdict, judged.checks[0]), (ValidityVerdict::Beyond, meeting));
        // Half the thickness of the thinnest blade on a chord of 100 is 0.1.
        assert!(is_slight(0.0999 / 100.0) && !is_slight(0.1001 / 100.0));
        // Stress without a strength leaves the deformation checked.
        assert_eq!(
            verdict(vec![chord(0.01)], lacking(true, Some(1.0), None, false)),
            ValidityVerdict::Linear
        );
    }

    #[test]
    fn measures_take_the_place_of_geometry() {
        let excursion = |what, value, (doubtful_above, beyond_above): Limits| ValidityCheck {
            what,
            value,
            doubtful_above,
            beyond_above,
            scaled_from: None,
        };
        let guessed = conclude(
            vec![
                excursion(ValidityMeasure::DisplacementOverChord, 0.2, OVER_CHORD),
                excursion(ValidityMeasure::ContactOverLobe, 0.01, OVER_LOBE),
            ],
            lacking(false, Some(1.0), None, false),
        );
        assert_eq!(guessed.verdict, ValidityVerdict::Doubtful);
        // Limits from both sides, and the second-order gap beside a harmless energy.
        for (excess, gap, verdict) in [
            (0.019, None, ValidityVerdict::Linear),
            (0.021, None, ValidityVerdict::Doubtful),
            (0.099, Some(0.019), ValidityVerdict::Doubtful),
            (0.101, Some(0.019), ValidityVerdict::Beyond),
            (0.001, Some(0.021), ValidityVerdict::Doubtful),
            (0.001, Some(0.101), ValidityVerdict::Beyond),
        ] {
            let judged = beside(&guessed, (excess, None), gap.map(|gap| (gap, Some(3))));
            assert_eq!(judged.verdict, verdict, "{excess} {gap:?}");
            assert_eq!(geometric(&judged).count(), 0);
            assert_eq!(judged.measures_lacking(), [ValidityMeasure::StressOverYield]);
            assert_eq!(judged.checks.len(), 2 + usize::from(gap.is_some()));
        }
        let failed = unmeasured(&guessed, "the basis cannot be read");
        assert_eq!((failed.verdict, failed.lacking.len()), (ValidityVerdict::Doubtful, 3));
    }

    #[test]
    fn what_earlier_versions_stored_is_read() {
        let check = r#"{"what":"rotation","value":0.3,"doubtful_above":0.1,"beyond_above":0.2}"#;
        let read: ValidityCheck = serde_json::from_str(check).unwrap();
        assert_eq!((read.verdict(), read.beyond_above), (ValidityVerdict::Beyond, Some(0.2)));
        let old = r#"{"verdict":"linear","checks":[]}"#;
        let read: Validity = serde_json::from_str(old).unwrap();
        assert_eq!((read.lacking.len(), serde_json::to_string(&read).unwrap()), (0, old.to_owned()));
    }
}
