//! What is told of a point of a branch.

use super::family::Scenes;
use crate::record::half_peak_to_peak;
use crate::result::{BranchPoint, FloquetMultiplier};
use crate::steady::multiplier;
use faer::c64;
use rubmap_wheel::dynamics::initial::Stepped;
use rubmap_wheel::dynamics::integrate::{Outcome, Passage, Simulation};
use rubmap_wheel::dynamics::steady::branch::correct::Found;
use rubmap_wheel::dynamics::steady::branch::{Branch, Family, Lap, Lost, Motion, Unreachable};
use rubmap_wheel::dynamics::steady::response::MULTIPLIERS;
use rubmap_wheel::dynamics::steady::stability::{Floquet, Stability};

/// What is told of a response.
#[derive(Debug, Clone)]
pub(super) struct Told {
    pub(super) stability: Stability,
    pub(super) multipliers: Vec<FloquetMultiplier>,
    /// What grows most or decays slowest: directions of the motion.
    pub(super) disturbances: Stepped,
    /// The leading one alone.
    pub(super) leading: Stepped,
    pub(super) lobe_passages: u32,
    /// The same in passages over a lobe, of which laps are counted.
    pub(super) passages: u32,
    pub(super) half_peak_to_peak: Vec<f64>,
    /// Revolutions that it took.
    pub(super) revolutions: f64,
}

impl Told {
    /// The modulus of the leading multiplier less 1; negative without any.
    pub(super) fn growth(&self) -> f64 {
        self.multipliers.first().map_or(-1.0, |leading| leading.modulus - 1.0)
    }

    /// Whether it is known to last or not to.
    pub(super) fn is_decided(&self) -> bool {
        self.stability != Stability::Undecided
    }

    pub(super) fn point(&self, found: &Found, speed_rad_s: f64) -> BranchPoint {
        BranchPoint {
            value: found.motion.value,
            speed_rad_s,
            half_peak_to_peak: self.half_peak_to_peak.clone(),
            stability: self.stability,
            multipliers: self.multipliers.clone(),
            lobe_passages: self.lobe_passages,
            residual: found.residual,
            newton_steps: found.steps as u32,
            revolutions: found.revolutions + self.revolutions,
        }
    }
}

/// Tells multipliers and amplitudes of a response; `hint`: what is likely to grow most.
pub(super) fn tell(
    scenes: &Scenes<'_>,
    branch: &Branch<'_>,
    motion: &Motion,
    hint: &Stepped,
) -> Result<Told, Lost> {
    if !(branch.go_on)() {
        return Err(Lost::Cancelled);
    }
    let told = scenes.simulation(motion.value, 0.0, |simulation, _| {
        let mut passage = branch.lap.passage(&simulation)?;
        let (state, hint) = (passage.state_of(&motion.state), passage.state_of(hint));
        let floquet = Floquet::of(&passage, (&state, &hint), MULTIPLIERS)?;
        let part = |vector: &[c64], of: fn(&c64) -> f64| -> Vec<f64> { vector.iter().map(of).collect() };
        let mut disturbances = vec![0.0; passage.size()];
        for one in &floquet.multipliers {
            for of in [|x: &c64| x.re, |x: &c64| x.im] {
                disturbances.iter_mut().zip(part(&one.vector, of)).for_each(|(sum, x)| *sum += x);
            }
        }
        let leading = floquet.multipliers.first().map_or_else(Vec::new, |one| part(&one.vector, |x| x.re));
        let size = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
        // As large as the motion.
        let scale = if leading.is_empty() { 0.0 } else { size(&state) / size(&leading) };
        let leading: Vec<f64> = leading.iter().map(|x| scale * x).collect();
        let half_peak_to_peak = amplitudes(&simulation, &passage, &motion.state)?;
        Ok::<_, Lost>(Told {
            stability: floquet.stability,
            multipliers: floquet
                .multipliers
                .iter()
                .map(|one| multiplier(&floquet, one, &simulation))
                .collect(),
            disturbances: passage.stepped(&disturbances),
            leading: if leading.is_empty() { Stepped::default() } else { passage.stepped(&leading) },
            lobe_passages: floquet.lobes as u32,
            passages: floquet.passages as u32,
            half_peak_to_peak,
            revolutions: floquet.revolutions + 1.0,
        })
    });
    told.map_err(|reason| Lost::Unreachable(Unreachable(reason.to_string())))?
}

/// Half the peak-to-peak displacement of every sensor of a response.
pub(super) fn amplitudes_of(scenes: &Scenes<'_>, lap: Lap, motion: &Motion) -> Result<Vec<f64>, Lost> {
    let found = scenes.simulation(motion.value, 0.0, |simulation, _| {
        amplitudes(&simulation, &lap.passage(&simulation)?, &motion.state)
    });
    found.map_err(|reason| Lost::Unreachable(Unreachable(reason.to_string())))?
}

/// Over as many revolutions as show all of it.
fn amplitudes(simulation: &Simulation<'_>, passage: &Passage<'_>, from: &Stepped) -> Result<Vec<f64>, Lost> {
    let revolutions = passage.steps().div_ceil(simulation.steps_per_revolution);
    let run = Simulation { revolutions, window_revolutions: 0, ..*simulation }.go_on(from, &|_| true);
    match run.outcome {
        Outcome::Completed(history) => {
            Ok(history.displacement.iter().map(|line| half_peak_to_peak(line)).collect())
        }
        _ => Err(Unreachable("the response could not be followed for a revolution".to_owned()).into()),
    }
}

/// A state of the scene at `from` in the modes at `to`.
pub(super) fn carried(scenes: &Scenes<'_>, state: &Stepped, from: f64, to: f64) -> Result<Stepped, Lost> {
    Ok(scenes.carry(state, from, to)?)
}
