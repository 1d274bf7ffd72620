//! Small wheels shared by the tests: masses and springs in three dimensions, every matrix sound by construction, and a
//! finite-element impeller.

use faer::sparse::{SparseColMat, Triplet};
use nalgebra::DMatrix;
use rubmap::dynamics::sector::{ContactNode, CyclicMatrix, SectorModel, SectorParts, Units};
use rubmap::impeller::{ImpellerParameters, MeshDensities, generate};
use rubmap::package::raw::RawPackage;

/// Generator of deterministic numbers in [0, 1).
pub(crate) struct Numbers(u64);

impl Numbers {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    pub(crate) fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Recipe of a test wheel.
#[derive(Debug, Clone, Copy)]
pub(crate) struct WheelRecipe {
    pub(crate) sectors: usize,
    /// Number of nodes of a sector (three DOF each), the contact nodes last.
    pub(crate) nodes: usize,
    pub(crate) contact_nodes: usize,
    /// Number of low-face nodes (the first ones), coupled to the previous sector.
    pub(crate) face_nodes: usize,
    /// Whether K depends on Ω.
    pub(crate) stiffening: bool,
    pub(crate) seed: u64,
    /// Stiffness of the ground springs, relative to the others.
    pub(crate) ground: f64,
}

impl Default for WheelRecipe {
    fn default() -> Self {
        Self {
            sectors: 10,
            nodes: 7,
            contact_nodes: 3,
            face_nodes: 2,
            stiffening: true,
            seed: 1,
            ground: 1.0,
        }
    }
}

/// Top speed Ω1 of the test wheels, rad/s.
pub(crate) const TOP_SPEED: f64 = 3000.0;

/// Sector of point masses joined by anisotropic springs (a positive semidefinite 3 × 3 block each), all tied to the
/// ground by weak springs, faces tied to the next sector's. Frequencies are a few times TOP_SPEED/2π·(1…10), so that
/// engine orders 1 to 10 meet modes; lengths are millimetres by size.
pub(crate) fn wheel(recipe: WheelRecipe) -> SectorModel {
    let WheelRecipe { sectors, nodes, contact_nodes, face_nodes, stiffening, seed, ground } = recipe;
    let mut numbers = Numbers::new(seed);
    let size = 3 * nodes;
    let mass_scale = 1e-5;
    let unit = mass_scale * TOP_SPEED * TOP_SPEED;
    let mut own = DMatrix::zeros(size, size);
    let mut next = DMatrix::zeros(size, size);
    for a in 0..nodes {
        let tie = spring(&mut numbers, 2.0 * unit * ground);
        add(&mut own, a, a, &tie);
        for b in 0..a {
            let link = spring(&mut numbers, 8.0 * unit / (a - b) as f64);
            add(&mut own, a, a, &link);
            add(&mut own, b, b, &link);
            add(&mut own, a, b, &(-&link));
            add(&mut own, b, a, &(-&link));
        }
    }
    for high in 0..face_nodes {
        // Node nodes−1−high of this sector to low-face node `high` of the next; the low face's own share is folded
        // onto this sector's low face, as every sector receives it from its neighbour.
        let from = nodes - 1 - high.min(nodes - 1);
        let link = spring(&mut numbers, 5.0 * unit);
        add(&mut own, from, from, &link);
        add(&mut own, high, high, &link);
        add(&mut next, from, high, &(-&link));
    }
    let mass: Vec<f64> = (0..nodes).flat_map(|_| [mass_scale * (0.5 + numbers.next()); 3]).collect();
    let mass = DMatrix::from_diagonal(&nalgebra::DVector::from_vec(mass));
    // Stiffening grows with Ω² on the diagonal blocks, softening acts in the plane of rotation.
    let mut growth = DMatrix::zeros(size, size);
    for a in 0..nodes {
        let link = spring(&mut numbers, 0.6 * mass_scale);
        add(&mut growth, a, a, &link);
        for plane in 0..2 {
            growth[(3 * a + plane, 3 * a + plane)] -= 0.2 * mass[(3 * a, 3 * a)];
        }
    }
    let speeds: Vec<f64> = if stiffening { vec![0.0, TOP_SPEED / 2.0, TOP_SPEED] } else { vec![0.0] };
    let stiffness = speeds.iter().map(|omega| cyclic(&(&own + &growth * (omega * omega)), &next)).collect();
    let first = nodes - contact_nodes;
    let contact = (0..contact_nodes)
        .map(|k| {
            let node = first + k;
            let turn = std::f64::consts::FRAC_PI_2 * k as f64 / contact_nodes.max(2) as f64;
            ContactNode {
                id: node as u64 + 1,
                position: [60.0 + 5.0 * k as f64, -0.1 * k as f64, 4.0 * k as f64],
                normal: [turn.cos(), 0.0, -turn.sin()],
                dofs: [3 * node, 3 * node + 1, 3 * node + 2],
            }
        })
        .collect();
    let parts = SectorParts {
        name: "test wheel".into(),
        sectors,
        units: Units { length: "mm".into(), force: "N".into(), time: "s".into(), mass: "t".into() },
        mass: cyclic(&mass, &DMatrix::zeros(size, size)),
        stiffness,
        gyroscopic: None,
        speeds_rad_s: speeds,
        contact,
        axis: Vec::new(),
        node_of_dof: (0..size).map(|dof| dof / 3).collect(),
    };
    SectorModel::new(parts).unwrap()
}

/// Package of a finite-element impeller of a few hundred DOF a sector, four contact nodes.
pub(crate) fn small_impeller(sectors: usize) -> RawPackage {
    let mesh = MeshDensities {
        between_contact_nodes: 2,
        blade_height: 3,
        blade_thickness: 1,
        half_passage: 2,
        disk: 2,
    };
    let parameters = ImpellerParameters { sectors, contact_nodes: 4, mesh, ..Default::default() };
    generate(&parameters).unwrap()
}

/// Random positive definite 3 × 3 spring block of about `scale`.
fn spring(numbers: &mut Numbers, scale: f64) -> DMatrix<f64> {
    let root = DMatrix::from_fn(3, 3, |_, _| numbers.next() - 0.5);
    (&root * root.transpose() + DMatrix::identity(3, 3) * 0.1) * scale
}

fn add(matrix: &mut DMatrix<f64>, a: usize, b: usize, block: &DMatrix<f64>) {
    let mut view = matrix.view_mut((3 * a, 3 * b), (3, 3));
    view += block;
}

pub(crate) fn cyclic(own: &DMatrix<f64>, next: &DMatrix<f64>) -> CyclicMatrix {
    CyclicMatrix { own: sparse(own), next: sparse(next) }
}

fn sparse(matrix: &DMatrix<f64>) -> SparseColMat<usize, f64> {
    let mut entries = Vec::new();
    for j in 0..matrix.ncols() {
        for i in 0..matrix.nrows() {
            if matrix[(i, j)] != 0.0 {
                entries.push(Triplet::new(i, j, matrix[(i, j)]));
            }
        }
    }
    SparseColMat::try_new_from_triplets(matrix.nrows(), matrix.ncols(), &entries).unwrap()
}

/// Matrix of the whole wheel, sector by sector: [own on the diagonal, next above it, its transpose below], closed to a ring.
pub(crate) fn assembled_wheel(matrix: &CyclicMatrix, sectors: usize) -> DMatrix<f64> {
    let size = matrix.own.nrows();
    let mut wheel = DMatrix::zeros(sectors * size, sectors * size);
    for s in 0..sectors {
        let t = (s + 1) % sectors;
        for entry in matrix.own.triplet_iter() {
            wheel[(s * size + entry.row, s * size + entry.col)] += *entry.val;
        }
        for entry in matrix.next.triplet_iter() {
            wheel[(s * size + entry.row, t * size + entry.col)] += *entry.val;
            wheel[(t * size + entry.col, s * size + entry.row)] += *entry.val;
        }
    }
    wheel
}

/// Random gyroscopic matrix of the size of `recipe`'s masses, with the couplings of its faces.
pub(crate) fn gyroscopic(recipe: WheelRecipe, seed: u64) -> CyclicMatrix {
    let mut numbers = Numbers::new(seed);
    let size = 3 * recipe.nodes;
    let mut random = |columns: usize| {
        DMatrix::from_fn(size, size, |_, j| if j < columns { 1e-5 * (numbers.next() - 0.5) } else { 0.0 })
    };
    let half = random(size);
    cyclic(&(&half - half.transpose()), &random(3 * recipe.face_nodes))
}

/// Matrix of the whole wheel, from a skew-symmetric matrix.
pub(crate) fn assembled_skew(matrix: &CyclicMatrix, sectors: usize) -> DMatrix<f64> {
    let size = matrix.own.nrows();
    let mut wheel = DMatrix::zeros(sectors * size, sectors * size);
    for s in 0..sectors {
        let t = (s + 1) % sectors;
        for entry in matrix.own.triplet_iter() {
            wheel[(s * size + entry.row, s * size + entry.col)] += *entry.val;
        }
        for entry in matrix.next.triplet_iter() {
            wheel[(s * size + entry.row, t * size + entry.col)] += *entry.val;
            wheel[(t * size + entry.col, s * size + entry.row)] -= *entry.val;
        }
    }
    wheel
}

/// Eigenvalues ω² of K x = ω² M x in ascending order, by nalgebra.
pub(crate) fn eigenvalues(k: &DMatrix<f64>, m: &DMatrix<f64>) -> Vec<f64> {
    let lower = m.clone().cholesky().expect("a mass is positive definite").l();
    let half = lower.solve_lower_triangular(k).unwrap();
    let standard = lower.solve_lower_triangular(&half.transpose()).unwrap();
    let mut values: Vec<f64> = standard.symmetric_eigenvalues().iter().copied().collect();
    values.sort_by(f64::total_cmp);
    values
}
