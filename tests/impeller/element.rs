//! The element alone: patch test, rigid bodies, mass.

use nalgebra::{Matrix3, SymmetricEigen, Vector3};
use rubmap::impeller::Material;
use rubmap::impeller::element::{
    Corners, Matrix24, Vector24, expand_nodal, geometric_stiffness, mass, stiffness, stresses,
};
use rubmap::impeller::mesh::{Elements, HexMesh};

/// A block of 3 × 3 × 3 elements whose inner nodes are moved at random by up to a quarter of an element.
fn distorted_block() -> (HexMesh, Vec<bool>) {
    let n = 4;
    let mut state = 7u64;
    let mut random = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    };
    let mut mesh = HexMesh::default();
    let mut outside = Vec::new();
    for k in 0..n {
        for j in 0..n {
            for i in 0..n {
                let on_surface = [i, j, k].iter().any(|&c| c == 0 || c == n - 1);
                let shift = if on_surface { [0.0; 3] } else { [(); 3].map(|()| 0.5 * random()) };
                let at = [i as f64, j as f64, k as f64];
                mesh.nodes.push(std::array::from_fn(|d| at[d] + shift[d]));
                outside.push(on_surface);
            }
        }
    }
    let node = |i: usize, j: usize, k: usize| i + n * (j + n * k);
    let mut elements = Vec::new();
    for k in 0..n - 1 {
        for j in 0..n - 1 {
            for i in 0..n - 1 {
                let face =
                    |k: usize| [node(i, j, k), node(i + 1, j, k), node(i + 1, j + 1, k), node(i, j + 1, k)];
                let (a, b) = (face(k), face(k + 1));
                elements.push([a[0], a[1], a[2], a[3], b[0], b[1], b[2], b[3]]);
            }
        }
    }
    mesh.elements = Elements::Linear(elements);
    (mesh, outside)
}

/// A hexahedron with no parallel faces.
fn crooked() -> Corners {
    [
        [0.1, -0.1, 0.0],
        [2.0, 0.2, -0.2],
        [2.3, 1.1, 0.1],
        [-0.2, 0.9, 0.2],
        [0.0, 0.1, 0.8],
        [1.8, -0.2, 1.1],
        [2.1, 1.2, 0.7],
        [0.2, 1.0, 1.0],
    ]
}

fn titanium() -> Material {
    Material::default()
}

/// Linear displacements on the surface must come out linear inside, with the exact constant stress everywhere:
/// the patch test. Round-off of a 192-unknown solve allows 1e-10 relative with a wide margin.
#[test]
fn patch_test_holds_on_a_distorted_mesh() {
    let (mesh, outside) = distorted_block();
    mesh.check_jacobians().unwrap();
    let material = titanium();
    let gradient = Matrix3::new(1.0, 0.3, -0.2, 0.5, -0.7, 0.4, 0.1, 0.6, 0.9) * 1e-3;
    let exact = |n: usize| gradient * Vector3::from(mesh.nodes[n]);

    // Nodes inside: K_ff u_f = −K_fs u_s, dense.
    let inner: Vec<usize> = (0..mesh.nodes.len()).filter(|&n| !outside[n]).collect();
    let place = |n: usize| inner.iter().position(|&m| m == n);
    let size = 3 * inner.len();
    let mut k_ff = nalgebra::DMatrix::<f64>::zeros(size, size);
    let mut load = nalgebra::DVector::<f64>::zeros(size);
    for e in 0..mesh.elements.len() {
        let k = stiffness(&mesh.corners(e), &material);
        for (a, &na) in mesh.elements.nodes_of(e).iter().enumerate() {
            let Some(pa) = place(na) else { continue };
            for (b, &nb) in mesh.elements.nodes_of(e).iter().enumerate() {
                let block = k.fixed_view::<3, 3>(3 * a, 3 * b);
                match place(nb) {
                    Some(pb) => {
                        let mut view = k_ff.fixed_view_mut::<3, 3>(3 * pa, 3 * pb);
                        view += block;
                    }
                    None => {
                        let mut view = load.fixed_rows_mut::<3>(3 * pa);
                        view -= block * exact(nb);
                    }
                }
            }
        }
    }
    let solution = k_ff.cholesky().unwrap().solve(&load);
    let scale = (0..mesh.nodes.len()).map(|n| exact(n).norm()).fold(0.0, f64::max);
    for (p, &n) in inner.iter().enumerate() {
        let error = (solution.fixed_rows::<3>(3 * p) - exact(n)).norm() / scale;
        assert!(error < 1e-10, "node {n}: {error:e}");
    }

    let h = gradient;
    let strain = nalgebra::Vector6::new(
        h[(0, 0)],
        h[(1, 1)],
        h[(2, 2)],
        h[(0, 1)] + h[(1, 0)],
        h[(1, 2)] + h[(2, 1)],
        h[(2, 0)] + h[(0, 2)],
    );
    let expected = material.elasticity() * strain;
    for e in 0..mesh.elements.len() {
        let u = Vector24::from_fn(|d, _| {
            let n = mesh.elements.nodes_of(e)[d / 3];
            place(n).map_or_else(|| exact(n)[d % 3], |p| solution[3 * p + d % 3])
        });
        for s in stresses(&mesh.corners(e), &material, &u) {
            assert!((s - expected).norm() < 1e-10 * expected.norm());
        }
    }
}

/// A free element has exactly six zero eigenvalues; 1e-12 of the largest is its round-off.
#[test]
fn free_element_has_six_rigid_body_modes() {
    let k = stiffness(&crooked(), &titanium());
    assert!((k - k.transpose()).norm() <= 1e-15 * k.norm());
    let mut values: Vec<f64> = SymmetricEigen::new(k).eigenvalues.iter().copied().collect();
    values.sort_by(f64::total_cmp);
    let largest = values[23];
    assert!(values[..6].iter().all(|v| v.abs() < 1e-12 * largest), "{values:?}");
    assert!(values[6] > 1e-4 * largest, "{values:?}");
}

/// Bending of a rectangular element about any axis is exact: one element gives the beam's energy E I κ² L / 2,
/// which a plain trilinear hexahedron overestimates many times when slender (ν = 0, so no anticlastic part).
#[test]
fn pure_bending_of_one_element_is_exact() {
    let (l, t) = (10.0, 0.5);
    let material = Material { poissons_ratio: 0.0, ..titanium() };
    let x: Corners = [
        [0.0, 0.0, 0.0],
        [l, 0.0, 0.0],
        [l, 1.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, t],
        [l, 0.0, t],
        [l, 1.0, t],
        [0.0, 1.0, t],
    ];
    let kappa = 1e-3;
    // u_x = −κ (x − l/2)(z − t/2); u_z follows by the bubble.
    let u = Vector24::from_fn(|d, _| {
        if d % 3 == 0 { -kappa * (x[d / 3][0] - l / 2.0) * (x[d / 3][2] - t / 2.0) } else { 0.0 }
    });
    let energy = 0.5 * u.dot(&(stiffness(&x, &material) * u));
    let beam = 0.5 * material.youngs_modulus * t.powi(3) / 12.0 * kappa * kappa * l;
    assert!((energy / beam - 1.0).abs() < 1e-12, "{}", energy / beam);
}

/// Rigid translations carry the whole mass; a uniform stress gives the geometric stiffness no force on them.
#[test]
fn mass_and_geometric_stiffness_of_translations() {
    let x = crooked();
    let density = 2.5;
    let m: Matrix24 = expand_nodal(&mass(&x, density), [1.0; 3]);
    // Volume by the divergence theorem on the six bilinear faces, each split at its centre: exact for bilinear
    // faces' flux of x/3 only when planar, so compare with a fine subdivision of the element instead.
    let volume = volume_by_subdivision(&x, 24);
    for d in 0..3 {
        let unit = Vector24::from_fn(|i, _| if i % 3 == d { 1.0 } else { 0.0 });
        let total = unit.dot(&(m * unit));
        // The midpoint rule's own error is a few 1e-5 at this subdivision.
        assert!((total / (density * volume) - 1.0).abs() < 1e-4);
    }
    let sigma = nalgebra::Vector6::new(3.0, -1.0, 2.0, 0.5, 0.2, -0.4);
    let k = expand_nodal(&geometric_stiffness(&x, &[sigma; 8]), [1.0; 3]);
    for d in 0..3 {
        let unit = Vector24::from_fn(|i, _| if i % 3 == d { 1.0 } else { 0.0 });
        assert!((k * unit).norm() < 1e-13 * k.norm());
    }
    assert!((k - k.transpose()).norm() < 1e-14 * k.norm());
}

/// ∫ det J by an n³ midpoint rule on the trilinear map, with det J from finite cells' edge vectors.
fn volume_by_subdivision(x: &Corners, n: usize) -> f64 {
    let map = |a: f64, b: f64, c: f64| -> Vector3<f64> {
        let w = [
            (1.0 - a) * (1.0 - b) * (1.0 - c),
            a * (1.0 - b) * (1.0 - c),
            a * b * (1.0 - c),
            (1.0 - a) * b * (1.0 - c),
            (1.0 - a) * (1.0 - b) * c,
            a * (1.0 - b) * c,
            a * b * c,
            (1.0 - a) * b * c,
        ];
        x.iter().zip(w).map(|(x, w)| Vector3::from(*x) * w).sum()
    };
    let h = 1.0 / n as f64;
    let mut volume = 0.0;
    for i in 0..n {
        for j in 0..n {
            for k in 0..n {
                let [a, b, c] = [i, j, k].map(|q| (q as f64 + 0.5) * h);
                let e = 0.5 * h;
                let da = map(a + e, b, c) - map(a - e, b, c);
                let db = map(a, b + e, c) - map(a, b - e, c);
                let dc = map(a, b, c + e) - map(a, b, c - e);
                volume += da.cross(&db).dot(&dc);
            }
        }
    }
    volume
}
