//! Default impeller: its package has what docs/package.md asks for, and its matrices are honest.

use std::collections::{HashMap, HashSet};
use std::f64::consts::PI;

use rubmap::dynamics::sector::Units;
use rubmap::impeller::mesh::{Elements, HexMesh};
use rubmap::impeller::{
    ImpellerError, ImpellerParameters, Material, MeshDensities, generate, impeller_sector,
};
use rubmap::package::raw::RawPackage;

use crate::eigen::{harmonic, hertz, lowest};

/// Parameters of a small impeller, for the checks that do not need the default's mesh.
fn small() -> ImpellerParameters {
    ImpellerParameters {
        contact_nodes: 4,
        mesh: MeshDensities {
            between_contact_nodes: 2,
            blade_height: 3,
            blade_thickness: 1,
            half_passage: 2,
            disk: 2,
        },
        ..ImpellerParameters::default()
    }
}

fn frequencies(package: &RawPackage, speed: usize, diameter: usize, count: usize) -> Option<Vec<f64>> {
    let k = harmonic(package, &package.stiffness[speed], diameter);
    let m = harmonic(package, &package.mass, diameter);
    lowest(&k, &m, count).map(|values| hertz(&values))
}

#[test]
fn high_face_is_the_low_face_turned() {
    for parameters in [ImpellerParameters::default(), ImpellerParameters { sectors: 13, ..small() }] {
        let package = generate(&parameters).unwrap();
        let position: HashMap<u64, [f64; 3]> = package.nodes.iter().map(|n| (n.id, n.position)).collect();
        let mut components: HashMap<u64, Vec<u8>> = HashMap::new();
        for dof in &package.dofs {
            components.entry(dof.node).or_default().push(dof.component);
        }
        let (s, c) = (2.0 * PI / parameters.sectors as f64).sin_cos();
        for [low, high] in &package.manifest.cyclic {
            let ([x, y, z], at) = (position[low], position[high]);
            let turned = [c * x - s * y, s * x + c * y, z];
            for d in 0..3 {
                // The tolerance is a few roundings of sine and cosine.
                assert!((turned[d] - at[d]).abs() < 1e-14 * parameters.outlet_radius);
            }
            assert_eq!(components[low], components[high]);
        }
        // The high face's rows come last, in the order of the pairs.
        let high: Vec<u64> = package.manifest.cyclic.iter().map(|p| p[1]).collect();
        let tail = &package.dofs[package.dofs.len() - 3 * high.len()..];
        assert!(tail.iter().map(|d| d.node).eq(high.iter().flat_map(|&n| [n; 3])));
    }
}

#[test]
fn contact_normals_turn_with_the_shroud() {
    let parameters = ImpellerParameters::default();
    let package = generate(&parameters).unwrap();
    let contact = &package.manifest.contact;
    assert_eq!(contact.len(), parameters.contact_nodes);
    let faces: HashSet<u64> = package.manifest.cyclic.iter().flatten().copied().collect();
    let free: HashSet<u64> = package.dofs.iter().map(|d| d.node).collect();
    let position: HashMap<u64, [f64; 3]> = package.nodes.iter().map(|n| (n.id, n.position)).collect();
    let mut last = None;
    let mut spacings = Vec::new();
    for tip in contact {
        let [n_r, n_t, n_z] = tip.normal;
        assert!((n_r.hypot(n_z) - 1.0).abs() < 1e-14 && n_t == 0.0);
        assert!(!faces.contains(&tip.node) && free.contains(&tip.node));
        let [x, y, z] = position[&tip.node];
        let (r, angle) = (x.hypot(y), n_z.atan2(n_r));
        if let Some((last_r, last_z, last_angle)) = last {
            assert!(angle < last_angle, "the normal turns from +r to -z");
            // The chord between two contact nodes is normal to the mean of their normals, to second order.
            let chord: [f64; 2] = [r - last_r, z - last_z];
            spacings.push(chord[0].hypot(chord[1]));
            let mean = 0.5 * (angle + last_angle);
            assert!((chord[0] * mean.cos() + chord[1] * mean.sin()).abs() < 0.02 * chord[0].hypot(chord[1]));
        }
        last = Some((r, z, angle));
    }
    assert!((contact[0].normal[0] - 1.0).abs() < 1e-12);
    assert!((contact[contact.len() - 1].normal[2] + 1.0).abs() < 1e-12);
    // Equal arcs: their chords differ by curvature only.
    let (least, most) = spacings.iter().fold((f64::MAX, 0.0_f64), |(a, b), &s| (a.min(s), b.max(s)));
    assert!(most / least < 1.01, "{least} {most}");
}

#[test]
fn stiffness_is_exactly_linear_in_the_speed_squared() {
    let package = generate(&small()).unwrap();
    let [k0, k1, k2] = [0, 1, 2].map(|s| &package.stiffness[s].entries);
    let largest = k0.iter().map(|e| e.2.abs()).fold(0.0, f64::max);
    let mut spin = 0.0_f64;
    for ((a, b), c) in k0.iter().zip(k1).zip(k2) {
        assert_eq!((a.0, a.1), (b.0, b.1));
        assert_eq!((a.0, a.1), (c.0, c.1));
        assert!((4.0 * (b.2 - a.2) - (c.2 - a.2)).abs() < 1e-14 * largest);
        spin = spin.max((c.2 - a.2).abs());
    }
    // By docs/method.md, Centrifugal stiffening: about 1e-3 or less of the elastic stiffness for matrices on the undeformed geometry.
    assert!(spin > 1e-6 * largest && spin < 2e-3 * largest, "{}", spin / largest);
}

#[test]
fn mass_and_rest_stiffness_do_not_depend_on_the_top_speed() {
    let slow = generate(&small()).unwrap();
    let fast = generate(&ImpellerParameters { top_speed_rad_s: 8000.0, ..small() }).unwrap();
    assert_eq!(slow.mass, fast.mass);
    assert_eq!(slow.stiffness[0], fast.stiffness[0]);
    assert_eq!(slow.stiffness[2], fast.stiffness[1]);
}

/// Default wheel: every harmonic has a Cholesky factor at every speed, and its first six frequencies rise with the speed.
#[test]
fn default_wheel_is_stable_and_stiffens_with_speed() {
    let parameters = ImpellerParameters::default();
    let package = generate(&parameters).unwrap();
    for diameter in 0..=parameters.sectors / 2 {
        let [rest, half, top] = [0, 1, 2].map(|speed| frequencies(&package, speed, diameter, 6).unwrap());
        assert!((1500.0..3000.0).contains(&rest[0]), "{rest:?}");
        for j in 0..6 {
            assert!(rest[j] < half[j] && half[j] < top[j], "diameter {diameter}, family {j}");
        }
    }
}

/// Units SI and mm-t-s describe the same wheel: the same frequencies, to the conditioning of the iteration.
#[test]
fn units_do_not_change_the_frequencies() {
    let p = small();
    let unit = |text: &str| text.to_owned();
    let si = ImpellerParameters {
        units: Units { length: unit("m"), force: unit("N"), time: unit("s"), mass: unit("kg") },
        bore_radius: p.bore_radius / 1e3,
        inlet_hub_radius: p.inlet_hub_radius / 1e3,
        inlet_tip_radius: p.inlet_tip_radius / 1e3,
        outlet_radius: p.outlet_radius / 1e3,
        axial_length: p.axial_length / 1e3,
        outlet_blade_height: p.outlet_blade_height / 1e3,
        rim_thickness: p.rim_thickness / 1e3,
        root_thickness: p.root_thickness / 1e3,
        tip_thickness: p.tip_thickness / 1e3,
        material: Material {
            youngs_modulus: p.material.youngs_modulus * 1e6,
            density: p.material.density * 1e12,
            ..p.material.clone()
        },
        ..p.clone()
    };
    let (a, b) = (generate(&p).unwrap(), generate(&si).unwrap());
    for (a, b) in frequencies(&a, 2, 2, 6).unwrap().iter().zip(frequencies(&b, 2, 2, 6).unwrap()) {
        assert!((a / b - 1.0).abs() < 1e-9, "{a} {b}");
    }
}

/// Refinement of the mesh lowers the first frequency by less than 3 %, and each refinement by less than the one before.
#[test]
fn first_frequency_converges_with_the_mesh() {
    let first = |factor: usize| {
        let p = ImpellerParameters {
            mesh: MeshDensities {
                between_contact_nodes: factor,
                blade_height: 4 * factor,
                blade_thickness: 1,
                half_passage: factor + 1,
                disk: factor + 1,
            },
            ..ImpellerParameters::default()
        };
        frequencies(&generate(&p).unwrap(), 0, 4, 2).unwrap()[0]
    };
    let f: Vec<f64> = [1, 2, 3].map(first).to_vec();
    println!("{f:.1?}");
    assert!(f[0] > f[1] && f[1] > f[2]);
    assert!(f[1] / f[2] - 1.0 < 0.03 && f[0] - f[1] > f[1] - f[2]);
}

#[test]
fn bad_parameters_are_named() {
    let field = |p: ImpellerParameters| match generate(&p) {
        Err(ImpellerError::Parameter { field, .. }) => field,
        other => panic!("{:?}", other.map(|_| ())),
    };
    let d = ImpellerParameters::default;
    assert_eq!(field(ImpellerParameters { sectors: 2, ..d() }), "sectors");
    assert_eq!(field(ImpellerParameters { bore_radius: f64::NAN, ..d() }), "bore_radius");
    assert_eq!(field(ImpellerParameters { inlet_tip_radius: 140.0, ..d() }), "outlet_radius");
    assert_eq!(field(ImpellerParameters { outlet_blade_height: 70.0, ..d() }), "axial_length");
    assert_eq!(field(ImpellerParameters { root_thickness: 14.0, ..d() }), "root_thickness");
    assert_eq!(field(ImpellerParameters { contact_nodes: 1, ..d() }), "contact_nodes");
    assert_eq!(field(ImpellerParameters { backsweep_deg: 90.0, ..d() }), "backsweep_deg");
    let mut units = d().units;
    units.time = "ms".to_owned();
    assert_eq!(field(ImpellerParameters { units, ..d() }), "units.time");
    let material = Material { poissons_ratio: 0.5, ..Material::default() };
    assert_eq!(field(ImpellerParameters { material, ..d() }), "material.poissons_ratio");
    let mesh = MeshDensities { half_passage: usize::MAX, ..MeshDensities::default() };
    assert_eq!(field(ImpellerParameters { mesh, ..d() }), "mesh");
    assert_eq!(field(ImpellerParameters { tip_thickness: 60.0, ..d() }), "tip_thickness");
    let mesh = MeshDensities { disk: 0, ..MeshDensities::default() };
    assert_eq!(field(ImpellerParameters { mesh, ..d() }), "mesh.disk");
    assert!(serde_json::from_str::<ImpellerParameters>(r#"{"sector":10}"#).is_err());
    assert_eq!(serde_json::from_str::<ImpellerParameters>("{}").unwrap(), d());
}

#[test]
fn inverted_elements_are_named() {
    let mut mesh = impeller_sector(&small()).unwrap().mesh;
    let Elements::Linear(elements) = &mut mesh.elements else { panic!("linear by default") };
    elements[3].swap(0, 1);
    assert!(matches!(mesh.check_jacobians(), Err(ImpellerError::Jacobian { element: 4, .. })));
    assert!(HexMesh::default().check_jacobians().is_ok());
}

/// Parameters far from the default still give a sector with positive Jacobians that can be solved.
#[test]
fn other_shapes_are_generated_too() {
    for sectors in [3, 5, 7, 12, 30] {
        for (wrap_deg, backsweep_deg) in [(0.0, 0.0), (40.0, 35.0), (80.0, 50.0), (120.0, 10.0)] {
            for (inlet_hub_radius, axial_length) in [(18.0, 45.0), (40.0, 62.0), (60.0, 110.0)] {
                let p = ImpellerParameters {
                    sectors,
                    wrap_deg,
                    backsweep_deg,
                    inlet_hub_radius,
                    axial_length,
                    ..small()
                };
                let package = generate(&p).unwrap_or_else(|error| panic!("{p:?}: {error}"));
                assert_eq!(package.manifest.contact.len(), p.contact_nodes);
            }
        }
    }
}

/// Package of the same parameters: the same bits, as models are known by their content.
#[test]
fn the_same_parameters_give_the_same_package() {
    let p = ImpellerParameters::default();
    assert_eq!(generate(&p).unwrap(), generate(&p).unwrap());
}
