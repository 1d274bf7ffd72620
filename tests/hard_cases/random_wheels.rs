//! Random wheels against random casings, by every scheme: cases that no list of special cases thinks of.
//!
//! Lesser codes are tuned on wheels like the last one: modes within two decades, as many modes as contact nodes, normals
//! that differ, a step well inside its limit. Guaranteed, whatever is drawn: finite numbers, no pulling, no tip inside the
//! casing at any step beyond round-off (measured on the recorded displacement, not on what the solver says of itself)
//! and a balanced energy; or an end by name. Never a panic.

mod recipe;

use std::cell::Cell;

use proptest::prelude::*;
use proptest::test_runner::{TestCaseResult, TestRunner};
use rubmap::dynamics::integrate::{Outcome, Run};
use rubmap::dynamics::schemes::Scheme;

use self::recipe::{Case, RADIUS, REVOLUTIONS, Recipe, Shapes, recipes};
use crate::campaign::campaign;
use crate::fixed::fixed;
use crate::support::ENERGY_TOLERANCE;

/// Counts of how the cases of a property ended.
#[derive(Debug, Default)]
struct Tally {
    refused: Cell<u32>,
    touched: Cell<u32>,
    untouched: Cell<u32>,
    diverged: Cell<u32>,
    failed: Cell<u32>,
}

fn count(cell: &Cell<u32>) {
    cell.set(cell.get() + 1);
}

/// Function that gives the scheme and the steps per revolution by which a recipe is run; `None` if it is refused.
type Choice = fn(&Recipe, &Case) -> Option<(Scheme, usize)>;

/// Runs `cases` recipes, each by the scheme and steps of `choose`.
fn hold(cases: u32, choose: Choice) -> Tally {
    let tally = Tally::default();
    let outcome = TestRunner::new(fixed(cases)).run(&recipes(), |recipe| {
        let case = recipe.case();
        withstands(&recipe, &case, choose(&recipe, &case), &tally)
    });
    outcome.unwrap_or_else(|error| panic!("{error}"));
    tally
}

fn withstands(
    recipe: &Recipe,
    case: &Case,
    chosen: Option<(Scheme, usize)>,
    tally: &Tally,
) -> TestCaseResult {
    let Some((scheme, steps)) = chosen else {
        count(&tally.refused);
        return Ok(());
    };
    let run = case.run(scheme, steps);
    let statistics = &run.statistics;
    prop_assert!(statistics.smallest_multiplier.is_none_or(|lambda| lambda >= 0.0), "{statistics:?}");
    let history = match &run.outcome {
        Outcome::Completed(history) => history,
        Outcome::Diverged(divergence) => {
            count(&tally.diverged);
            prop_assert!(divergence.tip.is_some_and(|tip| tip.displacement > 0.1 * RADIUS), "{divergence:?}");
            return Ok(());
        }
        Outcome::ContactFailed { .. } => {
            count(&tally.failed);
            return Ok(());
        }
        Outcome::Cancelled => panic!("nobody cancelled"),
    };
    count(if statistics.contact_steps > 0 { &tally.touched } else { &tally.untouched });
    let numbers = history.displacement.iter().chain(history.harmonics.iter().flatten()).flatten();
    prop_assert!(numbers.copied().all(f64::is_finite));
    prop_assert_eq!(statistics.steps, (REVOLUTIONS * steps) as u64);
    let (deepest, told) = (case.deepest(history, steps), statistics.largest_penetration);
    prop_assert!(deepest.max(told) <= recipe.penetration_tolerance(case), "{deepest:e}, told {told:e}");
    let residual = run.energy.residual();
    prop_assert!(residual <= recipe.energy_tolerance(), "{residual:e} of {:e}", run.energy.largest_energy());
    Ok(())
}

impl Recipe {
    /// Penetration that round-off may leave. Gaps are differences of lengths below a millimetre: some thousand roundings
    /// of them. Where nodes may be indistinguishable, the millionth from which on the code gives up: of the casing's
    /// lengths, and of the tenths of a millimetre by which moving tips may stand in it at the start.
    fn penetration_tolerance(&self, case: &Case) -> f64 {
        let distinct =
            self.shapes == Shapes::Independent && self.modes >= 3 * self.nodes && self.decades < 5.0;
        let start = if self.moving { 1.0 } else { 0.0 };
        if distinct { 1e-12 } else { 1e-6 * (case.casing.length_scale(0.1 * RADIUS) + start) }
    }

    /// Energy residual that round-off may leave: a mode whose ωh is 1e-10 has no energy beside the round-off of the work done on it.
    fn energy_tolerance(&self) -> f64 {
        if self.decades > 5.0 { 1e-5 } else { ENERGY_TOLERANCE }
    }
}

/// Central differences with the steps per revolution of the recipe: between 1.0001 and 5 times the limit.
fn central_differences(recipe: &Recipe, case: &Case) -> Option<(Scheme, usize)> {
    let smallest = Scheme::CentralDifferences.smallest_stable_steps(&case.wheel, &case.contact_nodes);
    assert!(smallest <= recipe.steps as u64);
    Some((Scheme::CentralDifferences, recipe.steps))
}

/// Exact propagator with as many steps, and some three and thirty times fewer: most modes are then beyond what a step resolves.
fn exact_modal(recipe: &Recipe, _: &Case) -> Option<(Scheme, usize)> {
    let fewer = [1, 3, 30][recipe.seed as usize % 3];
    Some((Scheme::ExactModal, recipe.steps / fewer + 40))
}

/// Massless boundary with any number of kept modes whose step is bearable.
fn massless_boundary(recipe: &Recipe, case: &Case) -> Option<(Scheme, usize)> {
    let scheme = Scheme::MasslessBoundary { kept_modes: 1 + recipe.seed as usize % recipe.modes };
    let smallest = scheme.smallest_stable_steps(&case.wheel, &case.contact_nodes);
    let steps = smallest.max(recipe.steps as u64);
    (steps < 20_000).then_some((scheme, steps as usize))
}

#[test]
fn central_differences_hold() {
    let tally = hold(150, central_differences);
    assert!(tally.touched.get() > 60 && tally.failed.get() < 30, "{tally:?}");
}

#[test]
fn exact_modal_holds() {
    let tally = hold(200, exact_modal);
    assert!(tally.touched.get() > 80 && tally.failed.get() < 30, "{tally:?}");
}

#[test]
fn massless_boundary_holds() {
    let tally = hold(150, massless_boundary);
    assert!(tally.touched.get() > 20 && tally.failed.get() < 30, "{tally:?}");
}

/// Asserts that a boundary without mass does not pump energy. Contact that opens and closes from step to step costs nothing
/// without mass at the boundary: at a step that is merely stable while contact lasts it pumps the modes, with perfect
/// credentials. At half that step, the longest that is accepted, it does not: the blades go no further than by central
/// differences, but for what those lose at closings.
fn does_not_pump(mut recipe: Recipe, compared: &Cell<u32>) -> TestCaseResult {
    // The recipe starts from rest, with no mode so soft that a push alone carries it away, and enough modes to leave out.
    // Its lobes are wide enough for the blades to follow: a blow tells the schemes apart by what a closing costs.
    recipe.width_rad = recipe.width_rad.max(0.5);
    recipe.ramp_revolutions = recipe.ramp_revolutions.max(0.5);
    recipe.moving = false;
    recipe.sectors = recipe.sectors.min(12);
    recipe.decades = recipe.decades.min(1.0);
    recipe.modes += 2 * recipe.nodes;
    let kept_modes = 1 + recipe.seed as usize % (recipe.modes - recipe.nodes);
    let scheme = Scheme::MasslessBoundary { kept_modes };
    let case = recipe.case();
    let steps = scheme.smallest_stable_steps(&case.wheel, &case.contact_nodes).min(20_000) as usize;
    if steps == 20_000 {
        return Ok(());
    }
    let expected = peak(&case.run(Scheme::CentralDifferences, recipe.steps))?;
    let found = peak(&case.run(scheme, steps.max(400)))?;
    if expected > 0.0 {
        count(compared);
    }
    prop_assert!(found <= 5.0 * expected, "{found} by {scheme:?} in {steps} steps, {expected}");
    Ok(())
}

#[test]
fn massless_boundary_does_not_pump() {
    let compared = Cell::new(0);
    let outcome = TestRunner::new(fixed(100)).run(&recipes(), |recipe| does_not_pump(recipe, &compared));
    outcome.unwrap_or_else(|error| panic!("{error}"));
    assert!(compared.get() > 30, "{compared:?}");
}

/// Campaign of all properties on wheel after wheel.
#[test]
#[ignore = "a campaign: runs for as long as one likes"]
fn campaign_of_random_wheels() {
    let (tally, compared) = (Tally::default(), Cell::new(0));
    campaign("random wheels in contact", recipes(), |recipe| {
        let case = recipe.case();
        for choose in [central_differences, exact_modal, massless_boundary] {
            withstands(&recipe, &case, choose(&recipe, &case), &tally)?;
        }
        does_not_pump(recipe, &compared)
    });
    println!("{tally:?}, {} compared for pumping", compared.get());
}

/// Largest displacement of a run that went to its end.
fn peak(run: &Run) -> Result<f64, TestCaseError> {
    match &run.outcome {
        Outcome::Completed(history) => {
            Ok(history.displacement.iter().flatten().fold(0.0, |largest, u| u.abs().max(largest)))
        }
        other => Err(TestCaseError::fail(format!("{other:?}"))),
    }
}
