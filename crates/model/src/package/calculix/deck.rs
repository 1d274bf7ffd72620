//! Parts of a CalculiX deck that an import needs: nodes, node sets, and the cyclic symmetry it states.
//!
//! Cards and set names are read as CalculiX does: capitals and blanks do not matter, a card ending in a comma goes on
//! on the next line, `*INCLUDE` may be nested. Cards that say nothing about these things are skipped.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use super::error::{CalculixError, LineProblem};
use super::solids::{SolidBlock, Solids};
use super::text::{self, TextLines, normal};
use crate::package::quote::quoted;
use rubmap_mesh::inp::card::Card;

/// Deepest nesting of `*INCLUDE`.
const DEEPEST_INCLUDE: usize = 20;

/// Content of a deck, as far as an import needs it.
#[derive(Debug, Default)]
pub(super) struct Deck {
    /// Positions by node number.
    pub(super) nodes: BTreeMap<u64, [f64; 3]>,
    /// Node sets by name, in the order written, each node once.
    pub(super) sets: BTreeMap<String, Vec<u64>>,
    /// Node surfaces by name.
    surfaces: BTreeMap<String, Vec<u64>>,
    /// Slave and master surface of each cyclic tie.
    ties: BTreeMap<String, (String, String)>,
    /// Cyclic symmetry of `*CYCLIC SYMMETRY MODEL`: N and the two points on the axis.
    pub(super) cyclic: Option<Cyclic>,
    /// Elements and materials.
    pub(super) solids: Solids,
}

/// Cyclic symmetry as stated by `*CYCLIC SYMMETRY MODEL`.
#[derive(Debug)]
pub(super) struct Cyclic {
    pub(super) sectors: usize,
    tie: String,
    /// Two points on the axis.
    pub(super) axis: [[f64; 3]; 2],
}

/// Block to which the data lines that follow belong.
enum Block {
    Nodes { set: Option<String> },
    Set { name: String, generate: bool },
    NodeSurface { name: String },
    Tie { name: String },
    Axis { sectors: usize, tie: String, numbers: Vec<f64> },
    Solid(SolidBlock),
    Skip,
}

impl Deck {
    /// Reads `path` and all files it includes.
    pub(super) fn read(path: &Path) -> Result<Self, CalculixError> {
        let mut deck = Self::default();
        let mut block = Block::Skip;
        deck.read_file(path, path.parent().unwrap_or(Path::new("")), &mut block, 0)?;
        Ok(deck)
    }

    /// Two faces of the cyclic tie, in no particular order, if the deck has one of node surfaces.
    pub(super) fn tied_faces(&self) -> Option<[&[u64]; 2]> {
        let named = self.cyclic.as_ref().and_then(|cyclic| self.ties.get(&cyclic.tie));
        let (slave, master) = named.or_else(|| self.ties.values().next())?;
        let face = |name: &String| self.surfaces.get(name).or_else(|| self.sets.get(name));
        Some([face(slave)?, face(master)?])
    }

    fn read_file(
        &mut self,
        path: &Path,
        folder: &Path,
        block: &mut Block,
        depth: usize,
    ) -> Result<(), CalculixError> {
        let mut lines = TextLines::open(path)?;
        while let Some(line) = lines.next()? {
            if line.starts_with("**") || line.trim().is_empty() {
                continue;
            }
            if !line.trim_start().starts_with('*') {
                self.data(&line, block).map_err(|problem| lines.fault(problem))?;
                continue;
            }
            let mut card = line.trim().to_owned();
            while card.ends_with(',') {
                match lines.next()? {
                    Some(more) if more.starts_with("**") => {}
                    Some(more) => card += more.trim(),
                    None => break,
                }
            }
            let card = Card::parse(&card, lines.number());
            if card.keyword == "*INCLUDE" {
                let Some(file) = card.value_as_written("INPUT") else {
                    return Err(lines.fault(LineProblem::Words { expected: "*INCLUDE, INPUT=file" }));
                };
                if depth == DEEPEST_INCLUDE {
                    return Err(lines.fault(LineProblem::TooDeep { limit: DEEPEST_INCLUDE }));
                }
                // CalculiX looks in its working folder, which is that of the main deck.
                self.read_file(&folder.join(file), folder, block, depth + 1)?;
                continue;
            }
            *block = self.start(&card).map_err(|problem| lines.fault(problem))?;
        }
        Ok(())
    }

    fn start(&mut self, card: &Card) -> Result<Block, LineProblem> {
        Ok(match &card.keyword[..] {
            "*NODE" => Block::Nodes { set: card.value("NSET") },
            "*NSET" => {
                let Some(name) = card.value("NSET") else {
                    return Err(LineProblem::Words { expected: "*NSET, NSET=name" });
                };
                self.sets.entry(name.clone()).or_default();
                Block::Set { name, generate: card.has("GENERATE") }
            }
            "*SURFACE" if card.value("TYPE").as_deref() == Some("NODE") => {
                let name = card.value("NAME").unwrap_or_default();
                self.surfaces.entry(name.clone()).or_default();
                Block::NodeSurface { name }
            }
            "*TIE" if card.has("CYCLICSYMMETRY") => {
                Block::Tie { name: card.value("NAME").unwrap_or_default() }
            }
            "*CYCLICSYMMETRYMODEL" => {
                let text = card.value("N").unwrap_or_default();
                let sectors = text.parse().map_err(|_| LineProblem::NotA {
                    text: quoted(&text),
                    expected: "a number of sectors (N=)",
                })?;
                Block::Axis { sectors, tie: card.value("TIE").unwrap_or_default(), numbers: Vec::new() }
            }
            "*TRANSFORM" => return Err(LineProblem::Card { card: quoted(&card.keyword) }),
            _ => self.solids.start(card).map_or(Block::Skip, Block::Solid),
        })
    }

    fn data(&mut self, line: &str, block: &mut Block) -> Result<(), LineProblem> {
        let mut words: Vec<&str> = line.split(',').map(str::trim).collect();
        while words.last().is_some_and(|word| word.is_empty()) {
            words.pop();
        }
        match block {
            Block::Skip => {}
            Block::Solid(block) => self.solids.data(&words, block)?,
            Block::Nodes { set } => {
                let Some((&id, position)) = words.split_first().filter(|(_, p)| (1..=3).contains(&p.len()))
                else {
                    return Err(LineProblem::Words { expected: "a node: number, x, y, z" });
                };
                let node = text::node(id)?;
                let mut place = [0.0; 3];
                for (coordinate, word) in place.iter_mut().zip(position) {
                    *coordinate = if word.is_empty() { 0.0 } else { text::real(word, "a coordinate")? };
                }
                if self.nodes.insert(node, place).is_some_and(|before| before != place) {
                    return Err(LineProblem::NodeMoved { node });
                }
                if let Some(set) = set {
                    self.sets.entry(set.clone()).or_default().push(node);
                }
            }
            Block::Set { name, generate } => {
                let found = if *generate {
                    let numbers = words.iter().map(|word| text::node(word)).collect::<Result<Vec<_>, _>>()?;
                    let (first, last, step) = match numbers[..] {
                        [first] => (first, first, 1),
                        [first, last] => (first, last, 1),
                        [first, last, step] if step > 0 => (first, last, step),
                        _ => return Err(LineProblem::Words { expected: "first, last, increment" }),
                    };
                    // Numbers without a node are skipped, so that no range can be longer than the mesh.
                    let in_mesh = self.nodes.range(first..=last.max(first)).map(|(node, _)| *node);
                    in_mesh.filter(|node| (node - first) % step == 0).collect()
                } else {
                    Self::members(&self.sets, &words)?
                };
                append(self.sets.entry(name.clone()).or_default(), found);
            }
            Block::NodeSurface { name } => {
                let found = Self::members(&self.sets, &words[..words.len().min(1)])?;
                append(self.surfaces.entry(name.clone()).or_default(), found);
            }
            Block::Tie { name } => {
                let [slave, master] = words[..] else {
                    return Err(LineProblem::Words { expected: "two surfaces: slave, master" });
                };
                self.ties.insert(name.clone(), (normal(slave), normal(master)));
            }
            Block::Axis { sectors, tie, numbers } => {
                for word in words {
                    numbers.push(text::real(word, "a coordinate of the axis")?);
                }
                if let [a, b, c, d, e, f] = numbers[..] {
                    let axis = [[a, b, c], [d, e, f]];
                    self.cyclic = Some(Cyclic { sectors: *sectors, tie: tie.clone(), axis });
                }
            }
        }
        Ok(())
    }

    /// Nodes by number, or all nodes of sets by name.
    fn members(sets: &BTreeMap<String, Vec<u64>>, words: &[&str]) -> Result<Vec<u64>, LineProblem> {
        let mut found = Vec::new();
        for word in words.iter().filter(|word| !word.is_empty()) {
            if word.bytes().all(|byte| byte.is_ascii_digit()) {
                found.push(text::node(word)?);
            } else {
                let set = normal(word);
                found.extend(sets.get(&set).ok_or_else(|| LineProblem::UnknownSet { set: quoted(&set) })?);
            }
        }
        Ok(found)
    }
}

/// Appends the nodes that are not there yet.
fn append(to: &mut Vec<u64>, found: Vec<u64>) {
    let mut seen: BTreeSet<u64> = to.iter().copied().collect();
    to.extend(found.into_iter().filter(|node| seen.insert(*node)));
}
