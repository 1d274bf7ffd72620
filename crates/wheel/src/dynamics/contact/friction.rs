//! Coulomb friction of blade tips that slide over the casing in the direction of rotation.
//!
//! A tip runs at hundreds of metres per second and vibrates at a few: it never sticks and never slides backwards. Friction is
//! then no unknown but follows the normal force λ, and acts against the rotation:
//!
//! ```text
//! f = −λ (n + μ t),   t = (e_θ − (e_θ·n) n)/|…|        on the blade, rotation towards +θ
//! 0 ≤ λ ⊥ g = g_p + W λ ≥ 0,   W = W_n + μ W_t
//! ```
//!
//! W_n and W_t being what unit forces along n and t move along n. W is no longer symmetric. As long as it is a P-matrix (all
//! principal minors positive) the contact forces exist and are unique; beyond, a tip that is dragged along digs in, the more
//! the harder it is pressed: it jams (Painlevé's paradox; Klarbring, Ingenieur-Archiv 60, 1990). [`SlidingFlexibility::check`]
//! finds out before the run.
//!
//! Left out here: the vibration's own velocity v turns the sliding, by v/rΩ, and with it the force, by μλ v/rΩ across the rotation: small
//! beside μλ, but a damping, which [`disc`](super::disc) has in full.

use faer::{Mat, c64};

use super::super::direction::Direction;
use super::super::sector::ContactNode;
use super::flexibility::outward_normals;
use rubmap_numerics::dense::Dense;
use rubmap_numerics::p_matrix::non_positive_minor;
use rubmap_numerics::sector_fourier::is_single;

/// Error: a coefficient or a geometry for which sliding contact makes no sense. Contact nodes count from the leading edge from 0.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum FrictionError {
    /// Normal that points along the rotation.
    #[error(
        "the outward normal of contact node {node} points along the rotation: a casing of revolution has no such wall for the \
         tip to slide on; correct the normal"
    )]
    NoTangent {
        /// Index of the contact node.
        node: usize,
    },
    /// Node that digs in when pressed alone.
    #[error(
        "with a friction coefficient of {coefficient} contact node {node} jams: friction presses its tip into the casing more \
         than the contact force lifts it off; the largest coefficient this wheel can slide with is {largest}"
    )]
    Jams {
        /// Index of the contact node.
        node: usize,
        /// Coefficient μ asked for.
        coefficient: f64,
        /// Largest μ that passes, rounded down to thousandths.
        largest: f64,
    },
    /// Node that digs in when pressed together with others.
    #[error(
        "with a friction coefficient of {coefficient} contact node {node} jams together with other nodes of its tip: the \
         contact forces are not unique; the largest coefficient this wheel can slide with is {largest}"
    )]
    JamsTogether {
        /// Index of the contact node, the last of the set whose minor is not positive.
        node: usize,
        /// Coefficient μ asked for.
        coefficient: f64,
        /// Largest μ that passes, rounded down to thousandths.
        largest: f64,
    },
}

impl FrictionError {
    /// Largest μ that passes; none where no coefficient does.
    pub fn largest(&self) -> f64 {
        match *self {
            Self::NoTangent { .. } => 0.0,
            Self::Jams { largest, .. } | Self::JamsTogether { largest, .. } => largest,
        }
    }
}

/// Sine of the angle between normal and rotation below which the tangent would be made of the normal's round-off.
const ALONG_ROTATION: f64 = 1e-3;

/// Unit tangents t of the casing along the rotation at the contact nodes, in (r, θ, z) components.
pub fn tangents(contact_nodes: &[ContactNode]) -> Result<Vec<Direction>, FrictionError> {
    let tangent = |(node, contact): (usize, &ContactNode)| {
        let [r, theta, z] = contact.normal;
        // e_θ − n_θ n, whose θ component 1 − n_θ² is that of the other two squared: nothing cancels.
        let across = r * r + z * z;
        let sine = across.sqrt();
        if sine < ALONG_ROTATION {
            return Err(FrictionError::NoTangent { node });
        }
        Ok(Direction { node, components: [-theta * r / sine, sine, -theta * z / sine] })
    };
    contact_nodes.iter().enumerate().map(tangent).collect()
}

/// Directions n + μt at the contact nodes: forces act against them, displacements are still read along n.
pub fn sliding_directions(
    contact_nodes: &[ContactNode],
    coefficient: f64,
) -> Result<Vec<Direction>, FrictionError> {
    let mut directions = tangents(contact_nodes)?;
    for (direction, contact) in directions.iter_mut().zip(contact_nodes) {
        for (component, normal) in direction.components.iter_mut().zip(contact.normal) {
            *component = normal + coefficient * *component;
        }
    }
    Ok(directions)
}

/// Flexibility of the normals to contact forces, one `nodes × nodes` block for every nodal diameter.
#[derive(Debug, Clone)]
pub struct SlidingFlexibility {
    /// Flexibility W_n to forces along n.
    pub normal: Vec<Mat<c64>>,
    /// Flexibility W_t to forces along t.
    pub tangential: Vec<Mat<c64>>,
}

impl SlidingFlexibility {
    /// Flexibility from `blocks(from)`, which gives the displacements along the outward normals by forces along `from`.
    pub fn new(
        contact_nodes: &[ContactNode],
        blocks: impl Fn(&[Direction]) -> Vec<Mat<c64>>,
    ) -> Result<Self, FrictionError> {
        let tangential = blocks(&tangents(contact_nodes)?);
        Ok(Self { normal: blocks(&outward_normals(contact_nodes)), tangential })
    }

    /// Blocks of W_n + μ W_t; with μ = 0 the bits of W_n.
    pub fn blocks(&self, coefficient: f64) -> Vec<Mat<c64>> {
        let sum = |(normal, tangential): (&Mat<c64>, &Mat<c64>)| {
            Mat::from_fn(normal.nrows(), normal.ncols(), |i, j| {
                normal[(i, j)] + tangential[(i, j)] * coefficient
            })
        };
        self.normal.iter().zip(&self.tangential).map(sum).collect()
    }

    /// Whether contact of a wheel of `sectors` has a unique solution with `coefficient` ≥ 0; `ridge` is what is added to the
    /// diagonal of W where nodes cannot be told apart.
    ///
    /// The diagonal of W comes first, necessary. Then the Hermitian parts of all blocks: sufficient if they are positive definite. Where
    /// one is not, the principal minors of one sector's block decide, necessary and, as sectors are weakly coupled, all but sufficient: see
    /// [`non_positive_minor`] for which.
    pub fn check(&self, sectors: usize, ridge: f64, coefficient: f64) -> Result<(), FrictionError> {
        if coefficient == 0.0 {
            return Ok(());
        }
        let Err(verdict) = self.verdict(sectors, ridge, coefficient) else { return Ok(()) };
        let largest = self.largest_coefficient(sectors, ridge, coefficient);
        Err(match verdict {
            Jam::Alone(node) => FrictionError::Jams { node, coefficient, largest },
            Jam::Together(node) => FrictionError::JamsTogether { node, coefficient, largest },
        })
    }

    /// Largest coefficient that passes, by bisection over whole thousandths below `failing`. Coefficients for which the first two criteria
    /// hold are an interval from 0; those of the minors need not be, but the result always passes (0 does by construction).
    fn largest_coefficient(&self, sectors: usize, ridge: f64, failing: f64) -> f64 {
        const PARTS: f64 = 1000.0;
        let (mut passes, mut fails) = (0, (failing * PARTS).ceil() as u64);
        while fails > passes + 1 {
            let middle = passes.midpoint(fails);
            if self.verdict(sectors, ridge, middle as f64 / PARTS).is_ok() {
                passes = middle;
            } else {
                fails = middle;
            }
        }
        passes as f64 / PARTS
    }

    fn verdict(&self, sectors: usize, ridge: f64, coefficient: f64) -> Result<(), Jam> {
        let blocks = self.blocks(coefficient);
        let own = own_sector(&blocks, sectors, ridge);
        let worst = (0..own.nrows()).min_by(|&a, &b| own[(a, a)].total_cmp(&own[(b, b)]));
        if let Some(node) = worst.filter(|&node| own[(node, node)] <= 0.0) {
            return Err(Jam::Alone(node));
        }
        if blocks.iter().all(|block| is_positive_definite(block, ridge)) {
            return Ok(());
        }
        non_positive_minor(own.as_ref()).map_or(Ok(()), |node| Err(Jam::Together(node)))
    }
}

/// Node at which a wheel jams, alone or with others.
enum Jam {
    Alone(usize),
    Together(usize),
}

/// Operator W between the nodes of one sector, real `nodes × nodes`.
fn own_sector(blocks: &[Mat<c64>], sectors: usize, ridge: f64) -> Mat<f64> {
    let nodes = blocks.first().map_or(0, Mat::nrows);
    let mut own = Mat::from_fn(nodes, nodes, |i, j| if i == j { ridge } else { 0.0 });
    for (harmonic, block) in blocks.iter().enumerate() {
        let waves = if is_single(harmonic, sectors) { 1.0 } else { 2.0 };
        for j in 0..nodes {
            for i in 0..nodes {
                own[(i, j)] += block[(i, j)].re * waves / sectors as f64;
            }
        }
    }
    own
}

/// Whether xᴴWx + ridge·xᴴx has a positive real part for every x.
fn is_positive_definite(block: &Mat<c64>, ridge: f64) -> bool {
    let hermitian = Mat::from_fn(block.nrows(), block.ncols(), |i, j| {
        0.5 * (block[(i, j)] + block[(j, i)].conj()) + if i == j { ridge } else { 0.0 }
    });
    c64::lower_factor(hermitian.as_ref()).is_some()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_4;

    use super::super::super::modal_wheel::{ModalHarmonic, ModalWheel};
    use super::super::flexibility::{flexibility, ridge};
    use super::*;

    fn contact_node(normal: [f64; 3]) -> ContactNode {
        ContactNode { id: 1, position: [1.0, 0.0, 0.0], normal, dofs: [0, 1, 2] }
    }

    /// Rod whose tip leans by `lean` in the direction of rotation against its root: flexibility `along` its axis and `across`.
    fn leaning_rod(lean: f64, along: f64, across: f64) -> SlidingFlexibility {
        let shapes = [[lean.cos(), lean.sin(), 0.0], [-lean.sin(), lean.cos(), 0.0]];
        let wheel = ModalWheel {
            speed_rad_s: 1.0,
            sectors: 1,
            repeats: 1,
            harmonics: vec![ModalHarmonic {
                harmonic: 0,
                single: true,
                omega: vec![1.0, 1.0],
                contact: Mat::from_fn(3, 2, |component, mode| c64::new(shapes[mode][component], 0.0)),
                gyroscopic: None,
            }],
        };
        let nodes = [contact_node([1.0, 0.0, 0.0])];
        let normals = outward_normals(&nodes);
        let blocks =
            |from: &[Direction]| flexibility(&wheel, &normals, from, |_, mode| [along, across][mode]);
        SlidingFlexibility::new(&nodes, blocks).unwrap()
    }

    #[test]
    fn tangents_are_unit_vectors_of_the_casing_along_the_rotation() {
        for normal in [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.6, 0.64, 0.48], [0.36, -0.8, 0.48]] {
            let t = tangents(&[contact_node(normal)]).unwrap()[0].components;
            let dot = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            assert!(dot(t, normal).abs() < 1e-15 && (dot(t, t) - 1.0).abs() < 1e-15 && t[1] > 0.0, "{t:?}");
        }
        let error = tangents(&[contact_node([1.0, 0.0, 0.0]), contact_node([0.0, -1.0, 0.0])]).unwrap_err();
        assert_eq!(error, FrictionError::NoTangent { node: 1 });
    }

    /// Friction works against the motion: it drags a tip back, whatever its normal.
    #[test]
    fn friction_drags_the_tip_against_the_rotation() {
        let nodes = [contact_node([0.6, 0.64, 0.48])];
        let (with, without) = (sliding_directions(&nodes, 0.5).unwrap(), outward_normals(&nodes));
        assert!(-with[0].components[1] < -without[0].components[1]);
        assert_eq!(sliding_directions(&nodes, 0.0).unwrap(), without);
    }

    /// Rod that leans by β: W_n = a cos²β + b sin²β and W_t = (a − b) sin β cos β. A forward lean jams from μ = −W_n/W_t, tan β of a rod
    /// that is stiff along its axis; a backward one trails and never does.
    #[test]
    fn a_rod_that_leans_forwards_jams_at_the_tangent_of_its_lean() {
        for (lean, along) in [(0.2f64, 0.0), (0.2, 0.01), (FRAC_PI_4, 0.1)] {
            let (sin, cos) = lean.sin_cos();
            let limit = (along * cos * cos + sin * sin) / ((1.0 - along) * sin * cos);
            let rod = leaning_rod(lean, along, 1.0);
            assert_eq!(rod.check(1, 0.0, limit - 1e-3), Ok(()));
            let coefficient = limit + 0.1;
            let largest = (limit * 1000.0).floor() / 1000.0;
            assert_eq!(
                rod.check(1, 0.0, coefficient),
                Err(FrictionError::Jams { node: 0, coefficient, largest }),
                "{lean} {along}"
            );
            assert_eq!(leaning_rod(-lean, along, 1.0).check(1, 0.0, 100.0), Ok(()));
        }
    }

    /// Mirror image of a rod, in which the rotation is reversed: W(μ) of the rod is W(−μ) of its image.
    #[test]
    fn the_mirror_image_turns_the_other_way() {
        let (rod, mirrored) = (leaning_rod(0.3, 0.1, 1.0), leaning_rod(-0.3, 0.1, 1.0));
        for coefficient in [0.1, 0.4] {
            let difference = &rod.blocks(coefficient)[0] - &mirrored.blocks(-coefficient)[0];
            assert!(difference.norm_max() < 1e-15);
        }
        assert_eq!(rod.blocks(0.0), rod.normal);
    }

    /// Two nodes with W = [1, c + 2μ; c, 1]: the symmetric part is definite below μ = 1 − c, the minor 1 − c(c + 2μ) positive below (1/c −
    /// c)/2; in between the minors decide.
    #[test]
    fn two_nodes_jam_together_where_their_minor_vanishes() {
        let real = |values: [[f64; 2]; 2]| vec![Mat::from_fn(2, 2, |i, j| c64::new(values[i][j], 0.0))];
        let pair = SlidingFlexibility {
            normal: real([[1.0, 0.5], [0.5, 1.0]]),
            tangential: real([[0.0, 2.0], [0.0, 0.0]]),
        };
        for coefficient in [0.0, 0.4, 0.6, 0.74] {
            assert_eq!(pair.check(1, 0.0, coefficient), Ok(()), "{coefficient}");
        }
        let error = FrictionError::JamsTogether { node: 1, coefficient: 0.8, largest: 0.749 };
        assert_eq!(pair.check(1, 0.0, 0.8), Err(error));
    }

    /// Coincident nodes leave W singular; friction small enough for one node is small enough for both.
    #[test]
    fn coincident_nodes_slide_as_one() {
        let twin = |blocks: Vec<Mat<c64>>| vec![Mat::from_fn(2, 2, |_, _| blocks[0][(0, 0)])];
        let rod = leaning_rod(0.2, 0.01, 1.0);
        let twins = SlidingFlexibility { normal: twin(rod.normal), tangential: twin(rod.tangential) };
        let ridge = ridge(&twins.normal, 1);
        assert!(ridge > 0.0);
        assert_eq!(twins.check(1, ridge, 0.2), Ok(()));
        assert!(matches!(twins.check(1, ridge, 0.3), Err(FrictionError::Jams { node: 0, .. })));
    }
}
