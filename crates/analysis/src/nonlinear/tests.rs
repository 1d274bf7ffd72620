//! Relaxation against a non-linear static solution, closed forms, and its own limits.

use std::collections::HashMap;

use faer::linalg::solvers::Solve;
use faer::{Col, ColRef, Mat, c64};
use nalgebra::Vector3;

use super::condense::{Condensed, condense, held};
use super::relax::{NotRelaxed, Relaxation};
use super::sector::HeldSector;
use rubmap_solid::element::ElementKind;
use rubmap_solid::green_lagrange::BUBBLES;
use rubmap_solid::material::Material;
use rubmap_solid::mesh::{Element, ElementSet, SectorMesh};
use rubmap_solid::topology::Topology;
use rubmap_wheel::dynamics::bending::EnergyForm;
use rubmap_wheel::dynamics::bending::backbone::{Backbone, BackboneEnd, FreeMode, FreeModes, FreeWheel};
use rubmap_wheel::dynamics::nodes::{NodeDof, SectorNode};

const YOUNG: f64 = 100e3;

/// Strip as of [`plate`], one element across.
fn strip(kind: ElementKind, size: [f64; 3], count: usize, both_ends: bool) -> (SectorMesh, Vec<SectorNode>) {
    plate(kind, size, [count, 1], both_ends)
}

/// Plate of so many elements along x and across along y, one through its thickness along z; clamped at x = 0 and, if asked for, at its other end.
pub(super) fn plate(
    kind: ElementKind,
    [length, width, thickness]: [f64; 3],
    [count, across]: [usize; 2],
    both_ends: bool,
) -> (SectorMesh, Vec<SectorNode>) {
    let mut found: HashMap<[usize; 3], u32> = HashMap::new();
    let mut nodes: Vec<[f64; 3]> = Vec::new();
    let mut elements = Vec::new();
    for k in 0..count * across {
        let first = [2 * (k / across), 2 * (k % across), 0];
        let place = |xi: &[f64; 3]| {
            let lattice = [0, 1, 2].map(|d| first[d] + (xi[d] + 1.0) as usize);
            *found.entry(lattice).or_insert_with(|| {
                let [x, y, z] = lattice.map(|at| at as f64 / 2.0);
                nodes.push([x * length / count as f64, y * width / across as f64, z * thickness]);
                nodes.len() as u32 - 1
            })
        };
        let element_nodes = Topology::of(kind).nodes().iter().map(place).collect();
        elements.push(Element { id: k as u64 + 1, kind, set: 0, nodes: element_nodes });
    }
    let material = Material {
        youngs_modulus: YOUNG,
        poissons_ratio: 0.0,
        density: 5e-9,
        yield_strength: None,
        ultimate_strength: None,
        fatigue_strength: None,
    };
    let mut own = 0;
    let sector_node = |(index, &position): (usize, &[f64; 3])| {
        let clamped = position[0] == 0.0 || both_ends && (position[0] / length - 1.0).abs() < 1e-12;
        let mut dof = |k: usize| {
            let mut components = [0.0; 3];
            components[k] = 1.0;
            own += 1;
            NodeDof { dof: own - 1, components }
        };
        let dofs = [0, 1, 2].map(|k| (!clamped).then(|| dof(k)));
        // At θ = 0 the directions r, θ, z are x, y, z.
        let coordinates = [position[0], 0.0, position[2]];
        let contact = (position == [length, 0.0, 0.0]).then_some(0);
        SectorNode { id: index as u64 + 1, position, coordinates, dofs, on_high_face: false, contact }
    };
    let sector_nodes = nodes.iter().enumerate().map(sector_node).collect();
    let mesh = SectorMesh {
        sectors: 1,
        node_ids: (1..=nodes.len() as u64).collect(),
        nodes,
        axis: ([0.0; 3], [0.0, 0.0, 1.0]),
        cyclic: Vec::new(),
        elements,
        sets: vec![ElementSet { name: "STRIP".to_owned(), material }],
    };
    (mesh, sector_nodes)
}

/// Field of a mode, its largest displacement `amplitude`.
fn mode(sector: &HeldSector, relaxation: &Relaxation<'_>, mode: usize, amplitude: f64) -> Vec<Vector3<f64>> {
    let shape: Vec<f64> = relaxation.modes().col(mode).iter().copied().collect();
    let field = sector.spread(&shape);
    let largest = field.iter().map(|u| u.norm()).fold(0.0, f64::max);
    field.iter().map(|u| u * (amplitude / largest)).collect()
}

/// Modes that bend out of the plane, lowest first.
fn out_of_plane(sector: &HeldSector, relaxation: &Relaxation<'_>) -> Vec<usize> {
    let bends = |&mode: &usize| {
        let shape: Vec<f64> = relaxation.modes().col(mode).iter().copied().collect();
        let sums = sector
            .spread(&shape)
            .iter()
            .fold([0.0; 2], |[out, all], u| [out + u.z * u.z, all + u.norm_squared()]);
        sums[0] > 0.9 * sums[1]
    };
    (0..relaxation.modes().ncols()).filter(bends).collect()
}

/// Non-linear static solution by Newton's method on all unknowns (v, β) and the multipliers of the held modes, the load in steps; the
/// tangent by differences that are exact for a cubic force. Energy V(u + v, β).
fn converged(sector: &HeldSector, modes: &Mat<f64>, field: &[Vector3<f64>]) -> f64 {
    let rows = sector.rows.len();
    let bubbles = if sector.elements.iter().any(|(_, element)| element.has_bubbles()) { 9 } else { 0 };
    let size = rows + bubbles * sector.elements.len();
    let held = &sector.stiffness * modes;
    // The system below has no loads: K u does no work on what is not held.
    let count = held.ncols();
    let split = |x: &[f64], scale: f64| {
        let moved = sector.spread(&x[..rows]);
        let full: Vec<Vector3<f64>> = field.iter().zip(&moved).map(|(u, v)| u * scale + v).collect();
        let beta: Vec<[Vector3<f64>; BUBBLES]> = (0..sector.elements.len())
            .map(|e| {
                std::array::from_fn(|b| {
                    Vector3::from_fn(|d, _| if bubbles == 0 { 0.0 } else { x[rows + 9 * e + 3 * b + d] })
                })
            })
            .collect();
        (full, beta)
    };
    let force = |x: &[f64], scale: f64| -> Vec<f64> {
        let (full, beta) = split(x, scale);
        let (mut free, on_beta) = sector.force(&full, &beta);
        if bubbles > 0 {
            free.extend(on_beta.iter().flatten().flat_map(|f| [f.x, f.y, f.z]));
        }
        free
    };
    let mut x = vec![0.0; size];
    for part in 1..=10 {
        let scale = f64::from(part) / 10.0;
        for iteration in 0.. {
            assert!(iteration < 60, "Newton's method does not converge at {scale}");
            let residual = force(&x, scale);
            let mut tangent = Mat::<f64>::zeros(size + count, size + count);
            let h = 1e-2;
            for column in 0..size {
                let at = |step: f64| {
                    let mut moved = x.clone();
                    moved[column] += step * h;
                    force(&moved, scale)
                };
                let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(at);
                for row in 0..size {
                    tangent[(row, column)] = (a[row] - 8.0 * b[row] + 8.0 * c[row] - d[row]) / (12.0 * h);
                }
            }
            for k in 0..count {
                // Of the size of the stiffness, so that the system is not badly scaled.
                let size_of_row = held.col(k).norm_max() / YOUNG;
                for row in 0..rows {
                    let value = held[(row, k)] / size_of_row;
                    (tangent[(row, size + k)], tangent[(size + k, row)]) = (value, value);
                }
            }
            let right = Col::from_fn(size + count, |row| if row < size { -residual[row] } else { 0.0 });
            let step = tangent.partial_piv_lu().solve(&right);
            (0..size).for_each(|row| x[row] += step[row]);
            let moved = (0..rows).map(|row| step[row].abs()).fold(0.0, f64::max);
            if moved < 1e-9 {
                break;
            }
        }
    }
    let (full, beta) = split(&x, 1.0);
    let [energy] = sector.sum(|index, nodes, element| {
        [element.energy(&element.values(&HeldSector::at(nodes, &full), &beta[index]))]
    });
    energy
}

#[test]
fn a_relaxed_field_has_the_energy_of_a_converged_static_solution() {
    for (kind, both_ends) in [
        (ElementKind::C3D20, true),
        (ElementKind::C3D20, false),
        (ElementKind::QM6, true),
        (ElementKind::QM6, false),
    ] {
        let (mesh, nodes) = strip(kind, [40.0, 4.0, 1.0], 6, both_ends);
        let sector = HeldSector::new(&mesh, &nodes).unwrap();
        let relaxation = Relaxation::new(&sector).unwrap();
        let bending = out_of_plane(&sector, &relaxation);
        let [first, second] = [(bending[0], 1.5), (bending[1], 0.4)]
            .map(|(number, amplitude)| mode(&sector, &relaxation, number, amplitude));
        let field: Vec<_> = first.iter().zip(&second).map(|(a, b)| a + b).collect();
        let relaxed = relaxation.relax(&field).unwrap();
        let held = relaxation.held(&sector.linear_force(&field));
        let expected = converged(&sector, &held, &field);
        let off = relaxed.relaxed / expected - 1.0;
        println!(
            "{kind:?} {both_ends}: raw {} relaxed {} {off:e}, {} steps",
            relaxed.raw / relaxed.linear,
            relaxed.relaxed / relaxed.linear,
            relaxed.steps
        );
        assert!(off.abs() < 1e-4, "{kind:?} {both_ends}: {off:e}");
    }
}

#[test]
fn a_cantilever_stays_linear_and_draws_its_tip_back() {
    // So thin that no mode along the strip is among the held ones.
    let (length, thickness) = (60.0, 0.25);
    let (mesh, nodes) = strip(ElementKind::C3D20, [length, 4.0, thickness], 10, false);
    let sector = HeldSector::new(&mesh, &nodes).unwrap();
    let relaxation = Relaxation::new(&sector).unwrap();
    let bending = out_of_plane(&sector, &relaxation);
    let amplitude = 3.0 * thickness;
    let field = mode(&sector, &relaxation, bending[0], amplitude);
    let found = relaxation.relax(&field).unwrap();
    let (raw, relaxed) = (found.raw / found.linear, found.relaxed / found.linear);
    println!("cantilever: raw {raw} relaxed {relaxed}, {} steps", found.steps);
    assert!(raw > 3.0, "{raw}");
    // A tenth of the limit of doubt.
    assert!((relaxed - 1.0).abs() < 2e-3, "{relaxed}");
    // An inextensible cantilever draws its tip back by ½ ∫w′².
    let (beta, sigma) = (1.875_104_068_711_961 / length, 0.734_095_513_758_536);
    let points = 4000;
    let slope = |k: usize| {
        let x = beta * length * (k as f64 + 0.5) / points as f64;
        0.5 * amplitude * beta * (x.sinh() + x.sin() - sigma * (x.cosh() - x.cos()))
    };
    let drawn = 0.5 * (0..points).map(|k| slope(k).powi(2)).sum::<f64>() * length / points as f64;
    let [back, _, _] = found.second_order[0];
    assert!((back / -drawn - 1.0).abs() < 0.02, "{back} {drawn}");
}

/// Energy of the membrane over that of bending in the lowest mode of a clamped–clamped beam, at a displacement of 1 in its middle.
fn clamped_beam(length: f64, thickness: f64) -> f64 {
    // Clamped–clamped beam: cosh βx − cos βx − σ (sinh βx − sin βx).
    let (beta, sigma) = (4.730_040_744_862_704 / length, 0.982_502_214_576_238);
    let [slope, curvature] = [
        |b: f64, s: f64, x: f64| b * (x.sinh() + x.sin() - s * (x.cosh() - x.cos())),
        |b: f64, s: f64, x: f64| b * b * (x.cosh() + x.cos() - s * (x.sinh() + x.sin())),
    ];
    let middle = {
        let x: f64 = 0.5 * beta * length;
        x.cosh() - x.cos() - sigma * (x.sinh() - x.sin())
    };
    let squared = |of: fn(f64, f64, f64) -> f64| {
        let points = 4000;
        let at = |k: usize| of(beta, sigma, beta * length * (k as f64 + 0.5) / points as f64) / middle;
        (0..points).map(|k| at(k).powi(2)).sum::<f64>() * length / points as f64
    };
    let (slope, curvature) = (squared(slope), squared(curvature));
    // Half EI ∫w″² of bending, EA/(8L) (∫w′²)² of the membrane.
    let bent = 0.5 * thickness.powi(3) / 12.0 * curvature;
    thickness / (8.0 * length) * slope * slope / bent
}

#[test]
fn a_strip_clamped_at_both_ends_stiffens_as_its_closed_form() {
    let (length, thickness) = (100.0, 1.0);
    let (mesh, nodes) = strip(ElementKind::C3D20, [length, 2.0, thickness], 16, true);
    let sector = HeldSector::new(&mesh, &nodes).unwrap();
    let relaxation = Relaxation::new(&sector).unwrap();
    let bending = out_of_plane(&sector, &relaxation);
    let beam = clamped_beam(length, thickness);
    for amplitude in [0.25, 0.5, 1.0, 2.0] {
        let field = mode(&sector, &relaxation, bending[0], amplitude);
        let found = relaxation.relax(&field).unwrap();
        let (excess, expected) = (found.relaxed / found.linear - 1.0, beam * amplitude * amplitude);
        println!(
            "strip {amplitude}: raw {} κ {excess} closed {expected}, {} steps",
            found.raw / found.linear,
            found.steps
        );
        assert!((excess / expected - 1.0).abs() < 0.02, "{amplitude}: {excess} {expected}");
    }
}

#[test]
fn a_small_motion_is_linear_and_no_motion_is_refused() {
    let (mesh, nodes) = strip(ElementKind::QM6, [40.0, 4.0, 1.0], 6, true);
    let sector = HeldSector::new(&mesh, &nodes).unwrap();
    let relaxation = Relaxation::new(&sector).unwrap();
    let found = relaxation.relax(&mode(&sector, &relaxation, 0, 1e-3)).unwrap();
    assert!((found.relaxed / found.linear - 1.0).abs() < 1e-5, "{found:?}");
    assert!(found.second_order[0].iter().all(|v| v.abs() < 1e-6), "{found:?}");
    let still = vec![Vector3::zeros(); mesh.nodes.len()];
    assert_eq!(relaxation.relax(&still).unwrap_err(), NotRelaxed::Still);
}

/// Lowest out-of-plane mode of a strip, its largest displacement given, as the one shape in which the strip bends.
struct CondensedMode {
    condensed: Condensed,
    /// Energy of the linear field, and that of the relaxed one.
    linear: f64,
    relaxed: f64,
    /// Modal mass.
    mass: f64,
}

impl CondensedMode {
    /// Backbone curve up to a largest displacement, in which the amplitude is that of the place that moves most, with these energies; and the
    /// linear frequency.
    fn backbone(&self, largest: f64, [potential, inertia]: [&EnergyForm; 2]) -> (Backbone, f64) {
        let row = Mat::from_fn(1, 1, |_, _| c64::new(1.0 / self.mass.sqrt(), 0.0));
        let omega = (2.0 * self.linear / self.mass).sqrt();
        let modes = FreeModes { omega: vec![omega], rows: row.clone(), contact: row };
        let wheel = FreeWheel { sectors: 1, modes: vec![modes], potential, inertia };
        (wheel.backbone(FreeMode { nodal_diameter: 0, rank: 0 }, largest), omega)
    }
}

fn condensed_mode(both_ends: bool, [length, thickness]: [f64; 2], amplitude: f64) -> CondensedMode {
    let (mesh, nodes) = strip(ElementKind::C3D20, [length, 2.0, thickness], 16, both_ends);
    let sector = HeldSector::new(&mesh, &nodes).unwrap();
    let relaxation = Relaxation::new(&sector).unwrap();
    let bending = out_of_plane(&sector, &relaxation);
    let field = mode(&sector, &relaxation, bending[0], amplitude);
    let relaxed = relaxation.relax(&field).unwrap();
    let free = sector.gathered(&field);
    let inertia = &sector.mass * ColRef::from_slice(&free);
    CondensedMode {
        mass: inertia.iter().zip(&free).map(|(f, u)| f * u).sum(),
        condensed: condense(&sector, relaxation.factor(), &[field]),
        linear: relaxed.linear,
        relaxed: relaxed.relaxed,
    }
}

#[test]
fn condensed_energy_is_that_of_the_relaxed_field_and_of_the_closed_form() {
    // Clamped at both ends: energy of fourth order alone, EA/(8L) (∫w′²)², which relaxation finds to its own tolerance.
    let CondensedMode { condensed, linear, relaxed, .. } = condensed_mode(true, [100.0, 1.0], 1.0);
    let (excess, expected) = (condensed.potential.energy(&[1.0]) / linear, relaxed / linear - 1.0);
    assert!((excess / expected - 1.0).abs() < 0.01, "{excess} {expected}");
    let half = condensed.potential.energy(&[0.5]);
    assert!((16.0 * half / condensed.potential.energy(&[1.0]) - 1.0).abs() < 1e-9);
    // Free at one end: hardly any.
    let CondensedMode { condensed, linear, .. } = condensed_mode(false, [60.0, 0.5], 1.5);
    let excess = condensed.potential.energy(&[1.0]) / linear;
    assert!(excess.abs() < 2e-3, "{excess}");
    let tip = 60.0f64;
    let back = condensed.second_order[0].iter().map(|v| v.x).fold(0.0, f64::min);
    // A cantilever's first mode: ½ ∫w′² = 0.581 times the squared tip displacement over its length.
    let (beta, sigma) = (1.875_104_068_711_961 / tip, 0.734_095_513_758_536);
    let points = 4000;
    let slope = |k: usize| {
        let x = beta * tip * (k as f64 + 0.5) / points as f64;
        0.5 * 1.5 * beta * (x.sinh() + x.sin() - sigma * (x.cosh() - x.cos()))
    };
    let drawn = 0.5 * (0..points).map(|k| slope(k).powi(2)).sum::<f64>() * tip / points as f64;
    assert!((back / -drawn - 1.0).abs() < 0.02, "{back} {drawn}");
}

#[test]
fn the_backbone_of_a_strip_clamped_at_both_ends_is_its_closed_form() {
    let (length, thickness) = (100.0, 1.0);
    let mode = condensed_mode(true, [length, thickness], 1.0);
    let Condensed { potential, inertia, .. } = &mode.condensed;
    let (curve, omega) = mode.backbone(2.0 * thickness, [potential, inertia]);
    assert_eq!(curve.end, BackboneEnd::LargestAmplitude);
    let beam = clamped_beam(length, thickness);
    for point in &curve.points[4..] {
        let squared = (point.omega / omega).powi(2);
        // A cubic force alone, ε = 2κ, x = a cos ωt + b cos 3ωt: b (1 − 9ω²) + ε/4 (a³ + 6a²b) = 0 and ω² = 1 + ¾ε (a² + ab + 2b²).
        let (a, epsilon) = (point.amplitude, 2.0 * beam);
        let third = 0.25 * epsilon * a.powi(3) / (9.0 * squared - 1.0 - 1.5 * epsilon * a * a);
        let expected = 0.75 * epsilon * (a * a + a * third + 2.0 * third * third);
        let off = (squared - 1.0) / expected - 1.0;
        assert!(off.abs() < 0.01, "{a}: {squared} {expected} {off}");
    }
    let last = curve.points.last().unwrap();
    assert!(last.omega > 1.6 * omega, "{last:?}");
}

#[test]
fn a_cantilever_hardens_by_its_curvature_and_softens_by_the_inertia_of_its_tip() {
    // An inextensible beam (Crespo da Silva and Glynn), w = qφ: V = ½∫w″²(1 + w′²), T = ½∫ẇ² + ⅛∫(∂/∂t ∫w′²)², so that
    // ω²(1 + ½βa²) = ω₀² + ¾αa² with α = 2∫φ″²φ′² and β = ∫(∫φ′²)² for ∫φ² = 1 and a length of 1.
    let length = 60.0;
    let mode = condensed_mode(false, [length, 1.5], 1.0);
    let (beta, sigma) = (1.875_104_068_711_961, 0.734_095_513_758_536);
    let points = 4000;
    let (mut drawn, mut alpha, mut mass) = (0.0f64, 0.0, 0.0);
    for k in 0..points {
        let x: f64 = beta * (k as f64 + 0.5) / points as f64;
        let slope = beta * (x.sinh() + x.sin() - sigma * (x.cosh() - x.cos()));
        let curvature = beta * beta * (x.cosh() + x.cos() - sigma * (x.sinh() + x.sin()));
        let step = 1.0 / points as f64;
        mass += (drawn + 0.5 * step * slope * slope).powi(2) * step;
        drawn += slope * slope * step;
        alpha += 2.0 * (slope * curvature).powi(2) * step;
    }
    assert!((alpha - 40.44).abs() < 0.01 && (mass - 4.597).abs() < 2e-3, "{alpha} {mass}");
    let change = |energies: [&EnergyForm; 2]| {
        let (curve, omega) = mode.backbone(0.05 * length, energies);
        let last = curve.points.last().unwrap();
        // φ is 2 at the tip.
        let a = last.amplitude / (2.0 * length);
        ((last.omega / omega).powi(2) - 1.0) / (a * a)
    };
    let still = EnergyForm::zero(1);
    let Condensed { potential, inertia, .. } = &mode.condensed;
    let [both, stiffens, softens] =
        [[potential, inertia], [potential, &still], [&still, inertia]].map(change);
    let expected = [0.75 * alpha / beta.powi(4), -0.5 * mass];
    println!("{both} {stiffens} {softens}, closed {expected:?}");
    assert!((stiffens / expected[0] - 1.0).abs() < 0.01, "{stiffens}");
    assert!((softens / expected[1] - 1.0).abs() < 5e-3, "{softens}");
    assert!((both - expected[0] - expected[1]).abs() < 0.02 * expected[0], "{both}");
}

#[test]
fn condensed_energy_of_several_shapes_is_the_relaxed_one_to_fourth_order() {
    // The two lowest modes out of the plane and one in it, of a strip that is not straight, so that the third order matters, too.
    let (mut mesh, mut nodes) = strip(ElementKind::QM6, [40.0, 4.0, 1.0], 6, true);
    for (place, node) in mesh.nodes.iter_mut().zip(&mut nodes) {
        place[2] += 2.0 * (std::f64::consts::PI * place[0] / 40.0).sin();
        node.position = *place;
    }
    let sector = HeldSector::new(&mesh, &nodes).unwrap();
    let relaxation = Relaxation::new(&sector).unwrap();
    let shapes: Vec<_> = [0, 1, 3].map(|number| mode(&sector, &relaxation, number, 0.3)).into();
    let condensed = condense(&sector, relaxation.factor(), &shapes);
    let held = held(&sector, relaxation.factor(), &shapes);
    let error = |scale: f64| {
        let p = [scale, -0.7 * scale, 0.4 * scale];
        let field: Vec<_> = (0..mesh.nodes.len())
            .map(|node| shapes.iter().zip(p).map(|(shape, p)| shape[node] * p).sum::<Vector3<f64>>())
            .collect();
        let exact = converged(&sector, &held, &field);
        let linear: f64 = {
            let force = sector.linear_force(&field);
            0.5 * sector.gathered(&field).iter().zip(&force).map(|(u, f)| u * f).sum::<f64>()
        };
        let excess = exact - linear;
        (condensed.potential.energy(&p) - excess, excess)
    };
    let ((coarse, excess), (fine, _)) = (error(1.0), error(0.5));
    assert!(coarse.abs() < 0.05 * excess.abs(), "{coarse} {excess}");
    // What is left is of fifth order.
    assert!(fine.abs() < coarse.abs() / 20.0, "{coarse} {fine}");
}
