//! Shared impeller: a real mesh, in both frames, against each other.

use rubmap::dynamics::sector::CyclicMatrix;
use rubmap::package::{self, Limits};

use crate::sample::shared_models;

#[test]
fn both_frames_of_the_impeller_are_one_sector() {
    let Some(models) = shared_models() else {
        println!("skipped: no shared models beside the project (set RUBMAP_SHARED)");
        return;
    };
    let [cylindrical, cartesian] = ["impeller-a.zip", "impeller-a-cartesian.zip"].map(|name| {
        let start = std::time::Instant::now();
        let imported = package::read(&models.join(name), &Limits::default()).expect("a good package");
        println!("{name}: imported in {:.3} s, digest {}", start.elapsed().as_secs_f64(), imported.digest);
        imported.sector
    });
    assert_eq!((cylindrical.sectors, cylindrical.own_dofs(), cylindrical.contact.len()), (10, 3093, 10));
    assert_eq!(cylindrical.node_of_dof, cartesian.node_of_dof);
    for (a, b) in cylindrical.contact.iter().zip(&cartesian.contact) {
        assert_eq!((a.id, a.dofs, a.position), (b.id, b.dofs, b.position));
        // Both were printed from the same normals with 17 digits.
        assert!(a.normal.iter().zip(b.normal).all(|(a, b)| (a - b).abs() < 1e-14));
    }
    let matrices = |s: &'static str, a: &CyclicMatrix, b: &CyclicMatrix| {
        let largest = a.own.val().iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        for (a, b) in [(&a.own, &b.own), (&a.next, &b.next)] {
            let difference = (a.to_dense() - b.to_dense()).norm_max();
            println!("{s}: largest difference {:.1e} of the largest entry", difference / largest);
            // The rotation there (by the model's author) and back is a few roundings of entries up to the largest.
            assert!(difference <= 1e-14 * largest);
        }
    };
    matrices("M", &cylindrical.mass, &cartesian.mass);
    for (a, b) in cylindrical.stiffness.iter().zip(&cartesian.stiffness) {
        matrices("K", a, b);
    }
}
