//! Material of every element: from the settings or from the file.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use rubmap_mesh::{FileMaterial, MeshFile};
use rubmap_solid::material::Material;
use rubmap_solid::mesh::ElementSet;

use super::error::FromMeshError;
use super::settings::MeshSettings;

/// Name that stands for all elements.
const ALL: &str = "*";

/// Element sets of one material each, and the index of the set of every element.
pub(super) fn assigned(
    file: &MeshFile,
    settings: &MeshSettings,
) -> Result<(Vec<ElementSet>, HashMap<u64, u32>), FromMeshError> {
    check_names(file, settings)?;
    let mut sets = Vec::new();
    let mut set_of = HashMap::new();
    for (name, material, elements) in parts(file, settings)? {
        let made = made(file, settings, &name, material.as_deref())?;
        for element in elements {
            set_of.insert(element, sets.len() as u32);
        }
        sets.push(ElementSet { name, material: made });
    }
    match file.elements.keys().find(|element| !set_of.contains_key(element)) {
        None => {}
        Some(&element) => {
            let known = known(file);
            return Err(FromMeshError::NoMaterial { element, known });
        }
    }
    // Sets that others took all elements from are no sets of the model.
    let used: BTreeSet<u32> = set_of.values().copied().collect();
    let place: HashMap<u32, u32> = used.iter().copied().zip(0..).collect();
    set_of.values_mut().for_each(|set| *set = place[set]);
    let kept = sets.into_iter().zip(0..).filter(|(_, k)| used.contains(k)).map(|(set, _)| set).collect();
    Ok((kept, set_of))
}

/// Set, material of the file and elements of each part of the mesh; later parts take elements from earlier ones.
type Part = (String, Option<String>, BTreeSet<u64>);

fn parts(file: &MeshFile, settings: &MeshSettings) -> Result<Vec<Part>, FromMeshError> {
    let mut parts: Vec<Part> = Vec::new();
    if file.sections.is_empty() || settings.materials.contains_key(ALL) && file.materials.is_empty() {
        if settings.materials.contains_key(ALL) || file.materials.len() == 1 {
            let material =
                (file.materials.len() == 1).then(|| file.materials.keys().next().cloned()).flatten();
            parts.push(("ALL".to_owned(), material, file.elements.keys().copied().collect()));
        }
        for (name, elements) in &file.element_sets {
            if settings.materials.contains_key(name) {
                parts.push((name.clone(), None, elements.clone()));
            }
        }
        return Ok(parts);
    }
    for (set, material) in &file.sections {
        let elements = file.element_sets.get(set).cloned().unwrap_or_default();
        parts.push((set.clone(), Some(material.clone()), elements));
    }
    for (name, elements) in &file.element_sets {
        let of_section = file.sections.iter().any(|(set, _)| set == name);
        if settings.materials.contains_key(name) && !of_section {
            parts.push((name.clone(), None, elements.clone()));
        }
    }
    Ok(parts)
}

/// Refuses names that the file does not have.
fn check_names(file: &MeshFile, settings: &MeshSettings) -> Result<(), FromMeshError> {
    let names = settings.materials.keys().chain(settings.temperatures.keys());
    for name in names {
        let in_file = file.element_sets.contains_key(name) || file.materials.contains_key(name);
        if name != ALL && !in_file {
            return Err(FromMeshError::NoSuchMaterial { name: name.clone(), known: known(file) });
        }
    }
    for (name, material) in &settings.materials {
        check(name, material)?;
    }
    Ok(())
}

fn known(file: &MeshFile) -> Vec<String> {
    file.element_sets.keys().chain(file.materials.keys()).cloned().collect()
}

/// Setting for a set: by its own name, that of its material, or for all.
fn setting<'a, T>(settings: &'a BTreeMap<String, T>, set: &str, material: Option<&str>) -> Option<&'a T> {
    settings.get(set).or_else(|| settings.get(material?)).or_else(|| settings.get(ALL))
}

fn made(
    file: &MeshFile,
    settings: &MeshSettings,
    set: &str,
    material: Option<&str>,
) -> Result<Material, FromMeshError> {
    if let Some(given) = setting(&settings.materials, set, material) {
        return Ok(given.clone());
    }
    let name = material.unwrap_or(set);
    let lacks = |what| FromMeshError::MaterialLacks { material: name.to_owned(), what };
    let stated = file.materials.get(name).ok_or(lacks("constants"))?;
    let at = setting(&settings.temperatures, set, material).copied();
    let [youngs_modulus, poissons_ratio] = elastic(stated, at, name)?.ok_or(lacks("elastic constants"))?;
    let density = density(stated, at, name)?.ok_or(lacks("density"))?;
    let made = Material {
        youngs_modulus,
        poissons_ratio,
        density,
        yield_strength: None,
        ultimate_strength: None,
        fatigue_strength: None,
    };
    check(name, &made)?;
    Ok(made)
}

/// Refuses constants without a positive definite elasticity.
fn check(name: &str, material: &Material) -> Result<(), FromMeshError> {
    let positive = |x: f64| x > 0.0 && x.is_finite();
    let wrong = |constant, value, rule| {
        Err(FromMeshError::Constant { material: name.to_owned(), constant, value, rule })
    };
    if !positive(material.youngs_modulus) {
        return wrong("Young's modulus", material.youngs_modulus, "must be positive");
    }
    if !positive(material.density) {
        return wrong("density", material.density, "must be positive");
    }
    if !(material.poissons_ratio > -1.0 && material.poissons_ratio < 0.5) {
        return wrong("Poisson's ratio", material.poissons_ratio, "must be above -1 and below 0.5");
    }
    Ok(())
}

fn elastic(stated: &FileMaterial, at: Option<f64>, name: &str) -> Result<Option<[f64; 2]>, FromMeshError> {
    let rows: Vec<(Option<f64>, [f64; 2])> = (stated.elastic.iter())
        .map(|row| (row.temperature, [row.youngs_modulus, row.poissons_ratio]))
        .collect();
    tabulated(&rows, at, name)
}

fn density(stated: &FileMaterial, at: Option<f64>, name: &str) -> Result<Option<f64>, FromMeshError> {
    let rows: Vec<(Option<f64>, [f64; 1])> =
        stated.density.iter().map(|row| (row.temperature, [row.density])).collect();
    Ok(tabulated(&rows, at, name)?.map(|[density]| density))
}

/// Row of a table at a temperature, straight between the rows and constant beyond its ends; the only row for any temperature.
fn tabulated<const N: usize>(
    rows: &[(Option<f64>, [f64; N])],
    at: Option<f64>,
    name: &str,
) -> Result<Option<[f64; N]>, FromMeshError> {
    if let [(_, only)] = rows {
        return Ok(Some(*only));
    }
    let Some(at) = at.filter(|_| !rows.is_empty()) else {
        let material = name.to_owned();
        let untold = FromMeshError::Temperature { material, rows: rows.len() };
        return if rows.is_empty() { Ok(None) } else { Err(untold) };
    };
    let mut sorted: Vec<(f64, [f64; N])> =
        rows.iter().map(|(t, values)| (t.unwrap_or(0.0), *values)).collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let above = sorted.partition_point(|row| row.0 < at).clamp(1, sorted.len() - 1);
    let ((t0, a), (t1, b)) = (sorted[above - 1], sorted[above]);
    let part = if t1 > t0 { ((at - t0) / (t1 - t0)).clamp(0.0, 1.0) } else { 0.0 };
    Ok(Some(std::array::from_fn(|k| a[k] + part * (b[k] - a[k]))))
}
