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
    for part in parts(file, settings) {
        let made = made(file, settings, &part)?;
        for element in part.elements {
            set_of.insert(element, sets.len() as u32);
        }
        sets.push(ElementSet { name: part.name, material: made });
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

/// Elements of one material; later parts take elements from earlier ones.
struct Part {
    /// Name of the set in the model.
    name: String,
    /// Names under which the settings may have its material, the first that is there counting.
    settings: Vec<String>,
    /// Material of the file.
    material: Option<String>,
    elements: BTreeSet<u64>,
}

/// Parts of the mesh: all elements, sections of the file, element sets of the settings.
fn parts(file: &MeshFile, settings: &MeshSettings) -> Vec<Part> {
    let mut parts = Vec::new();
    let only = (file.materials.len() == 1 && file.sections.is_empty())
        .then(|| file.materials.keys().next().cloned());
    if settings.materials.contains_key(ALL) || only.is_some() {
        let material = only.flatten();
        let names = material.iter().cloned().chain([ALL.to_owned()]).collect();
        let elements = file.elements.keys().copied().collect();
        parts.push(Part { name: name_of_all(file), settings: names, material, elements });
    }
    for (set, material) in &file.sections {
        let elements = file.element_sets.get(set).cloned().unwrap_or_default();
        let names = vec![set.clone(), material.clone(), ALL.to_owned()];
        parts.push(Part { name: set.clone(), settings: names, material: Some(material.clone()), elements });
    }
    for (set, elements) in &file.element_sets {
        let of_section = file.sections.iter().any(|(other, _)| other == set);
        if settings.materials.contains_key(set) && !of_section {
            let names = vec![set.clone()];
            parts.push(Part {
                name: set.clone(),
                settings: names,
                material: None,
                elements: elements.clone(),
            });
        }
    }
    parts
}

/// Name of the set of all elements, which no set of the file has.
fn name_of_all(file: &MeshFile) -> String {
    let mut name = "ALL".to_owned();
    while file.element_sets.contains_key(&name) {
        name.push('_');
    }
    name
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

/// Setting of a part, by the first of its names that has one.
fn setting<'a, T>(settings: &'a BTreeMap<String, T>, part: &Part) -> Option<&'a T> {
    part.settings.iter().find_map(|name| settings.get(name))
}

fn made(file: &MeshFile, settings: &MeshSettings, part: &Part) -> Result<Material, FromMeshError> {
    if let Some(given) = setting(&settings.materials, part) {
        return Ok(given.clone());
    }
    let name = part.material.as_deref().unwrap_or(&part.name);
    let lacks = |what| FromMeshError::MaterialLacks { material: name.to_owned(), what };
    let stated = file.materials.get(name).ok_or(lacks("constants"))?;
    let at = setting(&settings.temperatures, part).copied();
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
        let unstated = FromMeshError::Temperature { material, rows: rows.len() };
        return if rows.is_empty() { Ok(None) } else { Err(unstated) };
    };
    let mut sorted: Vec<(f64, [f64; N])> =
        rows.iter().map(|(t, values)| (t.unwrap_or(0.0), *values)).collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let above = sorted.partition_point(|row| row.0 < at).clamp(1, sorted.len() - 1);
    let ((t0, a), (t1, b)) = (sorted[above - 1], sorted[above]);
    let part = if t1 > t0 { ((at - t0) / (t1 - t0)).clamp(0.0, 1.0) } else { 0.0 };
    Ok(Some(std::array::from_fn(|k| a[k] + part * (b[k] - a[k]))))
}
