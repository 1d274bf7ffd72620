//! Meshes of the closed-form bodies: annular disk and beam.

use std::f64::consts::PI;

use rubmap::assembly::CanMove;
use rubmap::impeller::mesh::{ElementOrder, SectorMesh};
use rubmap::impeller::{
    AnnulusParameters, CantileverParameters, ImpellerError, annulus, annulus_mesh, cantilever_mesh,
};

use crate::conformity::{boundary, check_conforming, check_cyclic, volume};

const ORDERS: [ElementOrder; 2] = [ElementOrder::Linear, ElementOrder::Quadratic];

fn disk(order: ElementOrder, sectors: usize, elements: [usize; 3]) -> SectorMesh {
    let parameters =
        AnnulusParameters { sectors, elements, element_order: order, ..AnnulusParameters::default() };
    annulus_mesh(&parameters).unwrap()
}

#[test]
fn annulus_is_conforming_and_closed() {
    let p = AnnulusParameters::default();
    for order in ORDERS {
        for (sectors, elements) in [(3, [2, 9, 1]), (7, [3, 2, 2]), (12, [4, 3, 1]), (64, [1, 2, 3])] {
            let sector = disk(order, sectors, elements);
            check_conforming(&sector.mesh, p.outer_radius);
            check_cyclic(&sector, p.outer_radius);
            let [radial, around, through] = elements;
            let faces = 2 * (radial * around + around * through + through * radial);
            assert_eq!(boundary(&sector.mesh).len(), faces);
            assert_eq!(sector.contact.len(), through + 1);
        }
    }
}

/// Volume of the annulus converges to the closed form: a chord of a circle misses the area by (Δθ)²/6, a parabola
/// through its middle by the fourth order.
#[test]
fn volume_of_the_annulus_converges_to_the_closed_form() {
    let p = AnnulusParameters::default();
    let exact = PI * (p.outer_radius.powi(2) - p.inner_radius.powi(2)) * p.thickness;
    let error = |order, around| {
        let sectors = 6;
        1.0 - sectors as f64 * volume(&disk(order, sectors, [2, around, 1]).mesh) / exact
    };
    for (order, expected, bound) in [(ElementOrder::Linear, 4.0, 3e-3), (ElementOrder::Quadratic, 16.0, 1e-5)]
    {
        let (coarse, fine) = (error(order, 4), error(order, 8));
        println!("{order:?}: {coarse:.2e} {fine:.2e}");
        assert!(fine.abs() < bound && (coarse / fine / expected - 1.0).abs() < 0.02, "{coarse:e} {fine:e}");
    }
}

#[test]
fn mid_edge_nodes_lie_on_the_circles() {
    let p = AnnulusParameters::default();
    let sector = disk(ElementOrder::Quadratic, 3, [2, 2, 1]);
    let radii = [0.0, 0.25, 0.5, 0.75, 1.0].map(|x| p.inner_radius + x * (p.outer_radius - p.inner_radius));
    for [x, y, _] in &sector.mesh.nodes {
        assert!(radii.iter().any(|r| (x.hypot(*y) - r).abs() < 1e-13 * p.outer_radius));
    }
}

#[test]
fn bore_is_clamped_on_request() {
    for clamped_bore in [true, false] {
        let p = AnnulusParameters { clamped_bore, ..AnnulusParameters::default() };
        let sector = annulus_mesh(&p).unwrap();
        for ([x, y, _], clamped) in sector.mesh.nodes.iter().zip(&sector.clamped) {
            let at_bore = (x.hypot(*y) / p.inner_radius - 1.0).abs() < 1e-12;
            assert_eq!(*clamped, [clamped_bore && at_bore; 3]);
        }
    }
}

#[test]
fn bad_disks_are_named() {
    let d = AnnulusParameters::default;
    for (parameters, named) in [
        (AnnulusParameters { sectors: 2, ..d() }, "sectors"),
        (AnnulusParameters { inner_radius: 0.0, ..d() }, "inner_radius"),
        (AnnulusParameters { outer_radius: 30.0, ..d() }, "outer_radius"),
        (AnnulusParameters { thickness: f64::NAN, ..d() }, "thickness"),
        (AnnulusParameters { elements: [0, 2, 1], ..d() }, "elements[0]"),
        (AnnulusParameters { elements: [1, 1, 1], ..d() }, "elements[1]"),
        (AnnulusParameters { elements: [1, 2, 0], ..d() }, "elements[2]"),
        (AnnulusParameters { top_speed_rad_s: 0.0, ..d() }, "top_speed_rad_s"),
    ] {
        match annulus(&parameters) {
            Err(ImpellerError::Parameter { field, .. }) => assert_eq!(field, named),
            other => panic!("{named}: {:?}", other.map(|_| ())),
        }
    }
    let free = AnnulusParameters { clamped_bore: false, elements: [2, 2, 1], ..d() };
    assert_eq!(annulus(&free).map(|_| ()), Err(ImpellerError::CanMove(CanMove)));
}

#[test]
fn beams_of_both_orders_are_conforming() {
    for order in ORDERS {
        for elements in [[5, 1, 1], [3, 2, 4]] {
            let p =
                CantileverParameters { elements, element_order: order, ..CantileverParameters::default() };
            let sector = cantilever_mesh(&p).unwrap();
            check_conforming(&sector.mesh, p.length);
            let exact = p.length * p.width * p.depth;
            assert!((volume(&sector.mesh) / exact - 1.0).abs() < 1e-13);
            assert_eq!(sector.contact.len(), elements[2] + 1);
        }
    }
}
