//! Measured validity on wheels: recovery of a sector's field, and the scene by which the thresholds were chosen.

use std::sync::{LazyLock, Mutex};

use faer::{Mat, MatRef, c64};
use nalgebra::Vector3;
use rubmap_model::impeller::{ImpellerParameters, generate};
use rubmap_model::package::raw::RawPackage;
use rubmap_model::package::{Limits, read, read_mesh, read_nodes, write};
use rubmap_solid::frame::AxisFrame;
use rubmap_solid::mesh::SectorMesh;
use rubmap_wheel::dynamics::bending::{BladeBending, products};
use rubmap_wheel::dynamics::casing::arc_lengths;
use rubmap_wheel::dynamics::integrate::Excursion;
use rubmap_wheel::dynamics::nodes::SectorNode;
use rubmap_wheel::dynamics::reduction::{BasisRows, Checkpoints};
use rubmap_wheel::dynamics::sector::SectorModel;

use super::bending::{BasisProjection, blade_bending};
use super::measure::{
    LargestMotion, MeasuredMotion, Neglected, NotMeasured, fields, measure, measuring_bytes, phase,
};
use super::relax::{NotRelaxed, Relaxation};
use super::sector::HeldSector;
use crate::effects::geometric_nonlinearity::request::{Bending, GeometricNonlinearity};
use crate::end_state::EndState;
use crate::fields::BasisProduct;
use crate::measured::{judge_by_measures, largest_motion, speeds_to_measure, with_cost};
use crate::model::{MeshFacts, ModelFacts, ReducedSector};
use crate::monitor::Unwatched;
use crate::prepare::prepare;
use crate::request::AutoOr;
use crate::resolve::resolve_sweep;
use crate::resolved::ResolvedSweep;
use crate::result::{CostRange, Estimate, Point, Validity, ValidityCheck, ValidityMeasure, ValidityVerdict};
use crate::speed::{empty_point, run_speed};

/// Store that keeps whole bases in memory.
#[derive(Default)]
struct Bases(Mutex<Vec<(usize, Vec<Vec<f64>>)>>);

impl Checkpoints for Bases {
    fn load(&self, _part: &str) -> Option<Vec<u8>> {
        None
    }

    fn save(&self, _part: &str, _bytes: Vec<u8>) {}

    fn keep_basis(&self, rows: &BasisRows<'_>) {
        let whole = (0..rows.dofs()).map(|dof| rows.row(dof).collect()).collect();
        self.0.lock().unwrap().push((rows.harmonic(), whole));
    }
}

/// Wheel of a generated package, reduced.
pub(super) struct Wheel {
    sector: SectorModel,
    pub(super) mesh: SectorMesh,
    pub(super) nodes: Vec<SectorNode>,
    pub(super) reduced: ReducedSector,
    bases: Vec<(usize, Vec<Vec<f64>>)>,
}

impl Wheel {
    fn new(parameters: &ImpellerParameters, modes: u32) -> Self {
        Self::of(&generate(parameters).unwrap(), modes)
    }

    pub(super) fn of(package: &RawPackage, modes: u32) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("impeller.zip");
        write(package, std::fs::File::create(&path).unwrap()).unwrap();
        let limits = Limits::default();
        let sector = read(&path, &limits).unwrap().sector;
        let mesh = read_mesh(&path, &limits).unwrap().unwrap();
        let nodes = read_nodes(&path, &limits).unwrap();
        let bases = Bases::default();
        let reduced = prepare(&sector, modes, None, &bases, &Unwatched).unwrap();
        Self { sector, mesh, nodes, reduced, bases: bases.0.into_inner().unwrap() }
    }

    fn basis(&self, harmonic: usize, columns: MatRef<'_, c64>) -> Mat<c64> {
        let (_, rows) = self.bases.iter().find(|(of, _)| *of == harmonic).unwrap();
        Mat::from_fn(rows.len(), columns.ncols(), |dof, column| {
            let row = rows[dof].chunks_exact(2).enumerate();
            row.map(|(k, value)| c64::new(value[0], value[1]) * columns[(k, column)]).sum()
        })
    }

    /// Bending of a blade in so many coordinates.
    pub(super) fn blade(&self, coordinates: usize) -> BladeBending {
        let (sector, reduced) = ((&self.mesh, &self.nodes[..]), &*self.reduced.wheel);
        let mut product = |harmonic: usize, columns: MatRef<'_, c64>| Ok(self.basis(harmonic, columns));
        let mut project = |harmonic: usize, load: &[f64]| {
            let (_, rows) = self.bases.iter().find(|(of, _)| *of == harmonic).unwrap();
            let mut sums = vec![c64::ZERO; rows[0].len() / 2];
            for (row, load) in rows.iter().zip(load) {
                for (sum, value) in sums.iter_mut().zip(row.chunks_exact(2)) {
                    *sum += c64::new(value[0], -value[1]) * load;
                }
            }
            Ok(sums)
        };
        let maps: (BasisProduct<'_>, BasisProjection<'_>) = (&mut product, &mut project);
        blade_bending(sector, reduced, coordinates, maps, &Unwatched).unwrap()
    }

    fn facts(&self) -> ModelFacts {
        let mesh = Some(MeshFacts::of(&self.mesh, &self.sector));
        ModelFacts { mesh, ..ModelFacts::of(&self.sector) }
    }

    /// Scene of the demo at one speed.
    fn sweep(&self, rpm: f64) -> ResolvedSweep {
        self.sweep_of(&[rpm], "independent")
    }

    /// Scene of the demo at some speeds.
    fn sweep_of(&self, rpm: &[f64], direction: &str) -> ResolvedSweep {
        let request = serde_json::json!({
            "model": "wheel",
            "modes_per_speed": 20,
            "speeds": {"values": rpm, "unit": "rpm"},
            "sweep": direction,
            "scene": {
                "centrifugal_stiffening": true,
                "damping": {"modal_ratio": 0.005},
                "casing": {
                    "clearance": {"leading": 0.30, "trailing": 0.22},
                    "lobes": {"count": 2, "amplitude": 0.425, "width_rad": 0.35}
                },
                "contact": {}
            },
        });
        resolve_sweep(serde_json::from_value(request).unwrap(), &self.facts()).unwrap()
    }

    fn motion(&self, rpm: f64) -> LargestMotion {
        largest_motion(&self.reduced, &self.sweep(rpm), 0, &Unwatched).unwrap().unwrap()
    }
}

/// Small wheel of 8-node elements.
static SMALL: LazyLock<Wheel> = LazyLock::new(|| {
    let parameters = serde_json::from_value(serde_json::json!({
        "sectors": 7, "contact_nodes": 5,
        "mesh": {"between_contact_nodes": 2, "blade_height": 5, "blade_thickness": 1, "half_passage": 1, "disk": 1},
    }));
    Wheel::new(&parameters.unwrap(), 6)
});

/// Recovered fields have the displacements of the contact nodes, and go on from sector to sector.
#[test]
fn the_field_of_a_sector_is_that_of_its_tips_and_meets_the_next_sector() {
    let wheel = &*SMALL;
    let worst = wheel.motion(20_000.0);
    let next = LargestMotion { sector: (worst.sector + 1) % 7, ..worst.clone() };
    let mut basis = |harmonic: usize, columns: MatRef<'_, c64>| Ok(wheel.basis(harmonic, columns));
    let (sector, reduced) = ((&wheel.mesh, &wheel.nodes[..]), &wheel.reduced.wheel);
    let found = fields(sector, reduced, &[worst.clone(), next], &mut basis).unwrap();
    let tips = wheel.nodes.iter().zip(&found[0]).filter(|(node, _)| node.contact.is_some());
    let largest = tips.map(|(_, u)| u.norm()).fold(0.0, f64::max);
    assert!((largest / worst.displacement - 1.0).abs() < 1e-9, "{largest} {}", worst.displacement);
    // In the frame of its own sector the low face of the next one moves as this one's high face, turned back by a sector.
    let frame = AxisFrame::new(wheel.mesh.axis.0, wheel.mesh.axis.1).unwrap();
    let local = |field: &[Vector3<f64>], node: u32| {
        frame.cylindrical(wheel.nodes[node as usize].coordinates[1]) * field[node as usize]
    };
    for &(low, high) in &wheel.mesh.cyclic {
        let off = local(&found[0], high) - local(&found[1], low);
        assert!(off.norm() < 1e-9 * largest, "{off}");
    }
    // A field that cannot be relaxed, here one without a motion, leaves the other its measure.
    let still = worst.coordinates.iter().map(|(of, column)| (*of, vec![c64::ZERO; column.len()]));
    let still = LargestMotion { coordinates: still.collect(), ..worst.clone() };
    let measured = measure(sector, reduced, &[still, worst.clone()], &mut basis, &Unwatched).unwrap();
    assert_eq!((measured.len(), measured[1].displacement), (2, worst.displacement));
    assert_eq!(measured[0].neglected, Err(NotRelaxed::Still));
    let neglected = measured[1].neglected.unwrap();
    assert!(neglected.excess.is_finite() && neglected.gap.unwrap() > 0.0);
}

/// Measures count where they were taken, are scaled to smaller motions, and leave what geometry does not doubt.
#[test]
fn measures_are_scaled_below_the_largest_motion_measured() {
    let reduced = &SMALL.reduced;
    let request = SMALL.sweep(20_000.0);
    let positions: Vec<[f64; 3]> = reduced.wheel.contact.iter().map(|node| node.position).collect();
    let chord = *arc_lengths(&positions).last().unwrap();
    let point = |index: u32, displacement: f64| {
        let check = ValidityCheck {
            what: ValidityMeasure::DisplacementOverChord,
            value: displacement / chord,
            doubtful_above: 0.05,
            beyond_above: None,
            scaled_from: None,
        };
        let validity = Validity { verdict: check.verdict(), checks: vec![check], lacking: Vec::new() };
        Point { index, validity: Some(validity), ..empty_point(reduced, &request, 0, 2000.0) }
    };
    let sizes = [0.08, 0.16, 0.1, 0.02, 0.2].map(|share| share * chord);
    let mut points: Vec<Point> = (0..).zip(sizes).map(|(index, size)| point(index, size)).collect();
    assert_eq!(speeds_to_measure(&request, reduced, &points), [0, 4]);
    let measure = |index: usize, neglected| MeasuredMotion {
        index: index as u32,
        displacement: sizes[index],
        neglected,
    };
    let curved = measure(1, Ok(Neglected { excess: -0.3, gap: Some(0.01) }));
    let curved_more = Ok(Neglected { excess: 0.2, gap: None });
    let slight = measure(2, Ok(Neglected { excess: 0.01, gap: None }));
    let guessed = points.clone();
    let measured = Ok(vec![curved, slight]);
    judge_by_measures(&mut points, (reduced, &request), &measured);
    let told = |index: usize| {
        let validity = points[index].validity.as_ref().unwrap();
        let checks = validity.checks.iter().map(|check| (check.what, check.value, check.scaled_from));
        (validity.verdict, checks.collect::<Vec<_>>())
    };
    let (verdict, checks) = told(1);
    assert_eq!((verdict, checks.len(), checks[0].2), (ValidityVerdict::Beyond, 2, None));
    assert!((checks[0].1 - 0.3).abs() < 1e-12 && (checks[1].1 - 0.01).abs() < 1e-12, "{checks:?}");
    assert_eq!(told(2).0, ValidityVerdict::Linear);
    // Half the motion of speed 1: half its energy, a quarter of its second-order motion.
    let (verdict, checks) = told(0);
    assert_eq!((verdict, checks[0].2, checks[1].2), (ValidityVerdict::Beyond, Some(1), Some(1)));
    assert!((checks[0].1 - 0.15).abs() < 1e-12 && (checks[1].1 - 0.0025).abs() < 1e-12, "{checks:?}");
    // A smaller motion of another shape that bends blades more for its size.
    let mut points_between = points.clone();
    points_between[0].validity = guessed[0].validity.clone();
    let shaped = MeasuredMotion { index: 9, displacement: 0.5 * sizes[0], ..measure(1, curved_more) };
    judge_by_measures(&mut points_between, (reduced, &request), &Ok(vec![curved, shaped]));
    let checks = &points_between[0].validity.as_ref().unwrap().checks;
    assert!((checks[0].value - 0.4).abs() < 1e-12 && checks[0].scaled_from == Some(9), "{checks:?}");
    // Geometry: without a doubt, and beyond all that was measured.
    assert_eq!((told(3).0, told(4).0), (ValidityVerdict::Linear, ValidityVerdict::Doubtful));
    // A relaxation that fails is told at its own speed and takes nothing from the others: speed 0 has the measure of speed 2, of a larger motion.
    let mut points_beside = guessed;
    let failed = measure(1, Err(NotRelaxed::Steps));
    judge_by_measures(&mut points_beside, (reduced, &request), &Ok(vec![failed, slight]));
    let verdicts = points_beside.iter().map(|point| point.validity_verdict().unwrap());
    let (linear, doubtful) = (ValidityVerdict::Linear, ValidityVerdict::Doubtful);
    assert_eq!(verdicts.collect::<Vec<_>>(), [linear, doubtful, linear, linear, doubtful]);
    let lacking = &points_beside[1].validity.as_ref().unwrap().lacking;
    assert!(lacking.iter().any(|lack| lack.reason.contains("no minimum")), "{lacking:?}");
    judge_by_measures(&mut points, (reduced, &request), &Err(NotMeasured::Relaxed("no minimum".to_owned())));
    assert_eq!(points[4].validity_lacking(), [ValidityMeasure::ExcessEnergy]);
}

/// A speed without a doubt is measured where no thickness is known, and then checked.
#[test]
fn a_speed_is_measured_for_want_of_a_thickness() {
    let reduced = ReducedSector { tip_thickness: None, ..SMALL.reduced.clone() };
    let request = SMALL.sweep(20_000.0);
    let judged = |displacement: f64, request: &ResolvedSweep| {
        let excursion = Excursion { displacement, ..Excursion::default() };
        let validity = Some(crate::validity::judge(&excursion, None, &reduced, request));
        Point { index: 0, validity, ..empty_point(&reduced, request, 0, 2000.0) }
    };
    let positions: Vec<[f64; 3]> = reduced.wheel.contact.iter().map(|node| node.position).collect();
    let chord = *arc_lengths(&positions).last().unwrap();
    // Half the thickness of a blade of 1/500 of its chord.
    let (slight, seen) = (0.9e-3 * chord, 1.1e-3 * chord);
    let mut points = [judged(seen, &request)];
    assert_eq!(points[0].validity_verdict(), Some(ValidityVerdict::NotChecked));
    assert_eq!(speeds_to_measure(&request, &reduced, &points), [0]);
    let slight_excess = Ok(Neglected { excess: 0.001, gap: None });
    let measure = MeasuredMotion { index: 0, displacement: seen, neglected: slight_excess };
    judge_by_measures(&mut points, (&reduced, &request), &Ok(vec![measure]));
    assert_eq!(points[0].validity_verdict(), Some(ValidityVerdict::Linear));
    let verdict = |displacement, request: &ResolvedSweep| judged(displacement, request).validity_verdict();
    assert_eq!(verdict(slight, &request), Some(ValidityVerdict::Linear));
    let given = ResolvedSweep { blade_thickness: Some(4.0 * seen), ..request };
    assert_eq!(verdict(seen, &given), Some(ValidityVerdict::Linear));
    assert_eq!(verdict(3.0 * seen, &given), Some(ValidityVerdict::Doubtful));
}

/// Blades that bend far are judged by the motion that their coordinates carry; what linear theory leaves out is asked where they do not stiffen.
#[test]
fn blades_that_bend_far_are_judged_by_their_coordinates() {
    let reduced = &SMALL.reduced;
    let positions: Vec<[f64; 3]> = reduced.wheel.contact.iter().map(|node| node.position).collect();
    let far = *arc_lengths(&positions).last().unwrap();
    let judged_at = |displacement: f64, include: Bending, outside: f64, rotation: f64| {
        let mut request = SMALL.sweep(20_000.0);
        request.scene.geometric_nonlinearity = Some(GeometricNonlinearity { include, coordinates: 4 });
        let excursion =
            Excursion { displacement, rotation, outside_coordinates: outside, ..Excursion::default() };
        let validity = Some(crate::validity::judge(&excursion, None, reduced, &request));
        let point = Point { index: 0, validity, ..empty_point(reduced, &request, 0, 2000.0) };
        let measured = speeds_to_measure(&request, reduced, std::slice::from_ref(&point));
        (point.validity_verdict().unwrap(), measured.len())
    };
    let judged = |include, outside, rotation| judged_at(far, include, outside, rotation);
    for (outside, rotation, verdict) in [
        (0.09, 0.19, ValidityVerdict::Linear),
        (0.11, 0.19, ValidityVerdict::Doubtful),
        (0.5, 0.19, ValidityVerdict::Beyond),
        (0.09, 0.21, ValidityVerdict::Doubtful),
    ] {
        assert_eq!(judged(Bending::Full, outside, rotation), (verdict, 0), "{outside} {rotation}");
    }
    assert_eq!(judged(Bending::Kinematics, 0.09, 0.05), (ValidityVerdict::Doubtful, 1));
    // So little motion is linear, whatever carries it.
    assert_eq!(judged_at(1e-3 * far, Bending::Full, 0.9, 1e-4), (ValidityVerdict::Linear, 0));
}

/// The largest motion of a sweep down is that of the run from the end of the speed above, in whose window it is.
#[test]
fn the_motion_of_a_sweep_down_is_led_from_the_speed_above() {
    let (reduced, wheel) = (&SMALL.reduced, &*SMALL);
    let mut request = wheel.sweep_of(&[19_900.0, 20_000.0], "down");
    (request.integration.revolutions, request.integration.window_revolutions) = (AutoOr::Fixed(4), 1);
    let run =
        |index, start: Option<&EndState>| run_speed(reduced, &request, index, start, &Unwatched).unwrap();
    let above = run(1, None);
    let found = [run(0, above.end_state.as_ref()), run(0, None)].map(|found| found.point);
    let positions: Vec<[f64; 3]> = reduced.wheel.contact.iter().map(|node| node.position).collect();
    let chord = *arc_lengths(&positions).last().unwrap();
    let [led, alone] = found.each_ref().map(|point| {
        let checks = &point.validity.as_ref().unwrap().checks;
        chord * checks.iter().find(|of| of.what == ValidityMeasure::DisplacementOverChord).unwrap().value
    });
    let motion = largest_motion(reduced, &request, 0, &Unwatched).unwrap().unwrap().displacement;
    // States have more instants than the excursion of a point.
    assert!((1.0..1.01).contains(&(motion / led)) && alone > 1.02 * led, "{motion} {led} {alone}");
    // Only the largest motion is looked at.
    let points = [found[0].clone(), above.point];
    assert_eq!(speeds_to_measure(&request, reduced, &points).len(), 1);
}

/// Where nothing touches nothing is measured; otherwise at most six speeds once more, of a sweep up or down all of them, and six relaxations
/// with one for the factor.
#[test]
fn a_plan_has_what_measuring_takes() {
    let range = |free, contact| CostRange { free, contact };
    let all = Estimate {
        steps: 100,
        computing_time_s: range(10.0, 80.0),
        wall_time_s: range(5.0, 40.0),
        workers: 2,
        memory_bytes: 7,
        speed_memory_bytes: 3,
    };
    let facts = SMALL.facts();
    let planned = |direction: &str, facts: &ModelFacts| {
        let request = SMALL.sweep_of(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0].map(|k| 1e3 * k), direction);
        with_cost(all.clone(), &request, facts, 2)
    };
    let relaxed = 1.8e-6 * f64::from(facts.own_dofs).powf(1.5);
    let found = planned("independent", &facts);
    assert_eq!((found.computing_time_s.free, found.wall_time_s.free, found.steps), (10.0, 5.0, 100));
    assert!((found.computing_time_s.contact - (80.0 + 60.0 + 7.0 * relaxed)).abs() < 1e-9);
    assert!((found.wall_time_s.contact - (40.0 + 60.0 + 3.5 * relaxed)).abs() < 1e-9);
    // About as much as the mesh itself asks for, whose clamped nodes count as well.
    let bytes = measuring_bytes(&SMALL.mesh, 6);
    assert!((bytes / 2..2 * bytes).contains(&found.memory_bytes), "{} {bytes}", found.memory_bytes);
    let found = planned("up", &facts);
    assert!((found.computing_time_s.contact - (80.0 + 80.0 + 2.0 * relaxed)).abs() < 1e-9);
    assert_eq!(planned("independent", &ModelFacts { mesh: None, ..facts }), all);
}

/// Sectors of one instant against an independent code (docs/method.md, Stress): the energy of the linear field under Green–Lagrange strain over its
/// linear energy, the relaxed energy and the second-order radial motion of the worst one.
#[test]
#[ignore = "takes minutes: reduces and simulates a wheel of 20-node elements"]
fn sectors_of_the_demos_wheel_at_its_largest_motion() {
    let parameters = serde_json::from_value(serde_json::json!({"element_order": "quadratic"})).unwrap();
    let wheel = Wheel::new(&parameters, 20);
    let worst = wheel.motion(20_269.0);
    let motions: Vec<LargestMotion> =
        (0..wheel.reduced.wheel.sectors).map(|sector| LargestMotion { sector, ..worst.clone() }).collect();
    let mut basis = |harmonic: usize, columns: MatRef<'_, c64>| Ok(wheel.basis(harmonic, columns));
    let fields = fields((&wheel.mesh, &wheel.nodes), &wheel.reduced.wheel, &motions, &mut basis).unwrap();
    let sector = HeldSector::new(&wheel.mesh, &wheel.nodes).unwrap();
    let relaxation = Relaxation::new(&sector).unwrap();
    let relax = |field: &Vec<Vector3<f64>>| {
        let tip = sector.contact.iter().map(|at| field[at.node as usize].norm()).fold(0.0, f64::max);
        let found = relaxation.relax(field).unwrap();
        let radial = found.second_order.iter().map(|v| v[0]).fold(0.0, f64::min);
        let [raw, relaxed] = [found.raw, found.relaxed].map(|energy| energy / found.linear);
        println!(
            "tip {tip:.3} mm: raw {raw:.4}, relaxed {relaxed:.4}, inwards {radial:.4} mm, {} steps",
            found.steps
        );
        assert!(relaxed <= raw);
        (tip, raw, relaxed, radial)
    };
    let found: Vec<_> = fields.iter().map(relax).collect();
    for (moved, expected) in [(2.9, 8.2), (0.32, 1.06)] {
        let near = found.iter().min_by(|a, b| (a.0 - moved).abs().total_cmp(&(b.0 - moved).abs())).unwrap();
        assert!((near.0 / moved - 1.0).abs() < 0.05 && (near.1 / expected - 1.0).abs() < 0.02, "{near:?}");
    }
    assert!(found.iter().any(|(_, raw, ..)| (raw / 3.0 - 1.0).abs() < 0.02));
    // The other code relaxed by a few damped steps, to 1.11; converged energies lie below.
    let (_, _, relaxed, radial) = found.iter().max_by(|a, b| a.0.total_cmp(&b.0)).unwrap();
    assert!((1.05..1.11).contains(relaxed) && (radial / -0.065 - 1.0).abs() < 0.1, "{relaxed} {radial}");
}

/// Energy beyond the quadratic one and second-order motion towards the casing of a motion scaled down, condensed on coordinates that the
/// reduction reads, beside the relaxed field: excess shares and largest motions.
fn condensed_beside_relaxed(wheel: &Wheel, coordinates: usize, rpm: f64, scale: f64) -> ([f64; 2], [f64; 2]) {
    let mut worst = wheel.motion(rpm);
    worst.coordinates.iter_mut().flat_map(|(_, column)| column).for_each(|z| *z *= scale);
    let (sector, reduced) = ((&wheel.mesh, &wheel.nodes[..]), &*wheel.reduced.wheel);
    let mut product = |harmonic: usize, columns: MatRef<'_, c64>| Ok(wheel.basis(harmonic, columns));
    let blade = wheel.blade(coordinates);
    let field = fields(sector, reduced, std::slice::from_ref(&worst), &mut product).unwrap().remove(0);
    let p: Vec<f64> = (0..blade.coordinates())
        .map(|j| {
            let of = worst.coordinates.iter().map(|(harmonic, column)| {
                let row = blade.rows[*harmonic].row(j);
                let sum: c64 = row.iter().zip(column).map(|(r, z)| r * z).sum();
                (phase(reduced.sectors, *harmonic, worst.sector) * sum).re
            });
            of.sum()
        })
        .collect();
    let held = HeldSector::new(sector.0, sector.1).unwrap();
    let relaxed = Relaxation::new(&held).unwrap().relax(&field).unwrap();
    let q: Vec<f64> = products(p.len()).map(|(j, k)| p[j] * p[k]).collect();
    let towards = |node: usize, to_casing: [f64; 2]| {
        let [r, _, z] = reduced.contact[node].normal;
        r * to_casing[0] + z * to_casing[1]
    };
    let condensed = |node: usize| {
        let v = |d: usize| -> f64 {
            q.iter().enumerate().map(|(a, q)| blade.second_order[(3 * node + d, a)] * q).sum()
        };
        let around: f64 = p.iter().enumerate().map(|(j, p)| blade.linear[(3 * node + 1, j)] * p).sum();
        towards(node, [v(0) + around * around / (2.0 * reduced.contact[node].position[0]), v(2)])
    };
    let nodes = 0..reduced.contact.len();
    let largest = |of: &dyn Fn(usize) -> f64| nodes.clone().map(|node| of(node).abs()).fold(0.0, f64::max);
    (
        [blade.potential.energy(&p) / relaxed.linear, relaxed.relaxed / relaxed.linear - 1.0],
        [largest(&condensed), largest(&|node| towards(node, relaxed.to_casing[node]))],
    )
}

#[test]
fn condensed_bending_of_a_wheel_is_that_of_its_relaxed_fields() {
    for coordinates in [4, 6] {
        let ([energy, relaxed], [motion, expected]) =
            condensed_beside_relaxed(&SMALL, coordinates, 20_000.0, 0.5);
        println!("{coordinates}: κ {energy} {relaxed}, motion {motion} {expected}");
        assert!((motion / expected - 1.0).abs() < 0.2, "{coordinates}: {motion} {expected}");
    }
}
