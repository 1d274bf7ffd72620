//! Size and materials of a model in SI units.

use rubmap_solid::inertia::wheel_body;
use rubmap_solid::mesh::SectorMesh;
use rubmap_wheel::dynamics::findings::{InSi, MaterialInSi, WheelInSi};
use rubmap_wheel::dynamics::sector::SectorModel;

use crate::package::check::agreement::times;
use crate::package::check::layout::{Layout, NONE};
use crate::package::units;

/// Size and materials of a `sector` whose matrices still count time in the package's unit; none where a unit is not known.
pub(in crate::package) fn of(
    sector: &SectorModel,
    mesh: Option<&SectorMesh>,
    layout: &Layout,
) -> Option<InSi> {
    let [length, _, mass] = units::si_sizes(&sector.units)?;
    let radius = sector.contact.iter().map(|node| node.position[0]).fold(0.0, f64::max);
    let materials = mesh.into_iter().flat_map(|mesh| &mesh.sets).map(|set| {
        let [youngs_modulus_pa, density_kg_m3] =
            units::material_in_si(set.material.youngs_modulus, set.material.density, &sector.units)?;
        Some(MaterialInSi {
            set: set.name.clone(),
            youngs_modulus_pa,
            density_kg_m3,
            wave_speed_m_s: (youngs_modulus_pa / density_kg_m3).sqrt(),
        })
    });
    Some(InSi {
        mass_kg: sector.sectors as f64 * free_mass(sector, layout) * mass,
        contact_radius_m: radius * length,
        tip_speed_m_s: sector
            .speeds_rad_s
            .last()
            .filter(|&&speed| speed > 0.0)
            .map(|speed| speed * radius * length),
        wheel: mesh.and_then(wheel_body).map(|body| WheelInSi {
            volume_m3: body.volume * length.powi(3),
            mass_kg: body.mass * mass,
            centre_m: body.centre * length,
            polar_inertia_kg_m2: body.polar_inertia * mass * length * length,
        }),
        materials: materials.collect::<Option<_>>()?,
    })
}

/// Mass of a sector in a translation along its axis, without clamped nodes.
fn free_mass(sector: &SectorModel, layout: &Layout) -> f64 {
    let mut along = vec![0.0; sector.own_dofs()];
    for rows in layout.rows_of_node.iter().filter(|rows| !rows.contains(&NONE)) {
        along[layout.own_of_row[rows[2] as usize] as usize] = 1.0;
    }
    times(&sector.mass, &along).iter().zip(&along).map(|(force, moved)| force * moved).sum()
}
