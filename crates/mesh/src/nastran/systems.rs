//! CORD1R to CORD2S: rectangular, cylindrical and spherical coordinate systems, which may refer to each other.

use std::collections::{BTreeMap, BTreeSet};

use crate::error::{MeshFileError, MeshProblem};

use super::card::Card;
use super::frames::{Frames, Kind, Point, no_such};
use super::place::Place;

/// Origin, a point on the z axis and one in the plane of x and z.
enum Definition {
    Points { system: u64, positions: [[f64; 3]; 3] },
    Grids([u64; 3]),
}

/// System as its card states it.
struct System {
    kind: Kind,
    definition: Definition,
    card: String,
    place: Place,
}

/// Systems by number.
#[derive(Default)]
pub(super) struct Systems(BTreeMap<u64, System>);

impl Systems {
    /// Adds the systems of a card.
    pub(super) fn add(&mut self, card: &Card) -> Result<(), MeshFileError> {
        let kind = match card.name.as_bytes().last() {
            Some(b'R') => Kind::Rectangular,
            Some(b'C') => Kind::Cylindrical,
            _ => Kind::Spherical,
        };
        let number = "the number of a coordinate system";
        if card.name.starts_with("CORD2") {
            let system = card.optional(2, number)?.unwrap_or_default();
            let positions = [card.point(3)?, card.point(6)?, card.point(9)?];
            return self.insert(
                card,
                card.integer(1, number)?,
                kind,
                Definition::Points { system, positions },
            );
        }
        // A card has room for two systems by nodes.
        for first in [1, 5] {
            if first == 1 || !card.text(first).is_empty() {
                let mut grids = [0; 3];
                for (k, grid) in grids.iter_mut().enumerate() {
                    *grid = card.integer(first + 1 + k, "a node number")?;
                }
                self.insert(card, card.integer(first, number)?, kind, Definition::Grids(grids))?;
            }
        }
        Ok(())
    }

    fn insert(
        &mut self,
        card: &Card,
        id: u64,
        kind: Kind,
        definition: Definition,
    ) -> Result<(), MeshFileError> {
        let system = System { kind, definition, card: card.name.clone(), place: card.place.clone() };
        if id == 0 {
            return Err(card.expected("a number of a coordinate system from 1"));
        }
        match self.0.insert(id, system) {
            None => Ok(()),
            Some(_) => Err(card.error(MeshProblem::Twice { what: "coordinate system", id })),
        }
    }

    /// Axes of all systems; `node` gives the points of nodes.
    pub(super) fn frames(&self, node: &dyn Fn(u64) -> Option<Point>) -> Result<Frames, MeshFileError> {
        let mut frames = Frames::basic();
        for &id in self.0.keys() {
            // Systems that wait for the one behind them.
            let mut waiting = vec![id];
            let mut known = BTreeSet::from([id]);
            while let Some((id, system)) = waiting.last().and_then(|id| self.0.get_key_value(id)) {
                let failed = |problem| system.place.error(problem, &system.card);
                let points = system.points(node).map_err(failed)?;
                let missing = points.iter().map(|point| point.system).find(|&id| !frames.have(id));
                if let Some(missing) = missing {
                    if !self.0.contains_key(&missing) {
                        return Err(failed(no_such(missing)));
                    }
                    if !known.insert(missing) {
                        let expected = "coordinate systems that do not refer to each other in a circle";
                        return Err(failed(MeshProblem::Expected { expected: expected.to_owned() }));
                    }
                    waiting.push(missing);
                    continue;
                }
                if !frames.have(*id) {
                    frames.add(*id, system.kind, points).map_err(failed)?;
                }
                waiting.pop();
            }
        }
        Ok(frames)
    }
}

impl System {
    fn points(&self, node: &dyn Fn(u64) -> Option<Point>) -> Result<[Point; 3], MeshProblem> {
        match self.definition {
            Definition::Points { system, positions } => {
                Ok(positions.map(|position| Point { system, position }))
            }
            Definition::Grids(grids) => {
                let point = |id: u64| {
                    node(id).ok_or_else(|| MeshProblem::NoSuch { what: "node", name: id.to_string() })
                };
                let [a, b, c] = grids.map(point);
                Ok([a?, b?, c?])
            }
        }
    }
}
