//! Results at a point of a branch: multipliers and amplitudes.

use super::family::Scenes;
use crate::peak_to_peak::half_peak_to_peak;
use crate::result::{BranchPoint, FloquetMultiplier};
use crate::steady::multiplier;
use faer::c64;
use rubmap_wheel::dynamics::initial::Stepped;
use rubmap_wheel::dynamics::integrate::{Outcome, Passage, Simulation};
use rubmap_wheel::dynamics::steady::branch::correct::Found;
use rubmap_wheel::dynamics::steady::branch::{Branch, Family, Lap, Lost, Motion, Unreachable};
use rubmap_wheel::dynamics::steady::response::MULTIPLIERS;
use rubmap_wheel::dynamics::steady::stability::{Floquet, Stability};
use serde::{Deserialize, Serialize};

/// Half the peak-to-peak displacement of every sensor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Amplitudes {
    /// Amplitudes of the samples, as they are reported everywhere.
    pub(super) sampled: Vec<f64>,
    /// Amplitudes of parabolas through the extreme samples and their neighbours. Along a branch extremes move past samples, and the largest
    /// sample misses them by varying amounts, which would show as false maxima.
    pub(super) smooth: Vec<f64>,
}

/// Result at a point of a branch.
#[derive(Debug, Clone)]
pub(super) struct Told {
    pub(super) stability: Stability,
    pub(super) multipliers: Vec<FloquetMultiplier>,
    /// Sum of the disturbances that grow most or decay slowest: directions of the motion.
    pub(super) disturbances: Stepped,
    /// Disturbance of the leading multiplier alone.
    pub(super) leading: Stepped,
    pub(super) lobe_passages: u32,
    /// Period of the motion, in passages over a lobe, which laps count; `lobe_passages` counts the lobes that pass.
    pub(super) passages: u32,
    pub(super) amplitudes: Amplitudes,
    /// Revolutions that were computed for this result.
    pub(super) revolutions: f64,
}

impl Told {
    /// Growth rate: modulus of the leading multiplier less 1; −1 without multipliers.
    pub(super) fn growth(&self) -> f64 {
        self.multipliers.first().map_or(-1.0, |leading| leading.modulus - 1.0)
    }

    /// Whether the stability is decided.
    pub(super) fn is_decided(&self) -> bool {
        self.stability != Stability::Undecided
    }

    pub(super) fn point(&self, found: &Found, speed_rad_s: f64) -> BranchPoint {
        BranchPoint {
            value: found.motion.value,
            speed_rad_s,
            half_peak_to_peak: self.amplitudes.sampled.clone(),
            stability: self.stability,
            multipliers: self.multipliers.clone(),
            lobe_passages: self.lobe_passages,
            residual: found.residual,
            newton_steps: found.steps as u32,
            revolutions: found.revolutions + self.revolutions,
        }
    }
}

/// Computes multipliers and amplitudes of a response; `hint`: what is likely to grow most.
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
        let floquet = Floquet::of(&passage, &state, &hint, MULTIPLIERS)?;
        let part = |vector: &[c64], of: fn(&c64) -> f64| -> Vec<f64> { vector.iter().map(of).collect() };
        let mut disturbances = vec![0.0; passage.size()];
        for one in &floquet.multipliers {
            for of in [|x: &c64| x.re, |x: &c64| x.im] {
                disturbances.iter_mut().zip(part(&one.vector, of)).for_each(|(sum, x)| *sum += x);
            }
        }
        let leading = floquet.multipliers.first().map_or_else(Vec::new, |one| part(&one.vector, |x| x.re));
        let size = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
        // Scaled to the size of the motion.
        let scale = if leading.is_empty() { 0.0 } else { size(&state) / size(&leading) };
        let leading: Vec<f64> = leading.iter().map(|x| scale * x).collect();
        let amplitudes = amplitudes(&simulation, &passage, &motion.state)?;
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
            amplitudes,
            revolutions: floquet.revolutions + 1.0,
        })
    });
    told.map_err(|reason| Lost::Unreachable(Unreachable(reason.to_string())))?
}

/// Amplitudes of a response.
pub(super) fn amplitudes_of(scenes: &Scenes<'_>, lap: Lap, motion: &Motion) -> Result<Amplitudes, Lost> {
    let found = scenes.simulation(motion.value, 0.0, |simulation, _| {
        amplitudes(&simulation, &lap.passage(&simulation)?, &motion.state)
    });
    found.map_err(|reason| Lost::Unreachable(Unreachable(reason.to_string())))?
}

/// Amplitudes over as many revolutions as show the whole period.
fn amplitudes(
    simulation: &Simulation<'_>,
    passage: &Passage<'_>,
    from: &Stepped,
) -> Result<Amplitudes, Lost> {
    let revolutions = passage.steps().div_ceil(simulation.steps_per_revolution);
    let run = Simulation { revolutions, window_revolutions: 0, ..*simulation }.go_on(from, &|_| true);
    match run.outcome {
        Outcome::Completed(history) => {
            let of =
                |measure: fn(&[f64]) -> f64| history.displacement.iter().map(|line| measure(line)).collect();
            Ok(Amplitudes { sampled: of(half_peak_to_peak), smooth: of(between_samples) })
        }
        _ => Err(Unreachable("the response could not be followed for a revolution".to_owned()).into()),
    }
}

/// Half the difference between the highest and the lowest point of a periodic line, by parabolas through samples.
fn between_samples(line: &[f64]) -> f64 {
    let highest = |sign: f64| {
        let at = (0..line.len()).max_by(|&a, &b| (sign * line[a]).total_cmp(&(sign * line[b]))).unwrap_or(0);
        let of = |i: usize| line.get(i % line.len()).map_or(0.0, |x| sign * x);
        let (before, top, after) = (of(at + line.len() - 1), of(at), of(at + 1));
        let (slope, bend) = (0.5 * (after - before), before - 2.0 * top + after);
        if bend < 0.0 { top - 0.5 * slope * slope / bend } else { top }
    };
    if line.is_empty() { 0.0 } else { 0.5 * (highest(1.0) + highest(-1.0)) }
}

/// State of the scene at `from`, expressed in the modes at `to`.
pub(super) fn carried(scenes: &Scenes<'_>, state: &Stepped, from: f64, to: f64) -> Result<Stepped, Lost> {
    Ok(scenes.carry(state, from, to)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extremes_lie_between_samples() {
        for shift in [0.0, 0.1, 0.37, 0.5] {
            let of = |i: usize| 2.0 + 3.0 * ((i as f64 + shift) * std::f64::consts::TAU / 64.0).cos();
            let line: Vec<f64> = (0..64).map(of).collect();
            assert!((between_samples(&line) - 3.0).abs() < 1e-5, "{shift}");
        }
        assert!(half_peak_to_peak(&[0.0, 1.0, 0.0, -1.0]) == 1.0 && between_samples(&[0.0; 4]) == 0.0);
        assert_eq!((between_samples(&[]), between_samples(&[5.0])), (0.0, 0.0));
    }
}
