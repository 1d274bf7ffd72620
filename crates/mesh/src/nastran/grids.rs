//! GRID and GRDSET: positions in their coordinate systems, and permanent supports.

use std::collections::BTreeMap;

use crate::error::{MeshFileError, MeshProblem};

use super::card::Card;
use super::components;
use super::frames::{Frames, Point};
use super::place::Place;
use super::supports::{Support, Supports};

/// Node as its card states it.
struct Grid {
    system: Option<u64>,
    position: [f64; 3],
    held: Option<u8>,
    place: Place,
}

/// Nodes by number, and what is valid for those that do not say.
#[derive(Default)]
pub(super) struct Grids {
    grids: BTreeMap<u64, Grid>,
    system: u64,
    held: u8,
    /// First node that states a frame of its own.
    framed: Option<Place>,
    /// Whether a node leaves its frame to GRDSET, and the place of a GRDSET that states one.
    has_default_frame: bool,
    default_frame: Option<Place>,
}

impl Grids {
    /// Adds a GRID.
    pub(super) fn add(&mut self, card: &Card) -> Result<(), MeshFileError> {
        let id = card.integer(1, "a node number")?;
        let system = card.optional(2, "the number of a coordinate system")?;
        let position = card.point(3)?;
        let held = if card.text(7).is_empty() { None } else { Some(components::mask(card, 7)?) };
        match frame(card) {
            Some(false) => {}
            Some(true) => {
                self.framed.get_or_insert_with(|| card.place.clone());
            }
            None => self.has_default_frame = true,
        }
        match self.grids.insert(id, Grid { system, position, held, place: card.place.clone() }) {
            None => Ok(()),
            Some(_) => Err(card.error(MeshProblem::Twice { what: "node", id })),
        }
    }

    /// Takes the values of GRDSET.
    pub(super) fn set_defaults(&mut self, card: &Card) -> Result<(), MeshFileError> {
        self.system = card.optional(2, "the number of a coordinate system")?.unwrap_or_default();
        self.held = components::mask(card, 7)?;
        self.default_frame = frame(card).unwrap_or(false).then(|| card.place.clone());
        Ok(())
    }

    /// Line and card of the first node whose displacements are not in x, y, z.
    pub(super) fn nodal_frames(&self) -> Option<(u64, String)> {
        let by_default = self.default_frame.as_ref().filter(|_| self.has_default_frame);
        let by_default = by_default.map(|place| (place.line, "GRDSET".to_owned()));
        self.framed.as_ref().map(|place| (place.line, "GRID".to_owned())).or(by_default)
    }

    /// Point of a node in its coordinate system.
    pub(super) fn point(&self, id: u64) -> Option<Point> {
        let grid = self.grids.get(&id)?;
        Some(Point { system: grid.system.unwrap_or(self.system), position: grid.position })
    }

    /// Cartesian positions.
    pub(super) fn positions(&self, frames: &Frames) -> Result<BTreeMap<u64, [f64; 3]>, MeshFileError> {
        let mut positions = BTreeMap::new();
        for (&id, grid) in &self.grids {
            let point = Point { system: grid.system.unwrap_or(self.system), position: grid.position };
            let position = frames.position(point).map_err(|problem| grid.place.error(problem, "GRID"))?;
            positions.insert(id, position);
        }
        Ok(positions)
    }

    /// Adds the permanent supports.
    pub(super) fn add_supports(&self, supports: &mut Supports) {
        for (&id, grid) in &self.grids {
            let mask = grid.held.unwrap_or(self.held);
            if mask != 0 {
                let place = grid.place.clone();
                supports.add(Support { set: None, nodes: [id, id], mask, moved: false, card: "GRID", place });
            }
        }
    }
}

/// Whether the field CD of a card states a coordinate system of displacements other than the basic one; none if the field is empty.
fn frame(card: &Card) -> Option<bool> {
    Some(card.text(6)).filter(|text| !text.is_empty()).map(|text| text.parse() != Ok(0_i64))
}
