//! Rigid boundary: so many modes kept under `massless_boundary` that fewer are left out than there are contact nodes.
//!
//! The residual flexibility is then singular: forces of any size close no gap, or, with a little added to its diagonal,
//! leave the blade deep in the casing (measured on a soft wheel: half the lobe's height) under numbers that look
//! settled. Guaranteed: `auto` never keeps that many; asked for, they are refused at /integration/kept_modes; the largest
//! number that is not refused runs and closes every gap.

use rubmap::analysis::error::AnalysisError;
use rubmap::analysis::monitor::Unwatched;
use rubmap::analysis::run::check;
use serde_json::json;

use crate::fixtures::{TOP_SPEED, WheelRecipe, wheel};
use crate::support::{assert_sound, reduced, run, sweep};

const CONTACT_NODES: u32 = 3;

#[test]
fn modes_left_out_are_at_least_as_many_as_contact_nodes() {
    let sector = wheel(WheelRecipe { contact_nodes: CONTACT_NODES as usize, ..Default::default() });
    let reduced = reduced(&sector, 6);
    let modes = *reduced.report.unknowns.iter().min().unwrap();
    let keeping = |kept: u32| {
        let changes = json!({"integration": {"kept_modes": kept, "revolutions": 3, "window_revolutions": 1}});
        sweep(&sector, "massless_boundary", &[0.6 * TOP_SPEED], changes)
    };
    for kept in [modes - CONTACT_NODES + 1, modes - 1, modes, modes + 1, 1000, u32::MAX] {
        let Err(AnalysisError::Refused(violations)) = check(&reduced, &keeping(kept), &Unwatched) else {
            panic!("{kept} of {modes} modes leave the boundary no flexibility");
        };
        assert_eq!(violations[0].pointer, "/integration/kept_modes");
        assert!(violations[0].message.contains("keep fewer"), "{violations:?}");
    }
    let result = &run(&reduced, &keeping(modes - CONTACT_NODES))[0];
    assert_sound(result, 1.0);
    assert!(result.point.contact_share > 0.0);
}
