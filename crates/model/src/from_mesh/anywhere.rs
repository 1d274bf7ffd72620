//! Search for an axis that nobody states.
//!
//! A turn that carries a face of the skin onto a congruent one that looks the opposite way says where its axis is. All such turns by 2π/N
//! vote; the axes with most votes, and with most of the skin on surfaces of revolution about them, are fitted to the nodes of their faces.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use nalgebra::{Matrix3, Matrix4, Vector3, Vector4};
use rubmap_solid::frame::{AxisFrame, distance};
use rubmap_solid::mesh::SectorMesh;

use super::surface::Face;
use super::turned::{MOST_SECTORS, OPPOSITE, matched};
use crate::package::raw::Axis;

/// Passes of the search, one after the other: distance of a turned node from its partner in parts of the tolerance, and width of the cells in
/// which axes count as one, for directions as unit vectors and places in sizes of the mesh. Meshes with many digits need the first alone.
pub(super) const PASSES: [(f64, f64); 3] = [(1e-3, 1e-3), (1e-1, 1e-2), (1.0, 5e-2)];

/// Largest number of faces whose turns vote, which bounds the time of the search.
const VOTERS: usize = 512;

/// Largest number of congruent faces onto which one face is turned, which bounds the time on regular meshes.
const MOST_PARTNERS: usize = 512;

/// Number of congruent faces above which a face is as common as any.
const COMMON: usize = 32;

/// Largest number of faces of about one perimeter that are compared with each face, to learn how rare it is.
const MOST_COMPARED: usize = 512;

/// Largest number of faces of about one perimeter that are compared with a face that votes.
const MOST_COMPARED_VOTER: usize = 4096;

/// Factor on the tolerance of nodes for lengths and angles that follow from them.
const SLACK: f64 = 8.0;

/// Number of axes whose share of surfaces of revolution is looked at.
const MOST_RANKED: usize = 256;

/// Number of axes that are fitted.
const MOST_FITTED: usize = 12;

/// Largest circumferential part of the normal of a face on a surface of revolution: facets lie askew.
const REVOLVED: f64 = 0.1;

/// Number of faces by which axes are ranked.
const SAMPLED: usize = 1000;

/// Factor on the tolerance within which faces are matched at first.
const NEARLY: f64 = 10.0;

/// Decimal places to which an axis is rounded, in sizes of the mesh: two less than a double has, which round-off of the fit changes.
const DIGITS: i32 = 13;

/// Gauss–Newton steps of a fit: errors of 5 % are squared each time, and reach round-off with the fourth.
const STEPS: usize = 4;

/// Turn of a face onto a congruent one, corner by corner.
#[derive(Debug, Clone, Copy)]
struct Turn {
    /// Faces: from the first to the second about the axis's direction.
    faces: [usize; 2],
    /// Corner of the other face on which the first corner of the voter lies.
    offset: usize,
    /// Whether the voter is the second face.
    backwards: bool,
}

/// Axis that some turns have in common.
#[derive(Debug)]
struct Votes {
    line: Line,
    /// Size of the face that gave the line.
    reach: f64,
    area: f64,
    turns: Vec<Turn>,
}

/// Axis as a point and a unit vector.
#[derive(Debug, Clone, Copy)]
struct Line {
    origin: Vector3<f64>,
    direction: Vector3<f64>,
}

impl Line {
    /// Line in the sense in which the largest component of its direction is positive, and whether that reversed it.
    fn with_sense(self) -> (Self, bool) {
        let largest = self.direction.amax();
        // Of components that are alike the first counts, whatever the last digits are.
        let sign = self.direction.iter().find(|x| x.abs() > (1.0 - 1e-9) * largest);
        let reversed = sign.is_some_and(|x| *x < 0.0);
        (if reversed { Self { direction: -self.direction, ..self } } else { self }, reversed)
    }

    /// Axis with the point that is nearest to the origin of coordinates, rounded to the last digits that a mesh of some size has.
    fn axis(self, size: f64) -> Axis {
        let Self { origin, direction } = self.with_sense().0;
        let round = |v: Vector3<f64>, size: f64| -> [f64; 3] {
            let grains = 10_f64.powi(DIGITS - size.log10().ceil() as i32);
            // Added to nothing, a negative zero is a positive one.
            v.map(|x| (x * grains).round() / grains + 0.0).into()
        };
        let foot = origin - direction * direction.dot(&origin);
        Axis { origin: round(foot, size), direction: round(direction, 1.0) }
    }
}

/// Axes about which turns by 2π/N carry faces onto congruent ones within a distance, the likeliest first; of `sectors` if they are known.
pub(super) fn axes(
    mesh: &SectorMesh,
    surface: &[Face],
    sectors: Option<usize>,
    within: f64,
    (part, cell): (f64, f64),
) -> Vec<Axis> {
    let shapes = Shapes::new(mesh, surface);
    let near = part * within;
    let centre = surface.iter().map(|face| face.centre).sum::<Vector3<f64>>() / surface.len().max(1) as f64;
    let size = surface.iter().map(|face| (face.centre - centre).norm()).fold(f64::MIN_POSITIVE, f64::max);
    let mut votes: BTreeMap<(usize, [i64; 6]), Votes> = BTreeMap::new();
    for voter in shapes.voters(near) {
        for (other, offset) in shapes.partners(voter, near, MOST_PARTNERS, MOST_COMPARED_VOTER) {
            let Some((line, number)) = shapes.turn(voter, other, offset, near, sectors) else { continue };
            let (line, backwards) = line.with_sense();
            let foot = line.origin - line.direction * line.direction.dot(&(line.origin - centre));
            let place = (foot - centre) / size;
            let at = |k: usize| if k < 3 { line.direction[k] } else { place[k - 3] };
            let key = (number, std::array::from_fn(|k| (at(k) / cell).round() as i64));
            let faces = if backwards { [other, voter] } else { [voter, other] };
            let turn = Turn { faces, offset, backwards };
            let reach = shapes.reach(voter);
            let votes = votes.entry(key).or_insert(Votes { line, reach: 0.0, area: 0.0, turns: Vec::new() });
            if reach > votes.reach {
                (votes.line, votes.reach) = (line, reach);
            }
            votes.area += surface[voter].area;
            votes.turns.push(turn);
        }
    }
    let mut ranked: Vec<(usize, Votes)> =
        votes.into_iter().map(|((number, _), votes)| (number, votes)).collect();
    ranked.sort_by(|a, b| b.1.area.total_cmp(&a.1.area));
    ranked.truncate(MOST_RANKED);
    let stride = surface.len().div_ceil(SAMPLED).max(1);
    let score = |votes: &Votes| votes.area * revolved(surface.iter().step_by(stride), &votes.line.axis(size));
    let mut scored: Vec<(f64, usize, Votes)> =
        ranked.into_iter().map(|(number, votes)| (score(&votes), number, votes)).collect();
    scored.sort_by(|a, b| b.0.total_cmp(&a.0));
    scored.truncate(MOST_FITTED);
    scored.into_iter().filter_map(|(_, number, votes)| shapes.fitted(&votes, number, within, size)).collect()
}

/// Area of faces that lie on surfaces of revolution about an axis.
pub(super) fn revolved<'a>(faces: impl Iterator<Item = &'a Face>, axis: &Axis) -> f64 {
    let Some(axis) = AxisFrame::new(axis.origin, axis.direction) else { return 0.0 };
    let on = |face: &&Face| face.cylindrical_normal(&axis)[1].abs() <= REVOLVED;
    faces.filter(on).map(|face| face.area).sum()
}

/// Whether two axes are one line, as the nodes of a mesh see it: each is where the other has it, within a distance.
pub(super) fn same(mesh: &SectorMesh, a: &Axis, b: &Axis, within: f64) -> bool {
    let [one, other] = [a, b].map(|axis| AxisFrame::new(axis.origin, axis.direction));
    let (Some(one), Some(other)) = (one, other) else { return false };
    // Half a turn about one and back about the other moves a node by twice its distance from where both axes are one.
    let turned = |axis: &AxisFrame, at| axis.turn_point(at, 0.5 * TAU);
    mesh.nodes.iter().all(|&at| distance(turned(&one, at), turned(&other, at)) <= SLACK * within)
}

/// Faces by their perimeters, with the lengths of their edges.
struct Shapes<'a> {
    mesh: &'a SectorMesh,
    surface: &'a [Face],
    lengths: Vec<Vec<f64>>,
    /// Perimeters and faces in ascending order.
    by_perimeter: Vec<(f64, usize)>,
}

impl<'a> Shapes<'a> {
    fn new(mesh: &'a SectorMesh, surface: &'a [Face]) -> Self {
        let length = |[a, b]: [u32; 2]| distance(mesh.nodes[a as usize], mesh.nodes[b as usize]);
        let lengths: Vec<Vec<f64>> = surface.iter().map(|face| face.edges().map(length).collect()).collect();
        let mut by_perimeter: Vec<(f64, usize)> =
            lengths.iter().map(|lengths| lengths.iter().sum()).zip(0..).collect();
        by_perimeter.sort_by(|a, b| a.0.total_cmp(&b.0));
        Self { mesh, surface, lengths, by_perimeter }
    }

    fn corner(&self, face: usize, k: usize) -> Vector3<f64> {
        self.mesh.nodes[self.surface[face].corners()[k] as usize].into()
    }

    fn reach(&self, face: usize) -> f64 {
        (self.corner(face, 0) - self.surface[face].centre).norm()
    }

    /// Faces to which the fewest others are congruent, evenly chosen among those that are equally rare.
    fn voters(&self, near: f64) -> Vec<usize> {
        let partners = |face: usize| self.partners(face, near, COMMON, MOST_COMPARED).len();
        let mut rare: Vec<(usize, usize)> =
            (0..self.surface.len()).map(|face| (partners(face), face)).collect();
        rare.retain(|&(partners, _)| partners > 0);
        rare.sort_unstable();
        let mut chosen = Vec::new();
        for alike in rare.chunk_by(|a, b| a.0 == b.0) {
            let left = VOTERS.saturating_sub(chosen.len()).min(alike.len());
            chosen.extend((0..left).map(|k| alike[k * alike.len() / left].1));
        }
        chosen
    }

    /// Faces that are congruent to one when seen from inside, with the corner on which its first corner lies.
    fn partners(&self, face: usize, near: f64, most: usize, compared: usize) -> Vec<(usize, usize)> {
        let lengths = &self.lengths[face];
        let (count, perimeter) = (lengths.len(), lengths.iter().sum::<f64>());
        let from = self.by_perimeter.partition_point(|&(other, _)| other < perimeter - SLACK * near);
        let alike = self.by_perimeter[from..].iter().take(compared);
        let alike = alike.take_while(|&&(other, _)| other <= perimeter + SLACK * near);
        let fits = |other: usize, offset: usize| {
            let edge = |k: usize| self.lengths[other][(offset + count - k - 1) % count];
            lengths.iter().enumerate().all(|(k, length)| (length - edge(k)).abs() <= 2.0 * near)
        };
        let others = alike.map(|&(_, other)| other).filter(|&other| self.lengths[other].len() == count);
        let turns = others.filter(|&other| other != face);
        let turns = turns.flat_map(|other| (0..count).map(move |offset| (other, offset)));
        turns.filter(|&(other, offset)| fits(other, offset)).take(most).collect()
    }

    /// Axis of the turn by 2π/N that carries one face onto another, which looks the opposite way, and N; none if another motion does.
    fn turn(
        &self,
        face: usize,
        other: usize,
        offset: usize,
        near: f64,
        sectors: Option<usize>,
    ) -> Option<(Line, usize)> {
        let [from, to] = [face, other].map(|face| &self.surface[face]);
        let count = from.corners().len();
        let partner = |k: usize| self.corner(other, (offset + count - k) % count);
        let unit = |face: &Face, corner: Vector3<f64>, normal: Vector3<f64>| {
            let along = corner - face.centre;
            let x = (along - normal * normal.dot(&along)).try_normalize(0.0)?;
            Some(Matrix3::from_columns(&[x, normal.cross(&x), normal]))
        };
        let before = unit(from, self.corner(face, 0), from.normal)?;
        let rotation = unit(to, partner(0), -to.normal)? * before.transpose();
        let carried = |k: usize| rotation * (self.corner(face, k) - from.centre) + to.centre;
        if (0..count).any(|k| (carried(k) - partner(k)).norm() > SLACK * near) {
            return None;
        }
        let off = SLACK * near / self.reach(face);
        let (direction, angle) = axis_and_angle(&rotation)?;
        let number = sectors.map_or((TAU / angle).round(), |sectors| sectors as f64);
        if !(2.0..=MOST_SECTORS).contains(&number) || (angle - TAU / number).abs() > off + f64::EPSILON {
            return None;
        }
        let half = 0.5 * TAU / number;
        let way = to.centre - from.centre;
        if direction.dot(&way).abs() > SLACK * near + off / half.sin() * way.norm() {
            return None;
        }
        // A half turn leaves its axis in the middle.
        let aside = if number > 2.0 { direction.cross(&way) / (2.0 * half.tan()) } else { Vector3::zeros() };
        Some((Line { origin: (from.centre + to.centre) * 0.5 + aside, direction }, number as usize))
    }

    /// Axis of some turns, fitted to the corners of their faces, then to those of all faces that it carries onto others.
    fn fitted(&self, votes: &Votes, sectors: usize, within: f64, size: f64) -> Option<Axis> {
        let angle = TAU / sectors as f64;
        let corners = |turn: &Turn| {
            let [from, to] = turn.faces;
            let count = self.surface[from].corners().len();
            let (from, to, turn) = (from, to, *turn);
            (0..count).map(move |k| {
                let mirrored = (turn.offset + count - k) % count;
                let (a, b) = if turn.backwards { (mirrored, k) } else { (k, mirrored) };
                [self.corner(from, a), self.corner(to, b)]
            })
        };
        let places: Vec<[Vector3<f64>; 2]> = votes.turns.iter().flat_map(corners).collect();
        let mut line = least_squares(votes.line, angle, &places)?;
        for tolerance in [NEARLY * within, within] {
            line = line.with_sense().0;
            let about = AxisFrame::new(line.origin.into(), line.direction.into())?;
            let (fits, _) = matched(self.surface, &about, sectors, tolerance, OPPOSITE);
            let nearest = |(low, high): (usize, usize)| {
                let to = |k: usize| Vector3::from(about.turn_point(self.corner(low, k).into(), angle));
                let all = |face: usize| 0..self.surface[face].corners().len();
                let partner = |k: usize| {
                    let others = all(high).map(|other| self.corner(high, other));
                    others.min_by(|a, b| (a - to(k)).norm().total_cmp(&(b - to(k)).norm()))
                };
                let pairs = all(low).filter_map(|k| Some([self.corner(low, k), partner(k)?]));
                pairs.collect::<Vec<_>>()
            };
            let places: Vec<[Vector3<f64>; 2]> = fits.into_iter().flat_map(nearest).collect();
            if !places.is_empty() {
                line = least_squares(line, angle, &places)?;
            }
        }
        Some(line.axis(size))
    }
}

/// Direction and angle, from 0 to π, of a rotation; none of the identity.
fn axis_and_angle(rotation: &Matrix3<f64>) -> Option<(Vector3<f64>, f64)> {
    let skew = Vector3::new(
        rotation[(2, 1)] - rotation[(1, 2)],
        rotation[(0, 2)] - rotation[(2, 0)],
        rotation[(1, 0)] - rotation[(0, 1)],
    ) * 0.5;
    let cosine = 0.5 * (rotation.trace() - 1.0);
    let angle = skew.norm().atan2(cosine);
    if cosine > 0.0 {
        return Some((skew.try_normalize(0.0)?, angle));
    }
    // Near half a turn the skew part vanishes, and the symmetric one is (1 − cos) a aᵀ beside cos.
    let dyad = (rotation + rotation.transpose()) * 0.5 - Matrix3::identity() * cosine;
    let column = dyad.column(dyad.diagonal().imax()).into_owned();
    let direction = column.try_normalize(0.0)?;
    Some((if direction.dot(&skew) < 0.0 { -direction } else { direction }, angle))
}

/// Axis about which a turn by an angle carries the first of each two places onto the second, in least squares (Gauss–Newton).
fn least_squares(line: Line, angle: f64, places: &[[Vector3<f64>; 2]]) -> Option<Line> {
    let (sin, cos) = angle.sin_cos();
    let mean = places.iter().map(|[from, _]| from).sum::<Vector3<f64>>() / places.len() as f64;
    let mut line = line;
    for _ in 0..STEPS {
        let a = line.direction;
        let o = line.origin + a * a.dot(&(mean - line.origin));
        let scale = places.iter().map(|[from, _]| (from - o).norm()).fold(f64::MIN_POSITIVE, f64::max);
        let e1 = a.cross(&Vector3::ith(a.iamin(), 1.0)).normalize();
        let across = [e1, a.cross(&e1)];
        let turned = |v: &Vector3<f64>| v * cos + a.cross(v) * sin + a * (a.dot(v) * (1.0 - cos));
        let mut normal = Matrix4::<f64>::zeros();
        let mut right = Vector4::<f64>::zeros();
        for [from, to] in places {
            let v = from - o;
            let off = to - o - turned(&v);
            let moved = across.map(|e| e - turned(&e));
            let tilted =
                across.map(|e| (e.cross(&v) * sin + (e * a.dot(&v) + a * e.dot(&v)) * (1.0 - cos)) / scale);
            let columns = [moved[0], moved[1], tilted[0], tilted[1]];
            for (i, column) in columns.iter().enumerate() {
                right[i] += column.dot(&off);
                for (j, other) in columns.iter().enumerate() {
                    normal[(i, j)] += column.dot(other);
                }
            }
        }
        let change = normal.lu().solve(&right)?;
        let tilt = (across[0] * change[2] + across[1] * change[3]) / scale;
        let direction = (a + tilt).try_normalize(0.0)?;
        line = Line { origin: o + across[0] * change[0] + across[1] * change[1], direction };
    }
    line.direction.iter().chain(&line.origin).all(|x| x.is_finite()).then_some(line)
}
