//! Products of mode shapes and modal coordinates: one nodal diameter's part of every row.

use pulp::Simd;

use super::rows::RowBlock;

#[inline(always)]
pub(super) fn project_single<S: Simd>(
    simd: S,
    re: &[S::f64s],
    block: &RowBlock,
    length: usize,
    count: usize,
    out: &mut [f64],
) {
    for (row, out) in out[..count].iter_mut().enumerate() {
        let phi = S::as_simd_f64s(&block.re[row * length..][..length]).0;
        let mut sum = simd.splat_f64s(0.0);
        for (&phi, &re) in phi.iter().zip(re) {
            sum = simd.mul_add_e_f64s(phi, re, sum);
        }
        *out = simd.reduce_sum_f64s(sum);
    }
}

/// Five rows at a time share the loads of z and keep ten sums in flight: what sixteen registers hold.
#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "a kernel's operands")]
pub(super) fn project_pair<S: Simd>(
    simd: S,
    re: &[S::f64s],
    im: &[S::f64s],
    block: &RowBlock,
    length: usize,
    count: usize,
    out_re: &mut [f64],
    out_im: &mut [f64],
) {
    let mut row = 0;
    while row < count {
        match count - row {
            1 => project_rows::<S, 1>(simd, re, im, block, length, row, out_re, out_im),
            2 => project_rows::<S, 2>(simd, re, im, block, length, row, out_re, out_im),
            3 => project_rows::<S, 3>(simd, re, im, block, length, row, out_re, out_im),
            4 => project_rows::<S, 4>(simd, re, im, block, length, row, out_re, out_im),
            _ => project_rows::<S, 5>(simd, re, im, block, length, row, out_re, out_im),
        }
        row += 5;
    }
}

#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "a kernel's operands")]
fn project_rows<S: Simd, const R: usize>(
    simd: S,
    re: &[S::f64s],
    im: &[S::f64s],
    block: &RowBlock,
    length: usize,
    row: usize,
    out_re: &mut [f64],
    out_im: &mut [f64],
) {
    let vectors = re.len();
    let im = &im[..vectors];
    let mut group = [row; R];
    for (r, member) in group.iter_mut().enumerate() {
        *member += r;
    }
    let phi_re = RowBlock::rows::<S, R>(&block.re, group, length, vectors);
    let phi_im = RowBlock::rows::<S, R>(&block.im, group, length, vectors);
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
        out_re[row + r] = simd.reduce_sum_f64s(sum_re[r]);
        out_im[row + r] = simd.reduce_sum_f64s(sum_im[r]);
    }
}
