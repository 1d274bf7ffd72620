//! Wheels of random proportions: meshed, or refused by name.

use proptest::prelude::*;
use proptest::test_runner::TestCaseResult;
use rubmap::impeller::{ImpellerError, ImpellerParameters, MeshDensities, Splitter, impeller_sector};

use crate::campaign::campaign;
use crate::conformity::{check_conforming, check_cyclic, volume};
use crate::fixed::fixed;
use crate::impeller_mesh::{ORDERS, densities};

fn counts() -> impl Strategy<Value = MeshDensities> {
    [1..4usize, 1..4, 1..4, 1..4, 1..4].prop_map(densities)
}

/// Wheels of any proportions that pass the ranges, from the plausible to the absurd.
fn any_wheel() -> impl Strategy<Value = ImpellerParameters> {
    let splitter = prop::option::of((0.0..1.0f64).prop_map(|leading_edge| Splitter { leading_edge }));
    let radii = [1.0..60.0f64, 0.1..60.0, 0.1..80.0, 0.1..80.0];
    let heights = [0.1..40.0f64, 0.1..120.0, 0.1..30.0];
    let blade = (0.05..12.0f64, 0.05..1.0f64, 0.0..120.0f64, 0.0..75.0f64);
    let order = prop::sample::select(ORDERS.to_vec());
    (3..70usize, radii, heights, blade, splitter, 2..6usize, order, counts()).prop_map(
        |(
            sectors,
            radii,
            [height, axial, rim_thickness],
            blade,
            splitter,
            contact_nodes,
            element_order,
            mesh,
        )| {
            let (root_thickness, taper, wrap_deg, backsweep_deg) = blade;
            let [bore_radius, hub, tip, outlet] = radii;
            ImpellerParameters {
                sectors,
                bore_radius,
                inlet_hub_radius: bore_radius + hub,
                inlet_tip_radius: bore_radius + hub + tip,
                outlet_radius: bore_radius + hub + tip + outlet,
                axial_length: height + axial,
                outlet_blade_height: height,
                rim_thickness,
                root_thickness,
                tip_thickness: taper * root_thickness,
                wrap_deg,
                backsweep_deg,
                splitter,
                contact_nodes,
                element_order,
                mesh,
                ..ImpellerParameters::default()
            }
        },
    )
}

/// Asserts that a wheel is either a conforming mesh with positive Jacobians whose faces fit, or refused with the name of a field or an element.
fn is_meshed_or_refused(p: &ImpellerParameters) -> TestCaseResult {
    match impeller_sector(p) {
        Ok(sector) => {
            check_conforming(&sector.mesh, 1e-3 * p.root_thickness.min(p.bore_radius));
            check_cyclic(&sector, p.outlet_radius);
            prop_assert!(volume(&sector.mesh) > 0.0);
            prop_assert_eq!(sector.contact.len(), p.contact_nodes);
        }
        Err(ImpellerError::Parameter { .. } | ImpellerError::Jacobian { .. }) => {}
        Err(other) => prop_assert!(false, "{}", other),
    }
    Ok(())
}

#[test]
#[ignore = "a campaign: runs for as long as one likes"]
fn campaign_of_meshed_wheels() {
    campaign("random wheels to be meshed", any_wheel(), |p| is_meshed_or_refused(&p));
}

proptest! {
    #![proptest_config(fixed(400))]

    #[test]
    fn any_wheel_is_meshed_or_refused_by_name(p in any_wheel()) {
        is_meshed_or_refused(&p)?;
    }

    /// Values that no wheel can have are refused too, without a panic.
    #[test]
    fn absurd_numbers_are_refused(field in 0..12usize, value in prop::num::f64::ANY) {
        let mut p = ImpellerParameters { mesh: densities([1, 1, 1, 1, 1]), ..ImpellerParameters::default() };
        let fields = [
            &mut p.bore_radius, &mut p.inlet_hub_radius, &mut p.inlet_tip_radius, &mut p.outlet_radius,
            &mut p.axial_length, &mut p.outlet_blade_height, &mut p.rim_thickness, &mut p.root_thickness,
            &mut p.tip_thickness, &mut p.wrap_deg, &mut p.backsweep_deg, &mut p.top_speed_rad_s,
        ];
        *fields.into_iter().nth(field).unwrap() = value;
        if let Ok(sector) = impeller_sector(&p) {
            prop_assert!(volume(&sector.mesh).is_finite());
        }
    }
}
