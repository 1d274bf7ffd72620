//! Swing matrix S of a step ([`super::super::super::coriolis`]) in the layout of the oscillators.

use faer::{Mat, c64};
use pulp::Simd;

use super::super::super::coriolis::swing_matrix;
use super::super::super::modal_wheel::{ModalHarmonic, ModalWheel};
use super::super::Oscillators;
use super::super::rows::{Loads, RowBlock, Rows};
use super::super::segment::Segment;

/// Effect of Coriolis forces on the swing of a step.
#[derive(Debug)]
pub(super) struct Turning {
    /// Rows Sᴴ of every nodal diameter, which load its modes with S of a swing.
    swings: Vec<RowBlock>,
    /// Numbers of all rows of the largest nodal diameter.
    all: Vec<usize>,
    /// Rows φ R Sᴴ of the rows that contact loads: they load the modes with S R φᴴ f.
    loads: Option<Rows>,
}

impl Turning {
    /// Effect of Coriolis forces; none without them. Contact forces act along `loaded`.
    pub(super) fn new(
        wheel: &ModalWheel,
        oscillators: &Oscillators,
        step: f64,
        loaded: Option<&Rows>,
    ) -> Option<Self> {
        let of = |(harmonic, segment): (&ModalHarmonic, &Segment)| {
            let g = harmonic.gyroscopic.as_ref()?;
            Some(swing_matrix(g.as_ref(), wheel.speed_rad_s, step, oscillators.receptances(segment)))
        };
        let segments = &oscillators.segments;
        let turned: Vec<Mat<c64>> = wheel.harmonics.iter().zip(segments).map(of).collect::<Option<_>>()?;
        let swings = turned
            .iter()
            .zip(segments)
            .map(|(s, segment)| RowBlock::padded(s.adjoint().to_owned().as_ref(), segment.length));
        let loads = loaded.map(|rows| {
            rows.map(|index, phi| {
                let receptance = oscillators.receptances(&segments[index]);
                let moved =
                    Mat::from_fn(phi.nrows(), receptance.len(), |row, m| phi[(row, m)] * receptance[m]);
                moved * turned[index].adjoint()
            })
        });
        let all = (0..turned.iter().map(Mat::nrows).max().unwrap_or(0)).collect();
        Some(Self { swings: swings.collect(), all, loads })
    }

    /// Turns the swing of nodal diameter `index` by S, into the head of `out`.
    #[inline(always)]
    pub(super) fn turn<S: Simd>(
        &self,
        simd: S,
        index: usize,
        segment: Segment,
        swing: &[f64],
        out: &mut [f64],
    ) {
        let rows = &self.all[..segment.integrated];
        self.swings[index].load(simd, segment, rows, swing, segment.length, out);
    }

    /// Loads with rows that give the modes the displacement by `loads` within a step, under the same forces.
    pub(super) fn moving<'a>(&'a self, loads: Loads<'a>) -> Loads<'a> {
        Loads { rows: self.loads.as_ref().unwrap_or(loads.rows), ..loads }
    }
}
