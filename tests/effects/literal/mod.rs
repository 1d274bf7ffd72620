//! Literal model: the equations of a scene with effects, written out: real coordinates of all modes and all casing waves in
//! one vector, dense matrices, one linear system a step, forces sector by sector, contact by trying every combination.
//! Slow, and shares nothing with the production code but the types that describe a scene.

mod contact;
mod disc;
mod rods;

use std::f64::consts::{PI, TAU};

use faer::c64;
use nalgebra::{DMatrix, DVector, Dyn, LU, RowDVector};
use rubmap::dynamics::initial::InitialMode;
use rubmap::dynamics::modal_wheel::ModalWheel;
use rubmap::dynamics::schemes::Scheme;

use self::contact::Law;
use self::rods::Rods;
use crate::heights::height;
use crate::scene::{SPEED, Scene, sliding};

/// Part of a mode's complex amplitude.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Part {
    Real,
    Imaginary,
}

#[derive(Debug, Clone, Copy)]
struct Coordinate {
    harmonic: usize,
    family: usize,
    part: Part,
}

/// Literal model: the system and its state.
pub(crate) struct Literal<'a> {
    scene: &'a Scene,
    coordinates: Vec<Coordinate>,
    /// Contact DOF of all sectors (rows) from the wheel's coordinates, `[sector][node][component]`.
    displacement: DMatrix<f64>,
    /// Contact DOF of all sectors, moved by forces at the contact DOF through modes that follow statically.
    residual: DMatrix<f64>,
    /// Stiffness K of mistuning, over all coordinates.
    mistuning: DMatrix<f64>,
    /// Damping constants 2ζω m of all coordinates.
    damping: DVector<f64>,
    /// Energy that a step loses over (x⁺ − x⁻)², of all coordinates.
    loss: DVector<f64>,
    recursion: Recursion,
    now: DVector<f64>,
    before: DVector<f64>,
    rods: Option<Rods>,
    /// Sense of rotation: 1, or −1 for a wheel that turns towards −θ.
    sense: f64,
}

/// Recursion of a step: left·x⁺ = now·x + before·x⁻ + load f.
struct Recursion {
    left: LU<f64, Dyn, Dyn>,
    now: DMatrix<f64>,
    before: DMatrix<f64>,
    load: DVector<f64>,
}

/// Record of a run.
#[derive(Debug, Default)]
pub(crate) struct Record {
    /// Displacement, `[sensor][sample]`.
    pub(crate) displacement: Vec<Vec<f64>>,
    /// Impulse of contact, Σ λh.
    pub(crate) impulse: f64,
    /// Heat of friction, Σ μλ t_θ rΩh; of a disc Σ τ·v h.
    pub(crate) friction_heat: f64,
    /// Number of steps in which a node stuck, all nodes together.
    pub(crate) sticking: usize,
    pub(crate) excitation_work: f64,
    pub(crate) mistuning_work: f64,
    pub(crate) casing_work: f64,
    pub(crate) casing_loss: f64,
    pub(crate) contact_work: f64,
    /// Worn depths of the coating, `[rod][row]`.
    pub(crate) worn_depths: Vec<Vec<f64>>,
    /// Largest √(c² + s²) of any casing wave.
    pub(crate) casing_amplitude: f64,
}

/// Real coordinates of the first `families` modes, or of the others, of every nodal diameter.
fn coordinates(wheel: &ModalWheel, kept: impl Fn(usize) -> bool) -> Vec<Coordinate> {
    let mut all = Vec::new();
    for (harmonic, modes) in wheel.harmonics.iter().enumerate() {
        for family in (0..modes.omega.len()).filter(|&family| kept(family)) {
            all.push(Coordinate { harmonic, family, part: Part::Real });
            if !modes.single {
                all.push(Coordinate { harmonic, family, part: Part::Imaginary });
            }
        }
    }
    all
}

/// Displacements u_{s,d} = Σ_i Re(w_i e^{jisα} φ_d z_i) at every contact DOF of every sector.
fn displacements(wheel: &ModalWheel, coordinates: &[Coordinate]) -> DMatrix<f64> {
    let dofs = wheel.harmonics[0].contact.nrows();
    DMatrix::from_fn(wheel.sectors * dofs, coordinates.len(), |row, column| {
        let (sector, dof) = (row / dofs, row % dofs);
        let Coordinate { harmonic, family, part } = coordinates[column];
        weighted(wheel, harmonic, sector, part, wheel.harmonics[harmonic].contact[(dof, family)])
    })
}

/// Weighted share Re(w e^{jisα} φ z) of a mode for z = 1 or j.
fn weighted(wheel: &ModalWheel, harmonic: usize, sector: usize, part: Part, shape: c64) -> f64 {
    let n = wheel.sectors as f64;
    let weight = if wheel.harmonics[harmonic].single { (1.0 / n).sqrt() } else { (2.0 / n).sqrt() };
    let angle = TAU * (harmonic * sector) as f64 / n;
    let turned = c64::new(angle.cos(), angle.sin()) * shape;
    weight * if part == Part::Real { turned.re } else { -turned.im }
}

/// Stiffness of mistuning, from the strain energy ½ Σ δ_s a_s² of each family; a_s is what bends its blade in sector s: the
/// displacement of the first contact DOF relative to the family's shape, times ω.
fn mistuning_stiffness(scene: &Scene, coordinates: &[Coordinate], size: usize) -> DMatrix<f64> {
    let mut stiffness = DMatrix::zeros(size, size);
    let Some(deviations) = &scene.mistuning else { return stiffness };
    let wheel = &scene.wheel;
    let families = coordinates.iter().map(|c| c.family + 1).max().unwrap_or(0);
    let tuned = (0..families).find(|&family| !resolved(scene, family)).unwrap_or(families);
    for family in 0..tuned {
        let bent = |sector: usize| {
            RowDVector::from_fn(size, |_, column| match coordinates.get(column) {
                Some(c) if c.family == family => {
                    let modes = &wheel.harmonics[c.harmonic];
                    let blade = wheel.harmonics[0].contact[(0, family)].re;
                    weighted(wheel, c.harmonic, sector, c.part, modes.contact[(0, family)]) / blade
                        * modes.omega[family]
                }
                _ => 0.0,
            })
        };
        for (sector, delta) in deviations.iter().enumerate() {
            let row = bent(sector);
            stiffness += row.transpose() * &row * *delta;
        }
    }
    stiffness
}

/// Whether a step resolves a family of undamped modes: at most three quarters of the stability limit of central differences,
/// and with the exact propagator of the angle at which 2 sin(θ/2) is as large.
fn resolved(scene: &Scene, family: usize) -> bool {
    scene.wheel.harmonics.iter().all(|modes| {
        let angle = modes.omega[family] * scene.step_s();
        match scene.scheme {
            Scheme::CentralDifferences => angle * angle <= 3.0,
            _ if follows(scene, modes.omega[family]) => true,
            _ => angle <= 2.0 * PI / 3.0,
        }
    })
}

/// Gyroscopic matrix Ω G of the coordinates (a, b) of z = a + jb: g z = (g' a − g'' b) + j(g'' a + g' b).
fn gyroscopic(wheel: &ModalWheel, coordinates: &[Coordinate], size: usize) -> DMatrix<f64> {
    let mut matrix = DMatrix::zeros(size, size);
    for (row, to) in coordinates.iter().enumerate() {
        for (column, from) in coordinates.iter().enumerate() {
            let Some(g) = &wheel.harmonics[to.harmonic].gyroscopic else { continue };
            if to.harmonic != from.harmonic {
                continue;
            }
            let g = g[(to.family, from.family)];
            matrix[(row, column)] = wheel.speed_rad_s
                * match (to.part, from.part) {
                    (Part::Real, Part::Real) | (Part::Imaginary, Part::Imaginary) => g.re,
                    (Part::Real, Part::Imaginary) => -g.im,
                    (Part::Imaginary, Part::Real) => g.im,
                };
        }
    }
    assert_eq!(matrix, -matrix.transpose(), "Coriolis forces do no work");
    matrix
}

/// Whether modes of frequency `omega` follow statically where there is contact: those at the rhythm of the steps do.
fn follows(scene: &Scene, omega: f64) -> bool {
    scene.scheme == Scheme::ExactModal && scene.casing.is_some() && omega * scene.step_s() > 5.0 / 6.0 * PI
}

impl<'a> Literal<'a> {
    pub(crate) fn new(scene: &'a Scene) -> Self {
        let wheel = &scene.wheel;
        let kept = match scene.scheme {
            Scheme::MasslessBoundary { kept_modes } => kept_modes,
            Scheme::CentralDifferences | Scheme::ExactModal => usize::MAX,
        };
        let integrated = coordinates(wheel, |family| family < kept);
        let following = coordinates(wheel, |family| family >= kept);
        let follow = displacements(wheel, &following);
        let flexibility = DVector::from_iterator(
            following.len(),
            following.iter().map(|c| wheel.harmonics[c.harmonic].omega[c.family].powi(-2)),
        );
        let residual = &follow * DMatrix::from_diagonal(&flexibility) * follow.transpose();
        // ω, ζ and mass of the wheel's coordinates, then of cosine and sine of every casing wave.
        let mut numbers: Vec<(f64, f64, f64)> = integrated
            .iter()
            .map(|c| {
                let zeta = scene.damping.as_ref().map_or(0.0, |damping| {
                    damping.family_ratios.get(c.family).copied().unwrap_or(damping.modal_ratio)
                });
                (wheel.harmonics[c.harmonic].omega[c.family], zeta, 1.0)
            })
            .collect();
        if let Some(casing) = &scene.flexible_casing {
            for wave in &casing.waves {
                numbers.extend([(wave.omega, casing.damping_ratio, wave.modal_mass); 2]);
            }
        }
        let size = numbers.len();
        let mistuning = mistuning_stiffness(scene, &integrated, size);
        let coriolis = gyroscopic(wheel, &integrated, size);
        let h = scene.step_s();
        let diagonal = |of: &dyn Fn(&(f64, f64, f64)) -> f64| {
            DMatrix::from_diagonal(&DVector::from_iterator(size, numbers.iter().map(of)))
        };
        let (recursion, loss) = match scene.scheme {
            Scheme::CentralDifferences => {
                let mass = diagonal(&|&(_, _, m)| m / (h * h));
                let damping = diagonal(&|&(omega, zeta, m)| 2.0 * zeta * omega * m / (2.0 * h));
                let stiffness = diagonal(&|&(omega, _, m)| m * omega * omega) + &mistuning;
                // The loss is that of the velocity (x⁺ − x⁻)/2h for a time h.
                let loss = damping.diagonal() / 2.0;
                let swing = damping + &coriolis / (2.0 * h);
                let recursion = Recursion {
                    left: (&mass + &swing).lu(),
                    now: &mass * 2.0 - stiffness,
                    before: swing - mass,
                    load: DVector::from_element(size, 1.0),
                };
                (recursion, loss)
            }
            Scheme::ExactModal | Scheme::MasslessBoundary { .. } => {
                let decay = |omega: f64, zeta: f64| {
                    if follows(scene, omega) { 0.0 } else { (-zeta * omega * h).exp() }
                };
                let twice_cos = |omega: f64, zeta: f64| {
                    2.0 * decay(omega, zeta) * (omega * h * (1.0 - zeta * zeta).sqrt()).cos()
                };
                let moved = diagonal(&|&(omega, zeta, m)| {
                    (1.0 - twice_cos(omega, zeta) + decay(omega, zeta).powi(2)) / (m * omega * omega)
                });
                let remains = diagonal(&|&(omega, zeta, _)| decay(omega, zeta).powi(2));
                let turned = &moved * &coriolis / (2.0 * h);
                // x⁺ − 2 cos… x + a² x⁻ = b f times (x⁺ − x⁻)/2b: what is left beside differences of an energy.
                let loss = DVector::from_fn(size, |i, _| (1.0 - remains[(i, i)]) / (4.0 * moved[(i, i)]));
                let recursion = Recursion {
                    left: (DMatrix::identity(size, size) + &turned).lu(),
                    now: diagonal(&|&(omega, zeta, _)| twice_cos(omega, zeta)) - &moved * &mistuning,
                    before: turned - remains,
                    load: moved.diagonal(),
                };
                (recursion, loss)
            }
        };
        let mut this = Self {
            scene,
            displacement: displacements(wheel, &integrated),
            residual,
            damping: DVector::from_iterator(size, numbers.iter().map(|&(w, z, m)| 2.0 * z * w * m)),
            loss,
            mistuning,
            recursion,
            now: DVector::zeros(size),
            before: DVector::zeros(size),
            sense: 1.0,
            rods: scene.coating.map(|coating| Rods::new(coating, &scene.nodes)),
            coordinates: integrated,
        };
        this.start(&numbers, &coriolis);
        this
    }

    /// Model of the same scene with the wheel turning towards −θ.
    pub(crate) fn backwards(self) -> Self {
        Self { sense: -1.0, ..self }
    }

    /// Unit tangents of a contact node, both; the first is as near to e_θ as a tangent can be.
    fn tangents(&self, node: usize) -> [[f64; 3]; 2] {
        let n = self.scene.nodes[node].normal;
        let along = sliding(&self.scene.nodes[node], 1.0);
        let t = [0, 1, 2].map(|d| along[d] - n[d]);
        [t, [n[1] * t[2] - n[2] * t[1], n[2] * t[0] - n[0] * t[2], n[0] * t[1] - n[1] * t[0]]]
    }

    /// Directions of friction along the two tangents of all places, `[tangent][place]`, over the contact DOF.
    fn planes(&self) -> DMatrix<f64> {
        let nodes = self.scene.nodes.len();
        let places = self.scene.wheel.sectors * nodes;
        DMatrix::from_fn(2 * places, 3 * places, |row, column| {
            let place = row % places;
            if column / 3 == place { self.tangents(place % nodes)[row / places][column % 3] } else { 0.0 }
        })
    }

    /// Sets x(0) and x(−h) with the right velocity at 0.
    fn start(&mut self, numbers: &[(f64, f64, f64)], coriolis: &DMatrix<f64>) {
        let h = self.scene.step_s();
        let mut velocity = DVector::zeros(numbers.len());
        let (displacements, velocities) = self.initial();
        self.now.rows_mut(0, displacements.len()).copy_from(&displacements);
        velocity.rows_mut(0, velocities.len()).copy_from(&velocities);
        let force = self.excitation(0.0);
        let others = force - &self.mistuning * &self.now - coriolis * &velocity;
        for (row, &(omega, zeta, mass)) in numbers.iter().enumerate() {
            let (z, v) = (self.now[row], velocity[row]);
            self.before[row] = match self.scene.scheme {
                // It is x(0) − hẋ + ½h²ẍ, the only start from which (x⁺ − x⁻)/2h is ẋ.
                Scheme::CentralDifferences => {
                    let acceleration = others[row] / mass - 2.0 * zeta * omega * v - omega * omega * z;
                    z - h * v + 0.5 * h * h * acceleration
                }
                // Free motion backwards, and what the other forces add to it: z⁺ and z⁻ alike.
                Scheme::ExactModal | Scheme::MasslessBoundary { .. } => {
                    let damped = omega * (1.0 - zeta * zeta).sqrt();
                    let (sin, cos) = (damped * h).sin_cos();
                    let grown = (zeta * omega * h).exp();
                    let free = grown * (z * cos - (v + zeta * omega * z) / damped * sin);
                    let remains = if follows(self.scene, omega) { 0.0 } else { grown.powi(-2) };
                    free + self.recursion.load[row] / (1.0 + remains) * others[row]
                }
            };
        }
    }

    /// Forces of excitation Aᵢcos(k(sα + Ωt) + ψ) on the given directions of every sector, after `revolutions`.
    fn excitation(&self, revolutions: f64) -> DVector<f64> {
        let wheel = &self.scene.wheel;
        let dofs = 3 * self.scene.nodes.len();
        let mut force = DVector::zeros(wheel.sectors * dofs);
        for of in &self.scene.excitation {
            for sector in 0..wheel.sectors {
                let angle = TAU * (sector as f64 / wheel.sectors as f64 + revolutions);
                let along = of.amplitude * (f64::from(of.order) * angle + of.phase_rad).cos();
                for direction in &of.directions {
                    for d in 0..3 {
                        force[sector * dofs + 3 * direction.node + d] +=
                            along * direction.components[d] * growth(revolutions, of.ramp_revolutions);
                    }
                }
            }
        }
        let mut all = DVector::zeros(self.now.len());
        all.rows_mut(0, self.coordinates.len()).copy_from(&(self.displacement.transpose() * force));
        all
    }

    /// Angle of a contact node in the fixed frame.
    fn angle(&self, sector: usize, node: usize, revolutions: f64) -> f64 {
        self.scene.nodes[node].position[1]
            + TAU * (sector as f64 / self.scene.wheel.sectors as f64 + self.sense * revolutions)
    }

    /// Clearances c as they are then − p minus the orbit's share at every contact node of every sector.
    fn clearances(&self, revolutions: f64) -> DVector<f64> {
        let Some(casing) = &self.scene.casing else { return DVector::zeros(0) };
        let nodes = self.scene.nodes.len();
        DVector::from_fn(self.scene.wheel.sectors * nodes, |place, _| {
            let (sector, node) = (place / nodes, place % nodes);
            let angle = self.angle(sector, node, revolutions);
            let mut taken = casing.restriction.as_ref().map_or(0.0, |shape| height(shape, angle, node));
            if let Some(orbit) = &self.scene.orbit {
                // The axis is displaced by (x, y), of which the node's radial direction sees its share.
                let towards = TAU * orbit.whirl_ratio * revolutions + orbit.phase_rad;
                let (x, y) = (orbit.radius * towards.cos(), orbit.radius * towards.sin());
                taken += self.scene.nodes[node].normal[0] * (x * angle.cos() + y * angle.sin());
            }
            let mut clearance = casing.clearance[node];
            if let Some(change) = &self.scene.clearance_change {
                let mut from = (0.0, 0.0);
                let mut now = 0.0;
                for &to in &change.course {
                    if revolutions >= from.0 {
                        now = from.1 + (to.1 - from.1) * growth(revolutions - from.0, to.0 - from.0);
                    }
                    from = to;
                }
                clearance += now * change.along_chord.as_ref().map_or(1.0, |along| along[node]);
            }
            clearance - taken * growth(revolutions, casing.ramp_revolutions)
        })
    }

    /// Directions of all places along the normals (of displacement) or against the forces: over the contact DOF, and over
    /// the casing's waves, whose displacement opens the gap.
    fn directions(&self, revolutions: f64, mu: f64) -> (DMatrix<f64>, DMatrix<f64>) {
        let nodes = self.scene.nodes.len();
        let places = self.scene.wheel.sectors * nodes;
        let mut blades = DMatrix::zeros(places, 3 * places);
        let mut casing = DMatrix::zeros(places, self.now.len() - self.coordinates.len());
        for place in 0..places {
            let (sector, node) = (place / nodes, place % nodes);
            let components = sliding(&self.scene.nodes[node], mu);
            for d in 0..3 {
                blades[(place, 3 * place + d)] = components[d];
            }
            let angle = self.angle(sector, node, revolutions);
            for (w, wave) in self.scene.flexible_casing.iter().flat_map(|c| &c.waves).enumerate() {
                let radial = self.scene.nodes[node].normal[0];
                let turned = f64::from(wave.nodal_diameter) * angle;
                casing[(place, 2 * w)] = radial * turned.cos();
                casing[(place, 2 * w + 1)] = radial * turned.sin();
            }
        }
        (blades, casing)
    }

    /// Matrices of the wheel without contact as ẍ + Cẋ + Kx = Bᵀf, u = Bx: K, C with damping and Coriolis forces, and B.
    pub(crate) fn continuous(&self) -> (DMatrix<f64>, DMatrix<f64>, DMatrix<f64>) {
        let wheel = &self.scene.wheel;
        let stiffness = DVector::from_iterator(
            self.coordinates.len(),
            self.coordinates.iter().map(|c| wheel.harmonics[c.harmonic].omega[c.family].powi(2)),
        );
        let coriolis = gyroscopic(wheel, &self.coordinates, self.coordinates.len());
        (
            DMatrix::from_diagonal(&stiffness) + &self.mistuning,
            DMatrix::from_diagonal(&self.damping) + coriolis,
            self.displacement.clone(),
        )
    }

    /// Initial state: x(0) and ẋ(0).
    pub(crate) fn initial(&self) -> (DVector<f64>, DVector<f64>) {
        let of = |which: fn(&InitialMode) -> c64| {
            DVector::from_iterator(
                self.coordinates.len(),
                self.coordinates.iter().map(|c| {
                    let modes = self.scene.initial.iter();
                    let moving = modes.filter(|m| (m.harmonic, m.family) == (c.harmonic, c.family));
                    moving.map(|m| if c.part == Part::Real { which(m).re } else { which(m).im }).sum()
                }),
            )
        };
        (of(|mode| mode.displacement), of(|mode| mode.velocity))
    }

    /// Integrates the scene.
    pub(crate) fn run(mut self) -> Record {
        let scene = self.scene;
        let (nodes, h) = (scene.nodes.len(), scene.step_s());
        let wheel_size = self.coordinates.len();
        let mu = scene.friction.unwrap_or(0.0);
        // These are the directions of tips that slide forwards.
        let forward_mu = if scene.disc { 0.0 } else { mu };
        let planes = self.planes();
        let massless = matches!(scene.scheme, Scheme::MasslessBoundary { .. });
        let mut record = Record { displacement: vec![Vec::new(); scene.sensors.len()], ..Record::default() };
        let places = if scene.casing.is_some() { scene.wheel.sectors * nodes } else { 0 };
        // Forces on all coordinates and at the contact DOF that act through the next step (boundary without mass).
        let mut acting = DVector::zeros(self.now.len());
        for step in 1..=scene.steps * scene.revolutions {
            let revolutions = step as f64 / scene.steps as f64;
            let excitation = self.excitation((step - 1) as f64 / scene.steps as f64);
            let Recursion { left, now, before, load } = &self.recursion;
            let known = &excitation + if massless { acting.clone() } else { DVector::zeros(acting.len()) };
            let right = now * &self.now + before * &self.before + load.component_mul(&known);
            let mut next = left.solve(&right).unwrap();
            let mut contact = if massless { acting.clone() } else { DVector::zeros(acting.len()) };
            let mut follows = DVector::zeros(self.displacement.nrows());
            if places > 0 {
                let (normals, casing) = self.directions(revolutions, 0.0);
                let (against, _) = self.directions(revolutions, forward_mu);
                let reading = |next: &DVector<f64>| {
                    &normals * &self.displacement * next.rows(0, wheel_size)
                        - &casing * next.rows(wheel_size, next.len() - wheel_size)
                };
                let gap = self.clearances(revolutions) - reading(&next);
                // Forces of λ on all coordinates.
                let mut forces = DMatrix::zeros(next.len(), places);
                forces.rows_mut(0, wheel_size).copy_from(&-(&against * &self.displacement).transpose());
                forces.rows_mut(wheel_size, next.len() - wheel_size).copy_from(&casing.transpose());
                let mut lambda = DVector::zeros(places);
                // Forces of a disc on all coordinates.
                let mut rubbing = DVector::zeros(next.len());
                if gap.iter().any(|&g| g < 0.0) {
                    let w = if massless {
                        &normals * &self.residual * against.transpose()
                    } else {
                        let moved = left.solve(&(DMatrix::from_diagonal(load) * &forces)).unwrap();
                        DMatrix::from_columns(
                            &(0..places).map(|p| -reading(&moved.column(p).into_owned())).collect::<Vec<_>>(),
                        )
                    };
                    let rod = |rods: &Rods, place: usize| {
                        rods.at(self.angle(place / nodes, place % nodes, revolutions))
                    };
                    if scene.disc {
                        let sheared = &planes * &self.displacement;
                        let swing = &sheared * (&next - &self.before).rows(0, wheel_size);
                        let free = DVector::from_fn(2 * places, |row, _| {
                            let node = &scene.nodes[row % places % nodes];
                            let passes = self.sense * SPEED * node.position[0] * 2.0 * h;
                            swing[row]
                                + if row < places { passes * self.tangents(row % nodes)[0][1] } else { 0.0 }
                        });
                        let mut all = DMatrix::zeros(next.len(), 3 * places);
                        all.columns_mut(0, places).copy_from(&forces);
                        all.view_mut((0, places), (wheel_size, 2 * places)).copy_from(&-sheared.transpose());
                        let moved = left.solve(&(DMatrix::from_diagonal(load) * &all)).unwrap();
                        let mut w = DMatrix::zeros(3 * places, 3 * places);
                        for column in 0..3 * places {
                            let moved = moved.column(column).into_owned();
                            w.view_mut((0, column), (places, 1)).copy_from(&-reading(&moved));
                            let sheared = &sheared * moved.rows(0, wheel_size);
                            w.view_mut((places, column), (2 * places, 1)).copy_from(&-sheared);
                        }
                        let (found, friction) = disc::solve(&w, &gap, &free, mu);
                        let sliding = free - w.rows(places, 2 * places) * all_forces(&found, &friction);
                        record.friction_heat += 0.5 * friction.dot(&sliding);
                        record.sticking += (0..places)
                            .filter(|&place| {
                                let size = friction[place].hypot(friction[places + place]);
                                found[place] > 0.0 && size < mu * found[place] * (1.0 - 1e-9)
                            })
                            .count();
                        rubbing = all.columns(places, 2 * places) * &friction;
                        lambda = found;
                    } else {
                        lambda = contact::solve(&w, &gap, |place| match &self.rods {
                            Some(rods) => rods.law(rod(rods, place), place % nodes),
                            None => Law::wall(),
                        });
                    }
                    let angles: Vec<_> = (0..places)
                        .map(|place| self.angle(place / nodes, place % nodes, revolutions))
                        .collect();
                    if let Some(rods) = &mut self.rods {
                        for (place, angle) in angles.into_iter().enumerate() {
                            rods.press(rods.at(angle), place % nodes, lambda[place]);
                        }
                    }
                }
                for (place, force) in lambda.iter().enumerate() {
                    let node = &scene.nodes[place % nodes];
                    let forward = sliding(node, forward_mu)[1] - node.normal[1];
                    record.impulse += force * h;
                    record.friction_heat += force * forward * node.position[0] * SPEED * h;
                }
                let now = forces * &lambda + rubbing;
                if massless {
                    acting = now;
                    follows = -(&self.residual * against.transpose() * &lambda);
                } else {
                    next += left.solve(&load.component_mul(&now)).unwrap();
                    contact = now;
                }
            }
            self.count(&next, &excitation, &contact, &mut record);
            self.before = std::mem::replace(&mut self.now, next);
            if step.is_multiple_of(scene.steps / scene.samples) {
                let moved = &self.displacement * self.now.rows(0, wheel_size) + &follows;
                for (line, sensor) in record.displacement.iter_mut().zip(&scene.sensors) {
                    let first = 3 * (sensor.sector * nodes + sensor.direction.node);
                    line.push((0..3).map(|d| sensor.direction.components[d] * moved[first + d]).sum());
                }
            }
        }
        record.worn_depths = self.rods.map_or(Vec::new(), |rods| rods.depth);
        record
    }

    /// Counts the work of a step: force times half of x⁺ − x⁻.
    fn count(
        &self,
        next: &DVector<f64>,
        excitation: &DVector<f64>,
        contact: &DVector<f64>,
        record: &mut Record,
    ) {
        let swing = next - &self.before;
        let (wheel, casing) = (self.coordinates.len(), next.len() - self.coordinates.len());
        record.excitation_work += 0.5 * excitation.dot(&swing);
        record.mistuning_work -= 0.5 * swing.dot(&(&self.mistuning * &self.now));
        record.contact_work += 0.5 * contact.rows(0, wheel).dot(&swing.rows(0, wheel));
        record.casing_work += 0.5 * contact.rows(wheel, casing).dot(&swing.rows(wheel, casing));
        for row in wheel..next.len() {
            record.casing_loss += self.loss[row] * swing[row].powi(2);
        }
        for wave in next.rows(wheel, casing).as_slice().chunks_exact(2) {
            record.casing_amplitude = record.casing_amplitude.max(wave[0].hypot(wave[1]));
        }
    }
}

/// Forces of all kinds in one vector: normal forces, then friction.
fn all_forces(lambda: &DVector<f64>, friction: &DVector<f64>) -> DVector<f64> {
    DVector::from_iterator(lambda.len() + friction.len(), lambda.iter().chain(friction.iter()).copied())
}

/// Growth of the ramp, x²(3 − 2x) up to 1.
fn growth(revolutions: f64, ramp_revolutions: f64) -> f64 {
    if revolutions >= ramp_revolutions {
        return 1.0;
    }
    let x = revolutions / ramp_revolutions;
    x * x * (3.0 - 2.0 * x)
}
