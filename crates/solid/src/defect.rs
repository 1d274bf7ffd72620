//! Defects of elements: an element is whole if it is nowhere turned inside out or collapsed.

use crate::element::ElementKind;
use crate::frame::distance;
use crate::gradients::jacobian;
use crate::natural::Natural;
use crate::rule::points;
use crate::topology::Topology;

/// Largest distance of a mid-edge node from the middle of its edge, relative to the edge's length: an edge bent by 155°. Among the nodes of
/// a tetrahedron in a wrong order some are farther off, though its Jacobian determinant may be positive.
const FARTHEST_MIDDLE: f64 = 0.4;

/// Reason why an element is not whole.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Defect {
    /// Node that should be in the middle of an edge and is somewhere else.
    Middle {
        /// Local number of the node, from 0.
        node: usize,
        /// Local numbers of the ends of the edge, from 0.
        edge: [usize; 2],
    },
    /// Jacobian determinant that is not positive.
    Jacobian {
        /// Corner of the determinant, from 0; none where it is that of an integration point.
        corner: Option<usize>,
        /// Value of the determinant.
        determinant: f64,
        /// Likely cause.
        likely: Likely,
    },
}

/// Likely cause of a defect.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Likely {
    /// Mirror image of an element is listed.
    Mirrored,
    /// Mid-edge nodes are misplaced: with them in the middle of their edges the element would be whole.
    MiddleNodes,
    /// Cause that is none of the others.
    Other,
}

/// First defect of an element: a mid-edge node elsewhere, then a corner or integration point at which the Jacobian determinant is not a
/// positive number. None for a whole element.
pub fn defect(kind: ElementKind, positions: &[[f64; 3]]) -> Option<Defect> {
    let topology = Topology::of(kind);
    for (node, &edge) in (topology.corners.len()..positions.len()).zip(topology.edges) {
        let [a, b] = edge.map(|corner| positions[corner]);
        let middle = std::array::from_fn(|d| 0.5 * (a[d] + b[d]));
        if distance(positions[node], middle) > FARTHEST_MIDDLE * distance(a, b) {
            return Some(Defect::Middle { node, edge });
        }
    }
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
    Some(Defect::Jacobian { corner, determinant: value, likely })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reference(kind: ElementKind) -> Vec<[f64; 3]> {
        Topology::of(kind).nodes()
    }

    fn likely(kind: ElementKind, positions: &[[f64; 3]]) -> Option<Likely> {
        match defect(kind, positions) {
            Some(Defect::Jacobian { likely, .. }) => Some(likely),
            _ => None,
        }
    }

    #[test]
    fn the_cause_is_recognised() {
        for kind in ElementKind::ALL {
            let whole = reference(kind);
            assert_eq!(defect(kind, &whole), None, "{kind:?}");
            let mirrored: Vec<[f64; 3]> = whole.iter().map(|&[x, y, z]| [x, y, -z]).collect();
            assert_eq!(likely(kind, &mirrored), Some(Likely::Mirrored), "{kind:?}");
            let mut collapsed = whole.clone();
            collapsed[1] = collapsed[0];
            assert!(defect(kind, &collapsed).is_some(), "{kind:?}");
            for from in kind.corners()..kind.nodes() {
                for to in from + 1..kind.nodes() {
                    let mut other = whole.clone();
                    other.swap(from, to);
                    let found = defect(kind, &other);
                    assert!(
                        matches!(found, Some(Defect::Middle { node, .. }) if node == from || node == to),
                        "{kind:?} {from} {to}"
                    );
                }
                // Nearer to one end than a quarter of the edge.
                let mut pushed = whole.clone();
                let [a, b] = Topology::of(kind).edges[from - kind.corners()].map(|corner| whole[corner]);
                pushed[from] = std::array::from_fn(|d| 0.8 * a[d] + 0.2 * b[d]);
                assert_eq!(likely(kind, &pushed), Some(Likely::MiddleNodes), "{kind:?} {from}");
            }
        }
    }
}
