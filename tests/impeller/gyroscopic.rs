//! The generator's gyroscopic matrix beside its mass: Coriolis forces of motions that every element represents exactly.

use rubmap::impeller::mesh::ElementOrder;
use rubmap::impeller::{ImpellerParameters, MeshDensities, generate};
use rubmap::package::raw::{RawMatrix, RawPackage};
use rubmap::package::to_sector;

fn small(element_order: ElementOrder) -> ImpellerParameters {
    ImpellerParameters {
        contact_nodes: 3,
        gyroscopic: true,
        element_order,
        mesh: MeshDensities {
            between_contact_nodes: 1,
            blade_height: 2,
            blade_thickness: 1,
            half_passage: 1,
            disk: 1,
        },
        ..ImpellerParameters::default()
    }
}

/// Product A u with Aᵀ = ±A.
fn product(matrix: &RawMatrix, image: f64, u: &[f64]) -> Vec<f64> {
    let mut product = vec![0.0; matrix.size];
    for &(row, column, value) in &matrix.entries {
        let (row, column) = (row as usize, column as usize);
        product[row] += value * u[column];
        if row != column {
            product[column] += image * value * u[row];
        }
    }
    product
}

/// Components (r, θ, z) of a vector field in the rows of a package whose axis is z.
fn field(package: &RawPackage, at: impl Fn([f64; 3]) -> [f64; 3]) -> Vec<f64> {
    let component = |dof: &rubmap::package::raw::RawDof| {
        let x = package.nodes[dof.node as usize - 1].position;
        let ([vx, vy, vz], r) = (at(x), x[0].hypot(x[1]));
        [(x[0] * vx + x[1] * vy) / r, (x[0] * vy - x[1] * vx) / r, vz][usize::from(dof.component) - 1]
    };
    package.dofs.iter().map(component).collect()
}

/// Coriolis forces G u = 2 M (e_z × u): for translations and for any linear motion, clamped nodes or not, in either element.
#[test]
fn coriolis_forces_are_those_of_the_mass() {
    for order in [ElementOrder::Linear, ElementOrder::Quadratic] {
        let package = generate(&small(order)).unwrap();
        let gyroscopic = package.gyroscopic.as_ref().unwrap();
        assert!(gyroscopic.entries.iter().all(|&(row, column, _)| row > column));
        let motions: [fn([f64; 3]) -> [f64; 3]; 4] = [
            |_| [1.0, 0.0, 0.0],
            |_| [0.0, 1.0, 0.0],
            |_| [0.0, 0.0, 1.0],
            |[x, y, z]| [0.3 * y - 0.1 * z, 0.2 * x + 0.1 * y, z - x],
        ];
        for motion in motions {
            let crossed = field(&package, |x| {
                let [vx, vy, _] = motion(x);
                [-2.0 * vy, 2.0 * vx, 0.0]
            });
            let expected = product(&package.mass, 1.0, &crossed);
            let found = product(gyroscopic, -1.0, &field(&package, motion));
            let scale = product(&package.mass, 1.0, &field(&package, |[x, y, z]| [x + 1.0, y + 1.0, z]));
            let scale = scale.iter().fold(0.0, |scale, value| f64::max(scale, value.abs()));
            for (a, b) in found.iter().zip(&expected) {
                assert!((a - b).abs() < 1e-13 * scale, "{a:e} {b:e}");
            }
        }
    }
}

/// Gyroscopic matrix only where it is asked for: the rest of the package does not change, and without it neither does the model's id.
#[test]
fn only_where_it_is_asked_for() {
    let with = generate(&small(ElementOrder::Linear)).unwrap();
    let without = generate(&ImpellerParameters { gyroscopic: false, ..small(ElementOrder::Linear) }).unwrap();
    assert!(to_sector(with.clone()).unwrap().gyroscopic.is_some());
    let mut stripped = with;
    assert!(stripped.gyroscopic.take().is_some() && stripped.manifest.gyroscopic.take().is_some());
    assert_eq!(stripped, without);
}
