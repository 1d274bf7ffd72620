//! Excursion of the tips at single instants, by which linear theory is judged.

use std::f64::consts::PI;

use super::super::direction::COMPONENTS;
use super::super::sector::ContactNode;
use super::simulation::Simulation;

/// Largest excursions over the window, of all blades and contact nodes, at the instants of [`TipMotion`](super::TipMotion); mean included.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Excursion {
    /// Displacement of a contact node, length.
    pub displacement: f64,
    /// Tangential component of the displacement, length.
    pub tangential: f64,
    /// Rotation of the line between two neighbouring contact nodes, rad: the difference of their displacements across the line over its
    /// length. 0 with one contact node.
    pub rotation: f64,
    /// Approach of the same contact nodes of two neighbouring blades in the tangential direction, over the distance between them. 0 of a
    /// single blade.
    pub approach: f64,
    /// Share of the linear motion of the contact nodes that the coordinates of blades that bend far do not carry, root mean square over the
    /// window and all blades; 0 where blades do not bend far.
    pub outside_coordinates: f64,
}

/// Recorder of an [`Excursion`].
#[derive(Debug)]
pub(super) struct ExcursionTally {
    /// Unit vector and length of every segment of the contact line, in (r, θ, z) components: the components of neighbouring nodes count as
    /// the same, as far as the line does not run around the axis.
    segments: Vec<([f64; COMPONENTS], f64)>,
    /// Distance between the same node of neighbouring blades; empty of a single blade.
    apart: Vec<f64>,
    found: Excursion,
}

impl ExcursionTally {
    pub(super) fn new(simulation: &Simulation<'_>) -> Self {
        let nodes = simulation.contact_nodes;
        let segment = |pair: &[ContactNode]| {
            let (from, to) = (pair[0].position, pair[1].position);
            let turn = to[1] - from[1];
            let way = [to[0] * turn.cos() - from[0], 0.5 * (from[0] + to[0]) * turn.sin(), to[2] - from[2]];
            let length = way.iter().map(|w| w * w).sum::<f64>().sqrt();
            (way.map(|w| w / length), length)
        };
        let around = simulation.wheel.around();
        let apart = |node: &ContactNode| 2.0 * node.position[0] * (PI / around as f64).sin();
        Self {
            segments: nodes.windows(2).map(segment).collect(),
            apart: if around > 1 { nodes.iter().map(apart).collect() } else { Vec::new() },
            found: Excursion::default(),
        }
    }

    /// Updates the largest excursions by an instant, `[sector][contact node][component]`.
    pub(super) fn look(&mut self, now: &[f64]) {
        let blade = (self.segments.len() + 1) * COMPONENTS;
        let found = &mut self.found;
        for (sector, tips) in now.chunks_exact(blade).enumerate() {
            let mut before: Option<&[f64]> = None;
            for (node, tip) in tips.chunks_exact(COMPONENTS).enumerate() {
                found.displacement =
                    found.displacement.max((tip[0] * tip[0] + tip[1] * tip[1] + tip[2] * tip[2]).sqrt());
                found.tangential = found.tangential.max(tip[1].abs());
                if let Some(before) = before {
                    let (along, length) = &self.segments[node - 1];
                    let (mut square, mut stretch) = (0.0, 0.0);
                    for component in 0..COMPONENTS {
                        let difference = tip[component] - before[component];
                        square += difference * difference;
                        stretch += difference * along[component];
                    }
                    let across = (square - stretch * stretch).max(0.0).sqrt();
                    if *length > 0.0 {
                        found.rotation = found.rotation.max(across / length);
                    }
                }
                before = Some(tip);
                if let Some(&apart) = self.apart.get(node).filter(|&&apart| apart > 0.0) {
                    // The blade after the last one is the first one, or moves as it does.
                    let next = ((sector + 1) * blade) % now.len() + node * COMPONENTS + 1;
                    found.approach = found.approach.max((tip[1] - now[next]) / apart);
                }
            }
        }
    }

    pub(super) fn found(&self) -> Excursion {
        self.found
    }
}
