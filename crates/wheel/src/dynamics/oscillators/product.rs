//! Products of mode shapes with modal coordinates and with forces, one nodal diameter at a time.
//!
//! R rows at a time share the loads of z and keep 2R sums in flight. Each product is a function of its own for each kind
//! of vectors, compiled once and not once for every loop that needs it.

use pulp::{Simd, WithSimd};

use super::rows::{Loads, RowBlock, Rows};
use super::segment::Segment;

/// Largest number of rows at a time: ten sums and their operands are what sixteen registers hold.
const LARGEST_GROUP: usize = 5;

impl Rows {
    /// Reads the values of the rows by the modes of one nodal diameter, from the state array `z` into its columns of `out[column][row]`.
    #[inline(always)]
    pub(super) fn project<S: Simd>(
        &self,
        simd: S,
        index: usize,
        segment: Segment,
        z: &[f64],
        out: &mut [f64],
    ) {
        let (z, out) = (&z[segment.state..][..segment.size()], &mut out[segment.column * self.stride..]);
        self.blocks[index].project(simd, segment, z, out, self.count, self.stride);
    }
}

impl Loads<'_> {
    /// Writes the modal forces φᴴ f̂ of one nodal diameter into the head of `out`.
    #[inline(always)]
    pub(super) fn modal<S: Simd>(self, simd: S, index: usize, segment: Segment, out: &mut [f64]) {
        let Self { rows, loaded, force } = self;
        let force = &force[segment.column * rows.stride..];
        rows.blocks[index].load(simd, segment, loaded, force, rows.stride, out);
    }
}

impl RowBlock {
    /// Writes φᴴ f of one nodal diameter, f being on the rows in `loaded`: `force[part][row]`, parts `stride` apart. Into the head of
    /// `out`, both parts one after the other.
    #[inline(always)]
    pub(super) fn load<S: Simd>(
        &self,
        simd: S,
        segment: Segment,
        loaded: &[usize],
        force: &[f64],
        stride: usize,
        out: &mut [f64],
    ) {
        let reached = self.re.length.min(segment.length);
        if segment.single {
            let (out, beyond) = out[..segment.length].split_at_mut(reached);
            beyond.fill(0.0);
            simd.vectorize(LoadSingle { block: self, loaded, force, out });
        } else {
            let (force_re, force_im) = force.split_at(stride);
            let (re, im) = out[..segment.size()].split_at_mut(segment.length);
            let ((re, beyond_re), (im, beyond_im)) = (re.split_at_mut(reached), im.split_at_mut(reached));
            beyond_re.fill(0.0);
            beyond_im.fill(0.0);
            simd.vectorize(LoadPair { block: self, loaded, force_re, force_im, re, im });
        }
    }

    /// Writes φ z of one nodal diameter, both parts of z one after the other: `rows` rows of `out[part][row]`, parts `stride` apart.
    #[inline(always)]
    pub(super) fn project<S: Simd>(
        &self,
        simd: S,
        segment: Segment,
        z: &[f64],
        out: &mut [f64],
        rows: usize,
        stride: usize,
    ) {
        let reached = self.re.length.min(segment.length);
        if segment.single {
            simd.vectorize(ProjectSingle { block: self, z: &z[..reached], out: &mut out[..rows] });
        } else {
            let (re, im) = z.split_at(segment.length);
            let (re, im) = (&re[..reached], &im[..reached]);
            let (out_re, out_im) = out.split_at_mut(stride);
            let (out_re, out_im) = (&mut out_re[..rows], &mut out_im[..rows]);
            simd.vectorize(ProjectPair { block: self, re, im, out_re, out_im });
        }
    }
}

/// Product φ z of a single harmonic: `out[row]`.
struct ProjectSingle<'a> {
    block: &'a RowBlock,
    z: &'a [f64],
    out: &'a mut [f64],
}

impl WithSimd for ProjectSingle<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { block, z, out } = self;
        let z = S::as_simd_f64s(z).0;
        for first in (0..out.len()).step_by(LARGEST_GROUP) {
            match out.len() - first {
                1 => single_rows::<S, 1>(simd, block, first, z, out),
                2 => single_rows::<S, 2>(simd, block, first, z, out),
                3 => single_rows::<S, 3>(simd, block, first, z, out),
                4 => single_rows::<S, 4>(simd, block, first, z, out),
                _ => single_rows::<S, LARGEST_GROUP>(simd, block, first, z, out),
            }
        }
    }
}

#[inline(always)]
fn single_rows<S: Simd, const R: usize>(
    simd: S,
    block: &RowBlock,
    first: usize,
    z: &[S::f64s],
    out: &mut [f64],
) {
    let phi = block.re.rows::<S, R>(consecutive(first), z.len());
    let mut sums = [simd.splat_f64s(0.0); R];
    for m in 0..z.len() {
        for r in 0..R {
            sums[r] = simd.mul_add_e_f64s(phi[r][m], z[m], sums[r]);
        }
    }
    for r in 0..R {
        out[first + r] = simd.reduce_sum_f64s(sums[r]);
    }
}

/// Product φ z of a pair, (φ_re + jφ_im)(z_re + jz_im): `out_re[row]`, `out_im[row]`.
struct ProjectPair<'a> {
    block: &'a RowBlock,
    re: &'a [f64],
    im: &'a [f64],
    out_re: &'a mut [f64],
    out_im: &'a mut [f64],
}

impl WithSimd for ProjectPair<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { block, re, im, out_re, out_im } = self;
        let (re, im) = (S::as_simd_f64s(re).0, S::as_simd_f64s(im).0);
        for first in (0..out_re.len()).step_by(LARGEST_GROUP) {
            match out_re.len() - first {
                1 => pair_rows::<S, 1>(simd, block, first, re, im, out_re, out_im),
                2 => pair_rows::<S, 2>(simd, block, first, re, im, out_re, out_im),
                3 => pair_rows::<S, 3>(simd, block, first, re, im, out_re, out_im),
                4 => pair_rows::<S, 4>(simd, block, first, re, im, out_re, out_im),
                _ => pair_rows::<S, LARGEST_GROUP>(simd, block, first, re, im, out_re, out_im),
            }
        }
    }
}

#[inline(always)]
fn pair_rows<S: Simd, const R: usize>(
    simd: S,
    block: &RowBlock,
    first: usize,
    re: &[S::f64s],
    im: &[S::f64s],
    out_re: &mut [f64],
    out_im: &mut [f64],
) {
    let vectors = re.len();
    let im = &im[..vectors];
    let phi_re = block.re.rows::<S, R>(consecutive(first), vectors);
    let phi_im = block.im.rows::<S, R>(consecutive(first), vectors);
    let mut sum_re = [simd.splat_f64s(0.0); R];
    let mut sum_im = [simd.splat_f64s(0.0); R];
    for m in 0..vectors {
        let (a, b) = (re[m], im[m]);
        for r in 0..R {
            let (p, q) = (phi_re[r][m], phi_im[r][m]);
            sum_re[r] = simd.mul_add_e_f64s(p, a, sum_re[r]);
            sum_re[r] = simd.negate_mul_add_e_f64s(q, b, sum_re[r]);
            sum_im[r] = simd.mul_add_e_f64s(p, b, sum_im[r]);
            sum_im[r] = simd.mul_add_e_f64s(q, a, sum_im[r]);
        }
    }
    for r in 0..R {
        out_re[first + r] = simd.reduce_sum_f64s(sum_re[r]);
        out_im[first + r] = simd.reduce_sum_f64s(sum_im[r]);
    }
}

/// Product φᵀ f of the rows in `loaded`, of a single harmonic.
struct LoadSingle<'a> {
    block: &'a RowBlock,
    loaded: &'a [usize],
    force: &'a [f64],
    out: &'a mut [f64],
}

impl WithSimd for LoadSingle<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { block, loaded, force, out } = self;
        let out = S::as_mut_simd_f64s(out).0;
        out.fill(simd.splat_f64s(0.0));
        for group in loaded.chunks(LARGEST_GROUP) {
            match *group {
                [a] => load_single_rows(simd, block, [a], force, out),
                [a, b] => load_single_rows(simd, block, [a, b], force, out),
                [a, b, c] => load_single_rows(simd, block, [a, b, c], force, out),
                [a, b, c, d] => load_single_rows(simd, block, [a, b, c, d], force, out),
                [a, b, c, d, e, ..] => load_single_rows(simd, block, [a, b, c, d, e], force, out),
                [] => {}
            }
        }
    }
}

#[inline(always)]
fn load_single_rows<S: Simd, const R: usize>(
    simd: S,
    block: &RowBlock,
    group: [usize; R],
    force: &[f64],
    out: &mut [S::f64s],
) {
    let phi = block.re.rows::<S, R>(group, out.len());
    let force = gather(simd, force, group);
    for m in 0..out.len() {
        let mut sum = out[m];
        for r in 0..R {
            sum = simd.mul_add_e_f64s(phi[r][m], force[r], sum);
        }
        out[m] = sum;
    }
}

/// Product φᴴ f of the rows in `loaded`, of a pair: (φ_re − jφ_im)(f_re + jf_im).
struct LoadPair<'a> {
    block: &'a RowBlock,
    loaded: &'a [usize],
    force_re: &'a [f64],
    force_im: &'a [f64],
    re: &'a mut [f64],
    im: &'a mut [f64],
}

impl WithSimd for LoadPair<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { block, loaded, force_re, force_im, re, im } = self;
        let (re, im) = (S::as_mut_simd_f64s(re).0, S::as_mut_simd_f64s(im).0);
        re.fill(simd.splat_f64s(0.0));
        im.fill(simd.splat_f64s(0.0));
        for group in loaded.chunks(LARGEST_GROUP) {
            match *group {
                [a] => load_pair_rows(simd, block, [a], force_re, force_im, re, im),
                [a, b] => load_pair_rows(simd, block, [a, b], force_re, force_im, re, im),
                [a, b, c] => load_pair_rows(simd, block, [a, b, c], force_re, force_im, re, im),
                [a, b, c, d] => load_pair_rows(simd, block, [a, b, c, d], force_re, force_im, re, im),
                [a, b, c, d, e, ..] => {
                    load_pair_rows(simd, block, [a, b, c, d, e], force_re, force_im, re, im)
                }
                [] => {}
            }
        }
    }
}

#[inline(always)]
fn load_pair_rows<S: Simd, const R: usize>(
    simd: S,
    block: &RowBlock,
    group: [usize; R],
    force_re: &[f64],
    force_im: &[f64],
    re: &mut [S::f64s],
    im: &mut [S::f64s],
) {
    let vectors = re.len();
    let im = &mut im[..vectors];
    let phi_re = block.re.rows::<S, R>(group, vectors);
    let phi_im = block.im.rows::<S, R>(group, vectors);
    let (force_re, force_im) = (gather(simd, force_re, group), gather(simd, force_im, group));
    for m in 0..vectors {
        // Four chains of R instead of two of 2R.
        let (mut from_re, mut from_im) = (re[m], im[m]);
        let (mut cross_re, mut cross_im) = (simd.splat_f64s(0.0), simd.splat_f64s(0.0));
        for r in 0..R {
            let (p, q) = (phi_re[r][m], phi_im[r][m]);
            from_re = simd.mul_add_e_f64s(p, force_re[r], from_re);
            from_im = simd.mul_add_e_f64s(p, force_im[r], from_im);
            cross_re = simd.mul_add_e_f64s(q, force_im[r], cross_re);
            cross_im = simd.mul_add_e_f64s(q, force_re[r], cross_im);
        }
        re[m] = simd.add_f64s(from_re, cross_re);
        im[m] = simd.sub_f64s(from_im, cross_im);
    }
}

/// Numbers of R rows from `first` on.
#[inline(always)]
fn consecutive<const R: usize>(first: usize) -> [usize; R] {
    let mut rows = [first; R];
    for (r, row) in rows.iter_mut().enumerate() {
        *row += r;
    }
    rows
}

/// Values of `group`, each in every lane. A loop and no closure: a closure would be compiled without the wide vectors.
#[inline(always)]
fn gather<S: Simd, const R: usize>(simd: S, values: &[f64], group: [usize; R]) -> [S::f64s; R] {
    let mut lanes = [simd.splat_f64s(0.0); R];
    for (lane, row) in lanes.iter_mut().zip(group) {
        *lane = simd.splat_f64s(values[row]);
    }
    lanes
}
