//! Field of the wheel: displacement and stress of every node, over one or more frames.

use std::f64::consts::TAU;

use faer::{Mat, MatRef, c64};
use nalgebra::Vector3;

use super::error::FieldError;
use super::sector::FieldSector;
use super::tensor::{components, matrix};

/// Product Υ̂_i X of the basis of nodal diameter i: from `unknowns × columns` to `own DOF × columns`.
pub type BasisProduct<'a> = &'a mut dyn FnMut(usize, MatRef<'_, c64>) -> std::io::Result<Mat<c64>>;

/// Instant of a field.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// Time of the frame: revolutions since the start, or the part of a period.
    pub time: f64,
    /// Columns of the field, each with its weight.
    pub weights: Vec<(usize, c64)>,
    /// Weights a quarter of a period earlier, for a periodic field: the imaginary part of its complex amplitude.
    pub before: Vec<(usize, c64)>,
}

/// A field of the wheel.
#[derive(Debug)]
pub struct Field {
    /// Title of the field.
    pub title: String,
    /// Lines below the title.
    pub subtitles: Vec<String>,
    /// Frames of the field.
    pub frames: Vec<Frame>,
    harmonics: Vec<HarmonicField>,
    /// Static part, added to every sum of columns.
    fixed: Option<HarmonicField>,
}

/// Part of a field in one nodal diameter.
#[derive(Debug)]
struct HarmonicField {
    harmonic: usize,
    /// Displacement (r, θ, z), `3·nodes × columns`.
    displacement: Mat<c64>,
    /// Stress σ_rr, σ_θθ, σ_zz, σ_rθ, σ_θz, σ_zr, `6·nodes × columns`.
    stress: Option<Mat<c64>>,
}

impl Field {
    /// Field of columns in the coordinates of the reduction, by nodal diameter.
    ///
    /// # Errors
    /// Errors of reading the basis.
    pub(super) fn new(
        sector: &FieldSector,
        columns: &[(usize, Mat<c64>)],
        frames: Vec<Frame>,
        basis: BasisProduct<'_>,
    ) -> Result<Self, FieldError> {
        let mut harmonics = Vec::with_capacity(columns.len());
        for (harmonic, columns) in columns {
            let displacement = sector.at_nodes(*harmonic, basis(*harmonic, columns.as_ref())?.as_ref());
            let stress = sector.stress(*harmonic, displacement.as_ref());
            harmonics.push(HarmonicField { harmonic: *harmonic, displacement, stress });
        }
        Ok(Self { title: String::new(), subtitles: Vec::new(), frames, harmonics, fixed: None })
    }

    /// Field without displacement: the mesh alone.
    pub fn of_mesh(title: String) -> Self {
        let still = Frame { time: 0.0, weights: Vec::new(), before: Vec::new() };
        Self { title, subtitles: Vec::new(), frames: vec![still], harmonics: Vec::new(), fixed: None }
    }

    /// Adds a displacement of the own DOF that is the same in every sector and frame, that of the centrifugal load, if it is given; a
    /// subtitle says whether.
    #[must_use]
    pub fn upon(mut self, sector: &FieldSector, own: Option<&[f64]>) -> Self {
        let what = if sector.has_stress() { "displacement and stress" } else { "displacement" };
        let Some(own) = own else {
            self.subtitles.push(format!(
                "{what} of the vibration alone, without the static part of the centrifugal load"
            ));
            return self;
        };
        let own = Mat::from_fn(own.len(), 1, |dof, _| c64::new(own[dof], 0.0));
        let displacement = sector.at_nodes(0, own.as_ref());
        let stress = sector.stress(0, displacement.as_ref());
        self.fixed = Some(HarmonicField { harmonic: 0, displacement, stress });
        self.subtitles.push(format!("{what} of the vibration and of the centrifugal load together"));
        self
    }

    /// Adds the rotational speed to the title.
    #[must_use]
    pub fn at_speed(mut self, rad_s: f64) -> Self {
        self.title += &format!(", {:.0} rpm ({rad_s:.1} rad/s)", 60.0 * rad_s / TAU);
        self
    }

    /// Whether the field has displacements; that of a mesh alone has none.
    pub fn has_displacement(&self) -> bool {
        !self.harmonics.is_empty() || self.has_static()
    }

    /// Whether the field has a static part, the sum of no columns.
    pub fn has_static(&self) -> bool {
        self.fixed.is_some()
    }

    /// Sets title and subtitles.
    pub(super) fn titled(self, title: String, subtitles: Vec<String>) -> Self {
        Self { title, subtitles, ..self }
    }

    /// Displacement of nodes of a sector in the user's coordinates, for the weights of a frame.
    pub fn displacement(
        &self,
        of: &FieldSector,
        sector: usize,
        places: &[u32],
        weights: &[(usize, c64)],
    ) -> Vec<[f64; 3]> {
        let turned = |place, local| of.directions(sector, place).tr_mul(&Vector3::<f64>::from(local)).into();
        self.moved((of, sector), places, weights, turned)
    }

    /// Displacement of nodes of a sector in coordinates whose z is the axis, for drawings.
    pub(super) fn about_axis(
        &self,
        of: &FieldSector,
        sector: usize,
        places: &[u32],
        weights: &[(usize, c64)],
    ) -> Vec<[f64; 3]> {
        let turned = |place: u32, [r, t, z]: [f64; 3]| {
            let (sin, cos) = (of.nodes()[place as usize].coordinates[1] + of.turn(sector)).sin_cos();
            [r * cos - t * sin, r * sin + t * cos, z]
        };
        self.moved((of, sector), places, weights, turned)
    }

    /// Displacement of nodes, turned from (r, θ, z) by `turned`.
    fn moved(
        &self,
        (of, sector): (&FieldSector, usize),
        places: &[u32],
        weights: &[(usize, c64)],
        turned: impl Fn(u32, [f64; 3]) -> [f64; 3],
    ) -> Vec<[f64; 3]> {
        let local = self.sum::<3>(of, sector, places, weights, |harmonic| Some(&harmonic.displacement));
        places.iter().zip(local).map(|(&place, local)| turned(place, local)).collect()
    }

    /// Stress of nodes of a sector in the user's coordinates, σ_xx, σ_yy, σ_zz, σ_xy, σ_yz, σ_zx; NaN at nodes without stress, none where
    /// the field has no stress.
    pub fn stress(
        &self,
        of: &FieldSector,
        sector: usize,
        places: &[u32],
        weights: &[(usize, c64)],
    ) -> Option<Vec<[f64; 6]>> {
        let has = of.has_stress();
        let local =
            has.then(|| self.sum::<6>(of, sector, places, weights, |harmonic| harmonic.stress.as_ref()))?;
        let turned = |(&place, local): (&u32, [f64; 6])| {
            let directions = of.directions(sector, place);
            components(&(directions.transpose() * matrix(local) * directions))
        };
        Some(places.iter().zip(local).map(turned).collect())
    }

    /// Largest displacement of any node and sector over a whole period of the first frame.
    pub(super) fn largest_amplitude(&self, of: &FieldSector) -> f64 {
        let Some(frame) = self.frames.first() else { return 0.0 };
        let places: Vec<u32> = (0..of.nodes().len() as u32).collect();
        let of_sector = |sector| {
            let amplitudes = self.amplitude(of, sector, &places, frame);
            amplitudes.into_iter().fold(0.0f64, f64::max)
        };
        (0..of.sectors()).map(of_sector).fold(0.0, f64::max)
    }

    /// Largest displacement of each node over a period: the longer half axis of its ellipse.
    pub fn amplitude(&self, of: &FieldSector, sector: usize, places: &[u32], frame: &Frame) -> Vec<f64> {
        let real = self.displacement(of, sector, places, &frame.weights);
        let imaginary = self.displacement(of, sector, places, &frame.before);
        let longer = |(a, b): ([f64; 3], [f64; 3])| {
            let dot = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            let (aa, bb, ab) = (dot(a, a), dot(b, b), dot(a, b));
            (0.5 * (aa + bb) + 0.5 * (aa - bb).hypot(2.0 * ab)).sqrt()
        };
        real.into_iter().zip(imaginary).map(longer).collect()
    }

    /// Multiplies all columns of all nodal diameters by a number.
    pub(super) fn scale(&mut self, factor: f64) {
        let factor = c64::new(factor, 0.0);
        for harmonic in &mut self.harmonics {
            harmonic.displacement *= faer::Scale(factor);
            if let Some(stress) = &mut harmonic.stress {
                *stress *= faer::Scale(factor);
            }
        }
    }

    /// Sum Re Σ_i e^{jisα} Σ_c a_c column_c plus the static part, K components a node.
    fn sum<const K: usize>(
        &self,
        of: &FieldSector,
        sector: usize,
        places: &[u32],
        weights: &[(usize, c64)],
        values: impl Fn(&HarmonicField) -> Option<&Mat<c64>>,
    ) -> Vec<[f64; K]> {
        let mut sums = vec![[0.0; K]; places.len()];
        let one = [(0, c64::new(1.0, 0.0))];
        let moving = self.harmonics.iter().map(|harmonic| (harmonic, weights));
        for (harmonic, weights) in moving.chain(self.fixed.iter().map(|fixed| (fixed, &one[..]))) {
            let Some(values) = values(harmonic) else { continue };
            let turn = of.phase(harmonic.harmonic * sector % of.sectors());
            for &(column, weight) in weights {
                let factor = turn * weight;
                let column = values.col(column);
                for (sum, &place) in sums.iter_mut().zip(places) {
                    for (component, sum) in sum.iter_mut().enumerate() {
                        let value = column[K * place as usize + component];
                        *sum += factor.re * value.re - factor.im * value.im;
                    }
                }
            }
        }
        sums
    }
}
