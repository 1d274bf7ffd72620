//! Element types of Ansys and what becomes of their elements.

use std::collections::BTreeMap;

use super::command::Fields;
use crate::error::{MeshFileError, MeshProblem};
use crate::fields::{integer, quoted};
use crate::lines::Lines;

/// Element type, as ET and KEYOPT define it.
#[derive(Debug, Default)]
pub(super) struct ElementType {
    /// Number in Ansys's library, such as 186.
    number: u32,
    /// Options by number, where they are not zero.
    options: BTreeMap<u64, u64>,
}

/// Fate of the elements of a type.
#[derive(Debug, PartialEq)]
pub(super) enum Fate {
    /// Hexahedra of 8 nodes.
    Hexahedron8,
    /// Hexahedra of 20 nodes.
    Hexahedron20 {
        /// Whether 2 × 2 × 2 integration points are enough for the type.
        reduced: bool,
    },
    /// Tetrahedra of 10 nodes.
    Tetrahedron10,
    /// Tetrahedra of 4 nodes.
    Tetrahedron4,
    /// Lines and surfaces.
    LeftOut,
    /// Elements that a model cannot do without and that rubmap lacks, with advice.
    Refused(&'static str),
}

impl ElementType {
    /// Name of the type, such as `SOLID186`.
    pub(super) fn name(&self) -> String {
        let family = family(self.number).map_or("element type ", |(name, _)| name);
        format!("{family}{}", self.number)
    }

    /// Fate of the elements.
    pub(super) fn fate(&self) -> Fate {
        let option = |number| self.options.get(&number).copied().unwrap_or(0);
        match self.number {
            185 | 186 if option(3) == 1 => Fate::Refused("model each layer by solid elements of its own"),
            45 | 185 => Fate::Hexahedron8,
            186 => Fate::Hexahedron20 { reduced: option(2) != 1 },
            95 => Fate::Hexahedron20 { reduced: option(11) == 1 },
            92 | 187 => Fate::Tetrahedron10,
            285 => Fate::Tetrahedron4,
            number => family(number).map_or(Fate::Refused(OTHER), |(_, fate)| match fate {
                None => Fate::LeftOut,
                Some(advice) => Fate::Refused(advice),
            }),
        }
    }
}

/// Advice for types without a counterpart.
const OTHER: &str = "use SOLID185, SOLID186, SOLID187 or SOLID285";
/// Advice for contact.
const CONTACT: &str = "rubmap has no contact within the sector: merge the parts' nodes, so that they are one mesh, and write it again";
/// Advice for springs and masses.
const DISCRETE: &str = "a sector is made of solid elements: model the part by them, or delete these elements";

/// Name of a type's family; advice if its elements are refused, none if they are left out.
fn family(number: u32) -> Option<(&'static str, Option<&'static str>)> {
    let (name, advice) = match number {
        1 | 8 | 10 | 11 | 33 | 68 | 180 => ("LINK", None),
        3 | 4 | 23 | 24 | 44 | 54 | 188 | 189 => ("BEAM", None),
        16 | 18 | 20 | 59 | 60 | 288 | 289 => ("PIPE", None),
        290 => ("ELBOW", None),
        19 | 22 | 151..=154 | 156 | 159 => ("SURF", None),
        28 | 41 | 43 | 51 | 61 | 63 | 91 | 93 | 99 | 143 | 150 | 181 | 208 | 209 | 281 => ("SHELL", None),
        2 | 25 | 42 | 82 | 83 | 145 | 146 | 182 | 183 => ("PLANE", None),
        200 => ("MESH", None),
        201 => ("FOLLW", None),
        12 | 26 | 48 | 49 | 52 => ("CONTAC", Some(CONTACT)),
        169 | 170 => ("TARGE", Some(CONTACT)),
        171..=178 => ("CONTA", Some(CONTACT)),
        7 | 14 | 37 | 39 | 40 | 214 | 250 => ("COMBIN", Some(DISCRETE)),
        21 => ("MASS", Some(DISCRETE)),
        27 | 50 => ("MATRIX", Some(DISCRETE)),
        179 => ("PRETS", Some(DISCRETE)),
        184 => ("MPC", Some("rubmap has no joints and rigid links: merge the parts' nodes into one mesh")),
        45 | 46 | 62 | 64 | 65 | 92 | 95 | 147 | 148 | 164 | 168 | 185 | 186 | 187 | 191 | 285 => {
            ("SOLID", Some(OTHER))
        }
        190 => ("SOLSH", Some(OTHER)),
        _ => return None,
    };
    Some((name, advice))
}

/// Element types by their numbers in the file.
#[derive(Debug, Default)]
pub(super) struct ElementTypes(BTreeMap<u64, ElementType>);

impl ElementTypes {
    /// Type of a number.
    pub(super) fn get(&self, number: u64) -> Option<&ElementType> {
        self.0.get(&number)
    }

    /// Takes the command `ET,1,186` or `ET,1,SOLID186`, with options behind.
    pub(super) fn define(&mut self, fields: &Fields) -> Result<(), MeshProblem> {
        self.insert(fields.get(1), fields.get(2), fields.from(3))
    }

    /// Takes the command `KEYOPT,1,2,1`.
    pub(super) fn option(&mut self, fields: &Fields) -> Result<(), MeshProblem> {
        let number = integer(fields.get(1), "an element type number")?;
        let option = integer(fields.get(2), "the number of an option")?;
        let value = value(fields.get(3))?;
        if let Some(found) = self.0.get_mut(&number) {
            found.options.insert(option, value);
        }
        Ok(())
    }

    /// Takes the block of ETBLOCK: number, type and options on each line.
    pub(super) fn block(&mut self, lines: &mut Lines) -> Result<(), MeshFileError> {
        const CARD: &str = "ETBLOCK";
        lines.expect(CARD, "the block's format")?;
        loop {
            let line = String::from_utf8_lossy(lines.expect(CARD, "the end of the element types (-1)")?);
            let words: Vec<&str> = line.split_whitespace().collect();
            match words.as_slice() {
                ["-1", ..] => return Ok(()),
                [number, name, options @ ..] => self.insert(number, name, options),
                _ => Err(MeshProblem::Expected { expected: "an element type or -1".to_owned() }),
            }
            .map_err(|problem| problem.at(lines.number(), CARD))?;
        }
    }

    /// Defines a type, with its options from the first on.
    fn insert(&mut self, number: &str, name: &str, options: &[&str]) -> Result<(), MeshProblem> {
        let number = integer(number, "an element type number")?;
        let digits = name.trim_start_matches(|c: char| !c.is_ascii_digit());
        let not = || MeshProblem::NotA { text: quoted(name), expected: "an element type, such as SOLID186" };
        let mut found = ElementType { number: digits.parse().map_err(|_| not())?, ..Default::default() };
        for (option, text) in (1..).zip(options) {
            found.options.insert(option, value(text)?);
        }
        self.0.insert(number, found);
        Ok(())
    }
}

/// Value of an option: zero where it is left out, and where it is negative, which no option asked for here is.
fn value(text: &str) -> Result<u64, MeshProblem> {
    if text.is_empty() || text.starts_with('-') { Ok(0) } else { integer(text, "the value of an option") }
}
