//! Tip along a shroud curve: faces of the skin that look at the curve and are nearest to it.

use nalgebra::Vector2;
use rubmap_solid::frame::AxisFrame;
use rubmap_solid::mesh::SectorMesh;

use super::cyclic::Symmetry;
use super::error::FromMeshError;
use super::midline::midline;
use super::patches::patches;
use super::surface::{Face, sides};
use super::way::Line;

/// Largest circumferential part of the normal of a face on a tip, round ones included: the flanks of a blade look more around the wheel than by 45°.
const AROUND: f64 = 0.7;

/// Least cosine of the angle between the normal of a face and the way to the curve: 60°.
const TOWARDS: f64 = 0.5;

/// Cosine of any angle between neighbours: coarse round tips have ridges.
const ANY: f64 = -2.0;

/// Least distance of another strip of faces for it to be another surface, in mean distances of the nearest.
const OTHER: f64 = 2.0;

/// Distance by which a strip may lie farther away than [`OTHER`] allows, in lengths of the longest strip: where the curve lies on the tip itself.
const AS_NEAR: f64 = 0.02;

/// Largest distance of a tip from the curve, in lengths of the tip.
const FARTHEST: f64 = 0.1;

/// Largest number of points of a curve.
const MOST_POINTS: usize = 2000;

/// Strip of faces that have one surface in common.
struct Strip {
    faces: Vec<usize>,
    length: f64,
    /// Mean distance from the curve, by area.
    away: f64,
}

/// Refuses a curve of too few or too many points, of points that are no places, or of one place.
pub(super) fn check(curve: &[[f64; 2]]) -> Result<(), FromMeshError> {
    let wrong = |problem: String| Err(FromMeshError::Shroud { problem });
    if !(2..=MOST_POINTS).contains(&curve.len()) {
        return wrong(format!("has {} points; 2 to {MOST_POINTS} are needed", curve.len()));
    }
    if let Some((k, [r, z])) =
        (1..).zip(curve).find(|(_, [r, z])| !(*r >= 0.0 && r.is_finite() && z.is_finite()))
    {
        return wrong(format!(
            "has r = {r}, z = {z} at point {k}; give r as a number of at least 0, z as any number"
        ));
    }
    if curve.iter().all(|point| point == &curve[0]) {
        return wrong("is a single point; give at least two places".to_owned());
    }
    Ok(())
}

/// Faces of the longest tip along a curve of points (r, z), and the number of other tips that lie as near.
pub(super) fn strip(
    mesh: &SectorMesh,
    surface: &[Face],
    symmetry: &Symmetry,
    axis: &AxisFrame,
    curve: &[[f64; 2]],
) -> Result<(Vec<usize>, usize), FromMeshError> {
    let way = |face: &Face| {
        let [r, _, z] = axis.coordinates(face.centre.into());
        nearest(curve, Vector2::new(r, z))
    };
    let looks = |k: &usize| {
        let normal = surface[*k].cylindrical_normal(axis);
        let meridional = Vector2::new(normal[0], normal[2]);
        let way = way(&surface[*k]);
        // For a curve on the tip itself the way is zero.
        normal[1].abs() <= AROUND && meridional.dot(&way) >= TOWARDS * way.norm() * meridional.norm()
    };
    let chosen: Vec<usize> =
        (0..surface.len()).filter(|k| !symmetry.faces.contains(k)).filter(looks).collect();
    let sides = sides(surface, chosen.iter().copied());
    let strip = |faces: Vec<usize>| {
        let area: f64 = faces.iter().map(|&k| surface[k].area).sum();
        let away: f64 = faces.iter().map(|&k| surface[k].area * way(&surface[k]).norm()).sum();
        Strip { length: midline(mesh, surface, &faces).length(), away: away / area, faces }
    };
    let mut strips: Vec<Strip> = patches(surface, &sides, chosen.into_iter(), ANY)
        .into_iter()
        .map(|faces| strip(faces.into_iter().collect()))
        .collect();
    let longest = strips.iter().map(|strip| strip.length).fold(0.0, f64::max);
    let near = strips.iter().map(|strip| strip.away).fold(f64::INFINITY, f64::min);
    strips.retain(|strip| strip.away <= OTHER * near + AS_NEAR * longest);
    strips.sort_by(|a, b| b.length.total_cmp(&a.length));
    let count = strips.len();
    let Some(tip) = strips.into_iter().next() else {
        let problem =
            "faces no part of the skin; give its points as [r, z] from the axis, in the units of the mesh";
        return Err(FromMeshError::Shroud { problem: problem.to_owned() });
    };
    if tip.away.is_nan() || tip.away > FARTHEST * tip.length {
        return Err(FromMeshError::ShroudFar { distance: tip.away, length: tip.length, part: FARTHEST });
    }
    Ok((tip.faces, count - 1))
}

/// Least and largest distance of the nodes of a line from a curve.
pub(super) fn distances(line: &Line, axis: &AxisFrame, curve: &[[f64; 2]]) -> [f64; 2] {
    let away = line.iter().map(|(_, at)| {
        let [r, _, z] = axis.coordinates(*at);
        nearest(curve, Vector2::new(r, z)).norm()
    });
    away.fold([f64::INFINITY, 0.0_f64], |[low, high], away| [low.min(away), high.max(away)])
}

/// Way from a place to the nearest point of a polyline, in the meridional plane.
fn nearest(curve: &[[f64; 2]], at: Vector2<f64>) -> Vector2<f64> {
    let pieces = curve.windows(2).map(|ends| {
        let [from, to] = [Vector2::from(ends[0]), Vector2::from(ends[1])];
        let along = to - from;
        let part = (at - from).dot(&along) / along.norm_squared().max(f64::MIN_POSITIVE);
        from + along * part.clamp(0.0, 1.0) - at
    });
    let least = pieces.min_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()));
    least.unwrap_or_else(|| Vector2::repeat(f64::INFINITY))
}
