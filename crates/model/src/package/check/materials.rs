//! Checks of the materials in `sector.json`.

use std::ops::RangeInclusive;

use rubmap_solid::material::Material;
use rubmap_wheel::dynamics::sector::Units;

use crate::package::error::{ManifestProblem, PackageError};
use crate::package::quote::quoted;
use crate::package::raw::{LONGEST_NAME, Manifest, ManifestMesh};
use crate::package::units;

/// Largest Young's modulus that a package may have, Pa: a hundred diamonds.
const STIFFEST: f64 = 1e14;

/// Smallest Young's modulus that a package may have, Pa: a thousandth of the softest gels.
const SOFTEST: f64 = 1.0;

/// Largest density that a package may have, kg/m³: fifty times osmium.
const DENSEST: f64 = 1e6;

/// Smallest density that a package may have, kg/m³: a hundredth of air.
const LIGHTEST: f64 = 1e-2;

/// Largest number of element sets, more than any wheel has materials.
const MOST_SETS: usize = 1000;

/// Checks names, constants and strengths.
pub(super) fn check(mesh: &ManifestMesh) -> Result<(), PackageError> {
    if mesh.sets.len() > MOST_SETS {
        let problem = ManifestProblem::TooMany { what: "element sets", limit: MOST_SETS };
        return Err(PackageError::manifest("/mesh/sets", problem));
    }
    for (name, material) in &mesh.sets {
        let set = pointer(name);
        if name.chars().nth(LONGEST_NAME).is_some() {
            return Err(PackageError::manifest(set, ManifestProblem::TextTooLong { limit: LONGEST_NAME }));
        }
        of_one(material)
            .map_err(|(field, problem)| PackageError::manifest(format!("{set}/{field}"), problem))?;
    }
    Ok(())
}

/// Refuses constants beyond those of any solid, if the units are known. Runs after the checks of the matrices, whose messages say more.
pub(crate) fn check_solids(manifest: &Manifest) -> Result<(), PackageError> {
    for (name, material) in manifest.mesh.iter().flat_map(|mesh| &mesh.sets) {
        of_a_solid(material, &manifest.units).map_err(|(field, problem)| {
            PackageError::manifest(format!("{}/{field}", pointer(name)), problem)
        })?;
    }
    Ok(())
}

fn of_a_solid(material: &Material, units: &Units) -> Result<(), (&'static str, ManifestProblem)> {
    let (modulus, density) = (material.youngs_modulus, material.density);
    let Some([modulus_pa, density_kg_m3]) = units::material_in_si(modulus, density, units) else {
        return Ok(());
    };
    if !(SOFTEST..=STIFFEST).contains(&modulus_pa) {
        return Err(("youngs_modulus", no_solid(modulus, modulus_pa, SOFTEST..=STIFFEST, "Pa")));
    }
    if !(LIGHTEST..=DENSEST).contains(&density_kg_m3) {
        return Err(("density", no_solid(density, density_kg_m3, LIGHTEST..=DENSEST, "kg/m³")));
    }
    Ok(())
}

fn no_solid(value: f64, in_si: f64, accepted: RangeInclusive<f64>, unit: &'static str) -> ManifestProblem {
    ManifestProblem::NoSolid { value, in_si, least: *accepted.start(), most: *accepted.end(), unit }
}

/// JSON pointer to a set.
pub(super) fn pointer(name: &str) -> String {
    format!("/mesh/sets/{}", quoted(name).replace('~', "~0").replace('/', "~1"))
}

fn of_one(material: &Material) -> Result<(), (&'static str, ManifestProblem)> {
    let Material { youngs_modulus, poissons_ratio, density, yield_strength, ultimate_strength, .. } =
        material;
    let fatigue = material.fatigue_strength.as_ref();
    for (field, value) in [
        ("youngs_modulus", Some(*youngs_modulus)),
        ("density", Some(*density)),
        ("yield_strength", *yield_strength),
        ("ultimate_strength", *ultimate_strength),
        ("fatigue_strength/amplitude", fatigue.map(|fatigue| fatigue.amplitude)),
    ] {
        if let Some(value) = value.filter(|value| !(*value > 0.0 && value.is_finite())) {
            return Err((field, ManifestProblem::NotPositive { value }));
        }
    }
    if !(*poissons_ratio > -1.0 && *poissons_ratio < 0.5) {
        return Err(("poissons_ratio", ManifestProblem::PoissonsRatio { value: *poissons_ratio }));
    }
    if let (Some(yields), Some(ultimate)) = (yield_strength, ultimate_strength)
        && ultimate < yields
    {
        let problem = ManifestProblem::BreaksBeforeYielding { ultimate: *ultimate, yields: *yields };
        return Err(("ultimate_strength", problem));
    }
    if let (Some(fatigue), Some(ultimate)) = (fatigue, ultimate_strength)
        && fatigue.amplitude > *ultimate
    {
        let problem =
            ManifestProblem::FatigueAboveUltimate { amplitude: fatigue.amplitude, ultimate: *ultimate };
        return Err(("fatigue_strength/amplitude", problem));
    }
    match fatigue.map(|fatigue| fatigue.source.trim()) {
        Some("") => Err(("fatigue_strength/source", ManifestProblem::NoSource)),
        Some(source) if source.chars().nth(LONGEST_NAME).is_some() => {
            Err(("fatigue_strength/source", ManifestProblem::TextTooLong { limit: LONGEST_NAME }))
        }
        _ => Ok(()),
    }
}
