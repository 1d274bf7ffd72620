//! Checks of the casing.

use std::f64::consts::{PI, TAU};

use super::request::{ClearanceState, Measured, SingleLobe, Tilt, Wave};
use super::resolved::Clearance;
use super::result::Overshoot;
use super::shape::Shape;
use super::steps::least_steps;
use super::survey::overshoots;
use crate::model::ModelFacts;
use crate::request::AutoOr;
use crate::resolve::findings::{Findings, between, check_reach};
use crate::resolve::limits;
use crate::resolved::{ResolvedSweep, Scene};
use rubmap_wheel::dynamics::integrate::DIVERGED_SHARE_OF_RADIUS;

const AT: &str = "/scene/casing";
const MOST_LOBES: u32 = 100;
const LEAST_WIDTH_RAD: f64 = 1e-4;
/// Largest ratio of the half-width w to the distance of two equal Gaussians exp(−(φ/w)²) with a valley between them.
const WIDTH_OVER_DISTANCE: f64 = std::f64::consts::FRAC_1_SQRT_2;
/// Largest number of angles of a measured line.
const MOST_MEASURED: usize = 100_000;
/// Smallest distance of two points, as a share of the median distance: a curve through nearer points is made of their errors.
const LEAST_DISTANCE: f64 = 1e-3;
/// Largest overshoot of a curve beyond its points, as a share of their range: a curve that goes farther does not follow them.
const MOST_OVERSHOOT: f64 = 0.5;
/// Largest tilt, rad: the square of a larger one is more than a thousandth of it.
const MOST_TILT_RAD: f64 = 1e-3;
/// Shortest ramp of lobes that stand inside the blade.
pub(crate) const LEAST_RAMP_REVOLUTIONS: f64 = 0.05;

/// Checks clearance and shape.
pub(super) fn check(found: &mut Findings, request: &ResolvedSweep, facts: &ModelFacts) {
    let Some(casing) = &request.scene.casing else { return };
    let valid = |length: f64| length == 0.0 || limits::LENGTH.contains(&length.abs());
    let radius = facts.contact_radius.filter(|radius| *radius > 0.0).unwrap_or(f64::INFINITY);
    let fits =
        |length: f64| valid(length) && length <= radius && length >= -DIVERGED_SHARE_OF_RADIUS * radius;
    let message = format!(
        "a clearance is 0 or a length {}, no larger than the radius at which the tips lie; or negative, where the casing is pressed \
         into the tips by at most a tenth of that",
        between(&limits::LENGTH)
    );
    found.require(
        casing.given == ClearanceState::Running || facts.mesh.is_some(),
        "/scene/casing/clearance/given",
        "the package has no elements, of which the centrifugal load is made that tips grow under: give clearances of the running wheel, \
         or a package with elements",
    );
    match &casing.clearance {
        Clearance::AlongChord { leading, trailing } => {
            found.require(fits(*leading), "/scene/casing/clearance/leading", &message);
            found.require(fits(*trailing), "/scene/casing/clearance/trailing", &message);
        }
        Clearance::Each(values) => {
            found.require(
                values.len() == facts.contact_nodes as usize,
                "/scene/casing/clearance/values",
                format!("the model has {} contact nodes, not {}", facts.contact_nodes, values.len()),
            );
            for (index, &value) in values.iter().enumerate() {
                found.require(fits(value), &format!("/scene/casing/clearance/values/{index}"), &message);
            }
        }
    }
    let shape = &casing.shape;
    check_single_lobes(found, &shape.single_lobes, facts);
    check_waves(found, &shape.waves, facts);
    if let Some(measured) = &shape.measured {
        check_measured(found, measured, facts);
    }
    if let Some(tilt) = &shape.tilt {
        check_tilt(found, tilt, facts);
    }
    if let Some(lobes) = &shape.lobes {
        check_along_chord(found, lobes.along_chord.as_deref(), "/scene/casing/lobes", facts);
        check_lobe_count(found, lobes.count, "/scene/casing/lobes/count");
        found.require(
            lobes.amplitude >= 0.0 && valid(lobes.amplitude),
            "/scene/casing/lobes/amplitude",
            format!("a lobe's height is 0 or a length {}", between(&limits::LENGTH)),
        );
        check_reach(found, lobes.amplitude, "/scene/casing/lobes/amplitude", facts);
        let least = LEAST_WIDTH_RAD;
        let most = WIDTH_OVER_DISTANCE * TAU / f64::from(lobes.count.max(1));
        found.require(
            (least..=most).contains(&lobes.width_rad),
            "/scene/casing/lobes/width_rad",
            format!(
                "the half-width of a lobe is at least {least} rad and of {} lobes at most {most:.6} rad: between wider ones there is no \
                 valley",
                lobes.count
            ),
        );
        found.require(
            lobes.phase_rad.abs() <= limits::PHASE_RAD,
            "/scene/casing/lobes/phase_rad",
            format!("the phase is an angle of at most {} rad", limits::PHASE_RAD),
        );
    }
    // Parts that are right one by one may not be so together.
    if !found.refused(AT) {
        let highest = shape.highest();
        if highest.is_finite() {
            check_reach(found, highest, AT, facts);
        }
    }
}

/// Checks a height of a shape that is asked for at `pointer`.
fn check_height(found: &mut Findings, height: f64, pointer: &str, facts: &ModelFacts) {
    let size = height.abs();
    found.require(
        size == 0.0 || limits::LENGTH.contains(&size),
        pointer,
        format!("a height is 0 or a length {}, inward if positive", between(&limits::LENGTH)),
    );
    check_reach(found, size, pointer, facts);
}

fn check_angle(found: &mut Findings, angle_rad: f64, pointer: &str) {
    found.require(
        angle_rad.abs() <= limits::PHASE_RAD,
        pointer,
        format!("an angle of at most {} rad", limits::PHASE_RAD),
    );
}

/// Checks the shares at the contact nodes of what is asked for at `pointer`.
pub(crate) fn check_along_chord(
    found: &mut Findings,
    along: Option<&[f64]>,
    pointer: &str,
    facts: &ModelFacts,
) {
    let Some(along) = along else { return };
    let pointer = format!("{pointer}/along_chord");
    found.require(
        along.len() == facts.contact_nodes as usize,
        &pointer,
        format!("the model has {} contact nodes, not {}", facts.contact_nodes, along.len()),
    );
    for (index, share) in along.iter().enumerate() {
        let pointer = format!("{pointer}/{index}");
        found.require(share.abs() <= 1.0, &pointer, "a share from -1 to 1");
    }
}

fn check_single_lobes(found: &mut Findings, lobes: &[SingleLobe], facts: &ModelFacts) {
    let at = "/scene/casing/single_lobes";
    found.require(lobes.len() <= MOST_LOBES as usize, at, format!("at most {MOST_LOBES} lobes"));
    let most = WIDTH_OVER_DISTANCE * PI;
    for (index, lobe) in lobes.iter().enumerate() {
        let at = format!("{at}/{index}");
        check_angle(found, lobe.angle_rad, &format!("{at}/angle_rad"));
        check_height(found, lobe.amplitude, &format!("{at}/amplitude"), facts);
        found.require(
            (LEAST_WIDTH_RAD..=most).contains(&lobe.width_rad),
            &format!("{at}/width_rad"),
            format!(
                "the half-width of a lobe is at least {LEAST_WIDTH_RAD} rad and at most {most:.6} rad: wider ones do not end where \
                 they meet themselves"
            ),
        );
        check_along_chord(found, lobe.along_chord.as_deref(), &at, facts);
    }
}

fn check_waves(found: &mut Findings, waves: &[Wave], facts: &ModelFacts) {
    let at = "/scene/casing/waves";
    found.require(waves.len() <= MOST_LOBES as usize, at, format!("at most {MOST_LOBES} waves"));
    for (index, wave) in waves.iter().enumerate() {
        let at = format!("{at}/{index}");
        found.require(
            (1..=MOST_LOBES).contains(&wave.order),
            &format!("{at}/order"),
            format!("1 to {MOST_LOBES} waves around the circumference; what is the same all around belongs to the clearance"),
        );
        check_height(found, wave.amplitude, &format!("{at}/amplitude"), facts);
        check_angle(found, wave.phase_rad, &format!("{at}/phase_rad"));
        check_along_chord(found, wave.along_chord.as_deref(), &at, facts);
    }
}

/// Checks tables that curves go through.
fn check_measured(found: &mut Findings, measured: &Measured, facts: &ModelFacts) {
    let at = "/scene/casing/measured";
    let Measured { angles_rad, chord, heights, curves: _ } = measured;
    let ascending = |values: &[f64]| values.windows(2).all(|pair| pair[0] < pair[1]);
    found.require(
        (Measured::LEAST_ANGLES..=MOST_MEASURED).contains(&angles_rad.len()),
        &format!("{at}/angles_rad"),
        format!("{} to {MOST_MEASURED} angles", Measured::LEAST_ANGLES),
    );
    // From the last to the first as the curve has it.
    let closing = angles_rad.last().zip(angles_rad.first()).map(|(last, first)| first + TAU - last);
    let distances = || angles_rad.windows(2).map(|pair| pair[1] - pair[0]).chain(closing);
    let mut sorted: Vec<f64> = distances().collect();
    sorted.sort_by(f64::total_cmp);
    let least = LEAST_DISTANCE * sorted.get(sorted.len() / 2).copied().unwrap_or(0.0);
    found.require(
        least > 0.0
            && distances().all(|distance| distance >= least)
            && angles_rad.iter().all(|angle| angle.abs() <= limits::PHASE_RAD),
        &format!("{at}/angles_rad"),
        format!(
            "angles ascend within one turn, the first not repeated at its end, none nearer to the next than a thousandth of the \
             distance of half of them ({least} rad)"
        ),
    );
    let widest = distances().fold(0.0, f64::max);
    found.require(
        widest <= Measured::WIDEST_GAP_RAD,
        &format!("{at}/angles_rad"),
        format!("{widest} rad without a point: no curve can be laid across more than a quarter of a turn"),
    );
    let lines = chord.as_ref().map_or(facts.contact_nodes as usize, Vec::len);
    if let Some(chord) = chord {
        found.require(
            !chord.is_empty() && ascending(chord) && chord.iter().all(|share| (0.0..=1.0).contains(share)),
            &format!("{at}/chord"),
            "places of the lines along the chord ascend strictly from 0 at the leading to 1 at the trailing edge",
        );
    }
    found.require(
        heights.len() == lines,
        &format!("{at}/heights"),
        match chord {
            Some(_) => {
                format!("one list of heights for each of the {lines} lines of `chord`, not {}", heights.len())
            }
            None => format!(
                "one list of heights for each of the {lines} contact nodes, not {}; lines elsewhere are placed by `chord`",
                heights.len()
            ),
        },
    );
    for (line, heights) in heights.iter().enumerate() {
        let at = format!("{at}/heights/{line}");
        found.require(
            heights.len() == angles_rad.len(),
            &at,
            format!("one height for each of the {} angles, not {}", angles_rad.len(), heights.len()),
        );
        // The smallest and the largest of thousands of heights stand for all.
        let shown = || (0..heights.len()).filter(|&index| heights[index] != 0.0);
        let size = |&a: &usize, &b: &usize| heights[a].abs().total_cmp(&heights[b].abs());
        for index in [shown().min_by(size), shown().max_by(size)].into_iter().flatten() {
            if !found.refused(&at) {
                check_height(found, heights[index], &format!("{at}/{index}"), facts);
            }
        }
    }
    if found.refused(at) {
        return;
    }
    for (Overshoot { line, by, .. }, range) in overshoots(measured) {
        found.require(
            by <= MOST_OVERSHOOT * range,
            &format!("{at}/heights/{line}"),
            format!(
                "the curve through these heights goes {by} beyond them, more than half of their range: points too near to each other \
                 for their errors, or one that is wrong; the reading of a table says where"
            ),
        );
    }
}

fn check_tilt(found: &mut Findings, tilt: &Tilt, facts: &ModelFacts) {
    let at = "/scene/casing/tilt";
    check_reach(found, (tilt.angle_rad * tilt.about_z).abs(), &format!("{at}/about_z"), facts);
    found.require(
        tilt.angle_rad.abs() <= MOST_TILT_RAD,
        &format!("{at}/angle_rad"),
        format!("at most {MOST_TILT_RAD} rad: it is taken to first order"),
    );
    check_angle(found, tilt.towards_rad, &format!("{at}/towards_rad"));
    found.require(
        tilt.about_z == 0.0 || limits::LENGTH.contains(&tilt.about_z.abs()),
        &format!("{at}/about_z"),
        format!("0 or a length {}, of either sign", between(&limits::LENGTH)),
    );
}

/// Checks the number of lobes that is asked for at `pointer` of a request.
pub(crate) fn check_lobe_count(found: &mut Findings, count: u32, pointer: &str) {
    found.require(
        (1..=MOST_LOBES).contains(&count),
        pointer,
        format!("a casing has 1 to {} lobes", MOST_LOBES),
    );
}

/// Checks that steps resolve every lobe: wider ones would pass it by, with numbers that look fine.
pub(crate) fn check_steps(found: &mut Findings, request: &ResolvedSweep) {
    let AutoOr::Fixed(steps) = request.integration.steps_per_revolution else { return };
    if found.refused(AT) || request.scene.touched_shape().is_none_or(Shape::is_circular) {
        return;
    }
    let seen = least_steps(&request.scene);
    found.require(
        f64::from(steps) >= seen,
        "/integration/steps_per_revolution",
        format!(
            "{steps} steps per revolution pass the shape of the casing by, which is seen from {seen} steps per revolution on; give at least \
             {seen}, or \"auto\""
        ),
    );
}

/// Checks the ramp: without one a restriction inside the blade would hit it as a step, forces scale as 1/h, and nothing converges.
pub(crate) fn check_ramp(found: &mut Findings, request: &ResolvedSweep) {
    if found.refused(AT) {
        return;
    }
    let Scene { casing: Some(casing), contact: Some(_), .. } = &request.scene else { return };
    if request.has_cold_clearances() {
        found.require(
            request.integration.ramp_revolutions >= LEAST_RAMP_REVOLUTIONS,
            "/integration/ramp_revolutions",
            format!(
                "clearances given cold may be closed where the wheel turns: let the casing grow over at least {LEAST_RAMP_REVOLUTIONS} \
                 revolutions"
            ),
        );
        return;
    }
    let restriction = casing.shape.highest();
    let orbit = request.scene.orbit.as_ref().map_or(0.0, |orbit| orbit.radius);
    let smallest = casing.clearance.smallest();
    let highest = restriction + orbit;
    let what = if highest.is_finite() {
        format!(
            "shape and orbit of up to {highest} reach inside the blade at rest (smallest clearance {smallest})"
        )
    } else {
        "a tilted casing may reach inside the blade at rest".to_owned()
    };
    found.require(
        request.integration.ramp_revolutions >= LEAST_RAMP_REVOLUTIONS || highest <= smallest,
        "/integration/ramp_revolutions",
        format!("{what}: let them grow over at least {LEAST_RAMP_REVOLUTIONS} revolutions"),
    );
}
