//! Coulomb's disc in the contact plane: tips that stick, or slide in any direction.
//!
//! ```text
//! f = −(λn + τ),   |τ| ≤ μλ,   τ |v| = μλ v,   v = rΩ (e_θ·t) t + (1 − nnᵀ)(u⁺ − u⁻)/2h          on the blade
//! ```
//!
//! The tip slides over the casing by v, that of the rotation and its own vibration, t being the direction of the rotation along the casing
//! ([`tangents`]). This is the velocity with which the energy identity counts the work of a force, so that friction takes τ·v h = |τ||v|h ≥
//! 0 from rotation and vibration together in every step, whatever the step: sliding across the rotation damps the vibration there by about
//! μλ/rΩ per velocity, which the law of tips that only slide forwards does not include. The casing does not move in its surface, nor with
//! an orbit, whose own velocity is to that of the tip as its radius to theirs.
//!
//! Together with the gaps at the end of the step this is the problem of [`rubmap_numerics::complementarity::disc`].

use faer::{Mat, c64};

use super::super::direction::Direction;
use super::super::sector::ContactNode;
use super::flexibility::outward_normals;
use super::friction::{FrictionError, SlidingFlexibility, tangents};

/// Directions n, t and n × t of every contact node, one after the other: gaps and sliding are read along them, and forces act against them.
pub fn disc_directions(contact_nodes: &[ContactNode]) -> Result<Vec<Direction>, FrictionError> {
    let directions = |(along, contact): (Direction, &ContactNode)| {
        let ([a, b, c], [d, e, f]) = (contact.normal, along.components);
        let across = [b * f - c * e, c * d - a * f, a * e - b * d];
        let of = |components| Direction { node: along.node, components };
        [of(contact.normal), along, of(across)]
    };
    Ok(tangents(contact_nodes)?.into_iter().zip(contact_nodes).flat_map(directions).collect())
}

/// Number of directions in which all tips are taken to slide at once.
const DIRECTIONS: u32 = 16;

/// Flexibility of the normals to contact forces in all directions, one `nodes × nodes` block for every nodal diameter.
#[derive(Debug, Clone)]
pub struct DiscFlexibility {
    /// Blocks of forces along n, t and n × t.
    along: [Vec<Mat<c64>>; 3],
}

impl DiscFlexibility {
    /// Flexibility from `blocks(from)`, which gives the displacements along the outward normals by forces along `from`.
    pub fn new(
        contact_nodes: &[ContactNode],
        blocks: impl Fn(&[Direction]) -> Vec<Mat<c64>>,
    ) -> Result<Self, FrictionError> {
        let directions = disc_directions(contact_nodes)?;
        let of = |which: usize| -> Vec<_> { directions.iter().skip(which).step_by(3).copied().collect() };
        let normal = blocks(&outward_normals(contact_nodes));
        Ok(Self { along: [normal, blocks(&of(1)), blocks(&of(2))] })
    }

    /// Flexibility W_n to forces along the normals.
    pub fn normal(&self) -> &[Mat<c64>] {
        &self.along[0]
    }

    /// Checks as [`SlidingFlexibility::check`] tips that all slide in the same direction, for sixteen directions around the contact plane;
    /// `ridge` as there.
    ///
    /// The check is necessary, and for a node that is pressed alone sufficient to 2 % of the coefficient (a direction is at most π/16 from one that
    /// is checked). Tips that slide apart are not checked beforehand: for them the solver refuses solutions at which the orientation is another.
    pub fn check(&self, sectors: usize, ridge: f64, coefficient: f64) -> Result<(), FrictionError> {
        let angles =
            (0..DIRECTIONS).map(|part| std::f64::consts::TAU * f64::from(part) / f64::from(DIRECTIONS));
        let found =
            angles.filter_map(|angle| self.sliding_along(angle).check(sectors, ridge, coefficient).err());
        found.min_by(|a, b| a.largest().total_cmp(&b.largest())).map_or(Ok(()), Err)
    }

    /// Flexibility for tips that slide at an angle from the rotation.
    fn sliding_along(&self, angle: f64) -> SlidingFlexibility {
        let [normal, along, across] = &self.along;
        let (sin, cos) = angle.sin_cos();
        let turned = |(along, across): (&Mat<c64>, &Mat<c64>)| {
            Mat::from_fn(along.nrows(), along.ncols(), |i, j| along[(i, j)] * cos + across[(i, j)] * sin)
        };
        SlidingFlexibility {
            normal: normal.clone(),
            tangential: along.iter().zip(across).map(turned).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn contact_node(normal: [f64; 3]) -> ContactNode {
        ContactNode { id: 1, position: [1.0, 0.0, 0.0], normal, dofs: [0, 1, 2] }
    }

    #[test]
    fn directions_are_a_right_handed_frame_along_the_rotation() {
        for normal in [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.6, 0.64, 0.48], [0.36, -0.8, 0.48]] {
            let nodes = [contact_node(normal)];
            let [n, t, b] = disc_directions(&nodes).unwrap()[..] else { panic!("three of one node") };
            assert_eq!((n.components, t), (normal, tangents(&nodes).unwrap()[0]));
            let frame = [n, t, b].map(|d| d.components);
            let dot = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            for (i, a) in frame.iter().enumerate() {
                for (j, b) in frame.iter().enumerate() {
                    assert!((dot(*a, *b) - f64::from(u8::from(i == j))).abs() < 1e-15);
                }
            }
            let [x, y, z] = frame;
            let volume = x[0] * (y[1] * z[2] - y[2] * z[1]) - x[1] * (y[0] * z[2] - y[2] * z[0])
                + x[2] * (y[0] * z[1] - y[1] * z[0]);
            // What is left of e_θ is along t.
            assert!((volume - 1.0).abs() < 1e-15 && z[1].abs() < 1e-15);
        }
    }

    /// Node that jams at W_n/|W_t| where it slides in the direction that presses it in most, wherever that is: here along 50° from the rotation.
    #[test]
    fn a_node_jams_in_the_direction_that_digs_in() {
        let (sin, cos) = 50.0f64.to_radians().sin_cos();
        let block = |value: f64| vec![Mat::from_fn(1, 1, |_, _| c64::from(value))];
        let node = DiscFlexibility { along: [block(0.3), block(-cos), block(-sin)] };
        assert_eq!(node.check(1, 0.0, 0.299), Ok(()));
        let Err(FrictionError::Jams { node: 0, largest, .. }) = node.check(1, 0.0, 0.5) else {
            panic!("it jams")
        };
        // π/16 from a direction that is looked at, at most.
        assert!((0.299..=0.306).contains(&largest), "{largest}");
        // Forwards alone it would slide up to 0.3/cos 50°.
        assert_eq!(node.sliding_along(0.0).check(1, 0.0, 0.46), Ok(()));
        assert_eq!(node.check(1, 0.0, 0.0), Ok(()));
    }
}
