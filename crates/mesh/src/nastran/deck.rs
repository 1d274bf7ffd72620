//! Content of the cards on its way to a mesh: cards may come in any order.

use std::collections::BTreeSet;

use crate::error::MeshFileError;
use crate::fields::quoted;
use crate::format::MeshFormat;
use crate::mesh_file::MeshFile;

use super::card::Card;
use super::control::Control;
use super::grids::Grids;
use super::materials::Materials;
use super::others::Other;
use super::sets::Sets;
use super::solids::Solid;
use super::supports::Supports;
use super::systems::Systems;

/// Content of the cards so far.
pub(super) struct Deck {
    mesh: MeshFile,
    grids: Grids,
    systems: Systems,
    solids: Vec<Solid>,
    materials: Materials,
    supports: Supports,
    /// Sets of supports that case control selects.
    selected: BTreeSet<u64>,
    sets: Sets,
}

/// Most names of unknown cards that are noted.
const MOST_UNKNOWN: usize = 50;

impl Deck {
    /// Deck without cards.
    pub(super) fn new(control: Option<Control>) -> Self {
        let Control { sets: stated, supports: selected } = control.unwrap_or_default();
        let mut sets = Sets::default();
        for (id, text, place) in stated {
            let words: Vec<&str> = text.split([' ', '\t', ',']).collect();
            sets.add(id, &words, "SET", &place);
        }
        Self {
            mesh: MeshFile::new(MeshFormat::Nastran),
            grids: Grids::default(),
            systems: Systems::default(),
            solids: Vec::new(),
            materials: Materials::default(),
            supports: Supports::default(),
            selected,
            sets,
        }
    }

    /// Adds a card.
    pub(super) fn add(&mut self, card: &Card) -> Result<(), MeshFileError> {
        match card.name.as_str() {
            "GRID" => self.grids.add(card),
            "GRDSET" => self.grids.set_defaults(card),
            "CORD1R" | "CORD1C" | "CORD1S" | "CORD2R" | "CORD2C" | "CORD2S" => self.systems.add(card),
            "MAT1" => self.materials.add(card),
            "PSOLID" => self.materials.add_property(card),
            "SPC" => self.supports.add_values(card),
            "SPC1" => self.supports.add_nodes(card),
            "SPCADD" => self.supports.add_union(card),
            "SET1" => {
                let id = card.integer(1, "the number of a set")?;
                let words: Vec<&str> = card.fields.iter().skip(1).map(String::as_str).collect();
                self.sets.add(id, &words, "SET1", &card.place);
                Ok(())
            }
            name if name.starts_with('=') => Err(card.not_carried(
                "a card that repeats the one before it",
                "write every card in full; preprocessors can",
            )),
            name if name.starts_with("BEGIN") => Err(card.not_carried(
                "a second BEGIN, as superelements have it,",
                "write the model without superelements",
            )),
            _ => match Solid::of(card)? {
                Some(solid) => {
                    self.solids.push(solid);
                    Ok(())
                }
                None => self.add_other(card),
            },
        }
    }

    fn add_other(&mut self, card: &Card) -> Result<(), MeshFileError> {
        match Other::of(card) {
            Other::Refused(what, advice) => return Err(card.not_carried(what, advice)),
            Other::Material => self.materials.add_other(card)?,
            Other::LeftOut => self.mesh.leave_out(&card.name),
            Other::Unknown if self.mesh.notes.len() < MOST_UNKNOWN => {
                self.mesh.note(format!("cards {} are not read", quoted(&card.name)));
            }
            Other::Unknown | Other::Skipped => {}
        }
        Ok(())
    }

    /// Mesh of all cards.
    pub(super) fn into_mesh(self) -> Result<MeshFile, MeshFileError> {
        let Self { mut mesh, grids, systems, solids, materials, mut supports, selected, sets } = self;
        let frames = systems.frames(&|id| grids.point(id))?;
        mesh.nodes = grids.positions(&frames)?;
        mesh.nodal_frames = grids.nodal_frames();
        for solid in solids {
            solid.add_to(&mut mesh)?;
        }
        crate::whole::check(&mesh, "")?;
        materials.add_to(&mut mesh)?;
        grids.add_supports(&mut supports);
        supports.hold(&selected, &mut mesh)?;
        sets.add_to(&mut mesh)?;
        Ok(mesh)
    }
}
