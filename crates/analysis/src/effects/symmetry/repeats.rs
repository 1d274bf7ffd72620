//! Rotational symmetry of a scene.

use num_integer::gcd;

use super::result::FoundSymmetry;
use crate::effects::effect::Repeats;
use crate::effects::table::named;
use crate::resolved::Scene;
use rubmap_numerics::sector_fourier::harmonic_count;

impl FoundSymmetry {
    /// Finds the symmetry of `scene` around `sectors` sectors.
    pub(crate) fn of(scene: &Scene, sectors: u32) -> Self {
        let repeats = repeats(scene, sectors);
        let (moving, resting) =
            (0..harmonic_count(sectors as usize) as u32).partition(|i| i.is_multiple_of(repeats));
        Self { repeats, moving_nodal_diameters: moving, resting_nodal_diameters: resting }
    }
}

/// Number of times that `scene` repeats around the wheel: [`FoundSymmetry::repeats`].
pub(crate) fn repeats(scene: &Scene, sectors: u32) -> u32 {
    let times = named(scene).flat_map(|effect| match effect.repeats {
        Repeats::Everywhere => Vec::new(),
        Repeats::Times(of) => of(scene),
        Repeats::Once(_) => vec![1],
    });
    times.fold(sectors, gcd)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::resolved::from_json;
    use serde_json::{Value, json};

    fn of(scene: Value, sectors: u32) -> (u32, Vec<u32>) {
        let found = FoundSymmetry::of(&from_json::scene(scene), sectors);
        assert_eq!(
            found.moving_nodal_diameters.len() + found.resting_nodal_diameters.len(),
            harmonic_count(sectors as usize)
        );
        (found.repeats, found.moving_nodal_diameters)
    }

    fn lobes(count: u32) -> Value {
        let casing = json!({"clearance": {"leading": 1, "trailing": 1},
            "lobes": {"count": count, "amplitude": 1, "width_rad": 0.3}});
        json!({"casing": casing, "contact": {}})
    }

    #[test]
    fn what_all_causes_have_in_common_remains() {
        assert_eq!(of(lobes(2), 10), (2, vec![0, 2, 4]));
        assert_eq!(of(lobes(4), 10), (2, vec![0, 2, 4]));
        assert_eq!(of(lobes(3), 10), (1, vec![0, 1, 2, 3, 4, 5]));
        assert_eq!(of(lobes(3), 9), (3, vec![0, 3]));
        // A circular casing, or lobes that nothing touches.
        assert_eq!(of(json!({}), 7), (7, vec![0]));
        let mut untouched = lobes(2);
        untouched.as_object_mut().unwrap().remove("contact");
        assert_eq!(of(untouched, 10), (10, vec![0]));
        let mut driven = lobes(4);
        driven["engine_order_excitation"] =
            json!([{"order": 6, "contact_nodes": [0], "component": "axial", "amplitude": 1}]);
        assert_eq!(of(driven.clone(), 12), (2, vec![0, 2, 4, 6]));
        driven["orbit"] = json!({"radius": 0.1});
        assert_eq!(of(driven, 12).0, 1);
        let mut moving = lobes(4);
        moving["initial"] = json!({"nodal_diameter": 2, "family": 1, "amplitude": 0.1});
        assert_eq!(of(moving, 8), (2, vec![0, 2, 4]));
    }
}
