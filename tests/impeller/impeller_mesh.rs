//! Mesh of the impeller against the curves it stands for, over sector counts, splitters, densities and orders.

use std::collections::HashSet;
use std::f64::consts::PI;

use rubmap::impeller::mesh::{ElementOrder, SectorMesh};
use rubmap::impeller::{ImpellerError, ImpellerParameters, MeshDensities, Splitter, impeller_sector};

use crate::conformity::{check_conforming, check_cyclic, volume};

pub(crate) const ORDERS: [ElementOrder; 2] = [ElementOrder::Linear, ElementOrder::Quadratic];

/// Densities: elements between contact nodes, over the height, through the thickness, across half a passage, through the disk.
pub(crate) fn densities(counts: [usize; 5]) -> MeshDensities {
    let [between_contact_nodes, blade_height, blade_thickness, half_passage, disk] = counts;
    MeshDensities { between_contact_nodes, blade_height, blade_thickness, half_passage, disk }
}

/// Wheels of both orders, with and without splitter, few and many sectors, even and odd densities.
fn wheels() -> impl Iterator<Item = ImpellerParameters> {
    let meshes = [(4, [2, 3, 1, 2, 2]), (10, [1, 2, 2, 1, 3]), (3, [3, 1, 3, 3, 1])];
    ORDERS.into_iter().flat_map(move |element_order| {
        [None, Some(Splitter { leading_edge: 0.45 })].into_iter().flat_map(move |splitter| {
            [(3, 1.7), (7, 1.7), (10, 1.7), (64, 0.3)].into_iter().flat_map(
                move |(sectors, root_thickness)| {
                    meshes.into_iter().map(move |(contact_nodes, counts)| ImpellerParameters {
                        sectors,
                        root_thickness,
                        tip_thickness: 0.5 * root_thickness,
                        splitter,
                        contact_nodes,
                        element_order,
                        mesh: densities(counts),
                        ..ImpellerParameters::default()
                    })
                },
            )
        })
    })
}

/// Upright wheel with blades of constant thickness: its volume is known.
fn upright(element_order: ElementOrder, factor: usize) -> ImpellerParameters {
    ImpellerParameters {
        wrap_deg: 0.0,
        backsweep_deg: 0.0,
        tip_thickness: ImpellerParameters::default().root_thickness,
        contact_nodes: 5,
        element_order,
        mesh: densities([factor, 2 * factor, 1, 2 * factor, factor]),
        ..ImpellerParameters::default()
    }
}

/// Cylindrical coordinates of a node.
fn cylindrical(sector: &SectorMesh, node: usize) -> [f64; 3] {
    let [x, y, z] = sector.mesh.nodes[node];
    [x.hypot(y), y.atan2(x), z]
}

/// Semi-axes of a curve's ellipse about (outlet radius, 0).
fn hub_axes(p: &ImpellerParameters) -> [f64; 2] {
    [p.outlet_radius - p.inlet_hub_radius, p.axial_length]
}

fn shroud_axes(p: &ImpellerParameters) -> [f64; 2] {
    [p.outlet_radius - p.inlet_tip_radius, p.axial_length - p.outlet_blade_height]
}

/// Arc length of a quarter ellipse up to the angle φ, r = R − a cos φ, z = b sin φ; Simpson's rule.
fn arc([a, b]: [f64; 2], phi: f64) -> f64 {
    let n = 2000;
    let speed = |i: usize| {
        let (s, c) = (phi * i as f64 / n as f64).sin_cos();
        (a * s).hypot(b * c)
    };
    let weight = |i: usize| if i == 0 || i == n { 1.0 } else { [2.0, 4.0][i % 2] };
    phi / n as f64 / 3.0 * (0..=n).map(|i| weight(i) * speed(i)).sum::<f64>()
}

#[test]
fn sectors_are_conforming_and_their_faces_fit() {
    for p in wheels() {
        let sector = impeller_sector(&p).unwrap_or_else(|error| panic!("{p:?}: {error}"));
        check_conforming(&sector.mesh, p.outlet_radius);
        check_cyclic(&sector, p.outlet_radius);
        assert!(volume(&sector.mesh) > 0.0);
        // The bore, and only the bore, is clamped.
        for (node, clamped) in sector.clamped.iter().enumerate() {
            let at_bore = (cylindrical(&sector, node)[0] / p.bore_radius - 1.0).abs() < 1e-12;
            assert_eq!(*clamped, [at_bore; 3]);
        }
    }
}

/// Contact nodes: their number, on the shroud's ellipse, evenly spaced along its arc, with its own normals that turn
/// from +r to −z, free, off the cyclic faces, and on the tip's mid-line where the mesh has one.
#[test]
fn contact_nodes_follow_the_shroud() {
    for p in wheels() {
        let sector = impeller_sector(&p).unwrap();
        let faces: HashSet<usize> = sector.cyclic.iter().flat_map(|&(low, high)| [low, high]).collect();
        let axes = shroud_axes(&p);
        let whole = arc(axes, 0.5 * PI);
        assert_eq!(sector.contact.len(), p.contact_nodes);
        for (index, tip) in sector.contact.iter().enumerate() {
            assert!(!faces.contains(&tip.node) && sector.clamped[tip.node] == [false; 3]);
            let [r, _, z] = cylindrical(&sector, tip.node);
            let (c, s) = ((p.outlet_radius - r) / axes[0], z / axes[1]);
            assert!((c.hypot(s) - 1.0).abs() < 1e-12);
            let fraction = index as f64 / (p.contact_nodes - 1) as f64;
            // The mesh's own table of arc lengths is good to 1e-8.
            assert!((arc(axes, s.atan2(c)) / whole - fraction).abs() < 1e-7);
            // This is the ellipse's normal away from the hub, which here is inwards of the ellipse.
            let normal = [c / axes[0], -s / axes[1]].map(|n| n / (c / axes[0]).hypot(s / axes[1]));
            let [n_r, n_t, n_z] = tip.normal;
            assert!((n_r - normal[0]).abs() < 1e-12 && n_t == 0.0 && (n_z - normal[1]).abs() < 1e-12);
            assert!((n_r.hypot(n_z) - 1.0).abs() < 1e-14);
        }
        let [first, last] = [0, p.contact_nodes - 1].map(|c| sector.contact[c].normal);
        assert!((first[0] - 1.0).abs() < 1e-12 && (last[2] + 1.0).abs() < 1e-12);

        if p.element_order == ElementOrder::Quadratic || p.mesh.blade_thickness.is_multiple_of(2) {
            let blade = if p.splitter.is_some() { -0.5 * PI / p.sectors as f64 } else { 0.0 };
            let camber = cylindrical(&sector, sector.contact[0].node)[1];
            assert!((camber - blade).abs() < 1e-12);
            let wrapped = cylindrical(&sector, sector.contact[p.contact_nodes - 1].node)[1] - camber;
            assert!((wrapped + p.wrap_deg.to_radians()).abs() < 1e-12);
        }
    }
}

/// Volume of the disk by Pappus's rule, of the blade as thickness times the area between the two ellipses. Chords miss
/// arcs at second order, parabolas at fourth.
#[test]
fn volume_converges_to_the_closed_form() {
    let p = upright(ElementOrder::Linear, 1);
    let ([a, b], [c, d]) = (hub_axes(&p), shroud_axes(&p));
    let block = (p.axial_length + p.rim_thickness) * (p.outlet_radius.powi(2) - p.bore_radius.powi(2)) / 2.0;
    let ellipse = 0.25 * PI * a * b * (p.outlet_radius - 4.0 * a / (3.0 * PI));
    let disk = 2.0 * PI / p.sectors as f64 * (block - ellipse);
    let exact = disk + p.root_thickness * 0.25 * PI * (a * b - c * d);
    for (order, least, bound) in [(ElementOrder::Linear, 3.7, 4e-3), (ElementOrder::Quadratic, 13.0, 1e-5)] {
        let error = |factor| volume(&impeller_sector(&upright(order, factor)).unwrap().mesh) / exact - 1.0;
        let (coarse, fine) = (error(2), error(4));
        println!("{order:?}: {coarse:.2e} {fine:.2e}");
        assert!(fine.abs() < bound && coarse / fine > least, "{order:?}: {coarse:.2e} {fine:.2e}");
    }
}

/// Nodes of the blades' tips, which are those on the shroud's ellipse, as (fraction of the arc, angle).
fn tips(sector: &SectorMesh, p: &ImpellerParameters) -> Vec<(f64, f64)> {
    let axes = shroud_axes(p);
    let whole = arc(axes, 0.5 * PI);
    let tips = (0..sector.mesh.nodes.len()).filter_map(|node| {
        let [r, theta, z] = cylindrical(sector, node);
        let (c, s) = ((p.outlet_radius - r) / axes[0], z / axes[1]);
        ((c.hypot(s) - 1.0).abs() < 1e-9).then(|| (arc(axes, s.atan2(c)) / whole, theta))
    });
    tips.collect()
}

/// Splitter: it begins where it is asked to, stands half a pitch from the main blade, and both have the thickness asked
/// for, less at the tip than at the root.
#[test]
fn splitter_stands_in_the_middle_of_the_passage() {
    for element_order in ORDERS {
        let p = ImpellerParameters {
            wrap_deg: 0.0,
            backsweep_deg: 0.0,
            splitter: Some(Splitter { leading_edge: 0.38 }),
            contact_nodes: 6,
            element_order,
            mesh: densities([2, 2, 2, 2, 2]),
            ..ImpellerParameters::default()
        };
        let sector = impeller_sector(&p).unwrap();
        let half_pitch = PI / p.sectors as f64;
        let tips = tips(&sector, &p);
        let (main, splitter): (Vec<_>, Vec<_>) = tips.into_iter().partition(|(_, theta)| *theta < 0.0);
        let begin = |blade: &[(f64, f64)]| blade.iter().map(|t| t.0).fold(f64::INFINITY, f64::min);
        // The splitter begins at four of ten elements.
        assert!(begin(&main).abs() < 1e-7 && (begin(&splitter) - 0.4).abs() < 1e-7);
        let edge = |blade: &[(f64, f64)]| -> [f64; 2] {
            let angles = blade.iter().filter(|t| t.0 > 1.0 - 1e-7).map(|t| t.1);
            angles.fold([f64::INFINITY, -f64::INFINITY], |[a, b], t| [a.min(t), b.max(t)])
        };
        let (main, splitter) = (edge(&main), edge(&splitter));
        for d in 0..2 {
            assert!((splitter[d] - main[d] - half_pitch).abs() < 1e-12);
        }
        let thickness = (main[1] - main[0]) * p.outlet_radius;
        assert!((thickness / p.tip_thickness - 1.0).abs() < 1e-12, "{thickness}");
    }
}

/// Sector with a splitter: it has the same disk, so it weighs the same but for the second, shorter blade.
#[test]
fn splitter_adds_its_own_volume() {
    let plain = upright(ElementOrder::Quadratic, 3);
    // The splitter begins at four of twelve elements along the blade.
    let split = ImpellerParameters { splitter: Some(Splitter { leading_edge: 1.0 / 3.0 }), ..plain.clone() };
    let added = [split, plain.clone()].map(|p| volume(&impeller_sector(&p).unwrap().mesh));
    // Its area lies behind the line from hub to shroud at a third of their arcs, by the shoelace rule.
    let mut outline = Vec::new();
    for (axes, forth) in [(hub_axes(&plain), true), (shroud_axes(&plain), false)] {
        let target = arc(axes, 0.5 * PI) / 3.0;
        let (mut low, mut high) = (0.0, 0.5 * PI);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if arc(axes, middle) < target { low = middle } else { high = middle }
        }
        let mut curve: Vec<[f64; 2]> = (0..=2000)
            .map(|i| {
                let (s, c) = (low + (0.5 * PI - low) * f64::from(i) / 2000.0).sin_cos();
                [-axes[0] * c, axes[1] * s]
            })
            .collect();
        if !forth {
            curve.reverse();
        }
        outline.extend(curve);
    }
    let next = outline.iter().cycle().skip(1);
    let area = 0.5 * outline.iter().zip(next).map(|(p, q)| p[0] * q[1] - p[1] * q[0]).sum::<f64>().abs();
    let share = (added[0] - added[1]) / (area * plain.root_thickness);
    assert!((share - 1.0).abs() < 1e-3, "{share}");
}

#[test]
fn impossible_wheels_are_named() {
    let d = ImpellerParameters::default;
    let split = |leading_edge| Some(Splitter { leading_edge });
    for (parameters, named) in [
        (ImpellerParameters { tip_thickness: 1.8, ..d() }, "tip_thickness"),
        (ImpellerParameters { root_thickness: 14.0, ..d() }, "root_thickness"),
        // There is room for one blade a sector, but not for two.
        (ImpellerParameters { root_thickness: 6.5, splitter: split(0.2), ..d() }, "root_thickness"),
        (ImpellerParameters { sectors: 80, ..d() }, "root_thickness"),
        (ImpellerParameters { splitter: split(0.0), ..d() }, "splitter.leading_edge"),
        (ImpellerParameters { splitter: split(0.99), ..d() }, "splitter.leading_edge"),
        (ImpellerParameters { splitter: split(f64::NAN), ..d() }, "splitter.leading_edge"),
        (ImpellerParameters { splitter: split(-1e30), ..d() }, "splitter.leading_edge"),
        (ImpellerParameters { mesh: densities([200, 200, 50, 50, 50]), ..d() }, "mesh"),
        (ImpellerParameters { mesh: densities([usize::MAX, 1, 1, 1, 1]), ..d() }, "mesh"),
        (ImpellerParameters { contact_nodes: usize::MAX, ..d() }, "mesh"),
        (
            ImpellerParameters { contact_nodes: 2, mesh: densities([1, 1, 1, 1, 1]), ..d() },
            "mesh.between_contact_nodes",
        ),
    ] {
        match impeller_sector(&parameters) {
            Err(ImpellerError::Parameter { field, .. }) => assert_eq!(field, named),
            other => panic!("{named}: {:?}", other.map(|_| ())),
        }
    }
    // A million degrees of freedom are allowed: 76,000 elements of 20 nodes.
    let large = ImpellerParameters {
        element_order: ElementOrder::Quadratic,
        splitter: split(0.5),
        mesh: densities([12, 32, 4, 8, 14]),
        ..d()
    };
    assert_eq!(large.validate(), Ok(()));
}
