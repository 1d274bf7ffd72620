//! Products of mode shapes and modal coordinates that every step makes, alone: the fastest this machine has for them in
//! this shape, on whole cache lines.

use std::hint::black_box;

use pulp::{Simd, WithSimd};
use rubmap::dynamics::modal_wheel::ModalWheel;

/// Products done at once.
pub(crate) const REPEATS: usize = 20_000;
/// Rows that share the loads of z, with ten sums in flight.
pub(crate) const GROUP: usize = 5;
/// Doubles of the widest vector; modes are padded to it.
const LANES: usize = 8;

/// Doubles on a boundary of cache lines.
struct Aligned {
    values: Vec<f64>,
    start: usize,
    length: usize,
}

impl Aligned {
    fn new(length: usize, value: impl Fn(usize) -> f64) -> Self {
        let mut values = vec![0.0; length + LANES];
        let start = values.as_ptr().align_offset(64);
        for (index, place) in values[start..start + length].iter_mut().enumerate() {
            *place = value(index);
        }
        Self { values, start, length }
    }

    #[inline(always)]
    fn vectors<S: Simd>(&self) -> &[S::f64s] {
        S::as_simd_f64s(&self.values[self.start..self.start + self.length]).0
    }

    #[inline(always)]
    fn vectors_mut<S: Simd>(&mut self) -> &mut [S::f64s] {
        S::as_mut_simd_f64s(&mut self.values[self.start..self.start + self.length]).0
    }
}

/// Rows and modal coordinates of one nodal diameter: real, or real and imaginary parts.
pub(crate) struct Block {
    phi: Vec<Aligned>,
    z: Vec<Aligned>,
}

/// Work on the blocks that is repeated `REPEATS` times.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Task {
    /// Loads the rows and adds them up.
    Read,
    /// Multiplies rows by coordinates.
    Project,
    /// Adds forces on all rows to the coordinates, then multiplies rows by coordinates.
    BackAndForth,
}

pub(crate) struct Products<'a> {
    pub(crate) task: Task,
    pub(crate) blocks: &'a mut [Block],
    /// Index of the block of each nodal diameter.
    pub(crate) order: &'a [usize],
    pub(crate) rows: usize,
}

impl WithSimd for Products<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let mut out = vec![0.0; 2 * self.rows];
        for _ in 0..REPEATS {
            for &index in self.order {
                let block = black_box(&mut self.blocks[index]);
                match self.task {
                    Task::Read => read(simd, block, &mut out),
                    Task::Project => project(simd, block, self.rows, &mut out),
                    Task::BackAndForth => {
                        push(simd, block, self.rows);
                        project(simd, block, self.rows, &mut out);
                    }
                }
                black_box(&mut out);
            }
        }
    }
}

#[inline(always)]
fn read<S: Simd>(simd: S, block: &Block, out: &mut [f64]) {
    let mut sums = [simd.splat_f64s(0.0); LANES];
    for part in &block.phi {
        for vectors in part.vectors::<S>().chunks_exact(LANES) {
            for (sum, &vector) in sums.iter_mut().zip(vectors) {
                *sum = simd.add_f64s(*sum, vector);
            }
        }
    }
    for (out, sum) in out.iter_mut().zip(sums) {
        *out = simd.reduce_sum_f64s(sum);
    }
}

/// Row `row` of `part` as vectors.
#[inline(always)]
fn row<S: Simd>(part: &Aligned, row: usize, vectors: usize) -> &[S::f64s] {
    &part.vectors::<S>()[row * vectors..][..vectors]
}

#[inline(always)]
fn project<S: Simd>(simd: S, block: &Block, rows: usize, out: &mut [f64]) {
    let re = block.z[0].vectors::<S>();
    let vectors = re.len();
    for first in (0..rows).step_by(GROUP) {
        let mut sum_re = [simd.splat_f64s(0.0); GROUP];
        let mut sum_im = [simd.splat_f64s(0.0); GROUP];
        let mut phi_re: [&[S::f64s]; GROUP] = [&[]; GROUP];
        for (r, phi) in phi_re.iter_mut().enumerate() {
            *phi = row::<S>(&block.phi[0], first + r, vectors);
        }
        if let [_, phi_im_part] = &block.phi[..] {
            let im = &block.z[1].vectors::<S>()[..vectors];
            let mut phi_im: [&[S::f64s]; GROUP] = [&[]; GROUP];
            for (r, phi) in phi_im.iter_mut().enumerate() {
                *phi = row::<S>(phi_im_part, first + r, vectors);
            }
            for m in 0..vectors {
                let (a, b) = (re[m], im[m]);
                for r in 0..GROUP {
                    let (p, q) = (phi_re[r][m], phi_im[r][m]);
                    sum_re[r] = simd.mul_add_e_f64s(p, a, sum_re[r]);
                    sum_re[r] = simd.negate_mul_add_e_f64s(q, b, sum_re[r]);
                    sum_im[r] = simd.mul_add_e_f64s(p, b, sum_im[r]);
                    sum_im[r] = simd.mul_add_e_f64s(q, a, sum_im[r]);
                }
            }
        } else {
            for m in 0..vectors {
                for r in 0..GROUP {
                    sum_re[r] = simd.mul_add_e_f64s(phi_re[r][m], re[m], sum_re[r]);
                }
            }
        }
        for r in 0..GROUP {
            out[first + r] = simd.reduce_sum_f64s(sum_re[r]);
            out[rows + first + r] = simd.reduce_sum_f64s(sum_im[r]);
        }
    }
}

/// Adds φᴴf of forces on all rows to z. The forces are zero, which the compiler cannot know: nothing grows.
#[inline(always)]
fn push<S: Simd>(simd: S, block: &mut Block, rows: usize) {
    let force = black_box(0.0);
    let (force_re, force_im) = ([simd.splat_f64s(force); GROUP], [simd.splat_f64s(-force); GROUP]);
    let Block { phi, z } = block;
    let (re, im) = z.split_at_mut(1);
    let re = re[0].vectors_mut::<S>();
    let vectors = re.len();
    for first in (0..rows).step_by(GROUP) {
        let mut phi_re: [&[S::f64s]; GROUP] = [&[]; GROUP];
        for (r, part) in phi_re.iter_mut().enumerate() {
            *part = row::<S>(&phi[0], first + r, vectors);
        }
        if let ([_, phi_im_part], [im]) = (&phi[..], &mut im[..]) {
            let im = &mut im.vectors_mut::<S>()[..vectors];
            let mut phi_im: [&[S::f64s]; GROUP] = [&[]; GROUP];
            for (r, part) in phi_im.iter_mut().enumerate() {
                *part = row::<S>(phi_im_part, first + r, vectors);
            }
            for m in 0..vectors {
                let (mut a, mut b) = (re[m], im[m]);
                for r in 0..GROUP {
                    let (p, q) = (phi_re[r][m], phi_im[r][m]);
                    a = simd.mul_add_e_f64s(p, force_re[r], a);
                    b = simd.mul_add_e_f64s(p, force_im[r], b);
                    a = simd.mul_add_e_f64s(q, force_im[r], a);
                    b = simd.negate_mul_add_e_f64s(q, force_re[r], b);
                }
                (re[m], im[m]) = (a, b);
            }
        } else {
            for m in 0..vectors {
                let mut a = re[m];
                for r in 0..GROUP {
                    a = simd.mul_add_e_f64s(phi_re[r][m], force_re[r], a);
                }
                re[m] = a;
            }
        }
    }
}

/// Multiply-adds on registers alone: the arithmetic rate that this core has.
pub(crate) struct Registers;

impl WithSimd for Registers {
    type Output = f64;

    /// Runs the multiply-adds; returns the flops done.
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        const CHAINS: usize = 10;
        let (a, b) = (simd.splat_f64s(black_box(0.5)), simd.splat_f64s(black_box(1.0)));
        let mut sums = [b; CHAINS];
        for _ in 0..100 * REPEATS {
            for sum in &mut sums {
                *sum = simd.mul_add_e_f64s(a, *sum, b);
            }
        }
        for sum in sums {
            black_box(simd.reduce_sum_f64s(sum));
        }
        (2 * S::F64_LANES * CHAINS * 100 * REPEATS) as f64
    }
}

/// Flops and bytes of one pass over `order`: the bytes of rows and coordinates, which are read once, as they are padded.
pub(crate) fn count(task: Task, blocks: &[Block], order: &[usize]) -> (f64, f64) {
    let (mut flops, mut bytes) = (0, 0);
    for block in order.iter().map(|&index| &blocks[index]) {
        let rows: usize = block.phi.iter().map(|part| part.length).sum();
        let product = 2 * rows * block.phi.len();
        flops += match task {
            Task::Read => 0,
            Task::Project => product,
            Task::BackAndForth => 2 * product,
        };
        bytes += 8 * rows;
        if task != Task::Read {
            bytes += 8 * block.z.iter().map(|part| part.length).sum::<usize>();
        }
    }
    (flops as f64, bytes as f64)
}

/// Blocks of the wheel's shape with `rows` rows.
pub(crate) fn blocks(wheel: &ModalWheel, rows: usize) -> Vec<Block> {
    let block = |single: bool, modes: usize| {
        let padded = modes.next_multiple_of(LANES);
        let parts = if single { 1 } else { 2 };
        let part = |length: usize, seed: f64| Aligned::new(length, |index| (seed + index as f64).sin());
        Block {
            phi: (0..parts).map(|part_index| part(rows * padded, part_index as f64)).collect(),
            z: (0..parts).map(|part_index| part(padded, part_index as f64)).collect(),
        }
    };
    wheel.harmonics.iter().map(|harmonic| block(harmonic.single, harmonic.omega.len())).collect()
}
