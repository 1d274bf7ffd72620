//! A sector on its way in: the facts requests are checked against, and its reduction with a report in words.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::result::{PreliminaryStiffening, ReductionReport, Strengths};
use crate::stiffening::preliminary_stiffening;
use rubmap_solid::mesh::SectorMesh;
use rubmap_wheel::dynamics::node_rows::NodeRows;
use rubmap_wheel::dynamics::reduction::ReducedWheel;
use rubmap_wheel::dynamics::sector::{SectorModel, Units};

/// A reduced sector: all that simulations need of a model. Computed once per (model, `modes_per_speed`) and stored.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct ReducedSector {
    /// Units of the model.
    pub units: Units,
    /// The reduced wheel.
    pub wheel: Arc<ReducedWheel>,
    /// What the reduction found and cost.
    pub report: ReductionReport,
    /// Rows of its basis at nodes that are to be read; kept apart from it.
    #[serde(skip)]
    pub nodes: NodeRows,
}

impl ReducedSector {
    /// Whether sensors at all of these `nodes`, given by their ids, can be read.
    pub fn reads(&self, nodes: &[u64]) -> bool {
        let contact = |id| self.wheel.contact.iter().any(|node| node.id == id);
        nodes.iter().all(|&id| self.nodes.find(id).is_some() || contact(id))
    }
}

/// The few facts about a model that requests are checked against.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct ModelFacts {
    /// Free text of the user.
    pub name: String,
    /// Number of sectors N.
    pub sectors: u32,
    /// Number of contact nodes.
    pub contact_nodes: u32,
    /// Own DOF of a sector (internal with the low face, and contact).
    pub own_dofs: u32,
    /// Speeds of the stiffness matrices, rad/s.
    pub speeds_rad_s: Vec<f64>,
    /// Units.
    pub units: Units,
    /// Whether the package has a gyroscopic matrix, so that Coriolis forces can be simulated.
    #[serde(default)]
    pub gyroscopic: bool,
    /// Largest distance of a contact node from the axis, in the model's unit of length; absent of models that an earlier version
    /// has kept.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contact_radius: Option<f64>,
    /// How far K(Ω) can be trusted, as far as the stiffness matrices tell by themselves; absent of models that an earlier version
    /// has kept. The verdict is that of a reduction.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiffening: Option<PreliminaryStiffening>,
    /// The elements, if the package has them; without them there are no fields of elements and no stress.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mesh: Option<MeshFacts>,
}

/// What a package says of its elements.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct MeshFacts {
    /// Number of elements of a sector.
    pub elements: u32,
    /// What its element sets bear, in the order of their names.
    pub sets: Vec<Strengths>,
}

impl MeshFacts {
    /// The facts of `mesh`.
    pub fn of(mesh: &SectorMesh) -> Self {
        Self { elements: mesh.elements.len() as u32, sets: Strengths::of(mesh) }
    }
}

impl ModelFacts {
    /// The facts of `sector`.
    pub fn of(sector: &SectorModel) -> Self {
        Self {
            name: sector.name.clone(),
            sectors: sector.sectors as u32,
            contact_nodes: sector.contact.len() as u32,
            own_dofs: sector.own_dofs() as u32,
            speeds_rad_s: sector.speeds_rad_s.clone(),
            units: sector.units.clone(),
            gyroscopic: sector.gyroscopic.is_some(),
            contact_radius: sector.contact.iter().map(|node| node.position[0]).reduce(f64::max),
            stiffening: Some(preliminary_stiffening(sector)),
            mesh: None,
        }
    }

    /// The same of a model whose package has these elements.
    pub fn with_mesh(self, mesh: Option<&SectorMesh>) -> Self {
        Self { mesh: mesh.map(MeshFacts::of), ..self }
    }

    /// Whether the model has stiffness at three speeds.
    pub fn has_stiffening(&self) -> bool {
        self.speeds_rad_s.len() == 3
    }
}

#[cfg(test)]
impl ModelFacts {
    /// Those of a model of no particular kind.
    pub(crate) fn of_ten_sectors(contact_nodes: u32) -> Self {
        let unit = |name: &str| name.to_owned();
        Self {
            name: unit("wheel"),
            sectors: 10,
            contact_nodes,
            own_dofs: 900,
            speeds_rad_s: vec![0.0],
            units: Units { length: unit("mm"), force: unit("N"), time: unit("s"), mass: unit("t") },
            gyroscopic: false,
            contact_radius: None,
            stiffening: None,
            mesh: None,
        }
    }
}
