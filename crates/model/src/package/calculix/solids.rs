//! Elements, element sets, materials and sections of a deck.
//!
//! Nothing here stops an import: the first unusable part is noted, and the package then has no mesh.

use std::collections::{BTreeMap, BTreeSet};

use rubmap_solid::element::ElementKind;

use super::error::LineProblem;
use super::no_mesh::NoMesh;
use super::text::{self, normal};
use crate::package::quote::quoted;
use rubmap_mesh::inp::card::Card;

/// Elements, sets, materials and sections of a deck.
#[derive(Debug, Default)]
pub(super) struct Solids {
    /// Elements by number.
    pub(super) elements: BTreeMap<u64, DeckElement>,
    /// Element sets by name.
    pub(super) sets: BTreeMap<String, BTreeSet<u64>>,
    /// Materials by name.
    pub(super) materials: BTreeMap<String, DeckMaterial>,
    /// Element set and material of each `*SOLID SECTION`.
    pub(super) sections: Vec<(String, String)>,
    /// First part that cannot be used.
    pub(super) unusable: Option<NoMesh>,
    /// Name of the material to which cards belong.
    material: String,
}

/// Element of a deck.
#[derive(Debug)]
pub(super) struct DeckElement {
    pub(super) kind: ElementKind,
    pub(super) nodes: Box<[u64]>,
}

/// Material of a deck.
#[derive(Debug, Default)]
pub(super) struct DeckMaterial {
    /// Type of `*ELASTIC`, if it is not isotropic.
    pub(super) anisotropic: Option<String>,
    /// Young's modulus E and Poisson's ratio ν, per temperature.
    pub(super) elastic: Vec<[f64; 2]>,
    /// Density, per temperature.
    pub(super) density: Vec<f64>,
}

/// Block to which the data lines that follow belong.
pub(super) enum SolidBlock {
    Elements { kind: ElementKind, set: Option<String>, numbers: Vec<u64> },
    Set { name: String, generate: bool },
    Elastic,
    Density,
}

impl Solids {
    /// Block that a card begins, if it is about elements or materials and has data.
    pub(super) fn start(&mut self, card: &Card) -> Option<SolidBlock> {
        match &card.keyword[..] {
            "*ELEMENT" => {
                let label = card.value("TYPE").unwrap_or_default();
                let Some(kind) = ElementKind::named(&label).filter(|&kind| kind != ElementKind::QM6) else {
                    self.unusable.get_or_insert(NoMesh::Type { kind: quoted(&label) });
                    return None;
                };
                Some(SolidBlock::Elements { kind, set: card.value("ELSET"), numbers: Vec::new() })
            }
            "*ELSET" => {
                let name = card.value("ELSET")?;
                Some(SolidBlock::Set { name, generate: card.has("GENERATE") })
            }
            "*MATERIAL" => {
                self.material = card.value("NAME").unwrap_or_default();
                self.materials.insert(self.material.clone(), DeckMaterial::default());
                None
            }
            "*ELASTIC" => {
                let kind = card.value("TYPE").filter(|kind| !matches!(&kind[..], "ISO" | "ISOTROPIC"));
                let material = self.materials.get_mut(&self.material)?;
                material.anisotropic = kind.as_deref().map(quoted);
                material.anisotropic.is_none().then_some(SolidBlock::Elastic)
            }
            "*DENSITY" => Some(SolidBlock::Density),
            "*SOLIDSECTION" => {
                self.sections.push((card.value("ELSET")?, card.value("MATERIAL")?));
                None
            }
            _ => None,
        }
    }

    /// Reads a data line of `block`.
    pub(super) fn data(&mut self, words: &[&str], block: &mut SolidBlock) -> Result<(), LineProblem> {
        match block {
            SolidBlock::Elements { kind, set, numbers } => {
                for word in words {
                    numbers.push(text::number(word, "an element or node number")?);
                    let [element, nodes @ ..] = &numbers[..] else { continue };
                    if nodes.len() < kind.nodes() {
                        continue;
                    }
                    let element = *element;
                    let read = DeckElement { kind: *kind, nodes: nodes.into() };
                    if self.elements.insert(element, read).is_some() {
                        self.unusable.get_or_insert(NoMesh::Twice { element });
                    }
                    if let Some(set) = set {
                        self.sets.entry(set.clone()).or_default().insert(element);
                    }
                    numbers.clear();
                }
            }
            SolidBlock::Set { name, generate: true } => {
                let numbers = words.iter().map(|word| text::number(word, "an element number"));
                let (first, last, step) = match numbers.collect::<Result<Vec<_>, _>>()?[..] {
                    [first] => (first, first, 1),
                    [first, last] => (first, last, 1),
                    [first, last, step] if step > 0 => (first, last, step),
                    _ => return Err(LineProblem::Words { expected: "first, last, increment" }),
                };
                // Numbers without an element are skipped, so that no range can be longer than the mesh.
                let in_mesh = self.elements.range(first..=last.max(first)).map(|(element, _)| *element);
                let found: Vec<u64> = in_mesh.filter(|element| (element - first) % step == 0).collect();
                self.sets.entry(name.clone()).or_default().extend(found);
            }
            SolidBlock::Set { name, generate: false } => {
                for word in words {
                    let found = match word.parse() {
                        Ok(element) => BTreeSet::from([element]),
                        Err(_) => self.sets.get(&normal(word)).cloned().unwrap_or_default(),
                    };
                    self.sets.entry(name.clone()).or_default().extend(found);
                }
            }
            SolidBlock::Elastic => {
                let [e, nu, ..] = words else {
                    return Err(LineProblem::Words { expected: "Young's modulus, Poisson's ratio" });
                };
                let constants = [text::real(e, "Young's modulus")?, text::real(nu, "Poisson's ratio")?];
                self.materials.entry(self.material.clone()).or_default().elastic.push(constants);
            }
            SolidBlock::Density => {
                let [density, ..] = words else { return Err(LineProblem::Words { expected: "a density" }) };
                let density = text::real(density, "a density")?;
                self.materials.entry(self.material.clone()).or_default().density.push(density);
            }
        }
        Ok(())
    }
}
