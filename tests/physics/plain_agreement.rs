//! Production reduction (one real factor a speed, all nodal diameters together) against the plain one (a complex
//! factorisation and a dense eigensolver for each).
//!
//! Both modal bases are mass-orthonormal, so they differ by a unitary matrix: the contact blocks, the products
//! Y_bm Y_mb and the spectra must be equal.

use std::collections::BTreeMap;
use std::sync::Mutex;

use faer::sparse::{SparseColMat, Triplet};
use faer::{Mat, c64};
use rubmap::dynamics::reduction::{
    BasisRows, Checkpoints, Completeness, NoCheckpoints, ReducedWheel, ReductionOptions, reduce,
};
use rubmap::dynamics::sector::{CyclicMatrix, SectorModel};
use rubmap::numerics::dense::Dense;
use rubmap::package::{raw::RawPackage, to_sector};

use crate::fixtures::{TOP_SPEED, WheelRecipe, small_impeller, wheel};
use crate::oracle::plain::{self, Solver};

fn close(found: &Mat<c64>, expected: &Mat<c64>, tolerance: f64, what: &str) {
    let error = (found - expected).norm_max() / expected.norm_max().max(f64::MIN_POSITIVE);
    assert!(error < tolerance, "{what}: {error:.1e}");
}

/// Parts that both reductions have in common: contact block and Y_bm Y_mb.
fn parts(y: &Mat<c64>, n_b: usize) -> [Mat<c64>; 2] {
    let coupling = y.submatrix(0, n_b, n_b, y.ncols() - n_b);
    [y.submatrix(0, 0, n_b, n_b).to_owned(), coupling * coupling.adjoint()]
}

/// Tolerance: the joint basis keeps directions with singular values down to 1e-5, in which errors of the modes are 1e5 times as large.
/// (4 sectors of 12 nodes: 1.0e-8 on one machine, less on others.)
const MAGNIFIED: f64 = 1e-7;

fn agree(sector: &SectorModel, modes: usize, solver: Solver, name: &str) -> ReducedWheel {
    let options = ReductionOptions::new(modes);
    let reduced = reduce(sector, &options, &NoCheckpoints, &|_, _| true).unwrap();
    let n_b = reduced.contact_dofs();
    for (harmonic, fast) in reduced.harmonics.iter().enumerate() {
        let name = format!("{name}, nodal diameter {harmonic}");
        let plain = plain::reduce(sector, harmonic, modes, options.basis_tolerance, solver);
        assert_eq!(fast.mass.nrows(), plain.mass.nrows(), "{name}");
        for (part, [found, expected]) in ["contact mass", "mass coupling"]
            .iter()
            .zip(transpose(parts(&fast.mass, n_b), parts(&plain.mass, n_b)))
        {
            close(&found, &expected, MAGNIFIED, &format!("{name}, {part}"));
        }
        for (index, (&speed, expected)) in sector.speeds_rad_s.iter().zip(&plain.stiffness).enumerate() {
            let found = fast.stiffness.at(speed, true);
            let pairs = transpose(parts(&found, n_b), parts(expected, n_b));
            for (part, [found, expected]) in ["contact stiffness", "stiffness coupling"].iter().zip(pairs) {
                // At rest the static modes leave the coupling zero but for round-off, so it is compared at speed.
                if index > 0 || *part == "contact stiffness" {
                    close(&found, &expected, MAGNIFIED, &format!("{name}, {part} at {speed}"));
                }
            }
            let [found, expected] = [(&found, &fast.mass), (expected, &plain.mass)]
                .map(|(k, m)| Dense::generalised_eigenvalues(k.as_ref(), m.as_ref()).unwrap());
            for (a, b) in found.iter().zip(&expected).take(n_b + modes) {
                assert!((a / b - 1.0).abs() < 1e-7, "{name} at {speed}: {a} {b}");
            }
            let certificate = &fast.certificates[index];
            for (a, b) in certificate.eigenvalues.iter().zip(&plain.eigenvalues[index]) {
                assert!((a / b - 1.0).abs() < 1e-9, "{name} at {speed}: {a} {b}");
            }
            assert_eq!(certificate.eigenvalues.len(), plain.eigenvalues[index].len());
            assert!(certificate.residuals.iter().all(|&residual| residual < 1e-9));
            match certificate.completeness {
                Completeness::Whole => assert_eq!(certificate.eigenvalues.len(), sector.own_dofs() - n_b),
                Completeness::Counted(count) => {
                    assert!(count.below >= modes && count.shift > certificate.eigenvalues[modes - 1]);
                }
                Completeness::Unproven => panic!("{name}"),
            }
        }
    }
    reduced
}

fn transpose<T>(a: [T; 2], b: [T; 2]) -> [[T; 2]; 2] {
    let ([a0, a1], [b0, b1]) = (a, b);
    [[a0, b0], [a1, b1]]
}

/// Wheels of point masses: every nodal diameter of odd and even wheels, one sector closed on itself among them; small
/// spaces (solved densely) and larger ones (Lanczos).
#[test]
fn point_mass_wheels() {
    for (sectors, nodes) in [(1, 90), (2, 90), (3, 90), (4, 12), (7, 90), (10, 12)] {
        let sector = wheel(WheelRecipe { sectors, nodes, seed: sectors as u64, ..Default::default() });
        agree(&sector, 6, Solver::Dense, &format!("{sectors} sectors of {nodes} nodes"));
    }
}

/// Package with the high face's own block added onto the low face, as other exporters have it.
fn assembled(mut package: RawPackage) -> RawPackage {
    let high_of: std::collections::HashMap<u64, u64> =
        package.manifest.cyclic.iter().map(|&[low, high]| (high, low)).collect();
    let row_of: std::collections::HashMap<(u64, u8), u32> =
        package.dofs.iter().enumerate().map(|(row, dof)| ((dof.node, dof.component), row as u32)).collect();
    let low: Vec<Option<u32>> = package
        .dofs
        .iter()
        .map(|dof| high_of.get(&dof.node).map(|&low| row_of[&(low, dof.component)]))
        .collect();
    for matrix in std::iter::once(&mut package.mass).chain(&mut package.stiffness) {
        let mut entries = std::collections::BTreeMap::new();
        for &(row, column, value) in &matrix.entries {
            let (row, column) = match (low[row as usize], low[column as usize]) {
                (Some(a), Some(b)) => (a.max(b), a.min(b)),
                _ => (row, column),
            };
            *entries.entry((column, row)).or_insert(0.0) += value;
        }
        matrix.entries = entries.into_iter().map(|((column, row), value)| (row, column, value)).collect();
    }
    package
}

/// Finite-element sector, both ways its high face may be exported: the same reduced wheel as the plain way makes.
#[test]
fn impellers_assembled_or_not() {
    for sectors in [5, 6] {
        let package = small_impeller(sectors);
        let not = agree(&to_sector(package.clone()).unwrap(), 8, Solver::Dense, "unassembled");
        let done = agree(&to_sector(assembled(package)).unwrap(), 8, Solver::Dense, "assembled");
        for (a, b) in not.harmonics.iter().zip(&done.harmonics) {
            close(&a.stiffness.at(0.0, true), &b.stiffness.at(0.0, true), 1e-9, "both");
        }
    }
}

/// Sector with `copies` more nodes that hang on the ground alone, by the same three springs each.
fn with_pendants(sector: &SectorModel, copies: usize, squares: [f64; 3]) -> SectorModel {
    let mut sector = sector.clone().into_parts();
    let own = sector.own_dofs();
    let nodes = own / 3;
    let size = own + 3 * copies;
    let extend = |matrix: &CyclicMatrix, diagonal: &dyn Fn(usize) -> f64| {
        let mut entries: Vec<_> =
            matrix.own.triplet_iter().map(|t| Triplet::new(t.row, t.col, *t.val)).collect();
        entries.extend((own..size).map(|dof| Triplet::new(dof, dof, diagonal(dof % 3))));
        let next: Vec<_> = matrix.next.triplet_iter().map(|t| Triplet::new(t.row, t.col, *t.val)).collect();
        CyclicMatrix {
            own: SparseColMat::try_new_from_triplets(size, size, &entries).unwrap(),
            next: SparseColMat::try_new_from_triplets(size, size, &next).unwrap(),
        }
    };
    sector.mass = extend(&sector.mass, &|_| 1e-5);
    sector.stiffness = sector.stiffness.iter().map(|k| extend(k, &|d| 1e-5 * squares[d])).collect();
    sector.node_of_dof.extend((0..3 * copies).map(|dof| nodes + dof / 3));
    SectorModel::new(sector).unwrap()
}

/// Multiple eigenvalue: eight modes of one frequency in every nodal diameter, more than a block holds. The count
/// notices what the first search leaves out, and the next one finds it; also where the eight straddle the last mode
/// asked for.
#[test]
fn no_copy_of_a_multiple_eigenvalue_is_missed() {
    let plain = wheel(WheelRecipe { sectors: 4, nodes: 90, stiffening: false, ..Default::default() });
    let low = 0.01 * TOP_SPEED * TOP_SPEED;
    let sector = with_pendants(&plain, 8, [low, 1.5 * low, 1e3 * low]);
    for modes in [5, 8, 12, 20] {
        let reduced = reduce(&sector, &ReductionOptions::new(modes), &NoCheckpoints, &|_, _| true).unwrap();
        for harmonic in &reduced.harmonics {
            let certificate = &harmonic.certificates[0];
            for (m, value) in certificate.eigenvalues.iter().take(16).enumerate() {
                let expected = if m < 8 { low } else { 1.5 * low };
                assert!((value / expected - 1.0).abs() < 1e-9, "{modes} modes: {value}, mode {m}");
            }
            assert!(matches!(certificate.completeness, Completeness::Counted(_)), "{modes} modes");
        }
        for comparison in &reduced.comparison {
            for (m, omega) in comparison.full.iter().enumerate() {
                let expected = if m < 8 { low } else { 1.5 * low };
                assert!((omega * omega / expected - 1.0).abs() < 1e-8, "{modes} modes: {comparison:?}");
            }
        }
    }
}

/// Threads change nothing: every bit of a reduction is the same on any number of them.
#[test]
fn threads_change_nothing() {
    let sector = to_sector(small_impeller(5)).unwrap();
    let bytes = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let reduced = pool
            .install(|| reduce(&sector, &ReductionOptions::new(8), &NoCheckpoints, &|_, _| true).unwrap());
        serde_json::to_string(&reduced).unwrap()
    };
    assert!(bytes(1) == bytes(3));
}

/// Checkpoints that keep parts in memory.
struct Kept(Mutex<BTreeMap<String, Vec<u8>>>);

impl Checkpoints for Kept {
    fn load(&self, part: &str) -> Option<Vec<u8>> {
        self.0.lock().unwrap().get(part).cloned()
    }

    fn save(&self, part: &str, bytes: Vec<u8>) {
        self.0.lock().unwrap().insert(part.into(), bytes);
    }

    fn keep_basis(&self, _rows: &BasisRows<'_>) {}
}

/// Lost part: a reduction that goes on with all parts but one, whichever it is, or without those of a kind, ends with the same bytes.
#[test]
fn a_lost_part_changes_nothing() {
    let sector = to_sector(small_impeller(5)).unwrap();
    let bytes = |kept: &Kept| {
        let reduced = reduce(&sector, &ReductionOptions::new(8), kept, &|_, _| true).unwrap();
        serde_json::to_string(&reduced).unwrap()
    };
    let kept = Kept(Mutex::default());
    let undisturbed = bytes(&kept);
    let parts = kept.0.into_inner().unwrap();
    // Three nodal diameters and a summary at three speeds, and two speeds between them.
    assert_eq!(parts.len(), 3 * 4 + 2);
    let goes_on = |is_lost: &dyn Fn(&str) -> bool, what: &str| {
        let left = parts.iter().filter(|(name, _)| !is_lost(name));
        let kept = Kept(Mutex::new(left.map(|(name, bytes)| (name.clone(), bytes.clone())).collect()));
        assert!(bytes(&kept) == undisturbed, "without {what}");
    };
    for lost in parts.keys() {
        goes_on(&|name| name == lost, lost);
    }
    for kind in ["harmonic-1", "between", "speed-2"] {
        goes_on(&|name| name.contains(kind), kind);
    }
}

/// Baseline of the benchmark: it computes what it is compared with.
#[test]
fn the_benchmark_baseline_agrees() {
    agree(&to_sector(small_impeller(4)).unwrap(), 8, Solver::Lanczos, "single-vector Lanczos");
}

/// Compared frequencies: ten of the reduced wheel are those of the full sector within what truncation explains, from above, at
/// the given speeds and between them; the full ones are the assembled matrices' own. Between the speeds they need no factor where
/// K is linear in Ω², whichever the speeds are.
#[test]
fn compared_frequencies_are_the_full_sectors() {
    for sectors in [1, 2, 5] {
        let mut parts = wheel(WheelRecipe { sectors, nodes: 90, ..Default::default() }).into_parts();
        frequencies_agree(&SectorModel::new(parts.clone()).unwrap(), true);
        let share: f64 = 0.3 * 0.3;
        parts.speeds_rad_s[1] = 0.3 * parts.speeds_rad_s[2];
        let [k0, k1, k2] = &mut parts.stiffness[..] else { panic!("three stiffnesses") };
        for ((a, rest), top) in k1.own.val_mut().iter_mut().zip(k0.own.val()).zip(k2.own.val()) {
            *a = rest + share * (top - rest);
        }
        frequencies_agree(&SectorModel::new(parts.clone()).unwrap(), true);
        parts.stiffness[1].own.val_mut().iter_mut().for_each(|value| *value *= 1.001);
        frequencies_agree(&SectorModel::new(parts).unwrap(), false);
    }
}

fn frequencies_agree(sector: &SectorModel, linear: bool) {
    let factored = std::cell::Cell::new(false);
    let watch = |_: f64, phase: &str| {
        factored.set(factored.get() || phase.contains("full sector at"));
        true
    };
    let reduced = reduce(sector, &ReductionOptions::new(20), &NoCheckpoints, &watch).unwrap();
    assert_eq!(factored.get(), !linear);
    let complete = reduce(sector, &ReductionOptions::new(1000), &NoCheckpoints, &|_, _| true).unwrap();
    assert_eq!(reduced.comparison.len(), 5 * (sector.sectors / 2 + 1));
    for comparison in &reduced.comparison {
        let exact = rubmap::dynamics::modal_wheel::natural_frequencies(
            &complete.harmonics[comparison.harmonic],
            comparison.speed_rad_s,
            true,
        )
        .unwrap();
        assert!(comparison.full.len() == 10 && comparison.reduced.len() == 10);
        for ((full, reduced), exact) in comparison.full.iter().zip(&comparison.reduced).zip(&exact) {
            assert!((full / exact - 1.0).abs() < 1e-9, "{comparison:?}");
            assert!(reduced / full > 1.0 - 1e-9);
        }
        assert!(comparison.largest_difference().unwrap().0 < 0.01);
    }
}
