//! Instances of parts.

use super::request::Request;
use crate::error::MeshProblem;
use crate::fields::real;

/// Most instances of an assembly.
pub(super) const MOST_INSTANCES: usize = 1000;

/// Instance of a part: where it is put, and the sets of the assembly that name its nodes and elements.
#[derive(Debug)]
pub(super) struct Instance {
    pub(super) name: String,
    pub(super) part: String,
    pub(super) line: u64,
    translation: [f64; 3],
    /// Two points on the axis of a turn, and its angle in degrees.
    turn: Option<([[f64; 3]; 2], f64)>,
    lines: usize,
    /// Sets of the assembly with their lines, which the part's numbers answer.
    pub(super) requests: Vec<(Request, Vec<String>)>,
}

impl Instance {
    pub(super) fn new(name: String, part: String, line: u64) -> Self {
        let (translation, turn) = ([0.0; 3], None);
        Self { name, part, line, translation, turn, lines: 0, requests: Vec::new() }
    }

    /// Reads the displacement of the instance, then its turn.
    pub(super) fn placed(&mut self, words: &[&str]) -> Result<(), MeshProblem> {
        let words = words.iter().filter(|word| !word.is_empty());
        let numbers: Vec<f64> = words.map(|word| real(word, "a coordinate")).collect::<Result<_, _>>()?;
        match (self.lines, &numbers[..]) {
            (0, &[x, y, z]) => self.translation = [x, y, z],
            (1, &[a, b, c, d, e, f, angle]) => self.turn = Some(([[a, b, c], [d, e, f]], angle)),
            _ => {
                let expected = "a displacement x, y, z, then two points on an axis and an angle".to_owned();
                return Err(MeshProblem::Expected { expected });
            }
        }
        self.lines += 1;
        Ok(())
    }

    /// Keeps a line of a set until the part is known.
    pub(super) fn request(&mut self, request: &Request, words: &[&str]) {
        let line = words.join(",");
        match self.requests.last_mut() {
            Some((last, lines)) if last == request => lines.push(line),
            _ => self.requests.push((request.clone(), vec![line])),
        }
    }

    /// Position of a node of the part.
    pub(super) fn position(&self, at: [f64; 3]) -> [f64; 3] {
        let moved: [f64; 3] = std::array::from_fn(|k| at[k] + self.translation[k]);
        let Some(([from, to], degrees)) = self.turn else { return moved };
        let direction = std::array::from_fn(|k| to[k] - from[k]);
        let frame = rubmap_solid::frame::AxisFrame::new(from, direction);
        frame.map_or(moved, |frame| frame.turn_point(moved, degrees.to_radians()))
    }
}
