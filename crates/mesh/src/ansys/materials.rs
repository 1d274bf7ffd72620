//! Isotropic materials of a mesh from the properties of the file.

use std::collections::{BTreeMap, BTreeSet};

use super::listed::listed;
use super::properties::Properties;
use super::table::{Curve, Table, together};
use crate::error::{MeshFileError, MeshProblem};
use crate::mesh_file::{DensityRow, ElasticRow, FileMaterial, MeshFile};

/// Largest relative difference of constants that are the same but for their rounding in the file.
const ROUNDING: f64 = 1e-4;
/// Poisson's ratio that Ansys takes where none is given.
const DEFAULT_RATIO: f64 = 0.3;

/// Tables of a material by label.
type Tables = BTreeMap<String, Table>;

/// Puts materials into a mesh, each under its number; those that elements use must be isotropic.
pub(super) fn place(
    properties: &Properties,
    used: &BTreeSet<u64>,
    mesh: &mut MeshFile,
) -> Result<(), MeshFileError> {
    let (mut anisotropic, mut nonlinear, mut without_ratio) = (Vec::new(), Vec::new(), Vec::new());
    for (&number, tables) in &properties.materials {
        let name = number.to_string();
        if let Some((label, line)) = anisotropy(tables)? {
            if used.contains(&number) {
                let what = format!("material {number}, anisotropic or not linear by {label},");
                let advice = "materials are isotropic: give it EX and PRXY alone";
                return Err(MeshProblem::NotCarried { what, advice }.at(line, "MPDATA"));
            }
            anisotropic.push(name);
            continue;
        }
        if tables.keys().any(|label| label.starts_with("TB,")) {
            nonlinear.push(name.clone());
        }
        if tables.contains_key("EX") && ratio(tables)?.is_none() {
            without_ratio.push(name.clone());
        }
        let material = material(tables)?;
        if material != FileMaterial::default() {
            mesh.materials.insert(name, material);
        }
    }
    for (names, note) in [
        (anisotropic, "materials that are anisotropic and left out, as no element uses them"),
        (nonlinear, "materials with tables (TB) that a linear model does not use"),
        (without_ratio, "materials without Poisson's ratio, which is 0.3 then, as in Ansys"),
    ] {
        if !names.is_empty() {
            mesh.note(format!("{note}: {}", listed(&names)));
        }
    }
    Ok(())
}

/// Material of tables that are isotropic.
fn material(tables: &Tables) -> Result<FileMaterial, MeshFileError> {
    let mut material = FileMaterial::default();
    if let Some(modulus) = curve(tables, "EX")? {
        let ratio = ratio(tables)?.unwrap_or_else(|| Curve::constant(DEFAULT_RATIO));
        for temperature in together(&[&modulus, &ratio]) {
            let at = temperature.unwrap_or(0.0);
            let row = modulus.at(at).zip(ratio.at(at));
            let row = row.map(|(youngs_modulus, poissons_ratio)| ElasticRow {
                youngs_modulus,
                poissons_ratio,
                temperature,
            });
            material.elastic.extend(row);
        }
    }
    if let Some(density) = curve(tables, "DENS")? {
        for temperature in together(&[&density]) {
            let row = density.at(temperature.unwrap_or(0.0));
            material.density.extend(row.map(|density| DensityRow { density, temperature }));
        }
    }
    Ok(material)
}

/// Curve of a label, if the file has values of it.
fn curve(tables: &Tables, label: &str) -> Result<Option<Curve>, MeshFileError> {
    let Some(table) = tables.get(label) else { return Ok(None) };
    let curve = table.curve().map_err(|problem| problem.at(table.line, "MPDATA"))?;
    Ok(curve.at(0.0).is_some().then_some(curve))
}

/// Poisson's ratio: major and minor are the same of an isotropic material.
fn ratio(tables: &Tables) -> Result<Option<Curve>, MeshFileError> {
    Ok(curve(tables, "PRXY")?.or(curve(tables, "NUXY")?))
}

/// Label and line of what makes a material anisotropic or not linear elastic, if anything does.
fn anisotropy(tables: &Tables) -> Result<Option<(String, u64)>, MeshFileError> {
    for label in ["TB,ANEL", "TB,ELAS", "TB,HYPE"] {
        let found = tables.iter().find(|(name, _)| name.starts_with(label));
        if let Some((name, table)) = found {
            return Ok(Some((name.clone(), table.line)));
        }
    }
    let (modulus, ratio) = (curve(tables, "EX")?, ratio(tables)?);
    let ratio_or_default = ratio.clone().unwrap_or_else(|| Curve::constant(DEFAULT_RATIO));
    let shear = |t: f64| Some(modulus.as_ref()?.at(t)? / (2.0 * (1.0 + ratio_or_default.at(t)?)));
    for (label, table) in tables {
        let isotropic = |t: f64| match label.as_str() {
            "EY" | "EZ" => modulus.as_ref()?.at(t),
            "NUXY" | "PRYZ" | "PRXZ" | "NUYZ" | "NUXZ" => ratio_or_default.at(t),
            _ => shear(t),
        };
        let others = ["EY", "EZ", "NUXY", "PRYZ", "PRXZ", "NUYZ", "NUXZ", "GXY", "GYZ", "GXZ"]
            .contains(&label.as_str());
        let Some(found) = curve(tables, label)?.filter(|_| others) else { continue };
        let curves: Vec<&Curve> =
            [Some(&found), modulus.as_ref(), ratio.as_ref()].into_iter().flatten().collect();
        let same = |t: Option<f64>| {
            let t = t.unwrap_or(0.0);
            let pair = found.at(t).zip(isotropic(t));
            pair.is_some_and(|(a, b)| (a - b).abs() <= ROUNDING * a.abs().max(b.abs()))
        };
        if !together(&curves).into_iter().all(same) {
            return Ok(Some((label.clone(), table.line)));
        }
    }
    Ok(None)
}
