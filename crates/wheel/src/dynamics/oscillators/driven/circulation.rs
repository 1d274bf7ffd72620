//! Euler force on the vibration ([`super::super::super::euler`]), a circulatory force, in the layout of the oscillators.

use faer::{Mat, c64};
use pulp::Simd;

use super::super::super::euler::SpeedRate;
use super::super::super::modal_wheel::{ModalHarmonic, ModalWheel};
use super::super::rows::RowBlock;
use super::super::segment::Segment;
use rubmap_numerics::aligned::Aligned;

/// Circulatory force −½Ω̇ g z of every nodal diameter.
#[derive(Debug)]
pub(super) struct Circulation {
    rate: SpeedRate,
    /// Rows ½g = (−½g)ᴴ of every nodal diameter, which load its modes with −½ g of a displacement.
    rows: Vec<RowBlock>,
    /// Numbers of all rows of the largest nodal diameter.
    all: Vec<usize>,
    /// Product −½ g z of the nodal diameter under way.
    pushed: Aligned,
}

impl Circulation {
    /// Circulatory force of `rate`; none without gyroscopic matrices.
    pub(super) fn new(rate: &SpeedRate, wheel: &ModalWheel, segments: &[Segment]) -> Option<Self> {
        let of = |(harmonic, segment): (&ModalHarmonic, &Segment)| {
            let g = harmonic.gyroscopic.as_ref()?;
            let half =
                Mat::from_fn(segment.integrated, segment.integrated, |i, j| g[(i, j)] * c64::from(0.5));
            Some(RowBlock::padded(half.as_ref(), segment.length))
        };
        let rows = wheel.harmonics.iter().zip(segments).map(of).collect::<Option<_>>()?;
        let longest = segments.iter().map(|segment| segment.length).max().unwrap_or(0);
        Some(Self {
            rate: rate.clone(),
            rows,
            all: (0..longest).collect(),
            pushed: Aligned::zeros(2 * longest),
        })
    }

    /// Adds the force on the displacements `z` of nodal diameter `index`, `revolutions` after the start, to its `forces`.
    #[inline(always)]
    pub(super) fn push<S: Simd>(
        &mut self,
        simd: S,
        index: usize,
        segment: Segment,
        revolutions: f64,
        z: &[f64],
        forces: &mut [f64],
    ) {
        let Self { rate, rows, all, pushed } = self;
        rows[index].load(simd, segment, &all[..segment.integrated], z, segment.length, pushed);
        let rate = simd.splat_f64s(rate.at(revolutions));
        let (forces, pushed) = (S::as_mut_simd_f64s(forces).0, S::as_simd_f64s(pushed).0);
        for (force, pushed) in forces.iter_mut().zip(pushed) {
            *force = simd.mul_add_e_f64s(rate, *pushed, *force);
        }
    }
}
