//! Contact results of a run.

use crate::resolved::ResolvedSweep;
use crate::result::{ContactForces, ContactSummary, ForceMap, ForceRow, Point};
use rubmap_wheel::dynamics::integrate::{ContactRecord, PairContact};
use rubmap_wheel::dynamics::modal_wheel::ModalWheel;
use rubmap_wheel::dynamics::sector::Units;
use rubmap_wheel::revision::VERSION;

/// Contact of a run over its window of revolutions, with the data needed to report it.
pub(super) struct ContactOf<'a> {
    pub(super) record: &'a ContactRecord,
    pub(super) wheel: &'a ModalWheel,
    /// Clearance c of every contact node.
    pub(super) clearance: &'a [f64],
    pub(super) window_revolutions: f64,
    pub(super) steps_per_revolution: usize,
    pub(super) samples_per_revolution: usize,
}

impl ContactOf<'_> {
    /// Contact forces of every blade and contact node.
    pub(super) fn forces(&self) -> ContactForces {
        let list = |number: &dyn Fn(usize, &PairContact) -> f64| {
            let blades = self.record.pairs.chunks_exact(self.record.nodes);
            blades.map(|blade| blade.iter().enumerate().map(|(k, pair)| number(k, pair)).collect()).collect()
        };
        let window = self.window_revolutions;
        let steps = window * self.steps_per_revolution as f64;
        let linear = self.record.linear.iter().enumerate();
        ContactForces {
            peak_force: list(&|_, pair| pair.peak_force),
            impulse_per_revolution: list(&|_, pair| pair.impulse / window),
            contact_share: list(&|_, pair| pair.steps as f64 / steps),
            closings_per_revolution: list(&|_, pair| pair.closings as f64 / window),
            clearance_consumption: list(&|node, pair| self.consumption(node, pair.outward)),
            linear_clearance_consumption: linear.map(|(node, &u)| self.consumption(node, u)).collect(),
        }
    }

    /// Share of the clearance of `node` that an outward displacement takes; a node without clearance has used all of it.
    fn consumption(&self, node: usize, outward: f64) -> f64 {
        let clearance = self.clearance[node];
        if clearance > 0.0 { outward.max(0.0) / clearance } else { 1.0 }
    }

    /// Summary of contact.
    pub(super) fn summary(&self, forces: &ContactForces) -> ContactSummary {
        let parts = self.wheel.repeats as f64;
        let revolution_s = std::f64::consts::TAU / self.wheel.speed_rad_s;
        let impulse: f64 = forces.impulse_per_revolution.iter().flatten().sum();
        let peak = largest(&forces.peak_force);
        let consumed = largest(&forces.clearance_consumption);
        let blade = |sums: &[f64]| sums.iter().sum::<f64>();
        let impulses = forces.impulse_per_revolution.iter().map(|blade_of| blade(blade_of)).enumerate();
        let worst = impulses.fold((0, 0.0), |worst, now| if now.1 > worst.1 { now } else { worst });
        let touches = impulse > 0.0;
        ContactSummary {
            mean_force: parts * impulse / revolution_s,
            peak_force: parts * self.record.peak_force,
            peak_node_force: peak.2,
            peak_contact_node: touches.then_some(peak.1),
            peak_sector: touches.then_some(peak.0),
            worst_sector: touches.then_some(worst.0 as u32),
            closings_per_revolution: parts * forces.closings_per_revolution.iter().flatten().sum::<f64>(),
            clearance_consumption: consumed.2,
            clearance_contact_node: consumed.1,
            linear_clearance_consumption: forces
                .linear_clearance_consumption
                .iter()
                .copied()
                .reduce(f64::max),
            samples_per_revolution: self.samples_per_revolution as u32,
        }
    }
}

/// Row of a [`ForceMap`] for a completed speed with contact: the worst blade of every contact node.
pub fn force_row(point: &Point, forces: &ContactForces) -> Option<ForceRow> {
    let summary = point.contact.as_ref()?;
    let nodes = forces.peak_force.first().map_or(0, Vec::len);
    let most = |of: &[Vec<f64>]| -> Vec<f64> {
        (0..nodes).map(|node| of.iter().fold(0.0, |most, blade| f64::max(most, blade[node]))).collect()
    };
    let worst = |node: usize| {
        let impulse = |sector: &usize| forces.impulse_per_revolution[*sector][node];
        let sectors = 0..forces.impulse_per_revolution.len();
        let worst = sectors.rev().max_by(|a, b| impulse(a).total_cmp(&impulse(b)));
        worst.filter(|sector| impulse(sector) > 0.0).map(|sector| sector as u32)
    };
    Some(ForceRow {
        summary: summary.clone(),
        peak_force: most(&forces.peak_force),
        impulse_per_revolution: most(&forces.impulse_per_revolution),
        worst_sector: (0..nodes).map(worst).collect(),
        contact_share: most(&forces.contact_share),
        closings_per_revolution: most(&forces.closings_per_revolution),
        clearance_consumption: most(&forces.clearance_consumption),
        linear_clearance_consumption: forces.linear_clearance_consumption.clone(),
    })
}

/// Force map of a sweep, from `rows` by index of their speed.
pub fn force_map(
    request: &ResolvedSweep,
    units: &Units,
    rows: impl IntoIterator<Item = (u32, ForceRow)>,
) -> ForceMap {
    let speeds = request.speeds.rad_s();
    let mut map = ForceMap {
        speeds_rad_s: speeds.to_vec(),
        rows: vec![None; speeds.len()],
        units: units.clone(),
        settings: request.clone().into(),
        version: VERSION.to_owned(),
    };
    for (index, row) in rows {
        // Speeds that a refinement has added since the request was read wait for the next reader.
        if let Some(place) = map.rows.get_mut(index as usize) {
            *place = Some(row);
        }
    }
    map
}

/// Sector and contact node of the largest number, the first of equal ones, and the number itself.
fn largest(of: &[Vec<f64>]) -> (u32, u32, f64) {
    let mut best = (0, 0, 0.0);
    for (sector, blade) in (0..).zip(of) {
        for (node, &value) in (0..).zip(blade) {
            if value > best.2 {
                best = (sector, node, value);
            }
        }
    }
    best
}
