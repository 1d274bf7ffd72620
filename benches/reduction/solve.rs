//! Limits of the solves of a search: the factor of a grid of springs, three unknowns a node, as many vectors at a time as searches send
//! through it, beside multiply-adds on registers and reading alone.

use std::hint::black_box;
use std::time::Instant;

use faer::sparse::{SparseColMat, Triplet};
use pulp::{Arch, Simd, WithSimd};
use rubmap::numerics::multifrontal::{Analysis, PartialFactor, postorder};
use rubmap::numerics::nested_dissection::nested_dissection;
use rubmap::numerics::panel::Panel;

/// Nodes along an edge of the grid.
const EDGE: usize = 26;
const WIDTHS: [usize; 6] = [8, 16, 24, 32, 40, 48];
/// Rounds, of which the quickest counts.
const ROUNDS: usize = 5;

/// Matrix of a grid of springs: every node coupled with the 26 around it; positive definite by its diagonal.
fn grid() -> SparseColMat<usize, f64> {
    let nodes = EDGE * EDGE * EDGE;
    let place = |node: usize| [node / (EDGE * EDGE), node / EDGE % EDGE, node % EDGE];
    let mut triplets = Vec::new();
    for a in 0..nodes {
        let near = place(a).map(|x| x.saturating_sub(1)..=(x + 1).min(EDGE - 1));
        let [xs, ys, zs] = near;
        for b in xs.flat_map(|x| ys.clone().map(move |y| (x * EDGE + y) * EDGE)) {
            for b in zs.clone().map(|z| b + z) {
                for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
                    let value = match (a == b, i == j) {
                        (true, true) => 100.0,
                        (true, false) => 0.1,
                        _ => 0.1 * (i + j) as f64 - 0.5,
                    };
                    triplets.push(Triplet::new(3 * a + i, 3 * b + j, value));
                }
            }
        }
    }
    SparseColMat::try_new_from_triplets(3 * nodes, 3 * nodes, &triplets).expect("indices are in range")
}

fn permuted(a: &SparseColMat<usize, f64>, order: &[usize]) -> SparseColMat<usize, f64> {
    let mut place = vec![0; order.len()];
    order.iter().enumerate().for_each(|(new, &old)| place[old] = new);
    let triplets: Vec<_> =
        a.triplet_iter().map(|t| Triplet::new(place[t.row], place[t.col], *t.val)).collect();
    SparseColMat::try_new_from_triplets(order.len(), order.len(), &triplets).expect("indices are in range")
}

/// Multiply-adds on 24 registers, enough to hide their latency.
struct Registers;

impl WithSimd for Registers {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        const TIMES: usize = 5_000_000;
        let [factor, term] = [1.000_000_1, 1e-9].map(|x| simd.splat_f64s(black_box(x)));
        let mut sums = [simd.splat_f64s(1.0); 24];
        let start = Instant::now();
        for _ in 0..TIMES {
            for sum in &mut sums {
                *sum = simd.mul_add_e_f64s(*sum, factor, term);
            }
        }
        let time = start.elapsed().as_secs_f64();
        black_box(sums.map(|sum| simd.reduce_sum_f64s(sum)));
        (TIMES * 24 * 2 * S::F64_LANES) as f64 / time
    }
}

/// Shortest time of `work` in seconds, each time after `before`.
fn quickest<T>(state: &mut T, mut before: impl FnMut(&mut T), mut work: impl FnMut(&mut T)) -> f64 {
    let time = |_| {
        before(state);
        let start = Instant::now();
        work(state);
        start.elapsed().as_secs_f64()
    };
    (0..ROUNDS).map(time).fold(f64::INFINITY, f64::min)
}

pub(crate) fn measure() {
    let a = grid();
    let n = a.ncols();
    let group: Vec<usize> = (0..n).map(|row| row / 3).collect();
    let a = permuted(&a, &nested_dissection(a.symbolic(), &group));
    let a = permuted(&a, &postorder(a.symbolic(), 0..n));
    let analysis = Analysis::new(a.symbolic(), n);
    let start = Instant::now();
    let factor = PartialFactor::new(&analysis, &[(1.0, &a)]).expect("positive definite");
    let factored = start.elapsed().as_secs_f64();
    let peak = Arch::new().dispatch(Registers);
    let mut memory: Vec<f64> = (0..50_000_000).map(f64::from).collect();
    let read = quickest(
        &mut memory,
        |_| {},
        |memory| {
            // There are many sums, or the additions would wait for each other.
            let mut sums = [0.0; 64];
            memory.as_chunks::<64>().0.iter().for_each(|chunk| (0..64).for_each(|i| sums[i] += chunk[i]));
            black_box(sums);
        },
    );
    let entries = analysis.factor_entries() as f64;
    println!("Solves: {n} unknowns, {entries:.2e} numbers in L.\n");
    println!("| what | ms | GFlop/s | GB/s of L |");
    println!("|---|---|---|---|");
    println!("| multiply-adds on registers, one thread | | {:.0} | |", 1e-9 * peak);
    println!("| reading memory, one thread | | | {:.1} |", 8e-9 * memory.len() as f64 / read);
    let threads = rayon::current_num_threads();
    println!(
        "| factorisation, {threads} threads | {:.0} | {:.0} | |",
        1e3 * factored,
        2e-9 * analysis.work() / factored
    );
    for width in WIDTHS {
        let mut x = Panel::zeros(width, n);
        for name in ["forward", "backward"] {
            let solve =
                |x: &mut Panel| if name == "forward" { factor.forward(x) } else { factor.backward(x) };
            let time = quickest(&mut x, |x| (0..n).for_each(|row| x.row_mut(row).fill(1.0)), solve);
            println!(
                "| {name}, {width} vectors | {:.1} | {:.1} | {:.1} |",
                1e3 * time,
                2e-9 * entries * width as f64 / time,
                8e-9 * entries / time
            );
        }
    }
}
