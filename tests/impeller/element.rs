//! Elements alone: patch tests, rigid bodies, mass, geometric stiffness, Jacobians.

use nalgebra::{DMatrix, DVector, Matrix3, SymmetricEigen, Vector3};
use rubmap::solid::blocks::Blocks;
use rubmap::solid::element::ElementKind;
use rubmap::solid::gauss::gauss_points;
use rubmap::solid::integrals::{geometric_stiffness, mass, stiffness};
use rubmap::solid::jacobian;
use rubmap::solid::material::{Material, Stress};
use rubmap::solid::mesh::{Element, ElementSet, SectorMesh};
use rubmap::solid::natural::{CORNERS, EDGES};
use rubmap::solid::rule::{MassRule, points};
use rubmap::solid::stress::point_stress;

/// Titanium in mm, N, s, t.
fn titanium() -> Material {
    rubmap::impeller::Material::default().to_solid()
}

/// Element of eight or of twenty nodes as the generator has it.
fn kind(nodes: usize) -> ElementKind {
    if nodes == 8 { ElementKind::QM6 } else { ElementKind::C3D20 }
}

/// Smallest det J over the corners and the integration points of an element.
fn smallest_jacobian(positions: &[[f64; 3]]) -> f64 {
    let places = CORNERS.into_iter().chain(gauss_points(3).iter().map(|point| point.xi));
    let determinants = places.map(|xi| jacobian(kind(positions.len()), positions, xi).determinant());
    determinants.fold(f64::INFINITY, f64::min)
}

/// Positions of a block of elements, which nodes lie on its surface, and the elements' nodes.
struct Patch<const N: usize> {
    nodes: Vec<Vector3<f64>>,
    outside: Vec<bool>,
    elements: Vec<[usize; N]>,
}

/// Patch of 3 × 3 × 3 cells of corners; those inside are moved at random by up to `shift` of a cell.
fn corners(shift: f64) -> Patch<8> {
    let n = 4;
    let mut state = 7u64;
    let mut random = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        2.0 * ((state >> 11) as f64 / (1u64 << 53) as f64) - 1.0
    };
    let node = |i: usize, j: usize, k: usize| i + n * (j + n * k);
    let mut patch = Patch { nodes: Vec::new(), outside: Vec::new(), elements: Vec::new() };
    for k in 0..n {
        for j in 0..n {
            for i in 0..n {
                let outside = [i, j, k].iter().any(|&c| c == 0 || c == n - 1);
                let moved = Vector3::from_fn(|_, _| if outside { 0.0 } else { shift * random() });
                patch.nodes.push(Vector3::new(i as f64, j as f64, k as f64) + moved);
                patch.outside.push(outside);
                if i < n - 1 && j < n - 1 && k < n - 1 {
                    let face =
                        |k| [node(i, j, k), node(i + 1, j, k), node(i + 1, j + 1, k), node(i, j + 1, k)];
                    let (a, b) = (face(k), face(k + 1));
                    patch.elements.push([a[0], a[1], a[2], a[3], b[0], b[1], b[2], b[3]]);
                }
            }
        }
    }
    patch
}

/// Patch of the same elements with a node at the centre of every edge.
fn with_edges(patch: &Patch<8>) -> Patch<20> {
    let mut quadratic =
        Patch { nodes: patch.nodes.clone(), outside: patch.outside.clone(), elements: Vec::new() };
    let mut known = std::collections::HashMap::new();
    // A node counts as outside if it is on the surface of the 3 × 3 × 3 block, not merely between two nodes of it.
    let on_surface = |x: &Vector3<f64>| x.iter().any(|&c| c == 0.0 || c == 3.0);
    for element in &patch.elements {
        quadratic.elements.push(std::array::from_fn(|a| {
            if a < 8 {
                return element[a];
            }
            let [p, q] = EDGES[a - 8].map(|corner| element[corner]);
            *known.entry([p.min(q), p.max(q)]).or_insert_with(|| {
                let centre = (patch.nodes[p] + patch.nodes[q]) / 2.0;
                quadratic.outside.push(on_surface(&centre));
                quadratic.nodes.push(centre);
                quadratic.nodes.len() - 1
            })
        }));
    }
    quadratic
}

impl<const N: usize> Patch<N> {
    fn positions(&self, element: usize) -> Vec<[f64; 3]> {
        self.elements[element].iter().map(|&node| self.nodes[node].into()).collect()
    }

    /// Mesh of the patch for stress.
    fn mesh(&self, material: &Material) -> SectorMesh {
        let element = |(e, nodes): (usize, &[usize; N])| Element {
            id: e as u64,
            kind: kind(N),
            set: 0,
            nodes: nodes.iter().map(|&node| node as u32).collect(),
        };
        SectorMesh {
            sectors: 1,
            node_ids: (0..self.nodes.len() as u64).collect(),
            nodes: self.nodes.iter().map(|&x| x.into()).collect(),
            axis: ([0.0; 3], [0.0, 0.0, 1.0]),
            cyclic: Vec::new(),
            elements: self.elements.iter().enumerate().map(element).collect(),
            sets: vec![ElementSet { name: "ALL".into(), material: material.clone() }],
        }
    }

    /// Displacements of a patch with those on the surface prescribed and no forces inside.
    fn solve(
        &self,
        material: &Material,
        surface: impl Fn(&Vector3<f64>) -> Vector3<f64>,
    ) -> Vec<Vector3<f64>> {
        let inner: Vec<usize> = (0..self.nodes.len()).filter(|&node| !self.outside[node]).collect();
        let place = |node: usize| inner.iter().position(|&other| other == node);
        let mut k_ff = DMatrix::<f64>::zeros(3 * inner.len(), 3 * inner.len());
        let mut load = DVector::<f64>::zeros(3 * inner.len());
        for (e, nodes) in self.elements.iter().enumerate() {
            let k = stiffness(kind(N), &self.positions(e), material.lame_constants());
            for (a, p) in nodes.iter().enumerate().filter_map(|(a, &node)| Some((a, place(node)?))) {
                for (b, &node) in nodes.iter().enumerate() {
                    match place(node) {
                        Some(q) => {
                            let mut view = k_ff.fixed_view_mut::<3, 3>(3 * p, 3 * q);
                            view += k[(a, b)];
                        }
                        None => {
                            let mut view = load.fixed_rows_mut::<3>(3 * p);
                            view -= k[(a, b)] * surface(&self.nodes[node]);
                        }
                    }
                }
            }
        }
        let solution = k_ff.cholesky().expect("held on its surface").solve(&load);
        (0..self.nodes.len())
            .map(|n| match place(n) {
                Some(p) => solution.fixed_rows::<3>(3 * p).into_owned(),
                None => surface(&self.nodes[n]),
            })
            .collect()
    }
}

/// Stress with these strains by Hooke's law solved for stress, from the compliance.
fn hooke(material: &Material, h: &Matrix3<f64>) -> Stress {
    let (e, nu) = (material.youngs_modulus, material.poissons_ratio);
    let compliance = nalgebra::Matrix6::from_fn(|i, j| match (i < 3, j < 3) {
        (true, true) => {
            if i == j {
                1.0 / e
            } else {
                -nu / e
            }
        }
        (false, false) if i == j => 2.0 * (1.0 + nu) / e,
        _ => 0.0,
    });
    let shear = |i, j| h[(i, j)] + h[(j, i)];
    let strain = Stress::new(h[(0, 0)], h[(1, 1)], h[(2, 2)], shear(0, 1), shear(1, 2), shear(2, 0));
    compliance.try_inverse().unwrap() * strain
}

fn gradient() -> Matrix3<f64> {
    Matrix3::new(1.0, 0.3, -0.2, 0.5, -0.7, 0.4, 0.1, 0.6, 0.9) * 1e-3
}

/// Patch test: linear displacements on the surface come out linear inside, with the exact constant stress at every
/// Gauss point. Round-off of the solve allows 1e-10 relative with a wide margin.
fn passes_patch_test<const N: usize>(patch: &Patch<N>) {
    let material = titanium();
    let exact = |x: &Vector3<f64>| gradient() * x;
    let u = patch.solve(&material, exact);
    let expected = hooke(&material, &gradient());
    for (x, u) in patch.nodes.iter().zip(&u) {
        assert!((u - exact(x)).norm() < 1e-10 * gradient().norm(), "at {x}");
    }
    let mesh = patch.mesh(&material);
    for (e, nodes) in patch.elements.iter().enumerate() {
        assert!(smallest_jacobian(&patch.positions(e)) > 0.0);
        for stress in point_stress(&mesh, &mesh.elements[e], &nodes.map(|node| u[node])) {
            assert!((stress - expected).norm() < 1e-10 * expected.norm());
        }
    }
}

#[test]
fn patch_test_holds_on_a_distorted_mesh() {
    let patch = corners(0.25);
    passes_patch_test(&patch);
    passes_patch_test(&with_edges(&patch));
}

/// Quadratic displacements of pure bending, `σ_xx = E κ z` and nothing else, are exact on skewed parallelepipeds of
/// 20 nodes.
#[test]
fn quadratic_element_bends_exactly_on_a_skewed_mesh() {
    let material = titanium();
    let (kappa, nu) = (1e-3, material.poissons_ratio);
    let mut patch = with_edges(&corners(0.0));
    let skew = Matrix3::new(1.0, 0.3, -0.4, 0.2, 0.9, 0.3, 0.1, -0.2, 1.1);
    for x in &mut patch.nodes {
        *x = skew * *x;
    }
    let exact = |p: &Vector3<f64>| {
        let (x, y, z) = (p.x, p.y, p.z);
        Vector3::new(x * z, -nu * y * z, -(x * x + nu * (z * z - y * y)) / 2.0) * kappa
    };
    let u = patch.solve(&material, exact);
    let largest = u.iter().map(|u| u.norm()).fold(0.0, f64::max);
    for (x, u) in patch.nodes.iter().zip(&u) {
        assert!((u - exact(x)).norm() < 1e-10 * largest, "at {x}");
    }
}

/// Hexahedron with no parallel faces.
fn crooked() -> [[f64; 3]; 8] {
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

/// Nodes of a hexahedron of 20: corners with a node on each edge, `bulge` off its centre in x, y and z.
fn twenty(corners: &[[f64; 3]; 8], bulge: f64) -> [[f64; 3]; 20] {
    std::array::from_fn(|a| match corners.get(a) {
        Some(x) => *x,
        None => {
            let [p, q] = EDGES[a - 8].map(|corner| corners[corner]);
            let sign = |d: usize| if (a + d).is_multiple_of(2) { bulge } else { -bulge };
            std::array::from_fn(|d| (p[d] + q[d]) / 2.0 + sign(d))
        }
    })
}

/// Corners of the block [0, 2] × [0, 3] × [0, 0.5].
fn brick() -> [[f64; 3]; 8] {
    CORNERS.map(|c| [1.0 + c[0], 1.5 * (1.0 + c[1]), 0.25 * (1.0 + c[2])])
}

fn dense(blocks: &Blocks) -> DMatrix<f64> {
    let size = 3 * blocks.count();
    DMatrix::from_fn(size, size, |i, j| blocks[(i / 3, j / 3)][(i % 3, j % 3)])
}

/// Asserts that a free element has exactly six zero eigenvalues (1e-12 of the largest is its round-off), the rest positive.
fn has_six_rigid_body_modes(positions: &[[f64; 3]]) {
    let k = dense(&stiffness(kind(positions.len()), positions, titanium().lame_constants()));
    assert!((&k - k.transpose()).norm() <= 1e-15 * k.norm());
    let mut values: Vec<f64> = SymmetricEigen::new(k).eigenvalues.iter().copied().collect();
    values.sort_by(f64::total_cmp);
    let largest = values[values.len() - 1];
    assert!(values[..6].iter().all(|v| v.abs() < 1e-12 * largest), "{:?}", &values[..8]);
    assert!(values[6] > 1e-5 * largest, "{:?}", &values[..8]);
}

#[test]
fn free_element_has_six_rigid_body_modes() {
    has_six_rigid_body_modes(&crooked());
    has_six_rigid_body_modes(&twenty(&crooked(), 0.05));
}

/// Bending of a rectangular element about any axis is exact: one element gives the beam's energy E I κ² L / 2,
/// which a plain trilinear hexahedron overestimates many times when slender (ν = 0, so no anticlastic part).
#[test]
fn pure_bending_of_one_linear_element_is_exact() {
    let material = Material { poissons_ratio: 0.0, ..titanium() };
    let kappa = 1e-3;
    // u_x = −κ (x − 1)(z − 0.25); u_z follows by the bubble.
    let u = DVector::from_fn(24, |d, _| {
        let x = brick()[d / 3];
        if d % 3 == 0 { -kappa * (x[0] - 1.0) * (x[2] - 0.25) } else { 0.0 }
    });
    let energy =
        0.5 * u.dot(&(dense(&stiffness(ElementKind::QM6, &brick(), material.lame_constants())) * &u));
    let beam = 0.5 * material.youngs_modulus * 3.0 * 0.5_f64.powi(3) / 12.0 * kappa * kappa * 2.0;
    assert!((energy / beam - 1.0).abs() < 1e-12, "{}", energy / beam);
}

/// Sum `Σ m_ab u_a · u_b` of a field.
fn kinetic(positions: &[[f64; 3]], u: impl Fn(Vector3<f64>) -> Vector3<f64>) -> f64 {
    let nodes = positions.len();
    let mass = mass(kind(nodes), positions, 2.5, MassRule::Consistent);
    let u: Vec<Vector3<f64>> = positions.iter().map(|&x| u(Vector3::from(x))).collect();
    let pairs = (0..nodes).flat_map(|a| (0..nodes).map(move |b| (a, b)));
    pairs.map(|(a, b)| mass[(a, b)] * u[a].dot(&u[b])).sum()
}

/// Asserts that a block has the mass and the moments of inertia of a block, and a definite mass matrix.
fn has_the_mass_of_a_block(positions: &[[f64; 3]]) {
    let (size, density) = ([2.0, 3.0, 0.5], 2.5);
    let total = density * size.iter().product::<f64>();
    for d in 0..3 {
        let translation = Vector3::from_fn(|i, _| f64::from(u8::from(i == d)));
        assert!((kinetic(positions, |_| translation) / total - 1.0).abs() < 1e-13);
        let centre = Vector3::from(size) / 2.0;
        let inertia = total / 12.0 * (size[(d + 1) % 3].powi(2) + size[(d + 2) % 3].powi(2));
        let turning = kinetic(positions, |x| translation.cross(&(x - centre)));
        assert!((turning / inertia - 1.0).abs() < 1e-13, "{turning} {inertia}");
    }
    let mass = mass(kind(positions.len()), positions, density, MassRule::Consistent);
    assert!(mass.cholesky().is_some());
}

#[test]
fn mass_is_that_of_a_block() {
    has_the_mass_of_a_block(&brick());
    has_the_mass_of_a_block(&twenty(&brick(), 0.0));
}

/// Asserts that under uniform stress a displacement with constant gradient G takes `V Σ σ_ij G_ki G_kj`; V is that of
/// the trilinear map, by a midpoint rule of its own (a few 1e-5 off).
fn takes_the_work_of_a_uniform_stress(positions: &[[f64; 3]], volume: f64) {
    let sigma = Matrix3::new(3.0, 0.5, -0.4, 0.5, -1.0, 0.2, -0.4, 0.2, 2.0);
    let stress = Stress::new(3.0, -1.0, 2.0, 0.5, 0.2, -0.4);
    let (nodes, kind) = (positions.len(), kind(positions.len()));
    let k = geometric_stiffness(kind, positions, &vec![stress; points(kind).len()]);
    assert_eq!(k, k.transpose());
    assert!(k.column_sum().norm() < 1e-13 * k.norm(), "no force on a translation");
    let u: Vec<Vector3<f64>> = positions.iter().map(|&x| gradient() * Vector3::from(x)).collect();
    let pairs = (0..nodes).flat_map(|a| (0..nodes).map(move |b| (a, b)));
    let work: f64 = pairs.map(|(a, b)| k[(a, b)] * u[a].dot(&u[b])).sum();
    let expected = volume * (gradient() * sigma * gradient().transpose()).trace();
    assert!((work / expected - 1.0).abs() < 1e-4, "{work} {expected}");
}

#[test]
fn geometric_stiffness_is_the_work_of_the_stress() {
    let volume = volume_by_subdivision(&crooked(), 24);
    takes_the_work_of_a_uniform_stress(&crooked(), volume);
    takes_the_work_of_a_uniform_stress(&twenty(&crooked(), 0.0), volume);
}

/// Volume ∫ det J by an n³ midpoint rule on the trilinear map, with det J from finite cells' edge vectors.
fn volume_by_subdivision(x: &[[f64; 3]; 8], n: usize) -> f64 {
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

/// Mid-edge node at a quarter of its edge: it makes the map singular at the corner (the crack-tip element of Henshell,
/// Shaw and Barsoum); nearer than that it folds.
#[test]
fn a_mid_edge_node_beyond_the_quarter_point_is_noticed() {
    let jacobian = |fraction: f64| {
        let mut x = twenty(&brick(), 0.0);
        x[8][0] = 2.0 * fraction;
        smallest_jacobian(&x)
    };
    assert!(jacobian(0.27) > 0.0 && jacobian(0.23) < 0.0);
    assert!(jacobian(0.25).abs() < 1e-12);
}
