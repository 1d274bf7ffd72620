//! Schemes beyond central differences on the whole dense wheel, literally: the exact propagator and the boundary
//! without mass (docs/method.md, Schemes).

use nalgebra::{DMatrix, DVector};
use rubmap::dynamics::reduction::ReducedWheel;

use rubmap::dynamics::schemes::Scheme;
use rubmap::dynamics::schemes::exact_modal::FOLLOWS;

use super::{DenseScheme, DenseWheel, constraints, real_form, recompose};

/// Literal form of a production scheme.
pub(crate) enum Literal {
    Central(DenseScheme),
    Modal(DenseModal),
}

impl Literal {
    /// Makes the literal form at rest, with damping `ratio` for every mode and steps of `h`.
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

    /// Takes one step; `free_gap[sector·nodes + node]` is c − p at its end, `solve(W, g_p, λ)` the contact solver.
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

    /// Displacement in component `d` of one contact node of one sector.
    pub(crate) fn displacement(&self, sector: usize, node: usize, d: usize) -> f64 {
        match self {
            Self::Central(scheme) => scheme.contact_displacement(sector, node)[d],
            Self::Modal(scheme) => scheme.displacement(sector, node, d),
        }
    }

    /// Contact forces of the last step, sector by sector.
    pub(crate) fn forces(&self) -> &DVector<f64> {
        match self {
            Self::Central(scheme) => &scheme.lambda,
            Self::Modal(scheme) => &scheme.lambda,
        }
    }

    /// Number of steps in which something touched.
    pub(crate) fn contact_steps(&self) -> u64 {
        match self {
            Self::Central(scheme) => scheme.contact_steps,
            Self::Modal(scheme) => scheme.contact_steps,
        }
    }
}

/// Scheme x⁺ = now·x + before·x⁻ + kick·f in the displacements x of the modes with mass, u = x + flexibility·f.
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

impl DenseModal {
    /// Takes every mode by its exact propagator, those beyond [`FOLLOWS`] statically.
    fn exact(reduced: &ReducedWheel, wheel: &DenseWheel, ratio: f64, speed: f64, h: f64) -> Self {
        let carried = modal_projector(reduced, speed, &|_, omega| omega * h <= FOLLOWS);
        let propagator = Propagator::new(&(carried * &wheel.mass), wheel, ratio, h);
        Self::new(reduced, wheel, propagator, false)
    }

    /// Takes the `kept` lowest modes of every nodal diameter by their exact propagator, the rest statically.
    fn massless(
        reduced: &ReducedWheel,
        wheel: &DenseWheel,
        ratio: f64,
        speed: f64,
        h: f64,
        kept: usize,
    ) -> Self {
        let carried = modal_projector(reduced, speed, &|mode, _| mode < kept);
        let propagator = Propagator::new(&(carried * &wheel.mass), wheel, ratio, h);
        Self::new(reduced, wheel, propagator, true)
    }

    fn new(reduced: &ReducedWheel, wheel: &DenseWheel, propagator: Propagator, massless: bool) -> Self {
        let constraints = constraints(wheel, reduced);
        let Propagator { now, before, mut kick, rest } = propagator;
        if !massless {
            kick += &rest;
        }
        let kick = kick * &constraints;
        let flexibility = massless.then(|| rest * &constraints);
        let size = wheel.size();
        Self {
            now,
            before,
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
            // This is the equation of motion at the old time.
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

/// Propagator x⁺ = now·x + before·x⁻ + kick·f of M ẍ + D ẋ + K x = f within the carried modes, f constant over the
/// step, and the static answer of all others.
struct Propagator {
    now: DMatrix<f64>,
    before: DMatrix<f64>,
    kick: DMatrix<f64>,
    /// Flexibility K⁻¹ less its share in the carried modes.
    rest: DMatrix<f64>,
}

impl Propagator {
    /// Makes the propagator by the exponential of the first-order system in (x, hẋ), forwards and backwards: no mode
    /// and no frequency is looked at. `carried` projects on the carried modes.
    fn new(carried: &DMatrix<f64>, wheel: &DenseWheel, ratio: f64, h: f64) -> Self {
        let size = wheel.size();
        let one = DMatrix::identity(size, size);
        let mass = wheel.mass.clone().cholesky().expect("M_r is positive definite");
        let mut generator = DMatrix::zeros(2 * size, 2 * size);
        let mut place = |row, column, block: DMatrix<f64>| {
            generator.view_mut((row * size, column * size), (size, size)).copy_from(&block);
        };
        place(0, 1, one.clone());
        place(1, 0, carried * mass.solve(&wheel.stiffness) * (-h * h));
        place(1, 1, carried * mass.solve(&wheel.modal_damping(ratio)) * -h);
        let flow = |sign: f64| {
            let flow = (&generator * sign).exp();
            let block = |column| flow.view((0, column * size), (size, size)).into_owned();
            (block(0), block(1))
        };
        let ((ahead, ahead_by_speed), (back, back_by_speed)) = (flow(1.0), flow(-1.0));
        // x⁻ = back·x + back_by_speed·hẋ gives the velocity that x⁺ = ahead·x + ahead_by_speed·hẋ needs.
        let before =
            ahead_by_speed * back_by_speed.try_inverse().expect("carried modes turn by less than π a step");
        let now = (ahead - &before * back) * carried;
        let before = before * carried;
        let stiffness = wheel.stiffness.clone().cholesky().expect("K_r is positive definite");
        let flexibility = stiffness.inverse();
        let carried_flexibility = carried * &flexibility;
        // A steady force holds its static displacement.
        let kick = (&one - &now - &before) * &carried_flexibility;
        Self { now, before, kick, rest: flexibility - carried_flexibility }
    }
}

/// Projector ΦΦᵀ of the modes of the whole wheel that are `chosen` by their place within the nodal diameter and by ω.
fn modal_projector(reduced: &ReducedWheel, speed: f64, chosen: &dyn Fn(usize, f64) -> bool) -> DMatrix<f64> {
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
        let mut chosen_or_not = eigen.eigenvalues.clone();
        for (place, &column) in order.iter().enumerate() {
            let picked = chosen(place / copies, eigen.eigenvalues[column].sqrt());
            chosen_or_not[column] = if picked { 1.0 } else { 0.0 };
        }
        let modes = lower.transpose().solve_upper_triangular(&eigen.eigenvectors).unwrap();
        &modes * DMatrix::from_diagonal(&chosen_or_not) * modes.transpose()
    };
    let blocks: Vec<_> = reduced.harmonics.iter().map(block).collect();
    recompose(&blocks, reduced)
}
