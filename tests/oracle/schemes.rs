//! The schemes beyond central differences on the whole dense wheel, literally: the exact propagator (METHOD §11) and the
//! boundary without mass (§12).

use nalgebra::{DMatrix, DVector};
use rubmap::dynamics::reduction::ReducedWheel;

use rubmap::dynamics::schemes::Scheme;
use rubmap::dynamics::schemes::exact_modal::FOLLOWS;

use super::{DenseScheme, DenseWheel, constraints, real_form, recompose};

/// The literal form of a production scheme.
pub(crate) enum Literal {
    Central(DenseScheme),
    Modal(DenseModal),
}

impl Literal {
    /// At rest; damping `ratio` for every mode, steps of `h`.
    pub(crate) fn new(scheme: Scheme, reduced: &ReducedWheel, speed: f64, ratio: f64, h: f64) -> Self {
        let wheel = DenseWheel::new(reduced, speed, true);
        match scheme {
            Scheme::CentralDifferences => {
                Self::Central(DenseScheme::new(&wheel, &wheel.modal_damping(ratio), reduced, h))
            }
            Scheme::ExactModal => Self::Modal(DenseModal::exact(reduced, &wheel, ratio, speed, h)),
            Scheme::MasslessBoundary { kept_modes } => {
                Self::Modal(DenseModal::massless(reduced, &wheel, ratio, speed, h, kept_modes))
            }
        }
    }

    /// One step; `free_gap[sector·nodes + node]` is c − p at its end, `solve(W, g_p, λ)` the contact solver.
    pub(crate) fn step(
        &mut self,
        free_gap: &[f64],
        solve: impl FnOnce(&DMatrix<f64>, &DVector<f64>, &mut DVector<f64>),
    ) {
        match self {
            Self::Central(scheme) => scheme.step(free_gap, solve),
            Self::Modal(scheme) => scheme.step(free_gap, solve),
        }
    }

    /// Component `d` of one contact node of one sector.
    pub(crate) fn displacement(&self, sector: usize, node: usize, d: usize) -> f64 {
        match self {
            Self::Central(scheme) => scheme.contact_displacement(sector, node)[d],
            Self::Modal(scheme) => scheme.displacement(sector, node, d),
        }
    }

    /// Steps in which something touched.
    pub(crate) fn contact_steps(&self) -> u64 {
        match self {
            Self::Central(scheme) => scheme.contact_steps,
            Self::Modal(scheme) => scheme.contact_steps,
        }
    }
}

/// x⁺ = now·x + before·x⁻ + kick·f in the displacements x of the modes with mass, u = x + flexibility·f.
pub(crate) struct DenseModal {
    now: DMatrix<f64>,
    before: DMatrix<f64>,
    kick: DMatrix<f64>,
    /// Residual flexibility times outward normals; without it the force completes the step.
    flexibility: Option<DMatrix<f64>>,
    constraints: DMatrix<f64>,
    delassus: DMatrix<f64>,
    x: DVector<f64>,
    last: DVector<f64>,
    lambda: DVector<f64>,
    u: DVector<f64>,
    contact_nodes: usize,
    contact_steps: u64,
}

/// 2a cosθ, a² and b of the exact propagator.
fn propagator(omega: f64, ratio: f64, h: f64) -> [f64; 3] {
    let a = (-ratio * omega * h).exp();
    let theta = omega * h * (1.0 - ratio * ratio).sqrt();
    let now = 2.0 * a * theta.cos();
    [now, a * a, (1.0 - now + a * a) / (omega * omega)]
}

impl DenseModal {
    /// Every mode by its exact propagator.
    fn exact(reduced: &ReducedWheel, wheel: &DenseWheel, ratio: f64, speed: f64, h: f64) -> Self {
        let follows = |omega: f64| omega * h > FOLLOWS;
        let term = |which: usize| {
            modal_function(reduced, speed, &|_, omega| match (follows(omega), which) {
                (false, _) => propagator(omega, ratio, h)[which],
                (true, 2) => omega.powi(-2),
                (true, _) => 0.0,
            })
        };
        Self::new(reduced, wheel, [term(0), term(1), term(2)], None)
    }

    /// The `kept` lowest modes of every nodal diameter by their exact propagator, the rest statically.
    fn massless(
        reduced: &ReducedWheel,
        wheel: &DenseWheel,
        ratio: f64,
        speed: f64,
        h: f64,
        kept: usize,
    ) -> Self {
        let term = |which: usize| {
            let of = |mode, omega| if mode < kept { propagator(omega, ratio, h)[which] } else { 0.0 };
            modal_function(reduced, speed, &of)
        };
        let residual =
            modal_function(reduced, speed, &|mode, omega| if mode < kept { 0.0 } else { omega.powi(-2) });
        Self::new(reduced, wheel, [term(0), term(1), term(2)], Some(residual))
    }

    fn new(
        reduced: &ReducedWheel,
        wheel: &DenseWheel,
        [now, before, kick]: [DMatrix<f64>; 3],
        residual: Option<DMatrix<f64>>,
    ) -> Self {
        let constraints = constraints(wheel, reduced);
        let kick = kick * &constraints;
        let flexibility = residual.map(|residual| residual * &constraints);
        let size = wheel.size();
        Self {
            now: now * &wheel.mass,
            before: -(before * &wheel.mass),
            delassus: constraints.transpose() * flexibility.as_ref().unwrap_or(&kick),
            lambda: DVector::zeros(constraints.ncols()),
            x: DVector::zeros(size),
            last: DVector::zeros(size),
            u: DVector::zeros(size),
            contact_nodes: reduced.contact.len(),
            contact_steps: 0,
            kick,
            flexibility,
            constraints,
        }
    }

    fn step(
        &mut self,
        free_gap: &[f64],
        solve: impl FnOnce(&DMatrix<f64>, &DVector<f64>, &mut DVector<f64>),
    ) {
        let mut next = &self.now * &self.x + &self.before * &self.last;
        if self.flexibility.is_some() {
            // Eq. of motion at the old time.
            next -= &self.kick * &self.lambda;
        }
        let gap = DVector::from_column_slice(free_gap) - self.constraints.transpose() * &next;
        self.lambda.fill(0.0);
        if gap.iter().any(|&g| g < 0.0) {
            solve(&self.delassus, &gap, &mut self.lambda);
            self.contact_steps += 1;
        }
        self.u = next.clone();
        match &self.flexibility {
            Some(flexibility) => self.u -= flexibility * &self.lambda,
            None => {
                self.u -= &self.kick * &self.lambda;
                next = self.u.clone();
            }
        }
        self.last = std::mem::replace(&mut self.x, next);
    }

    fn displacement(&self, sector: usize, node: usize, d: usize) -> f64 {
        self.u[(sector * self.contact_nodes + node) * 3 + d]
    }
}

/// Φ diag(of(mode within its nodal diameter, ω)) Φᵀ over the whole wheel, ΦᵀMΦ = 1.
fn modal_function(reduced: &ReducedWheel, speed: f64, of: &dyn Fn(usize, f64) -> f64) -> DMatrix<f64> {
    let block = |harmonic: &rubmap::dynamics::reduction::ReducedHarmonic| {
        let i = harmonic.harmonic;
        let mass = real_form(&harmonic.mass, i, reduced.sectors);
        let stiffness = real_form(&harmonic.stiffness.at(speed, true), i, reduced.sectors);
        // Modes of the real form come in pairs where those of the nodal diameter do.
        let copies = mass.nrows() / harmonic.mass.nrows();
        let lower = mass.cholesky().expect("M_r is positive definite").l();
        let half = lower.solve_lower_triangular(&stiffness).unwrap();
        let standard = lower.solve_lower_triangular(&half.transpose()).unwrap();
        let eigen = ((&standard + standard.transpose()) * 0.5).symmetric_eigen();
        let mut order: Vec<usize> = (0..eigen.eigenvalues.len()).collect();
        order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
        let mut values = eigen.eigenvalues.clone();
        for (place, &column) in order.iter().enumerate() {
            values[column] = of(place / copies, eigen.eigenvalues[column].sqrt());
        }
        let modes = lower.transpose().solve_upper_triangular(&eigen.eigenvectors).unwrap();
        &modes * DMatrix::from_diagonal(&values) * modes.transpose()
    };
    let blocks: Vec<_> = reduced.harmonics.iter().map(block).collect();
    recompose(&blocks, reduced)
}
