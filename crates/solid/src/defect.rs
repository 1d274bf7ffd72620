//! Whether an element is whole: nowhere turned inside out or collapsed.

use crate::element::ElementKind;
use crate::gradients::jacobian;
use crate::natural::Natural;
use crate::rule::points;
use crate::topology::Topology;

/// Where an element's Jacobian determinant is not positive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Defect {
    /// The corner, from 0, if it is there; otherwise an integration point.
    pub corner: Option<usize>,
    /// The determinant there.
    pub determinant: f64,
    /// What it looks like.
    pub likely: Likely,
}

/// The likely cause of a defect.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Likely {
    /// The mirror image of an element is listed.
    Mirrored,
    /// With its mid-edge nodes in the middle of their edges it would be whole.
    MiddleNodes,
    /// None of these.
    Other,
}

/// The first corner or integration point at which the Jacobian determinant is not a positive number; none for a whole element.
pub fn defect(kind: ElementKind, positions: &[[f64; 3]]) -> Option<Defect> {
    let topology = Topology::of(kind);
    let corners = topology.corners.iter().enumerate().map(|(k, &xi)| (Some(k), xi));
    let places: Vec<(Option<usize>, Natural)> =
        corners.chain(points(kind).iter().map(|point| (None, point.xi))).collect();
    let determinant = |positions: &[[f64; 3]], xi| jacobian(kind, positions, xi).determinant();
    let whole = |determinant: f64| determinant > 0.0 && determinant.is_finite();
    let found = |&(corner, xi): &(Option<usize>, Natural)| {
        let determinant = determinant(positions, xi);
        (!whole(determinant)).then_some((corner, determinant))
    };
    let (corner, value) = places.iter().find_map(found)?;
    let mut straight = positions.to_vec();
    for (&[a, b], middle) in topology.edges.iter().zip(&mut straight[topology.corners.len()..]) {
        *middle = std::array::from_fn(|d| 0.5 * (positions[a][d] + positions[b][d]));
    }
    let likely = if places.iter().all(|&(_, xi)| determinant(positions, xi) < 0.0) {
        Likely::Mirrored
    } else if straight != positions && places.iter().all(|&(_, xi)| whole(determinant(&straight, xi))) {
        Likely::MiddleNodes
    } else {
        Likely::Other
    };
    Some(Defect { corner, determinant: value, likely })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reference(kind: ElementKind) -> Vec<[f64; 3]> {
        Topology::of(kind).nodes()
    }

    #[test]
    fn the_cause_is_recognised() {
        for kind in ElementKind::ALL {
            let whole = reference(kind);
            assert_eq!(defect(kind, &whole), None, "{kind:?}");
            let mirrored: Vec<[f64; 3]> = whole.iter().map(|&[x, y, z]| [x, y, -z]).collect();
            assert_eq!(defect(kind, &mirrored).unwrap().likely, Likely::Mirrored, "{kind:?}");
            let mut collapsed = whole.clone();
            collapsed[1] = collapsed[0];
            assert!(defect(kind, &collapsed).is_some(), "{kind:?}");
            if kind.nodes() > kind.corners() {
                // Middles of the last edges before those of others, as some codes list them.
                let mut other = whole.clone();
                other[kind.corners()..].rotate_right(kind.corners() / 2);
                assert_eq!(defect(kind, &other).unwrap().likely, Likely::MiddleNodes, "{kind:?}");
            }
        }
    }
}
