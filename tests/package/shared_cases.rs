//! Shared packages that are wrong in one way each.

use rubmap::package::{self, Limits};

use crate::sample::shared_models;

#[test]
fn a_package_without_every_other_pair_is_refused() {
    let Some(models) = shared_models() else {
        println!("skipped: no shared models beside the project (set RUBMAP_SHARED)");
        return;
    };
    let path = models.with_file_name("cases").join("f_half.zip");
    if !path.is_file() {
        println!("skipped: {} is not there", path.display());
        return;
    }
    let error = package::read(&path, &Limits::default()).map(drop).expect_err("a slit");
    assert_eq!(error.field(), Some("/cyclic"));
    assert!(error.to_string().contains("they are no pair"), "{error}");
}
