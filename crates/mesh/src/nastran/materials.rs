//! MAT1 and PSOLID.

use std::collections::BTreeMap;

use crate::error::{MeshFileError, MeshProblem};
use crate::mesh_file::{DensityRow, ElasticRow, FileMaterial, MeshFile};

use super::card::Card;
use super::place::Place;

/// Materials and properties by number.
#[derive(Default)]
pub(super) struct Materials {
    isotropic: BTreeMap<u64, FileMaterial>,
    /// Names of the cards of materials that a model cannot have.
    others: BTreeMap<u64, String>,
    properties: BTreeMap<u64, Property>,
}

/// Property of solid elements.
struct Property {
    material: u64,
    place: Place,
}

impl Materials {
    /// Adds a MAT1.
    pub(super) fn add(&mut self, card: &Card) -> Result<(), MeshFileError> {
        let id = card.integer(1, "the number of a material")?;
        let [e, g, nu] = [
            card.real(2, "Young's modulus E")?,
            card.real(3, "the shear modulus G")?,
            card.real(4, "Poisson's ratio NU")?,
        ];
        let (youngs_modulus, poissons_ratio) = match (e, g, nu) {
            (Some(e), _, Some(nu)) => (e, nu),
            (Some(e), Some(g), None) => (e, e / (2.0 * g) - 1.0),
            (None, Some(g), Some(nu)) => (2.0 * g * (1.0 + nu), nu),
            _ => return Err(card.expected("two of E, G and NU")),
        };
        if !(youngs_modulus.is_finite() && poissons_ratio.is_finite()) {
            return Err(card.expected("E, G and NU that go together"));
        }
        let elastic = vec![ElasticRow { youngs_modulus, poissons_ratio, temperature: None }];
        let density = card.real(5, "the density RHO")?;
        let density = density.map(|density| DensityRow { density, temperature: None }).into_iter().collect();
        match self.isotropic.insert(id, FileMaterial { elastic, density }) {
            None => Ok(()),
            Some(_) => Err(card.error(MeshProblem::Twice { what: "material", id })),
        }
    }

    /// Adds a material of another card, which is refused where a solid element has it.
    pub(super) fn add_other(&mut self, card: &Card) -> Result<(), MeshFileError> {
        self.others.insert(card.integer(1, "the number of a material")?, card.name.clone());
        Ok(())
    }

    /// Adds a PSOLID.
    pub(super) fn add_property(&mut self, card: &Card) -> Result<(), MeshFileError> {
        let id = card.integer(1, "the number of a property")?;
        let material = card.integer(2, "the number of a material")?;
        if card.text(7).to_uppercase().ends_with("FLUID") {
            return Err(card.not_carried("a fluid", "a model is of solid elements only: take the fluid out"));
        }
        match self.properties.insert(id, Property { material, place: card.place.clone() }) {
            None => Ok(()),
            Some(_) => Err(card.error(MeshProblem::Twice { what: "property", id })),
        }
    }

    /// Adds the materials, and the sections of all properties that elements have.
    pub(super) fn add_to(self, mesh: &mut MeshFile) -> Result<(), MeshFileError> {
        for (id, Property { material, place }) in &self.properties {
            let set = id.to_string();
            if !mesh.element_sets.contains_key(&set) {
                continue;
            }
            if let Some(card) = self.others.get(material) {
                let what = format!("material {material}, which has a {card}");
                let advice = "give it by MAT1 alone: isotropic, elastic, at one temperature";
                return Err(place.error(MeshProblem::NotCarried { what, advice }, "PSOLID"));
            }
            if !self.isotropic.contains_key(material) {
                let problem = MeshProblem::NoSuch { what: "material", name: material.to_string() };
                return Err(place.error(problem, "PSOLID"));
            }
            mesh.sections.push((set, name(*material)));
        }
        mesh.materials = self.isotropic.into_iter().map(|(id, material)| (name(id), material)).collect();
        Ok(())
    }
}

fn name(material: u64) -> String {
    format!("MAT1 {material}")
}
