//! CTETRA, CHEXA, CPENTA and CPYRAM.

use rubmap_solid::element::ElementKind;

use crate::error::{MeshFileError, MeshProblem};
use crate::mesh_file::MeshFile;
use crate::solids;

use super::card::Card;
use super::place::Place;

/// Element as its card states it, with its nodes in CalculiX's order.
pub(super) struct Solid {
    /// Number of the element.
    id: u64,
    /// Number of its property.
    pub(super) property: u64,
    kind: ElementKind,
    nodes: Vec<u64>,
    card: &'static str,
    place: Place,
}

/// Names of the cards, with the linear and the quadratic element of each.
const CARDS: [(&str, ElementKind, ElementKind); 5] = [
    ("CTETRA", ElementKind::C3D4, ElementKind::C3D10),
    ("CHEXA", ElementKind::C3D8I, ElementKind::C3D20),
    ("CPENTA", ElementKind::C3D6, ElementKind::C3D15),
    ("CPYRAM", ElementKind::C3D5, ElementKind::C3D13),
    ("CPYRA", ElementKind::C3D5, ElementKind::C3D13),
];

impl Solid {
    /// Element of a card; none if the card is that of no solid element.
    pub(super) fn of(card: &Card) -> Result<Option<Self>, MeshFileError> {
        let Some(&(name, linear, quadratic)) = CARDS.iter().find(|(name, ..)| *name == card.name) else {
            return Ok(None);
        };
        let id = card.integer(1, "an element number")?;
        let property = card.optional(2, "the number of a property")?.unwrap_or(id);
        let (first, count) = (3, quadratic.nodes());
        let mut nodes = Vec::new();
        for field in first..first + count {
            nodes.push(card.optional(field, "a node number")?.unwrap_or_default());
        }
        if (first + count..=card.fields.len()).any(|field| !card.text(field).is_empty()) {
            return Err(card.expected(&format!("no more than {count} nodes")));
        }
        let (corners, middles) = nodes.split_at_mut(quadratic.corners());
        if corners.contains(&0) {
            return Err(card.expected(&format!("{} nodes at corners", corners.len())));
        }
        let kind = if middles.iter().all(|&node| node == 0) {
            nodes.truncate(linear.nodes());
            linear
        } else {
            // Only an edge of which both ends are one node may go without a node of its own: `collapse` knows.
            if middles.contains(&0) && !(linear == ElementKind::C3D8I && repeats(corners)) {
                return Err(card.not_carried("an element with nodes on some of its edges only", MIDDLES));
            }
            in_order(quadratic, middles);
            quadratic
        };
        Ok(Some(Self { id, property, kind, nodes, card: name, place: card.place.clone() }))
    }

    /// Adds the element to the mesh, and to the set of its property.
    pub(super) fn add_to(self, mesh: &mut MeshFile) -> Result<(), MeshFileError> {
        let Self { id, property, kind, nodes, card, place } = self;
        let failed = |problem: MeshProblem| place.error(problem, card);
        let element = solids::element(id, kind, &nodes, place.line).map_err(failed)?;
        solids::add(mesh, id, element).map_err(failed)?;
        mesh.element_sets.entry(property.to_string()).or_default().insert(id);
        Ok(())
    }
}

/// Advice on elements with nodes on some edges.
const MIDDLES: &str = "mesh with quadratic elements that have a node on every edge, or with linear ones";

/// Whether a node is there more than once.
fn repeats(nodes: &[u64]) -> bool {
    nodes.iter().enumerate().any(|(k, node)| nodes.iter().skip(k + 1).any(|other| other == node))
}

/// Puts the nodes on edges from Nastran's order, in which the upright edges of hexahedra and wedges come second, into CalculiX's, in which they
/// come last. Tetrahedra and pyramids have one order.
fn in_order(kind: ElementKind, middles: &mut [u64]) {
    if matches!(kind, ElementKind::C3D20 | ElementKind::C3D15) {
        let around = middles.len() / 3;
        if let Some((_, rest)) = middles.split_at_mut_checked(around) {
            rest.rotate_left(around);
        }
    }
}
