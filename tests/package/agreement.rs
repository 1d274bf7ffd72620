//! Agreement of the elements' materials with those of the matrices.

use rubmap::impeller::mesh::ElementOrder;
use rubmap::impeller::{Preset, generate};
use rubmap::package::{self, Limits};
use rubmap::solid::element::ElementKind;
use serde_json::json;

use crate::bad::{case, check_on};
use crate::mesh::{disk, linear};
use crate::sample::{Files, shared_models};

const JSON: Option<&str> = Some("sector.json");

fn set(f: &mut Files, field: &str, value: f64) {
    f.json(|json| json["mesh"]["sets"]["WHEEL"][field] = json!(value));
}

/// Wrong units are refused, here for the generator's titanium: 114 000 N/mm², 0.32 and 4.43e-9 t/mm³.
#[test]
fn wrong_units_are_refused() {
    check_on(
        &linear(),
        &[
            case(
                |f| set(f, "youngs_modulus", 113.8),
                "sector.json, /mesh/sets/WHEEL/youngs_modulus: the elements have Young's modulus 113.8 and Poisson's ratio 0.32, but k0.npz is the stiffness of a material with 1.140e5 and 0.320; give the constants that it was made with, in the package's units (force/length²)",
                (JSON, None, Some("/mesh/sets/WHEEL/youngs_modulus")),
            ),
            case(
                |f| set(f, "poissons_ratio", 0.0342),
                "sector.json, /mesh/sets/WHEEL/poissons_ratio: the elements have Young's modulus 114000.0 and Poisson's ratio 0.0342, but k0.npz is the stiffness of a material with 1.140e5 and 0.320; give the constants that it was made with, in the package's units (force/length²)",
                (JSON, None, Some("/mesh/sets/WHEEL/poissons_ratio")),
            ),
            case(
                |f| set(f, "density", 4430.0),
                "sector.json, /mesh/sets/WHEEL/density: the elements have density 4430.0, but m.npz is the mass of a material with 4.430e-9; give the density that it was made with, in the package's units (mass/length³)",
                (JSON, None, Some("/mesh/sets/WHEEL/density")),
            ),
        ],
    );
}

/// Additions at a node are not the material: a stiff spring and a point mass at one of four free nodes do not speak for the others; in
/// another formulation uniform strain is the same.
#[test]
fn what_is_added_at_a_node_is_not_the_material() {
    let mut package = disk(ElementOrder::Linear);
    let node = package.dofs.iter().position(|dof| dof.node == 6).unwrap() as u32;
    for (matrix, added) in [(&mut package.stiffness[0], 1e9), (&mut package.mass, 1e-3)] {
        let own = matrix
            .entries
            .iter_mut()
            .filter(|(row, column, _)| row == column && (node..node + 3).contains(row));
        own.for_each(|(_, _, value)| *value += added);
    }
    for element in package.elements.as_mut().unwrap() {
        element.kind = ElementKind::C3D8;
    }
    package::to_sector(package).unwrap();
}

/// Set whose material is wrong, one of two: it is named.
#[test]
fn the_set_is_named() {
    let mut package = disk(ElementOrder::Quadratic);
    let mesh = package.manifest.mesh.as_mut().unwrap();
    let mut other = mesh.sets["WHEEL"].clone();
    other.youngs_modulus *= 2.0;
    mesh.sets.insert("RIM".into(), other);
    for element in package.elements.as_mut().unwrap().iter_mut().filter(|element| element.id % 2 == 0) {
        element.set = "RIM".into();
    }
    let refused = package::to_sector(package).unwrap_err();
    assert_eq!(refused.field(), Some("/mesh/sets/RIM/youngs_modulus"), "{refused}");
}

#[test]
fn generated_and_shared_models_pass() {
    for preset in [Preset::Small, Preset::Medium] {
        let parameters = preset.parameters();
        package::to_sector(generate(&parameters).unwrap()).unwrap();
    }
    let Some(models) = shared_models() else { return };
    for name in ["impeller-a.zip", "impeller-a-cartesian.zip", "impeller-a-nlgeom.zip"] {
        package::read(&models.join(name), &Limits::default()).unwrap();
    }
}
