//! Second-order bending against CalculiX, `NLGEOM`: static load curves and free vibration.
//!
//! Material and element are the same in both: CalculiX's linear elastic material under `NLGEOM` is that of Green–Lagrange strain, too, and its C3D20 has
//! the points of ours.

use std::fmt::Write as _;
use std::process::Command;

use faer::{ColRef, MatMut};
use nalgebra::Vector3;

use super::condense::condense;
use super::modes::lowest_modes;
use super::sector::HeldSector;
use super::tests::plate;
use rubmap_numerics::sparse_cholesky::SparseCholesky;
use rubmap_solid::element::ElementKind;
use rubmap_solid::mesh::SectorMesh;
use rubmap_wheel::dynamics::nodes::SectorNode;

/// Deck of a clamped mesh, its nodes in the set NALL.
fn deck(mesh: &SectorMesh, nodes: &[SectorNode]) -> String {
    let mut deck = String::from("*NODE, NSET=NALL\n");
    for node in nodes {
        let [x, y, z] = node.position;
        writeln!(deck, "{}, {x:.12e}, {y:.12e}, {z:.12e}", node.id).unwrap();
    }
    writeln!(deck, "*ELEMENT, TYPE={}, ELSET=EALL", mesh.elements[0].kind.name()).unwrap();
    for element in &mesh.elements {
        let of_nodes = element.nodes.iter().map(|&node| nodes[node as usize].id);
        let numbers: Vec<_> = std::iter::once(element.id).chain(of_nodes).map(|id| id.to_string()).collect();
        let lines: Vec<_> = numbers.chunks(11).map(|line| line.join(", ")).collect();
        writeln!(deck, "{}", lines.join(",\n")).unwrap();
    }
    let material = &mesh.sets[0].material;
    let [young, poisson] = [material.youngs_modulus, material.poissons_ratio];
    writeln!(deck, "*MATERIAL, NAME=M\n*ELASTIC\n{young:e}, {poisson:e}").unwrap();
    writeln!(deck, "*DENSITY\n{:e}\n*SOLID SECTION, ELSET=EALL, MATERIAL=M", material.density).unwrap();
    deck += "*BOUNDARY\n";
    for node in nodes.iter().filter(|node| node.dofs.iter().all(Option::is_none)) {
        writeln!(deck, "{}, 1, 3", node.id).unwrap();
    }
    deck
}

/// Displacements of all nodes.
type Field = Vec<Vector3<f64>>;

/// Clamped mesh under a load.
struct Loaded {
    mesh: SectorMesh,
    nodes: Vec<SectorNode>,
    sector: HeldSector,
    /// Load on the free displacements.
    load: Vec<f64>,
}

/// Residual and correction at which an increment has converged, far below CalculiX's own 0.5 % and 1 %.
const CONVERGED: &str = "*CONTROLS, PARAMETERS=FIELD\n1.E-7, 1.E-5\n";

/// End of a step: displacements of all nodes are printed after every increment.
const PRINT: &str = "*NODE PRINT, NSET=NALL\nU\n*END STEP\n";

impl Loaded {
    /// Mesh without a load.
    fn new(mesh: SectorMesh, nodes: Vec<SectorNode>) -> Self {
        let sector = HeldSector::new(&mesh, &nodes).unwrap();
        let load = vec![0.0; sector.rows.len()];
        Self { mesh, nodes, sector, load }
    }

    /// Work of the load on a field.
    fn work(&self, field: &[Vector3<f64>]) -> f64 {
        self.load.iter().zip(self.sector.gathered(field)).map(|(f, u)| f * u).sum()
    }

    /// Part of a step that applies so many times the load. CalculiX reads 20 characters of a number.
    fn concentrated(&self, times: f64) -> String {
        let mut lines = String::from("*CLOAD\n");
        for (&(node, along), &force) in self.sector.rows.iter().zip(&self.load) {
            if force != 0.0 {
                writeln!(lines, "{}, {}, {:.12e}", node + 1, along.imax() + 1, times * force).unwrap();
            }
        }
        lines
    }

    /// Step in which so many times the load act on a linear mesh.
    fn linear_step(&self, times: f64) -> String {
        format!("*STEP\n*STATIC\n{}{PRINT}", self.concentrated(times))
    }

    /// Step in which the load grows to so many times itself in equal increments. It writes energies, without which no `*DYNAMIC` may follow.
    fn static_step(&self, times: f64, increments: u32) -> String {
        let first = 1.0 / f64::from(increments);
        let forces = self.concentrated(times);
        format!("*STEP, NLGEOM\n*STATIC, DIRECT\n{first}, 1.\n{CONVERGED}{forces}*EL FILE\nENER\n{PRINT}")
    }

    /// Runs CalculiX with `steps`; returns the field after every increment, or `None`, with a printed reason, without CalculiX.
    fn calculix(&self, steps: &str) -> Option<Vec<Field>> {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("blade.inp"), deck(&self.mesh, &self.nodes) + steps).unwrap();
        let mut command = Command::new("ccx");
        command.args(["-i", "blade"]).current_dir(folder.path()).env("OMP_NUM_THREADS", "1");
        match command.output() {
            Ok(output) => assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stdout)),
            Err(error) => {
                eprintln!("skipped: CalculiX (`ccx`, package calculix-ccx) cannot be run: {error}");
                return None;
            }
        }
        let mut fields: Vec<Field> = Vec::new();
        for line in std::fs::read_to_string(folder.path().join("blade.dat")).unwrap().lines() {
            let words: Vec<&str> = line.split_whitespace().collect();
            if line.contains("displacements (vx,vy,vz)") {
                fields.push(vec![Vector3::zeros(); self.nodes.len()]);
            } else if let [node, u @ ..] = &words[..] {
                let node: usize = node.parse().unwrap();
                let u = u.iter().map(|u| u.parse::<f64>().unwrap());
                fields.last_mut().unwrap()[node - 1] = Vector3::from_iterator(u);
            }
        }
        Some(fields)
    }
}

/// Bending in the one shape Ψ = K⁻¹f of a load, in its size with fᵀΨ = 1: u = Ψp + v p², V = B p³ + ½ A p⁴, T = 2 C pṗ² + 2 Γ p²ṗ². The load does no
/// work on v, so that p = fᵀu.
#[derive(Clone)]
struct Bent {
    shape: Field,
    second_order: Field,
    stiffness: f64,
    cubic: f64,
    quartic: f64,
    /// Inertia Γ = vᵀMv of the displacement of second order.
    inertia: f64,
}

impl Bent {
    fn new(loaded: &Loaded) -> Self {
        let sector = &loaded.sector;
        let factor = SparseCholesky::new(&sector.symbolic, &sector.stiffness).unwrap();
        let mut moved = loaded.load.clone();
        let rows = moved.len();
        factor.solve_in_place(MatMut::from_column_major_slice_mut(&mut moved, rows, 1));
        let moved = sector.spread(&moved);
        let stiffness = 1.0 / loaded.work(&moved);
        let shape: Field = moved.into_iter().map(|u| u * stiffness).collect();
        let mut condensed = condense(sector, &factor, std::slice::from_ref(&shape));
        let [up, down] = [1.0, -1.0].map(|p| condensed.potential.energy(&[p]));
        let kinetic = [1.0, -1.0].map(|p| condensed.inertia.kinetic_energy(&[p], &[1.0]));
        let inertia = 0.25 * (kinetic[0] + kinetic[1]);
        let second_order = condensed.second_order.remove(0);
        Self { shape, second_order, stiffness, cubic: 0.5 * (up - down), quartic: up + down, inertia }
    }

    /// Multiple of the load that holds p.
    fn load(&self, p: f64) -> f64 {
        p * (self.stiffness + p * (3.0 * self.cubic + p * 2.0 * self.quartic))
    }

    /// p under so many times the load, by Newton's method.
    fn under(&self, times: f64) -> f64 {
        let mut p = times / self.stiffness;
        for _ in 0..20 {
            p -= (self.load(p) - times) / (self.stiffness + p * (6.0 * self.cubic + p * 6.0 * self.quartic));
        }
        p
    }

    /// Displacements at p.
    fn at(&self, p: f64) -> Field {
        self.shape.iter().zip(&self.second_order).map(|(shape, v)| shape * p + v * (p * p)).collect()
    }

    /// Period of the free vibration between p and −p of the shape with this mass, without a cubic part: 4 ∫ dp/ṗ over p sin φ.
    fn period(&self, p: f64, mass: f64) -> f64 {
        let points = 1000;
        let slowness = |k: usize| {
            let now = p * (std::f64::consts::FRAC_PI_2 * (k as f64 + 0.5) / points as f64).sin();
            let mass = mass + 4.0 * self.inertia * now * now;
            (mass / (self.stiffness + self.quartic * (p * p + now * now))).sqrt()
        };
        std::f64::consts::TAU * (0..points).map(slowness).sum::<f64>() / points as f64
    }
}

/// Differences of p under equal parts of `times` the load from CalculiX's, over CalculiX's: of the model, and of what is linear in the load.
fn differences(loaded: &Loaded, bent: &Bent, times: f64, curve: &[Field]) -> Vec<[f64; 2]> {
    let of = |(increment, field): (usize, &Field)| {
        let now = times * (increment + 1) as f64 / curve.len() as f64;
        let expected = loaded.work(field);
        let off = [bent.under(now), now / bent.stiffness].map(|found| found / expected - 1.0);
        println!("p {expected:.4} mm: off {:.1e}, linear {:.1e}", off[0], off[1]);
        off
    };
    curve.iter().enumerate().map(of).collect()
}

/// Asserts that linear statics are those of CalculiX, but for the digits that it prints.
fn assert_linear_statics(bent: &Bent, found: &Field) {
    let off = bent.shape.iter().zip(found).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    println!("linear: off {off:.1e}");
    assert!(off < 2e-6, "{off:e}");
}

/// Height of the blade along x.
const HEIGHT: f64 = 20.0;

/// Blade of 20 × 12 × 0.8 mm whose surface rises by so much along and across it, under a load of one in all on its tip, along z: p is the mean
/// deflection of the tip.
fn blade([along, across]: [f64; 2]) -> Loaded {
    let width = 12.0;
    let (mut mesh, mut nodes) = plate(ElementKind::C3D20, [HEIGHT, width, 0.8], [8, 4], false);
    mesh.sets[0].material.poissons_ratio = 0.3;
    for (place, node) in mesh.nodes.iter_mut().zip(&mut nodes) {
        let [x, y, _] = *place;
        place[2] += along * (x / HEIGHT).powi(2) + across * (2.0 * y / width - 1.0).powi(2);
        node.position = *place;
    }
    let mut loaded = Loaded::new(mesh, nodes);
    let tip = tip(&loaded.nodes);
    for (force, (node, along)) in loaded.load.iter_mut().zip(&loaded.sector.rows) {
        if tip.contains(&(*node as usize)) {
            *force = along.z / tip.len() as f64;
        }
    }
    loaded
}

/// Nodes of the blade's tip.
fn tip(nodes: &[SectorNode]) -> Vec<usize> {
    (0..nodes.len()).filter(|&node| nodes[node].position[0] > HEIGHT - 1e-9).collect()
}

#[test]
fn blades_follow_their_load_curves_to_a_tenth_of_their_height() {
    // A flat blade, whose remainder is of even orders alone, and one that is curved along and across, loaded from either side.
    for (rise, directions, of_foreshortening) in
        [([0.0, 0.0], &[1.0][..], 0.005), ([2.0, 1.0], &[1.0, -1.0], 0.04)]
    {
        let loaded = blade(rise);
        let bent = Bent::new(&loaded);
        let Some(linear) = loaded.calculix(&loaded.linear_step(bent.stiffness)) else { return };
        assert_linear_statics(&bent, &linear[0]);
        let tip = tip(&loaded.nodes);
        // Mean displacement of second order along the blade.
        let drawn = |field: &Field, p: f64| {
            tip.iter().map(|&node| field[node].x - bent.shape[node].x * p).sum::<f64>()
        };
        for direction in directions {
            let times = bent.load(direction * 0.1 * HEIGHT);
            let curve = loaded.calculix(&loaded.static_step(times, 8)).unwrap();
            let deflection = differences(&loaded, &bent, times, &curve);
            let foreshortening: Vec<f64> = curve
                .iter()
                .map(|field| {
                    let p = loaded.work(field);
                    drawn(&bent.at(p), p) / drawn(field, p) - 1.0
                })
                .collect();
            println!("{rise:?}: foreshortening off {foreshortening:.5?}");
            let [[half, _], [full, linear]] = [3, 7].map(|at| deflection[at].map(f64::abs));
            assert!(full < 3e-3 && linear > 1e-2 && linear > 10.0 * full, "{rise:?}: {full:e} {linear:e}");
            // What is left of p falls with its third power at least, what is left of foreshortening with p.
            assert!(half < full / 4.0, "{rise:?}: {half:e} {full:e}");
            let [first, last] = [0, 7].map(|at| foreshortening[at].abs());
            assert!(last < of_foreshortening && first < last / 5.0, "{rise:?}: {first:e} {last:e}");
        }
    }
}

/// Thickness of the strip.
const THICKNESS: f64 = 1.0;

/// Strip under the inertia of its lowest mode, clamped at one end or both, so that Ψ is this mode: p is the deflection in it of its free end, or of
/// its middle. Returns its modal mass, too.
fn strip(size: [f64; 3], both_ends: bool) -> (Loaded, f64) {
    let (mesh, nodes) = plate(ElementKind::C3D20, size, [10, 1], both_ends);
    let mut loaded = Loaded::new(mesh, nodes);
    let sector = &loaded.sector;
    let factor = SparseCholesky::new(&sector.symbolic, &sector.stiffness).unwrap();
    let modes = lowest_modes(&factor, &sector.mass, 1).unwrap();
    let measured = [size[0] * if both_ends { 0.5 } else { 1.0 }, 0.0, 0.0];
    let measured = loaded.nodes.iter().position(|node| node.position == measured).unwrap();
    let measured = sector.spread(modes.col_as_slice(0))[measured].z;
    let mode: Vec<f64> = modes.col_as_slice(0).iter().map(|u| u / measured).collect();
    let inertia = &sector.mass * ColRef::from_slice(&mode);
    let mass: f64 = inertia.iter().zip(&mode).map(|(f, u)| f * u).sum();
    loaded.load = inertia.iter().map(|f| f / mass).collect();
    (loaded, mass)
}

/// Strip of this thickness that is clamped at both ends.
fn clamped_strip() -> (Loaded, f64) {
    strip([100.0, 2.0, THICKNESS], true)
}

#[test]
fn a_strip_clamped_at_both_ends_follows_its_load_curve_to_its_thickness() {
    let (loaded, _) = clamped_strip();
    let bent = Bent::new(&loaded);
    let Some(linear) = loaded.calculix(&loaded.linear_step(bent.stiffness)) else { return };
    assert_linear_statics(&bent, &linear[0]);
    let times = bent.load(THICKNESS);
    let curve = loaded.calculix(&loaded.static_step(times, 8)).unwrap();
    let off = differences(&loaded, &bent, times, &curve);
    let [[early, _], [full, linear]] = [1, 7].map(|at| off[at].map(f64::abs));
    assert!(full < 0.01 && linear > 0.5, "{full:e} {linear:e}");
    // At 0.39 of the thickness; what is left falls with the fourth power.
    assert!(early < full / 10.0, "{early:e} {full:e}");
}

/// Deflection at the beginning of a free vibration from rest at `amplitude`, and its period by CalculiX in steps of a hundredth of the linear one,
/// or `None`, with a printed reason, without CalculiX.
fn vibration(loaded: &Loaded, bent: &Bent, mass: f64, amplitude: f64) -> Option<(f64, f64)> {
    let linear = bent.period(0.0, mass);
    let (step, increments) = (linear / 100.0, 4);
    let release = format!(
        "*STEP, NLGEOM, INC=100\n*DYNAMIC, DIRECT, ALPHA=0.\n{step:.12e}, {:.12e}\n{CONVERGED}*CLOAD, OP=NEW\n{PRINT}",
        0.8 * linear
    );
    let held = loaded.static_step(bent.load(amplitude), increments);
    let fields = loaded.calculix(&(held + &release))?;
    // From rest at the end of the static step.
    let p: Vec<f64> = fields[increments as usize - 1..].iter().map(|field| loaded.work(field)).collect();
    let crosses = |at: &usize| p[*at] * p[at + 1] < 0.0;
    let crossings: Vec<f64> =
        (0..p.len() - 1).filter(crosses).map(|at| at as f64 + p[at] / (p[at] - p[at + 1])).collect();
    Some((p[0], 2.0 * step * (crossings[1] - crossings[0])))
}

#[test]
fn a_strip_clamped_at_both_ends_vibrates_faster_the_farther_it_bends() {
    let (loaded, mass) = clamped_strip();
    let bent = Bent::new(&loaded);
    assert!(bent.cubic.abs() < 1e-9 * bent.quartic, "{:e} {:e}", bent.cubic, bent.quartic);
    // Over thickness: amplitude, difference that is allowed, and what linear theory is off by at least. At the smallest one
    // the period is linear and CalculiX's longer by (2π/100)²/12 = 3.3e-4, for its step.
    for (amplitude, allowed, of_linear) in [(0.02, 5e-4, 0.0), (0.5, 0.003, 0.05), (1.0, 0.01, 0.2)] {
        let Some((p, expected)) = vibration(&loaded, &bent, mass, amplitude * THICKNESS) else { return };
        let off = [bent.period(p, mass), bent.period(0.0, mass)].map(|period| period / expected - 1.0);
        println!("p {p:.4} mm: period off {:.1e}, linear {:.1e}", off[0], off[1]);
        assert!(off[0].abs() < allowed && off[1].abs() > of_linear, "{amplitude}: {off:?}");
    }
}

#[test]
fn a_cantilever_vibrates_as_its_tip_is_drawn_back() {
    // Stiffening alone would shorten the period, the inertia of what draws back makes up for it.
    let (loaded, mass) = strip([60.0, 2.0, 1.0], false);
    let bent = Bent::new(&loaded);
    let stiffer = Bent { inertia: 0.0, ..bent.clone() };
    // CalculiX's own period is longer by 3.3e-4 for its step, at every amplitude.
    for amplitude in [0.5, 6.0, 12.0] {
        let Some((p, expected)) = vibration(&loaded, &bent, mass, amplitude) else { return };
        let off = bent.period(p, mass) / expected - 1.0;
        let without = stiffer.period(p, mass) / expected - 1.0;
        let linear = bent.period(0.0, mass) / expected - 1.0;
        println!("p {p:.4} mm: period off {off:.1e}, without inertia {without:.1e}, linear {linear:.1e}");
        assert!(off.abs() < 5e-4, "{amplitude}: {off}");
        assert!(amplitude < 1.0 || without.abs() > 4.0 * off.abs(), "{amplitude}: {off} {without}");
    }
}
