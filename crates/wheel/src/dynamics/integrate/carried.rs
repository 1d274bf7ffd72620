//! Share of the tips' motion that the coordinates of blades that bend far carry.

use faer::Mat;

use super::super::bending::BladeBending;

/// Sums of squares of the linear motion of all contact nodes: of all of it, and of u − L p, what the coordinates p leave.
///
/// The sums are those over the sectors, for columns in Fourier coordinates are an orthogonal transform of them.
#[derive(Debug)]
pub(super) struct Carried {
    /// Motion L of the contact nodes by the coordinates, `components × coordinates`.
    linear: Mat<f64>,
    all: f64,
    outside: f64,
}

impl Carried {
    pub(super) fn new(blade: &BladeBending) -> Self {
        Self { linear: blade.linear.clone(), all: 0.0, outside: 0.0 }
    }

    /// Adds an instant: linear motion in Fourier coordinates, `[column][component, coordinate]` with `stride` numbers to a column.
    #[inline(always)]
    pub(super) fn look(&mut self, harmonic: &[f64], stride: usize) {
        let (components, coordinates) = self.linear.shape();
        for column in harmonic.chunks_exact(stride) {
            let (motion, p) = column.split_at(components);
            for (component, u) in motion.iter().enumerate() {
                let carried: f64 = (0..coordinates).map(|j| self.linear[(component, j)] * p[j]).sum();
                self.all += u * u;
                self.outside += (u - carried) * (u - carried);
            }
        }
    }

    /// Root mean square of what is left over that of all; 0 where nothing moves.
    pub(super) fn outside(&self) -> f64 {
        if self.all > 0.0 { (self.outside / self.all).sqrt() } else { 0.0 }
    }
}
