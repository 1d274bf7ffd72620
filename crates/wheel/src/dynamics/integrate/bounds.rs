//! Guard against divergence: linear structural theory is void long before a tip moves by a tenth of the wheel's radius.
//!
//! Contact bounds a tip along its normal only, so every component of every contact node is checked. That takes a projection, which the
//! energy spares: with ω²z²(1 − ω²B/4) ≤ 2E of every mode ([`super::super::schemes`]),
//!
//! ```text
//! (dᵀu)² ≤ 2E · Σ_i w_i² Σ_m |dᵀφ_m|² / (ω_m²(1 − ω_m²B_m/4))
//! ```
//!
//! and no tip of a wheel with few sectors is near its bound in a run that is sound. With many sectors the energy of all might be in one
//! tip: then the sum of the amplitudes in all nodal diameters is checked, and tip by tip only what that does not bound.

use std::fmt;

use pulp::Simd;

use super::super::amplitude_sums::amplitude_sums;
use super::super::direction::Direction;
use super::super::oscillators::Oscillators;
use super::super::oscillators::rows::Rows;
use super::residual::ResidualDisplacement;
use super::simulation::Simulation;
use rubmap_numerics::sector_fourier::SectorFourier;

/// Component of a displacement at a contact node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TipComponent {
    /// Component along r.
    Radial,
    /// Component along θ.
    Tangential,
    /// Component along z.
    Axial,
    /// Component along the outward normal.
    Normal,
}

impl fmt::Display for TipComponent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Radial => "radially",
            Self::Tangential => "tangentially",
            Self::Axial => "axially",
            Self::Normal => "along its normal",
        })
    }
}

/// Components of a node, in the order of its rows.
const COMPONENTS: [TipComponent; 4] =
    [TipComponent::Normal, TipComponent::Radial, TipComponent::Tangential, TipComponent::Axial];

/// Displacement of a tip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TipDisplacement {
    /// Size of the displacement, length; not finite if numbers overflowed.
    pub displacement: f64,
    /// Index of the contact node.
    pub contact_node: usize,
    /// Index of the sector.
    pub sector: usize,
    /// Component of the displacement.
    pub component: TipComponent,
}

#[derive(Debug)]
pub(super) struct Bounds {
    reach: f64,
    rows: Rows,
    /// Largest (dᵀu)² per 2E.
    flexibility: f64,
    residual: ResidualDisplacement,
    harmonic: Vec<f64>,
    amplitude_sums: Vec<f64>,
}

impl Bounds {
    pub(super) fn new(simulation: &Simulation<'_>, oscillators: &Oscillators) -> Self {
        let Simulation { wheel, scheme, .. } = *simulation;
        let mut directions = Vec::with_capacity(COMPONENTS.len() * simulation.contact_nodes.len());
        for (node, contact) in simulation.contact_nodes.iter().enumerate() {
            directions.extend(COMPONENTS.map(|component| {
                let components = match component {
                    TipComponent::Normal => contact.normal,
                    TipComponent::Radial => [1.0, 0.0, 0.0],
                    TipComponent::Tangential => [0.0, 1.0, 0.0],
                    TipComponent::Axial => [0.0, 0.0, 1.0],
                };
                Direction { node, components }
            }));
        }
        let rows = Rows::new(wheel, &directions, |modes| scheme.integrated_modes(modes));
        Self {
            reach: simulation.reach(),
            flexibility: flexibility(simulation, oscillators, &directions),
            residual: ResidualDisplacement::new(simulation, &directions),
            harmonic: vec![0.0; wheel.sectors * rows.stride],
            amplitude_sums: vec![0.0; rows.stride],
            rows,
        }
    }

    /// Largest displacement of a tip, if it is beyond the bound or not a number. `force` is that on the contact nodes in Fourier
    /// coordinates, `[column][node]`.
    #[inline(always)]
    pub(super) fn exceeded<S: Simd>(
        &mut self,
        simd: S,
        oscillators: &Oscillators,
        fourier: &SectorFourier,
        energy: f64,
        force: &[f64],
    ) -> Option<TipDisplacement> {
        let elastic = (2.0 * self.flexibility * energy.max(0.0)).sqrt();
        if energy.is_finite() && elastic + self.residual.bound(force) <= self.reach {
            return None;
        }
        oscillators.project(simd, &self.rows, &mut self.harmonic);
        self.residual.add(force, force.len() / fourier.sectors(), &mut self.harmonic, self.rows.stride);
        amplitude_sums(simd, fourier, &self.harmonic, &mut self.amplitude_sums);
        if self.amplitude_sums.iter().all(|&sum| sum <= self.reach) {
            return None;
        }
        let largest = self.largest(fourier);
        (!largest.displacement.is_finite() || largest.displacement > self.reach).then_some(largest)
    }

    /// Largest displacement of a tip; the first that is not a number, if any.
    #[inline(never)]
    fn largest(&self, fourier: &SectorFourier) -> TipDisplacement {
        let stride = self.rows.stride;
        let mut largest =
            TipDisplacement { displacement: 0.0, contact_node: 0, sector: 0, component: COMPONENTS[0] };
        for sector in 0..fourier.sectors() {
            for row in 0..self.rows.count {
                let columns = fourier.row(sector).iter().enumerate();
                let u: f64 = columns.map(|(column, f)| f * self.harmonic[column * stride + row]).sum();
                if u.is_finite() && u.abs() <= largest.displacement {
                    continue;
                }
                let (contact_node, component) = (row / COMPONENTS.len(), COMPONENTS[row % COMPONENTS.len()]);
                largest = TipDisplacement { displacement: u.abs(), contact_node, sector, component };
                if !u.is_finite() {
                    return largest;
                }
            }
        }
        largest
    }
}

/// Largest (dᵀu)² per 2E of any direction; infinite at the limit of stability and beyond.
fn flexibility(simulation: &Simulation<'_>, oscillators: &Oscillators, directions: &[Direction]) -> f64 {
    let Simulation { wheel, scheme, .. } = *simulation;
    let of = |direction: &Direction| -> f64 {
        let harmonics = wheel.harmonics.iter().enumerate().map(|(index, harmonic)| {
            let modes = 0..scheme.integrated_modes(harmonic.omega.len());
            let sum: f64 = modes
                .map(|m| {
                    direction.of(harmonic.contact.as_ref(), m).norm_sqr()
                        * oscillators.largest_square(index, m)
                })
                .sum();
            sum * if harmonic.single { 1.0 } else { 2.0 } / wheel.sectors as f64
        });
        harmonics.sum()
    };
    directions.iter().map(of).fold(0.0, f64::max)
}
