//! Closed-form frequencies through the whole chain.

use faer::sparse::{SparseColMat, Triplet};
use rubmap::dynamics::modal_wheel::{ModalWheel, RotationEffects};
use rubmap::dynamics::reduction::{NoCheckpoints, ReductionOptions, reduce};
use rubmap::dynamics::sector::{ContactNode, CyclicMatrix, SectorModel, SectorParts, Units};

/// Cyclic chain: N masses m, ground springs k, neighbour springs k_c give
/// ω_i² = (k + 4 k_c sin²(πi/N))/m, a pair for 0 < i < N/2.
#[test]
fn cyclic_chain() {
    let (m, k, coupling) = (2e-6, 7.0, 1.3);
    for sectors in [1, 2, 3, 4, 9, 10, 64] {
        let sparse = |values: &[(usize, usize, f64)]| {
            let triplets: Vec<_> = values.iter().map(|&(i, j, v)| Triplet::new(i, j, v)).collect();
            SparseColMat::try_new_from_triplets(3, 3, &triplets).unwrap()
        };
        // The chain lives in the θ direction; r and z are plain oscillators at k/m.
        let own = sparse(&[(0, 0, k), (1, 1, k + 2.0 * coupling), (2, 2, k)]);
        let next = sparse(&[(1, 1, -coupling)]);
        let sector = SectorModel::new(SectorParts {
            name: "chain".into(),
            sectors,
            units: Units { length: "mm".into(), force: "N".into(), time: "s".into(), mass: "t".into() },
            mass: CyclicMatrix { own: sparse(&[(0, 0, m), (1, 1, m), (2, 2, m)]), next: sparse(&[]) },
            stiffness: vec![CyclicMatrix { own, next }],
            gyroscopic: None,
            speeds_rad_s: vec![0.0],
            contact: vec![ContactNode {
                id: 1,
                position: [50.0, 0.0, 0.0],
                normal: [1.0, 0.0, 0.0],
                dofs: [0, 1, 2],
            }],
            axis: Vec::new(),
            node_of_dof: vec![0; 3],
        })
        .unwrap();
        let reduced = reduce(&sector, &ReductionOptions::new(4), &NoCheckpoints, &|_, _| true).unwrap();
        let modal = ModalWheel::at(&reduced, 100.0, RotationEffects::stiffening(false)).unwrap();
        assert_eq!(modal.harmonics.len(), sectors / 2 + 1);
        assert_eq!(modal.unknowns(), 3 * sectors);
        for harmonic in &modal.harmonics {
            let sine = (std::f64::consts::PI * harmonic.harmonic as f64 / sectors as f64).sin();
            let expected = ((k + 4.0 * coupling * sine * sine) / m).sqrt();
            let highest = harmonic.omega[2];
            assert!((highest / expected - 1.0).abs() < 1e-12, "{sectors} {}: {highest}", harmonic.harmonic);
            assert_eq!(harmonic.single, harmonic.harmonic == 0 || 2 * harmonic.harmonic == sectors);
        }
    }
}
