//! Branches of wheels: where their period doubles, and the branch that begins there.

use faer::c64;

use super::{SCHEMES, SPEED, Scene};
use crate::dynamics::initial::Stepped;
use crate::dynamics::integrate::{Passage, Simulation};
use crate::dynamics::numbers::Numbers;
use crate::dynamics::steady::branch::correct::FOUND;
use crate::dynamics::steady::branch::follow::{Front, Step};
use crate::dynamics::steady::branch::locate::SpecialPoint;
use crate::dynamics::steady::branch::{Branch, Family, Lap, Motion, Unreachable};
use crate::dynamics::steady::response::seek;
use crate::dynamics::steady::stability::{Floquet, Stability};

/// Family of a scene over its speed; the modes do not depend on it.
struct OverSpeed(Scene);

impl Family for OverSpeed {
    fn with(&self, value: f64, lap: Lap, act: &mut dyn FnMut(&mut Passage<'_>)) -> Result<(), Unreachable> {
        let mut wheel = self.0.wheel.clone();
        wheel.speed_rad_s = value;
        let simulation = Simulation { wheel: &wheel, ..self.0.simulation() };
        act(&mut lap.passage(&simulation)?);
        Ok(())
    }

    fn carry(&self, state: &Stepped, from: f64, to: f64) -> Result<Stepped, Unreachable> {
        let mut carried = state.clone();
        carried.modes.iter_mut().for_each(|mode| mode.increment *= from / to);
        Ok(carried)
    }
}

/// Multipliers of a motion, and the disturbance that grows most, as large as the motion.
fn tell(family: &OverSpeed, lap: Lap, motion: &Motion) -> (Floquet, Stepped) {
    let mut told = None;
    let act = &mut |passage: &mut Passage<'_>| {
        let state = passage.state_of(&motion.state);
        let floquet = Floquet::of(passage, &state, &vec![1.0; state.len()], 4).unwrap();
        let size = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
        let grows: Vec<f64> = floquet.multipliers[0].vector.iter().map(|x: &c64| x.re).collect();
        let scale = size(&state) / size(&grows);
        let grows: Vec<f64> = grows.iter().map(|x| scale * x).collect();
        told = Some((floquet, passage.stepped(&grows)));
    };
    family.with(motion.value, lap, act).unwrap();
    told.unwrap()
}

fn growth(of: &Floquet) -> f64 {
    of.multipliers[0].value.norm() - 1.0
}

/// Branches from the flips of a wheel of one blade: responses found beside them repeat after twice the time, are another motion half-way,
/// and become ever more so.
#[test]
fn a_branch_of_doubled_period_begins_at_a_flip() {
    let mut numbers = Numbers(17);
    let mut within = |low: f64, high: f64| low + 0.5 * (numbers.next() + 1.0) * (high - low);
    let (mut flips, mut doubled) = (0, 0);
    // Of these the last has most.
    let cases: Vec<_> = SCHEMES
        .into_iter()
        .cycle()
        .map(|scheme| (scheme, within(0.02, 0.08), within(0.6, 2.0)))
        .take(6)
        .collect();
    for &(scheme, damping, speed) in &cases[5..] {
        let mut scene = Scene::new(1, 1, damping, scheme);
        let start = speed * SPEED;
        scene.wheel.speed_rad_s = start;
        let Ok(found) = seek(&scene.simulation(), 60, false, &|| true).response else { continue };
        let family = OverSpeed(scene);
        let branch = Branch { family: &family, lap: Lap::Symmetric, span: 0.2 * start, go_on: &|| true };
        let mut front = Front::new(Motion { value: start, state: found.start }, branch.span, 1.0);
        let (mut last, _) = tell(&family, branch.lap, &front.last);
        for _ in 0..30 {
            let Ok(Step::Point(found)) = branch.next(&mut front, (start, 1.1 * start)) else { break };
            let (now, _) = tell(&family, branch.lap, &found.motion);
            if growth(&last) * growth(&now) < 0.0 {
                let look = |motion: &Motion| {
                    let (floquet, grows) = tell(&family, branch.lap, motion);
                    Ok((growth(&floquet), (floquet, grows)))
                };
                let ends = [(&front.last, growth(&last)), (&found.motion, growth(&now))];
                let place = branch.crossing(ends[0], ends[1], look);
                if let Ok(Some(SpecialPoint { motion, told: (floquet, grows), .. })) = place
                    && floquet.stability == Stability::Flip
                {
                    flips += 1;
                    doubled += usize::from(doubles(&branch, motion, grows, floquet.passages));
                }
            }
            last = now;
            front.move_to(found.motion);
        }
    }
    assert!(flips > 2 && doubled > 1, "{flips} flips, {doubled} of which with a branch");
}

/// Whether a branch of twice the period leaves from `flip`, rather than the search coming back to the branch that was there.
fn doubles(branch: &Branch<'_>, flip: Motion, grows: Stepped, passages: usize) -> bool {
    let twice = Branch { lap: Lap::Lobes(2 * passages), ..*branch };
    let once = Branch { lap: Lap::Lobes(passages), ..*branch };
    let mut front = Front::aside(flip, grows);
    let mut between = Vec::new();
    for _ in 0..4 {
        let Ok(Step::Point(found)) = twice.next(&mut front, (0.0, f64::INFINITY)) else { return false };
        assert!(found.residual <= FOUND);
        between.push(once.off(&found.motion).unwrap());
        front.move_to(found.motion);
    }
    between[0] > 1e3 * FOUND && between.windows(2).all(|pair| pair[1] > pair[0])
}
