//! Models of sectors: the facts that requests are checked against, and the reduction with a report in words.

use std::f64::consts::TAU;
use std::sync::Arc;

use faer::Mat;
use serde::{Deserialize, Serialize};

use crate::euler_load::EulerLoad;
use crate::family_track::FamilyTracks;
use crate::result::{PreliminaryStiffening, ReductionReport, Strengths};
use crate::stiffening::{preliminary_stiffening, report_with_spin, with_spin};
use crate::stress::ReducedStress;
use crate::tip_growth::TipGrowth;
use crate::tip_thickness::tip_thickness;
use rubmap_solid::mesh::SectorMesh;
use rubmap_wheel::dynamics::bending::BladeBending;
use rubmap_wheel::dynamics::casing::arc_lengths;
use rubmap_wheel::dynamics::findings::{DigitNoise, Findings, InSi};
use rubmap_wheel::dynamics::modal_wheel::natural_frequencies;
use rubmap_wheel::dynamics::node_rows::NodeRows;
use rubmap_wheel::dynamics::reduction::ReducedWheel;
use rubmap_wheel::dynamics::sector::{ContactNode, SectorModel, Units};

/// Reduced sector: all that simulations need of a model. Computed once per (model, `modes_per_speed`) and stored.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct ReducedSector {
    /// Units of the model.
    pub units: Units,
    /// The reduced wheel.
    pub wheel: Arc<ReducedWheel>,
    /// Findings and cost of the reduction.
    pub report: ReductionReport,
    /// Rows of the basis at the nodes of sensors; stored beside the reduction.
    #[serde(skip)]
    pub nodes: NodeRows,
    /// Stress in reduced coordinates, where it is to be recorded; stored beside the reduction.
    #[serde(skip)]
    pub stress: Option<Arc<ReducedStress>>,
    /// Growth of the tips, where clearances are given cold; stored beside the reduction.
    #[serde(skip)]
    pub growth: Option<Arc<TipGrowth>>,
    /// Euler force in reduced coordinates, where the speed changes and it is asked for; stored beside the reduction.
    #[serde(skip)]
    pub euler_load: Option<Arc<EulerLoad>>,
    /// Second-order bending of a blade, where blades bend far.
    #[serde(skip)]
    pub bending: Option<Arc<BladeBending>>,
    /// Whether the rows of the basis at all nodes are stored beside the reduction.
    #[serde(skip)]
    pub has_basis: bool,
    /// Thickness of the blade at its tip, [`MeshFacts::tip_thickness`].
    #[serde(skip)]
    pub tip_thickness: Option<f64>,
    /// Modal families over speed.
    #[serde(skip)]
    pub families: FamilyTracks,
}

impl ReducedSector {
    /// Whether sensors at all of these `nodes`, given by their ids, can be read.
    pub fn reads(&self, nodes: &[u64]) -> bool {
        let contact = |id| self.wheel.contact.iter().any(|node| node.id == id);
        nodes.iter().all(|&id| self.nodes.find(id).is_some() || contact(id))
    }

    /// Adds the findings of the package about K(Ω) and about its digits to the report.
    pub fn with_findings(mut self, findings: &Findings) -> Self {
        self.report.stiffening = report_with_spin(self.report.stiffening, &findings.spin);
        if let Some(sentence) = findings.digits.and_then(|digits| self.cost_of(digits)) {
            self.report.stiffening.message += &format!(" {sentence}");
        }
        self
    }

    /// Sentence about the error of the lowest frequency at rest that few digits of the stiffness matrix may cause, if it can be estimated.
    pub(crate) fn cost_of(&self, digits: DigitNoise) -> Option<String> {
        if digits.has_all_digits {
            return None;
        }
        let lowest = |harmonic| natural_frequencies(harmonic, 0.0, false).ok()?.first().copied();
        let lowest_hz = self.wheel.harmonics.iter().filter_map(lowest).reduce(f64::min)? / TAU;
        let percent = 100.0 * digits.change_of(lowest_hz);
        Some(format!(
            "The few digits of the stiffness matrix may change the lowest frequency, {lowest_hz:.1} Hz, by {percent:.2} %."
        ))
    }

    /// Copy for a plan: where the growth of the tips, the Euler force and the bending of second order are not known yet, they are zero.
    pub(crate) fn for_planning(&self) -> Self {
        let still = || Arc::new(TipGrowth::none(self.wheel.contact.len()));
        Self {
            growth: Some(self.growth.clone().unwrap_or_else(still)),
            euler_load: Some(self.euler_load.clone().unwrap_or_else(|| Arc::new(EulerLoad::none()))),
            bending: Some(self.bending.clone().unwrap_or_else(|| Arc::new(self.unbent()))),
            ..self.clone()
        }
    }

    /// Bending of zero, in one coordinate.
    fn unbent(&self) -> BladeBending {
        let rows = self.wheel.harmonics.iter().map(|harmonic| Mat::zeros(1, harmonic.mass.ncols()));
        BladeBending::alike(1, self.wheel.contact.len(), rows.collect(), 0.0)
    }

    /// Whether the bending of second order that was made is in so many coordinates.
    pub fn bends_in(&self, coordinates: u32) -> bool {
        self.bending.as_ref().is_some_and(|blade| blade.asked == coordinates as usize)
    }

    /// Whether the stress that was read excludes exactly this radius about the contact nodes.
    pub fn tells_stress(&self, excluded_radius: f64) -> bool {
        self.stress.as_ref().is_some_and(|stress| stress.excluded_radius() == excluded_radius)
    }
}

/// Facts about a model, against which requests are checked.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct ModelFacts {
    /// Name of the model, free text of the user.
    pub name: String,
    /// Number of sectors N.
    pub sectors: u32,
    /// Number of contact nodes.
    pub contact_nodes: u32,
    /// Number of own DOF of a sector (internal with the low face, and contact).
    pub own_dofs: u32,
    /// Speeds of the stiffness matrices, rad/s.
    pub speeds_rad_s: Vec<f64>,
    /// Units of the model.
    pub units: Units,
    /// Whether the package has a gyroscopic matrix, so that Coriolis forces can be simulated.
    #[serde(default)]
    pub gyroscopic: bool,
    /// Largest distance of a contact node from the axis, in the model's unit of length; absent for models stored by an earlier version.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contact_radius: Option<f64>,
    /// Reliability of K(Ω) between its speeds, as far as the stiffness matrices alone show it; absent for models stored by an earlier
    /// version. The final verdict comes with a reduction.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiffening: Option<PreliminaryStiffening>,
    /// Mean distance of neighbouring contact nodes, in the model's unit of length; absent for a model with a single contact node, and for
    /// models stored by an earlier version.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contact_spacing: Option<f64>,
    /// Elements, if the package has them; without them there are no fields of elements and no stress.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mesh: Option<MeshFacts>,
    /// Size and materials in SI units; absent where a unit is not known, and for models stored by an earlier version.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub in_si: Option<InSi>,
    /// Noise of a stiffness matrix that was written with few digits; absent where it has all digits.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub digits: Option<DigitNoise>,
    /// Sentences about what looks wrong in the package and was accepted.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<String>,
    /// Findings about the mesh that the model was made from: elements, materials, axis, sectors, clamp and contact line, a line each; empty
    /// for models whose package had matrices.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub found: Vec<String>,
}

/// Facts about the elements of a package.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct MeshFacts {
    /// Number of elements of a sector.
    pub elements: u32,
    /// Strengths of the element sets, in the order of their names.
    pub sets: Vec<Strengths>,
    /// Smallest thickness of the blade at a contact node, measured along a straight line across the blade just below the tip; absent where
    /// no such line leaves the mesh on both sides.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tip_thickness: Option<f64>,
}

impl MeshFacts {
    /// Facts of the `mesh` of a sector.
    pub fn of(mesh: &SectorMesh, sector: &SectorModel) -> Self {
        Self {
            elements: mesh.elements.len() as u32,
            sets: Strengths::of(mesh),
            tip_thickness: tip_thickness(mesh, &sector.contact),
        }
    }
}

impl ModelFacts {
    /// Facts of `sector`.
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
            contact_spacing: contact_spacing(&sector.contact),
            mesh: None,
            in_si: None,
            digits: None,
            warnings: Vec::new(),
            found: Vec::new(),
        }
    }

    /// Facts of a package: its sector, elements and findings.
    pub fn of_package(sector: &SectorModel, mesh: Option<&SectorMesh>, findings: &Findings) -> Self {
        let facts = Self::of(sector);
        Self {
            mesh: mesh.map(|mesh| MeshFacts::of(mesh, sector)),
            stiffening: facts.stiffening.map(|found| with_spin(found, &findings.spin)),
            in_si: findings.in_si.clone(),
            digits: findings.digits,
            warnings: findings.warnings(),
            ..facts
        }
    }

    /// Whether K(Ω) is known at a speed, rad/s. A speed given in rpm may differ from the model's rad/s in the last digits.
    pub fn stiffness_reaches(&self, omega: f64) -> bool {
        !self.has_stiffening() || omega <= self.highest_speed() * (1.0 + 1e-6)
    }

    /// Message about a speed beyond the range of K(Ω).
    pub fn not_extrapolated(&self) -> String {
        format!(
            "the model's stiffness is given up to {} rad/s; K(Ω) is not extrapolated: stay below, or export the \
             stiffness at a higher speed",
            self.highest_speed()
        )
    }

    fn highest_speed(&self) -> f64 {
        self.speeds_rad_s.last().copied().unwrap_or(0.0)
    }

    /// Whether the model has stiffness at three speeds.
    pub fn has_stiffening(&self) -> bool {
        self.speeds_rad_s.len() == 3
    }
}

fn contact_spacing(contact: &[ContactNode]) -> Option<f64> {
    let positions: Vec<_> = contact.iter().map(|node| node.position).collect();
    let length = arc_lengths(&positions).last().copied()?;
    let segments = contact.len() - 1;
    (segments > 0 && length > 0.0).then(|| length / segments as f64)
}

#[cfg(test)]
impl ModelFacts {
    /// Facts of a model of ten sectors and no particular kind.
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
            contact_spacing: None,
            mesh: None,
            in_si: None,
            digits: None,
            warnings: Vec::new(),
            found: Vec::new(),
        }
    }
}
