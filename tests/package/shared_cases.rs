//! Shared packages that are wrong in one way each.

use rubmap::dynamics::findings::SpinAtSpeed;
use rubmap::package::{self, Imported, Limits, PackageError};

use crate::sample::shared_models;

fn case(name: &str) -> Option<Result<Imported, PackageError>> {
    let Some(models) = shared_models() else {
        println!("skipped: no shared models beside the project (set RUBMAP_SHARED)");
        return None;
    };
    let path = models.with_file_name("cases").join(name);
    if !path.is_file() {
        println!("skipped: {} is not there", path.display());
        return None;
    }
    Some(package::read(&path, &Limits::default()))
}

#[test]
fn speeds_in_rpm_are_told_as_such() {
    let Some(read) = case("sp_rpm.zip") else { return };
    for SpinAtSpeed { finding, .. } in read.unwrap().findings.spin {
        assert!(finding.is_wrong_at_speed() && finding.to_string().contains("in rpm"), "{finding}");
    }
}

#[test]
fn nodes_in_the_reverse_order_are_refused() {
    let Some(read) = case("d2_rev.zip") else { return };
    let error = read.map(drop).expect_err("another order");
    assert_eq!(error.field(), Some("/dofs"));
    assert!(error.to_string().contains("the DOF table, reversed"), "{error}");
}

#[test]
fn a_package_without_every_other_pair_is_refused() {
    let Some(read) = case("f_half.zip") else { return };
    let error = read.map(drop).expect_err("a slit");
    assert_eq!(error.field(), Some("/cyclic"));
    assert!(error.to_string().contains("they are no pair"), "{error}");
}
