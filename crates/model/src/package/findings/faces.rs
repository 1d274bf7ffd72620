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

use super::better::{Better, FEWEST, best, count};
use super::rigid::{Balance, Body, IN_BALANCE, MOTIONS, OfMotions, Reading, absolute_sums, forces};
use crate::package::check::layout::{Layout, NONE};
use crate::package::error::{FaceReading, ManifestProblem, PackageError};
use crate::package::raw::{Frame, RawMatrix, RawPackage};

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
    if joint.high_is_empty(stiffness) {
        return Err(PackageError::manifest("/cyclic", ManifestProblem::SectorsApart));
    }
    let (pairs, stated) = (joint.pairs.len(), joint.balanced(&inner.forces, &body.stated, stiffness));
    if count(&stated) + FEWEST > pairs {
        return Ok(None);
    }
    let once = joint.without_high_block(stiffness);
    let folded = std::iter::once((FaceReading::Twice, body.stated.clone(), &once));
    let read = joint.readings(body, package, layout).into_iter();
    let others = folded.chain(read.map(|(meant, reading)| (meant, reading, stiffness)));
    let balanced = others.map(|(meant, reading, matrix)| {
        let by_row = forces(matrix, &body.motions(&reading));
        (meant, joint.balanced(&by_row, &reading, matrix))
    });
    match best(&stated, pairs, balanced) {
        Some(Better { reading, found }) => {
            let problem = ManifestProblem::FacesOtherwise { reading, stated: count(&stated), found, pairs };
            Err(PackageError::manifest("/cyclic", problem))
        }
        None => Ok(OpenJoint::of(count(&stated), pairs, inner.count(), body.inner().count())),
    }
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
        let of_high = |row: u32, column: u32| self.is_high[row as usize] || self.is_high[column as usize];
        !stiffness.entries.iter().any(|&(row, column, value)| value != 0.0 && of_high(row, column))
    }

    /// The matrix without its block of the high face against itself.
    fn without_high_block(&self, stiffness: &RawMatrix) -> RawMatrix {
        let both = |row: u32, column: u32| self.is_high[row as usize] && self.is_high[column as usize];
        let entries = stiffness.entries.iter().filter(|&&(row, column, _)| !both(row, column));
        RawMatrix { size: stiffness.size, entries: entries.copied().collect() }
    }

    /// Whether each pair is in balance under `by_row`, the forces against the motions of the body.
    fn balanced(&self, by_row: &[OfMotions], reading: &Reading, stiffness: &RawMatrix) -> Vec<bool> {
        let scale = absolute_sums(stiffness);
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
