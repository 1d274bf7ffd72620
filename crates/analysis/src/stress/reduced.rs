//! Stress at the places of a mesh in the coordinates of a reduction.

use faer::{Mat, c64};
use serde::{Deserialize, Serialize};

use super::measure::Stress;
use super::metric::{Metric, Norm};
use super::places::{Place, places};
use rubmap_solid::mesh::{ElementSet, SectorMesh};
use rubmap_solid::stress::NodalStress;
use rubmap_wheel::dynamics::reduction::{ReducedWheel, StaticSpan};

/// Stress of one sector as a function of the reduced coordinates and of the speed.
#[derive(Debug)]
pub struct ReducedStress {
    pub(super) places: Vec<Place>,
    pub(super) sets: Vec<ElementSet>,
    /// Distance from a contact node within which nodes are left out.
    pub(super) excluded_radius: f64,
    /// Number of nodes of a sector that are left out.
    pub(super) excluded_nodes: u32,
    pub(super) harmonics: Vec<HarmonicStress>,
    pub(super) fixed: StaticStress,
}

/// Stress of one nodal diameter.
#[derive(Debug, Clone)]
pub struct HarmonicStress {
    /// Rows of S̃ = S L⁻ᴴ with S the stress of the basis Υ̂ and K_r(0) = L Lᴴ, so that coordinates are root energies: `2·unknowns ×
    /// 6·places`, a column for each component of each place, with real and imaginary part of every unknown.
    pub(super) rows: Mat<f32>,
    /// Bounds of every place.
    pub(super) norms: Vec<Norm>,
    pub(super) metric: Metric,
}

/// Static solution of the wheel under its centrifugal load.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StaticWheel {
    /// Stress of the solution.
    pub stress: StaticStress,
    /// Displacement of the solutions at the given speeds per unit Ω², `[own DOF][given speed]`.
    pub displacement: Vec<f64>,
}

/// Stress of the wheel under its centrifugal load.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StaticStress {
    /// Stress of the solutions at the given speeds per unit Ω², `[place][component][given speed]`.
    pub stress: Vec<f64>,
    /// Interpolation between the solutions at the given speeds.
    pub span: StaticSpan,
}

impl ReducedStress {
    /// Stress of a mesh at the places that `load` reads: for each nodal diameter the rows of those places (by number, ascending) that are
    /// not within `excluded_radius` of a contact node.
    ///
    /// # Errors
    /// Errors of `load`.
    pub fn load<E>(
        mesh: &SectorMesh,
        operator: &NodalStress,
        reduced: &ReducedWheel,
        excluded_radius: f64,
        fixed: StaticStress,
        mut load: impl FnMut(usize, &[usize]) -> Result<HarmonicStress, E>,
    ) -> Result<Self, E> {
        let contact: Vec<u64> = reduced.contact.iter().map(|node| node.id).collect();
        let all = places(mesh, operator, &contact);
        let kept: Vec<usize> =
            (0..all.len()).filter(|&place| all[place].from_contact > excluded_radius).collect();
        let harmonics =
            reduced.harmonics.iter().map(|h| load(h.harmonic, &kept)).collect::<Result<Vec<_>, E>>()?;
        let width = 6 * fixed.span.speeds_rad_s.len();
        let stress =
            kept.iter().flat_map(|&place| &fixed.stress[width * place..width * (place + 1)]).copied();
        Ok(Self {
            excluded_nodes: (all.len() - kept.len()) as u32,
            places: kept.iter().map(|&place| all[place].clone()).collect(),
            sets: mesh.sets.clone(),
            excluded_radius,
            harmonics,
            fixed: StaticStress { stress: stress.collect(), span: fixed.span.clone() },
        })
    }

    /// Distance from a contact node within which nodes are left out.
    pub fn excluded_radius(&self) -> f64 {
        self.excluded_radius
    }

    /// Number of places with stress.
    pub fn places(&self) -> usize {
        self.places.len()
    }

    /// Memory of the stress, in bytes.
    pub fn bytes(&self) -> u64 {
        let of = |h: &HarmonicStress| {
            size_of::<f32>() * h.rows.nrows() * h.rows.ncols() + size_of::<Norm>() * h.norms.len()
        };
        let harmonics: usize = self.harmonics.iter().map(of).sum();
        (harmonics + size_of::<f64>() * self.fixed.stress.len()) as u64
    }

    /// Stress of the centrifugal load at a speed, at every place.
    pub(super) fn fixed(&self, speed_rad_s: f64, stiffening: bool) -> Vec<Stress> {
        let shares = self.fixed.span.at(speed_rad_s, stiffening);
        let of = |place: &[f64]| -> Stress {
            std::array::from_fn(|component| {
                let from = shares.len() * component;
                shares.iter().zip(&place[from..]).map(|(share, stress)| share * stress).sum()
            })
        };
        self.fixed.stress.chunks_exact(6 * shares.len()).map(of).collect()
    }
}

impl StaticWheel {
    /// Displacement under the centrifugal load at a speed, of every own DOF; the same in every sector.
    pub fn displacement(&self, speed_rad_s: f64, stiffening: bool) -> Vec<f64> {
        let shares = self.stress.span.at(speed_rad_s, stiffening);
        let of = |dof: &[f64]| shares.iter().zip(dof).map(|(share, u)| share * u).sum();
        self.displacement.chunks_exact(shares.len()).map(of).collect()
    }
}

impl HarmonicStress {
    /// Stress of a nodal diameter from its columns, `2·unknowns × 6·places`.
    pub(super) fn new(rows: Mat<f32>) -> Self {
        let metric = Metric::of(&rows);
        let norms = metric.norms(&rows);
        Self { rows, norms, metric }
    }

    /// Stress of a nodal diameter at this number of places, one after the other: `read` gives the numbers of a place in the order of
    /// [`Self::of_place`].
    ///
    /// # Errors
    /// Errors of `read`.
    pub fn gather<E>(
        unknowns: usize,
        places: usize,
        mut read: impl FnMut(usize, &mut [f32]) -> Result<(), E>,
    ) -> Result<Self, E> {
        let mut rows = Mat::<f32>::zeros(2 * unknowns, 6 * places);
        let mut numbers = vec![0.0; 12 * unknowns];
        for place in 0..places {
            read(place, &mut numbers)?;
            for (component, numbers) in numbers.chunks_exact((2 * unknowns).max(1)).enumerate() {
                let column = rows.col_mut(6 * place + component);
                column.iter_mut().zip(numbers).for_each(|(into, number)| *into = *number);
            }
        }
        Ok(Self::new(rows))
    }

    /// Number of places.
    pub fn places(&self) -> usize {
        self.rows.ncols() / 6
    }

    /// Number of unknowns of the reduction.
    pub fn unknowns(&self) -> usize {
        self.rows.nrows() / 2
    }

    /// Numbers of a place: for σ_rr … σ_zr real and imaginary part of every unknown.
    pub fn of_place(&self, place: usize) -> impl Iterator<Item = f32> + use<'_> {
        (6 * place..6 * place + 6).flat_map(|column| self.rows.col(column).iter().copied())
    }

    /// Columns of some places, `2·unknowns × 6·places`.
    pub(super) fn of_places(&self, places: &[usize]) -> Mat<f32> {
        let mut found = Mat::zeros(self.rows.nrows(), 6 * places.len());
        for (at, &place) in places.iter().enumerate() {
            found.subcols_mut(6 * at, 6).copy_from(self.rows.subcols(6 * place, 6));
        }
        found
    }

    /// Rows of a place, `6 × unknowns`.
    pub(super) fn matrix(&self, place: usize) -> Mat<c64> {
        let columns = self.columns(place);
        Mat::from_fn(6, self.rows.nrows() / 2, |component, unknown| {
            let column = columns[component];
            c64::new(f64::from(column[2 * unknown]), f64::from(column[2 * unknown + 1]))
        })
    }

    fn columns(&self, place: usize) -> [&[f32]; 6] {
        std::array::from_fn(|component| {
            self.rows
                .col(6 * place + component)
                .try_as_col_major()
                .map_or(&[][..], |column| column.as_slice())
        })
    }
}
