//! Balance of the cyclic faces once the sectors of the wheel are joined.
//!
//! A rigid motion of the whole wheel moves the sector before this one by the same motion seen from there, turned by α = 2π/N. Where nothing
//! holds a pair of face nodes, what K(0) makes of both at the joint vanishes, whichever of the two blocks has the part of the other:
//!
//! ```text
//! F_low(v) + Rᵀ F_high(R v) = 0,    v(x) = t + a × x,    R v: R t, R a
//! ```

use std::f64::consts::TAU;

use nalgebra::{Matrix3, Vector3};
use rubmap_solid::frame::Basis;
use rubmap_wheel::dynamics::findings::OpenJoint;

use super::rigid::{Balance, Body, MOTIONS, OfMotions, Reading, forces};
use crate::package::check::layout::{Layout, NONE};
use crate::package::error::{FaceReading, ManifestProblem, PackageError};
use crate::package::raw::{Frame, RawMatrix, RawPackage};

/// Fewest pairs that another reading must put in balance.
const FEWEST: usize = 3;

/// Forces at a joint below this part of Σ|K_ij| times the size of the sector are balance, as for single nodes.
const IN_BALANCE: f64 = 1e-5;

/// Refuses high faces that fit the low ones only in another reading, or not at all because they are empty; returns counts that look wrong.
pub(super) fn check(
    body: &Body,
    inner: &Balance,
    package: &RawPackage,
    layout: &Layout,
) -> Result<Option<OpenJoint>, PackageError> {
    let joint = Joint::of(body, package, layout);
    if joint.pairs.is_empty() {
        return Ok(None);
    }
    let stiffness = &package.stiffness[0];
    let refuse = |reading: FaceReading, stated: usize, found: usize| {
        let problem = ManifestProblem::FacesOtherwise { reading, stated, found, pairs: joint.pairs.len() };
        Err(PackageError::manifest("/cyclic", problem))
    };
    if joint.high_is_empty(stiffness) {
        let problem = ManifestProblem::SectorsApart;
        return Err(PackageError::manifest("/cyclic", problem));
    }
    let stated = joint.balanced(&inner.forces, &body.stated, stiffness);
    let count = |balanced: &[bool]| balanced.iter().filter(|one| **one).count();
    if count(&stated) + FEWEST > joint.pairs.len() {
        return Ok(None);
    }
    let gains = |found: &[bool]| {
        let changes = || stated.iter().zip(found);
        let gained = changes().filter(|(before, after)| !**before && **after).count();
        let lost = changes().filter(|(before, after)| **before && !**after).count();
        gained >= FEWEST.max(10 * lost)
    };
    let once = joint.without_high_block(stiffness);
    let by_row = forces(&once, &body.motions(&body.stated));
    let found = joint.balanced(&by_row, &body.stated, &once);
    if gains(&found) {
        return refuse(FaceReading::Twice, count(&stated), count(&found));
    }
    for (meant, reading) in joint.readings(body, package, layout) {
        let by_row = forces(stiffness, &body.motions(&reading));
        let found = joint.balanced(&by_row, &reading, stiffness);
        if gains(&found) {
            return refuse(meant, count(&stated), count(&found));
        }
    }
    Ok(OpenJoint::of(count(&stated), joint.pairs.len(), inner.count(), body.inner().count()))
}

/// Pairs of face nodes that have all components, and the turn that joins them.
struct Joint {
    /// Low and high node of each pair.
    pairs: Vec<[usize; 2]>,
    /// R.
    turn: Matrix3<f64>,
    /// Vector from the axis, normal to it, to the middle of the sector.
    middle: Vector3<f64>,
    size: f64,
    /// Whether a row is of a high node.
    is_high: Vec<bool>,
}

impl Joint {
    fn of(body: &Body, package: &RawPackage, layout: &Layout) -> Self {
        let whole = |node: usize| !layout.rows_of_node[node].contains(&NONE);
        let pair = |(low, &high): (usize, &u32)| {
            (high != NONE && whole(low) && whole(high as usize)).then_some([low, high as usize])
        };
        let pairs = layout.high_of.iter().enumerate().filter_map(pair).collect();
        let high = |&node: &u32| layout.low_of[node as usize] != NONE;
        Self {
            pairs,
            turn: layout.frame.turned_global(TAU / package.manifest.sectors as f64).transpose(),
            middle: body.middle_from_axis(),
            size: body.size,
            is_high: layout.node_of_row.iter().map(high).collect(),
        }
    }

    fn high_is_empty(&self, stiffness: &RawMatrix) -> bool {
        let of_high = |row: u32| self.is_high[row as usize];
        !stiffness.entries.iter().any(|&(row, column, value)| {
            value != 0.0 && (of_high(row) != of_high(column) || (of_high(row) && of_high(column)))
        })
    }

    /// The matrix without its block of the high face against itself.
    fn without_high_block(&self, stiffness: &RawMatrix) -> RawMatrix {
        let both = |row: u32, column: u32| self.is_high[row as usize] && self.is_high[column as usize];
        let entries = stiffness.entries.iter().filter(|&&(row, column, _)| !both(row, column));
        RawMatrix { size: stiffness.size, entries: entries.copied().collect() }
    }

    /// Whether each pair is in balance under `by_row`, the forces against the motions of the body.
    fn balanced(&self, by_row: &[OfMotions], reading: &Reading, stiffness: &RawMatrix) -> Vec<bool> {
        let mut scale = vec![0.0; stiffness.size];
        for &(row, column, value) in &stiffness.entries {
            scale[row as usize] += value.abs();
            if row != column {
                scale[column as usize] += value.abs();
            }
        }
        let reach = self.size + self.middle.norm();
        let of_pair = |&[low, high]: &[usize; 2]| {
            let at = |node: usize| -> [Vector3<f64>; MOTIONS] {
                std::array::from_fn(|motion| reading.vector(node, by_row, motion))
            };
            let (low_forces, high_forces) = (at(low), at(high));
            let unit = |k: usize| Vector3::from_fn(|i, _| f64::from(u8::from(i == k)));
            let left = |t: Vector3<f64>, a: Vector3<f64>| {
                let back = self.turn.tr_mul(&self.force(&high_forces, self.turn * t, self.turn * a));
                (self.force(&low_forces, t, a) + back).amax()
            };
            let force = (0..3)
                .map(|k| left(unit(k) * reach, Vector3::zeros()).max(left(Vector3::zeros(), unit(k))))
                .fold(0.0, f64::max);
            let rows = reading.rows_of_node[low].iter().chain(&reading.rows_of_node[high]);
            let scale = rows.map(|&row| scale[row as usize] * reach).fold(0.0, f64::max);
            force <= IN_BALANCE * scale && scale > 0.0
        };
        self.pairs.iter().map(of_pair).collect()
    }

    /// Force on a node against v(x) = t + a × x, x from the axis, by those against the motions of the body, which turn about its middle.
    fn force(&self, forces: &[Vector3<f64>; MOTIONS], t: Vector3<f64>, a: Vector3<f64>) -> Vector3<f64> {
        let moved = (t + a.cross(&self.middle)) / self.size;
        (0..3).map(|k| forces[k] * moved[k] + forces[k + 3] * a[k]).sum()
    }

    /// Readings of the rows of the high face that exports are known for.
    fn readings(&self, body: &Body, package: &RawPackage, layout: &Layout) -> Vec<(FaceReading, Reading)> {
        let on_high = |node: usize| layout.low_of[node] != NONE;
        let along = |basis: &dyn Fn(usize) -> Basis| {
            let mut reading = body.stated.clone();
            for node in (0..reading.bases.len()).filter(|&node| on_high(node)) {
                reading.bases[node] = basis(node);
            }
            reading
        };
        let stated = &body.stated.bases;
        let other = match package.manifest.frame {
            Frame::Cartesian => Frame::Cylindrical,
            Frame::Cylindrical => Frame::Cartesian,
        };
        let in_other = body.in_frames(|_| other);
        let mut all = vec![
            (FaceReading::OtherFrame { meant: other.name() }, along(&|node| in_other.bases[node])),
            (FaceReading::OtherSign, along(&|node| -stated[node])),
            (FaceReading::Turned, along(&|node| stated[node] * self.turn.transpose())),
            (FaceReading::Turned, along(&|node| stated[node] * self.turn)),
        ];
        for axis in 0..3 {
            let mirrored = |node: usize| {
                let mut basis = stated[node];
                basis.row_mut(axis).neg_mut();
                basis
            };
            all.push((FaceReading::OtherSignOf { component: axis + 1 }, along(&mirrored)));
        }
        let first_row = |node: &usize| layout.rows_of_node[*node][0];
        let mut listed: Vec<usize> = self.pairs.iter().map(|pair| pair[1]).collect();
        listed.sort_by_key(first_row);
        let mut as_low: Vec<usize> = listed.clone();
        as_low.sort_by_key(|&high| first_row(&(layout.low_of[high] as usize)));
        let reversed: Vec<usize> = listed.iter().rev().copied().collect();
        for (order, nodes) in [("of the low face", as_low), ("reversed", reversed)] {
            if nodes == listed {
                continue;
            }
            let mut reading = body.stated.clone();
            for (&node, &has) in nodes.iter().zip(&listed) {
                reading.rows_of_node[node] = layout.rows_of_node[has];
            }
            all.push((FaceReading::OtherOrder { order }, reading));
        }
        all
    }
}
