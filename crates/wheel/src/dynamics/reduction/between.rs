//! Frequencies of the full sector between the given speeds, with K(Ω) through them.

use super::convex::Convex;
use super::interpolation::MatrixRatios;
use super::modes::{Modes, Pencil};
use super::options::{ReductionError, Watch};
use super::sector_factor::SectorFactor;
use super::speed::{
    COMPARED, FREQUENCY_TOLERANCE, Factored, FullFrequencies, LARGEST_BLOCK, SpeedPart, Work, frequencies,
    go_on, search,
};
use super::tied_factor::TiedFactor;
use crate::dynamics::centrifugal::stiffness_terms;

/// Ratio ‖Ω1⁴K2‖/‖K0‖ of matrices that are linear in Ω² but for the round-off of twelve written digits.
const EXACTLY_LINEAR: f64 = 1e-11;

impl Work<'_> {
    /// Frequencies at ¼ and ¾ of the last of three given speeds, at which `last` is the factor if it is still there.
    pub(super) fn between(
        &self,
        parts: &[SpeedPart],
        last: Option<Factored<'_>>,
        watch: Watch<'_>,
    ) -> Result<Vec<(f64, FullFrequencies)>, ReductionError> {
        let [_, _, top] = *self.sector.speeds_rad_s else { return Ok(Vec::new()) };
        let speeds = [0.25, 0.75].map(|share| share * top);
        let names = ["between-1", "between-2"];
        let mut found = names.map(|name| self.load(name));
        let linear = MatrixRatios::of(self.sector).is_some_and(|ratios| ratios.quadratic <= EXACTLY_LINEAR);
        // With the largest block no other search follows, and the modes may still lack one.
        let full = |part: usize, h: usize| {
            let part = &parts[part].harmonics[h];
            part.full.as_ref().filter(|_| part.full_block < LARGEST_BLOCK)
        };
        let known: Option<Vec<[&Modes; 3]>> =
            (0..self.harmonics).map(|h| Some([full(0, h)?, full(1, h)?, full(2, h)?])).collect();
        let part = |from: f64, to: f64| move |share: f64, what: &str| watch(from + (to - from) * share, what);
        match known.filter(|_| linear && found.iter().any(Option::is_none)) {
            Some(known) => {
                let last = match last {
                    Some(last) => last,
                    None => self.factored(2, &part(0.0, 0.2))?,
                };
                let by_modes = self.by_modes(&last, &known, speeds, &part(0.2, 0.4))?;
                for ((found, by_modes), name) in found.iter_mut().zip(by_modes).zip(names) {
                    by_modes.iter().for_each(|full| self.save(name, full));
                    *found = by_modes;
                }
            }
            // A search has a factor of its own.
            None => drop(last),
        }
        let blocks = parts.iter().flat_map(|part| &part.harmonics).map(|part| part.full_block);
        let block = blocks.max().unwrap_or(1);
        let mut all = Vec::with_capacity(speeds.len());
        for (index, (found, (name, speed_rad_s))) in
            found.into_iter().zip(names.into_iter().zip(speeds)).enumerate()
        {
            let from = 0.4 + 0.3 * index as f64;
            let full = match found {
                Some(full) => full,
                None => self.searched(name, speed_rad_s, block, &part(from, from + 0.3))?,
            };
            all.push((speed_rad_s, full));
        }
        Ok(all)
    }

    /// Frequencies from the `known` modes of every nodal diameter at the given speeds; nothing for a speed where that proves too little.
    fn by_modes(
        &self,
        last: &Factored<'_>,
        known: &[[&Modes; 3]],
        speeds_rad_s: [f64; 2],
        watch: Watch<'_>,
    ) -> Result<[Option<FullFrequencies>; 2], ReductionError> {
        let at_rest = self.untied.assemble(&[(1.0, &self.sector.stiffness[0])]);
        let convex = Convex {
            untied: self.untied,
            mass: self.mass,
            stiffness: [&at_rest, &last.stiffness],
            factor: &last.factor,
            shares: speeds_rad_s.map(|speed| (speed / self.sector.speeds_rad_s[2]).powi(2)),
        };
        let mut full = [const { Some(Vec::new()) }; 2];
        for (h, (tied, &known)) in last.tied.iter().zip(known).enumerate() {
            let what = format!("full sector between the speeds, nodal diameter {h}");
            go_on(watch, h as f64 / self.harmonics as f64, &what)?;
            let lowest = convex.lowest(tied, known, COMPARED, FREQUENCY_TOLERANCE);
            for (full, lowest) in full.iter_mut().zip(lowest) {
                *full = full.take().zip(lowest).map(|(mut full, lowest)| {
                    full.push(Some(lowest.into_iter().map(f64::sqrt).collect()));
                    full
                });
            }
            if full.iter().all(Option::is_none) {
                break;
            }
        }
        Ok(full)
    }

    /// Frequencies by a factor of their own and a search in blocks of `block`.
    fn searched(
        &self,
        name: &str,
        speed_rad_s: f64,
        block: usize,
        watch: Watch<'_>,
    ) -> Result<FullFrequencies, ReductionError> {
        let phase = |share: f64| go_on(watch, share, &format!("full sector at {speed_rad_s} rad/s"));
        phase(0.0)?;
        let stiffness = self.untied.assemble(&stiffness_terms(self.sector, speed_rad_s));
        let mut full: FullFrequencies = vec![None; self.harmonics];
        let Ok(factor) = SectorFactor::new(self.untied, &stiffness) else { return Ok(full) };
        let tied = self.tie(&factor, &stiffness);
        let free: Vec<&TiedFactor> = tied.iter().flatten().filter(|tied| tied.free.is_ok()).collect();
        let pencil = Pencil { untied: self.untied, stiffness: &stiffness, mass: self.mass, factor: &factor };
        let asked: Vec<_> = free.iter().map(|&tied| (tied, self.wanted_of_full(block, false))).collect();
        let found = search(&pencil, &asked, speed_rad_s, &|done| phase(done).is_ok())?;
        for (tied, modes) in free.iter().zip(&found) {
            full[tied.tie.harmonic] = Some(frequencies(modes));
        }
        self.save(name, &full);
        Ok(full)
    }
}
