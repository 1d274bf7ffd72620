//! Reader of a deck, card by card.

use std::collections::BTreeMap;

use super::assembly::assembled;
use super::card::{Card, normal};
use super::instance::{Instance, MOST_INSTANCES};
use super::request::Request;
use super::scope::{ElementBlock, Scope};
use super::skipped::{REFUSED, is_harmless};
use super::support::Support;
use super::work::Work;
use crate::error::{MeshFileError, MeshProblem};
use crate::fields::{integer, quoted, real};
use crate::format::MeshFormat;
use crate::include::Include;
use crate::mesh_file::{DensityRow, ElasticRow, MeshFile, StatedSymmetry};

/// Deepest nesting of `*INCLUDE`.
const DEEPEST_INCLUDE: usize = 20;

/// Most files included in all: a file that includes another twice, which includes another twice, and so on, has an end.
const MOST_INCLUDES: usize = 1000;

/// Block to which the data lines that follow belong.
enum Block {
    Nodes { set: Option<String> },
    Elements(ElementBlock),
    Set(Request),
    Elastic,
    Density,
    Boundary,
    Instance,
    Axis { sectors: usize, numbers: Vec<f64> },
    Skip,
}

/// Reader of a deck.
pub(super) struct Reader<'a> {
    include: &'a Include<'a>,
    /// Number of files included so far.
    included: usize,
    work: Work,
    mesh: MeshFile,
    /// Content outside of parts; sets of the assembly that name an instance are kept by it.
    root: Scope,
    parts: BTreeMap<String, Scope>,
    instances: Vec<Instance>,
    supports: Vec<Support>,
    block: Block,
    /// Card of the block.
    card: String,
    part: Option<String>,
    in_instance: bool,
    /// Instance whose nodes or elements the set that is read names.
    set_instance: Option<String>,
    material: String,
}

impl<'a> Reader<'a> {
    pub(super) fn new(include: &'a Include<'a>) -> Self {
        Self {
            include,
            included: 0,
            work: Work::default(),
            mesh: MeshFile::new(MeshFormat::Inp),
            root: Scope::default(),
            parts: BTreeMap::new(),
            instances: Vec::new(),
            supports: Vec::new(),
            block: Block::Skip,
            card: String::new(),
            part: None,
            in_instance: false,
            set_instance: None,
            material: String::new(),
        }
    }

    /// Reads a file, `depth` files deep.
    pub(super) fn file(&mut self, bytes: &[u8], depth: usize) -> Result<(), MeshFileError> {
        let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        let mut lines = text.split(|&b| b == b'\n').zip(1_u64..).map(|(line, number)| {
            let line = line.strip_suffix(b"\r").unwrap_or(line);
            (String::from_utf8_lossy(line).into_owned(), number)
        });
        while let Some((line, number)) = lines.next() {
            if line.starts_with("**") || line.trim().is_empty() {
                continue;
            }
            if !line.trim_start().starts_with('*') {
                self.data(&line, number).map_err(|problem| problem.at(number, &self.card))?;
                continue;
            }
            let mut text = line.trim().to_owned();
            while text.ends_with(',') {
                match lines.next() {
                    Some((more, _)) if more.starts_with("**") => {}
                    Some((more, _)) => text += more.trim(),
                    None => break,
                }
            }
            let card = Card::parse(&text, number);
            self.end_block()?;
            if card.keyword == "*INCLUDE" {
                self.included(&card, depth)
                    .map_err(|error| error.unwrap_or_else(|problem| problem.at(number, "*INCLUDE")))?;
                continue;
            }
            self.block = self.start(&card).map_err(|problem| problem.at(number, &card.keyword))?;
            self.card = card.keyword;
        }
        Ok(())
    }

    /// Reads an included file; errors in it name its own line.
    fn included(&mut self, card: &Card, depth: usize) -> Result<(), Result<MeshFileError, MeshProblem>> {
        let file = card.value_as_written("INPUT");
        let file = file.ok_or(Err(MeshProblem::Expected { expected: "*INCLUDE, INPUT=file".to_owned() }))?;
        if depth == DEEPEST_INCLUDE {
            return Err(Err(MeshProblem::TooDeep { limit: DEEPEST_INCLUDE }));
        }
        self.included += 1;
        let refused = |reason| Err(MeshProblem::Include { name: quoted(file), reason });
        if self.included > MOST_INCLUDES {
            return Err(refused(format!("it is one of more than {MOST_INCLUDES} included files")));
        }
        let bytes = (self.include)(file).map_err(refused)?;
        self.file(&bytes, depth + 1).map_err(Ok)
    }

    fn scope(&mut self) -> &mut Scope {
        self.scope_and_work().0
    }

    fn scope_and_work(&mut self) -> (&mut Scope, &mut Work) {
        let scope = match &self.part {
            Some(part) => self.parts.entry(part.clone()).or_default(),
            None => &mut self.root,
        };
        (scope, &mut self.work)
    }

    fn start(&mut self, card: &Card) -> Result<Block, MeshProblem> {
        Ok(match &card.keyword[..] {
            "*NODE" => {
                if card.value("SYSTEM").is_some_and(|system| system != "R") {
                    return Err(MeshProblem::NotCarried {
                        what: "a node in another coordinate system".to_owned(),
                        advice: "write nodes in x, y, z",
                    });
                }
                Block::Nodes { set: card.value("NSET") }
            }
            "*ELEMENT" => Block::Elements(Scope::elements(card, &mut self.mesh)?),
            "*NSET" | "*ELSET" => return self.set(card),
            "*MATERIAL" => {
                self.material = named(card, "NAME")?;
                self.mesh.materials.entry(self.material.clone()).or_default();
                Block::Skip
            }
            "*ELASTIC" => return elastic(card),
            "*DENSITY" => Block::Density,
            "*SOLIDSECTION" => {
                let section = (named(card, "ELSET")?, named(card, "MATERIAL")?);
                self.scope().sections.push(section);
                Block::Skip
            }
            "*BOUNDARY" => Block::Boundary,
            "*TIE" if card.has("CYCLICSYMMETRY") => Block::Skip,
            "*CYCLICSYMMETRYMODEL" => {
                let sectors = named(card, "N")?;
                let sectors = integer(&sectors, "a number of sectors")? as usize;
                Block::Axis { sectors, numbers: Vec::new() }
            }
            "*PART" => {
                self.part = Some(named(card, "NAME")?);
                Block::Skip
            }
            "*ENDPART" => {
                self.part = None;
                Block::Skip
            }
            "*INSTANCE" => return self.instance(card),
            "*ENDINSTANCE" => {
                self.in_instance = false;
                Block::Skip
            }
            "*ASSEMBLY" | "*ENDASSEMBLY" => Block::Skip,
            "*TRANSFORM" => {
                self.mesh.nodal_frames.get_or_insert_with(|| (card.line, card.keyword.clone()));
                Block::Skip
            }
            keyword => return self.other(keyword),
        })
    }

    /// Begins a set of nodes or elements, or makes the nodes of an element set one.
    fn set(&mut self, card: &Card) -> Result<Block, MeshProblem> {
        let nodes = card.keyword == "*NSET";
        let name = named(card, if nodes { "NSET" } else { "ELSET" })?;
        self.set_instance = card.value("INSTANCE");
        if let Some(instance) = self.set_instance.as_ref().filter(|_| self.of_instance().is_none()) {
            return Err(MeshProblem::NoSuch { what: "instance", name: quoted(instance) });
        }
        if let Some(elements) = card.value("ELSET").filter(|_| nodes) {
            let (scope, work) = self.scope_and_work();
            scope.nodes_of_elements(&name, &elements, work)?;
            return Ok(Block::Skip);
        }
        let generate = card.has("GENERATE");
        Ok(Block::Set(Request { nodes, name, generate }))
    }

    /// Begins an instance of a part.
    fn instance(&mut self, card: &Card) -> Result<Block, MeshProblem> {
        let (name, part) = (named(card, "NAME")?, named(card, "PART")?);
        if self.instances.len() == MOST_INSTANCES {
            return Err(MeshProblem::NotCarried {
                what: format!("an assembly of more than {MOST_INSTANCES} instances"),
                advice: "a sector is one body; write its mesh out without instances",
            });
        }
        self.instances.push(Instance::new(name, part, card.line));
        self.in_instance = true;
        Ok(Block::Instance)
    }

    /// Block of a card that is refused, skipped, or skipped with a note.
    fn other(&mut self, keyword: &str) -> Result<Block, MeshProblem> {
        if let Some((_, what, advice)) = REFUSED.iter().find(|(card, ..)| *card == keyword) {
            return Err(MeshProblem::NotCarried { what: (*what).to_owned(), advice });
        }
        if !is_harmless(keyword) {
            self.mesh.note(format!("cards {} are not read", quoted(keyword)));
        }
        Ok(Block::Skip)
    }

    fn data(&mut self, line: &str, number: u64) -> Result<(), MeshProblem> {
        let words: Vec<&str> = line.split(',').map(str::trim).collect();
        let mut block = std::mem::replace(&mut self.block, Block::Skip);
        let done = self.data_of(&words, number, &mut block);
        self.block = block;
        done
    }

    fn data_of(&mut self, words: &[&str], line: u64, block: &mut Block) -> Result<(), MeshProblem> {
        match block {
            Block::Skip => Ok(()),
            Block::Nodes { set } => self.scope().node(words, set.as_deref()),
            Block::Elements(elements) => {
                let mut mesh = std::mem::replace(&mut self.mesh, MeshFile::new(MeshFormat::Inp));
                let done = self.scope().element(words, elements, line, &mut mesh);
                self.mesh = mesh;
                done
            }
            Block::Set(request) => match self.of_instance() {
                Some(instance) => {
                    self.instances[instance].request(request, words);
                    Ok(())
                }
                None => {
                    let (scope, work) = self.scope_and_work();
                    request.answer(scope, words, work)
                }
            },
            Block::Elastic => self.elastic(words),
            Block::Density => {
                let value = real(words.first().copied().unwrap_or_default(), "a density")?;
                let temperature = optional(words.get(1), "a temperature")?;
                let row = DensityRow { density: value, temperature };
                self.mesh.materials.entry(self.material.clone()).or_default().density.push(row);
                Ok(())
            }
            Block::Boundary => self.boundary(words, line),
            Block::Instance => match self.instances.last_mut() {
                Some(instance) => instance.placed(words),
                None => Ok(()),
            },
            Block::Axis { sectors, numbers } => {
                for word in words.iter().filter(|word| !word.is_empty()) {
                    numbers.push(real(word, "a coordinate of a point on the axis")?);
                }
                if let [a, b, c, d, e, f, ..] = numbers[..] {
                    let symmetry = StatedSymmetry { sectors: *sectors, axis: [[a, b, c], [d, e, f]] };
                    self.mesh.symmetry = Some(symmetry);
                }
                Ok(())
            }
        }
    }

    /// Index of the instance that the set being read belongs to.
    fn of_instance(&self) -> Option<usize> {
        let name = self.set_instance.as_ref()?;
        self.instances.iter().position(|instance| instance.name == *name)
    }

    fn elastic(&mut self, words: &[&str]) -> Result<(), MeshProblem> {
        let [e, nu, ..] = words else {
            return Err(MeshProblem::Expected { expected: "Young's modulus, Poisson's ratio".to_owned() });
        };
        let row = ElasticRow {
            youngs_modulus: real(e, "Young's modulus")?,
            poissons_ratio: real(nu, "Poisson's ratio")?,
            temperature: optional(words.get(2), "a temperature")?,
        };
        self.mesh.materials.entry(self.material.clone()).or_default().elastic.push(row);
        Ok(())
    }

    /// Reads a support: node or set, first and last component, value; or a name such as ENCASTRE.
    fn boundary(&mut self, words: &[&str], line: u64) -> Result<(), MeshProblem> {
        let [target, rest @ ..] = words else { return Ok(()) };
        let by_name = rest.first().map(|word| normal(word));
        let components = match by_name.as_deref() {
            Some("ENCASTRE" | "PINNED") => [true; 3],
            _ => {
                let first = integer(rest.first().copied().unwrap_or_default(), "a component")?;
                let last = rest.get(1).filter(|word| !word.is_empty());
                let last = last.map_or(Ok(first), |word| integer(word, "a component"))?;
                if optional(rest.get(2), "a displacement")?.is_some_and(|value| value != 0.0) && first <= 3 {
                    return Err(MeshProblem::NotCarried {
                        what: "a prescribed displacement".to_owned(),
                        advice: "a clamp holds nodes at zero",
                    });
                }
                std::array::from_fn(|k| (first..=last).contains(&(k as u64 + 1)))
            }
        };
        if components.contains(&true) {
            self.supports.push(Support { target: normal(target), components, line });
        }
        Ok(())
    }

    fn end_block(&mut self) -> Result<(), MeshFileError> {
        match &self.block {
            Block::Elements(block) => Scope::end_of_elements(block),
            Block::Axis { numbers, .. } if numbers.len() < 6 => {
                let expected = "two points on the axis, x1, y1, z1, x2, y2, z2".to_owned();
                Err(MeshProblem::Expected { expected }.at(0, &self.card))
            }
            _ => Ok(()),
        }
    }

    /// Puts parts together and checks that all that is named is there.
    pub(super) fn finish(mut self) -> Result<MeshFile, MeshFileError> {
        self.end_block()?;
        if self.part.is_some() || self.in_instance {
            let expected = if self.in_instance { "*END INSTANCE" } else { "*END PART" };
            return Err(MeshProblem::CutShort { expected: expected.to_owned() }.at(0, ""));
        }
        assembled(self.mesh, self.root, self.parts, self.instances, &self.supports, &mut self.work)
    }
}

/// Block of elastic constants, which are those of an isotropic material.
fn elastic(card: &Card) -> Result<Block, MeshProblem> {
    match card.value("TYPE").as_deref() {
        None | Some("ISO" | "ISOTROPIC") => Ok(Block::Elastic),
        Some(other) => Err(MeshProblem::NotCarried {
            what: format!("elasticity of type \"{}\"", quoted(other)),
            advice: "materials are isotropic",
        }),
    }
}

/// Value of a parameter that a card must have.
fn named(card: &Card, what: &str) -> Result<String, MeshProblem> {
    let missing = || MeshProblem::Expected { expected: format!("{}, {what}=name", card.keyword) };
    card.value(what).ok_or_else(missing)
}

/// Number that may be missing.
fn optional(word: Option<&&str>, expected: &'static str) -> Result<Option<f64>, MeshProblem> {
    word.filter(|word| !word.is_empty()).map(|word| real(word, expected)).transpose()
}
