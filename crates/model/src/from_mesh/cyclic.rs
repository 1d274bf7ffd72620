//! Cyclic faces, found: faces of the skin that a turn by 2π/N carries onto others that look the opposite way.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::f64::consts::TAU;

use nalgebra::Vector3;
use rubmap_mesh::MeshFile;
use rubmap_solid::frame::{AxisFrame, distance};
use rubmap_solid::mesh::SectorMesh;
use rubmap_solid::place::tolerance;

use super::anywhere::{self, revolved};
use super::body::grid;
use super::error::{FittingAxis, FromMeshError, NearMiss};
use super::opposite::Opposite;
use super::settings::MeshSettings;
use super::surface::Face;
use super::turned::{MOST_SECTORS, OPPOSITE, matched};
use crate::package::raw::Axis;

/// Largest difference of unit normals of faces that almost fit each other.
const ALMOST_OPPOSITE: f64 = 0.3;

/// Least circumferential part of the normal of a face that counts for the number of sectors.
const CIRCUMFERENTIAL: f64 = 0.1;

/// Least share in the area of the best candidate for another number of sectors to be considered.
const SHARE: f64 = 0.25;

/// Least circumferential part of the normal of a face that may lie on a cut.
const FACING: f64 = 0.01;

/// Largest distance of a turned face from the plane of the face that it meets, in parts of that face's size.
const FLAT: f64 = 0.05;

/// Factor by which faces that almost fit must be larger than those that do, for these to be taken for a chance.
const MUCH: f64 = 2.0;

/// Factor on the tolerance within which faces that miss each other are reported.
const NEAR: f64 = 300.0;

/// Least score of another axis, in parts of the best one's, for both to be as good.
const AS_GOOD: f64 = 0.9;

/// Symmetry of a sector: axis, number of sectors, and pairs of nodes.
#[derive(Debug, Clone)]
pub(super) struct Symmetry {
    pub(super) axis: Axis,
    pub(super) sectors: usize,
    /// Pairs (low node, high node) of all nodes of the faces.
    pub(super) pairs: Vec<(u32, u32)>,
    /// Places of the low and high faces in the surface.
    pub(super) faces: HashSet<usize>,
    /// Largest distance of a turned low node from its high node.
    pub(super) farthest: f64,
    /// Whether the axis was found away from x, y and z through the origin.
    pub(super) axis_found: bool,
}

/// Finds the symmetry, as far as neither settings nor file state it.
pub(super) fn symmetry(
    file: &MeshFile,
    settings: &MeshSettings,
    mesh: &SectorMesh,
    surface: &[Face],
) -> Result<Symmetry, FromMeshError> {
    let stated = settings.sectors.or(file.symmetry.as_ref().map(|symmetry| symmetry.sectors));
    if stated == Some(0) {
        return Err(FromMeshError::Sectors);
    }
    let axes = candidates(file, settings);
    if stated == Some(1) {
        let axis = axes.into_iter().next().ok_or(FromMeshError::AxisWithoutDirection)?;
        frame(&axis)?;
        return Ok(Symmetry {
            axis,
            sectors: 1,
            pairs: Vec::new(),
            faces: HashSet::new(),
            farthest: 0.0,
            axis_found: false,
        });
    }
    let search = Search { mesh, surface, sectors: stated, within: tolerance(mesh.nodes.iter().copied()) };
    let tried = search.tried(&axes)?;
    // About another axis some faces may fit by chance.
    let known = match (tried.best, tried.unfit) {
        (Some(best), unfit) if unfit.as_ref().is_none_or(|unfit| best.fit >= unfit.fit) => Ok(best),
        (_, Some(unfit)) => Err((unfit.score, unfit.error)),
        (_, None) => Err(search.near_miss(&axes)?),
    };
    if axes.len() == 1 {
        return known.map(|found| found.symmetry).map_err(|(_, error)| error);
    }
    if let Ok(found) = &known
        && found.symmetry.sectors == 2
    {
        search.only_half_turn(&found.symmetry.axis, &axes)?;
    }
    match known {
        // Half a turn carries many a flat face onto itself.
        Ok(found) if stated.is_some() || found.symmetry.sectors > 2 => Ok(found.symmetry),
        Ok(found) => match search.elsewhere(found.score) {
            Ok(Some(other)) if other.sectors > 2 => Ok(other),
            _ => Ok(found.symmetry),
        },
        Err((_, error)) if stated == Some(2) => Err(error),
        Err((score, error)) => search.elsewhere(score)?.ok_or(error),
    }
}

/// Search for the cyclic faces of a mesh about axes.
struct Search<'a> {
    mesh: &'a SectorMesh,
    surface: &'a [Face],
    /// Number of sectors, if it is stated.
    sectors: Option<usize>,
    within: f64,
}

/// Symmetry by which faces fit, with the quality of the fit and its score: the area of the low faces and of those on surfaces of revolution.
struct Fitting {
    fit: Fit,
    score: f64,
    symmetry: Symmetry,
}

/// Fit that single nodes or faces spoil, with its refusal.
struct Unfit {
    fit: Fit,
    score: f64,
    sectors: usize,
    error: FromMeshError,
}

impl Fitting {
    /// Axis of the fit, for a refusal.
    fn axis(&self) -> FittingAxis {
        let Symmetry { axis, sectors, .. } = &self.symmetry;
        FittingAxis { origin: axis.origin, direction: axis.direction, sectors: *sectors }
    }
}

impl Unfit {
    /// Refusal with the axis that was found.
    fn about(self, axis: Axis) -> FromMeshError {
        let Axis { origin, direction } = axis;
        let Self { sectors, error, .. } = self;
        FromMeshError::With { error: Box::new(error), sectors, origin, direction, found: true }
    }
}

/// Best fit, and the best of the spoilt ones.
#[derive(Default)]
struct Tried {
    best: Option<Fitting>,
    unfit: Option<Unfit>,
}

impl Search<'_> {
    /// Refuses half a turn about an axis that nobody states where another turn fits, too: half a turn about a line in a flat face lays
    /// the face onto itself.
    fn only_half_turn(&self, about: &Axis, axes: &[Axis]) -> Result<(), FromMeshError> {
        let others: Vec<Axis> = axes.iter().filter(|axis| *axis != about).cloned().collect();
        let of_any_number = Search { sectors: None, ..*self };
        for search in [self, &of_any_number] {
            if let Some(other) = search.tried(&others)?.best {
                let sectors = other.symmetry.sectors;
                return Err(FromMeshError::HalfTurn {
                    about: about.direction,
                    other: other.symmetry.axis.direction,
                    sectors,
                });
            }
        }
        Ok(())
    }

    /// Best fits about these axes.
    fn tried(&self, axes: &[Axis]) -> Result<Tried, FromMeshError> {
        let mut tried = Tried::default();
        for axis in axes {
            match self.about(axis, axes.len())? {
                Some(Ok(found)) if tried.best.as_ref().is_none_or(|best| found.fit > best.fit) => {
                    tried.best = Some(found);
                }
                Some(Err(found)) if tried.unfit.as_ref().is_none_or(|unfit| found.fit > unfit.fit) => {
                    tried.unfit = Some(found);
                }
                _ => {}
            }
        }
        Ok(tried)
    }

    /// Fit about one of a number of axes, or the refusal of one that almost fits.
    fn about(&self, axis: &Axis, axes: usize) -> Result<Option<Result<Fitting, Unfit>>, FromMeshError> {
        let Self { mesh, surface, sectors: stated, within } = *self;
        let about = frame(axis)?;
        let Some(sectors) = stated.or_else(|| number(surface, &about, within, OPPOSITE)) else {
            return Ok(None);
        };
        let (fits, area) = matched(surface, &about, sectors, within, OPPOSITE);
        if fits.is_empty() {
            return Ok(None);
        }
        let fit = Fit { more_than_two: sectors > 2, area };
        let score = area + revolved(surface.iter(), axis);
        // Much larger faces that miss each other by little are meant, and these fit by chance.
        let missed = almost(surface, &about, stated, within)
            .filter(|(near, of_near)| stated.is_none() && *of_near > MUCH * area && near.farthest > within);
        let pairs = match missed {
            Some((near, _)) => Err(no_faces(stated, Some(near), within, axes)),
            None => facing(mesh, surface, &fits, &about, sectors, within)
                .and_then(|()| paired(mesh, surface, &fits, &about, sectors, within)),
        };
        Ok(Some(match pairs {
            Ok((pairs, farthest)) => {
                let faces = fits.iter().flat_map(|&(low, high)| [low, high]).collect();
                let axis = axis.clone();
                let symmetry = Symmetry { axis, sectors, pairs, faces, farthest, axis_found: false };
                Ok(Fitting { fit, score, symmetry })
            }
            Err(error) => Err(Unfit { fit, score, sectors, error }),
        }))
    }

    /// Symmetry about an axis that nothing states, with a better score than `least`; the refusal of an axis that almost fits better.
    fn elsewhere(&self, least: f64) -> Result<Option<Symmetry>, FromMeshError> {
        let Self { mesh, surface, sectors, within } = *self;
        let mut refusal: Option<(f64, FromMeshError)> = None;
        for pass in anywhere::PASSES {
            let mut found: Vec<Fitting> = Vec::new();
            for axis in anywhere::axes(mesh, surface, sectors, within, pass) {
                match self.about(&axis, 1)? {
                    Some(Ok(fitting)) if fitting.score > least => found.push(fitting),
                    Some(Err(unfit)) if unfit.score > refusal.as_ref().map_or(least, |(score, _)| *score) => {
                        refusal = Some((unfit.score, unfit.about(axis)));
                    }
                    _ => {}
                }
            }
            let score = refusal.as_ref().map_or(least, |(score, _)| *score);
            found.retain(|fitting| fitting.score >= score);
            found.sort_by(|a, b| b.score.total_cmp(&a.score));
            if let Some(best) = found.first() {
                let line = &best.symmetry.axis;
                let apart = |other: &&Fitting| !anywhere::same(mesh, line, &other.symmetry.axis, within);
                let as_good = |other: &&Fitting| other.score > AS_GOOD * best.score;
                if let Some(other) = found.iter().find(|other| as_good(other) && apart(other)) {
                    return Err(FromMeshError::AxesAlike { axes: [best, other].map(Fitting::axis) });
                }
                return Ok(found
                    .into_iter()
                    .next()
                    .map(|best| Symmetry { axis_found: true, ..best.symmetry }));
            }
        }
        refusal.map_or(Ok(None), |(_, error)| Err(error))
    }

    /// Refusal of a mesh whose faces do not fit: how near they come, with the score of the nearest.
    fn near_miss(&self, axes: &[Axis]) -> Result<(f64, FromMeshError), FromMeshError> {
        let Self { surface, sectors, within, .. } = *self;
        let mut best: Option<(f64, NearMiss)> = None;
        for axis in axes {
            let found = almost(surface, &frame(axis)?, sectors, within);
            if let Some((near, area)) =
                found.filter(|(near, _)| near.faces > best.as_ref().map_or(0, |(_, best)| best.faces))
            {
                best = Some((area + revolved(surface.iter(), axis), near));
            }
        }
        let (score, near) = best.map_or((0.0, None), |(score, near)| (score, Some(near)));
        Ok((score, no_faces(sectors, near, within, axes.len())))
    }
}

/// Quality of a fit: a half turn carries many a symmetric face onto itself, so that any other number of sectors is better, then the area.
#[derive(PartialEq, PartialOrd)]
struct Fit {
    more_than_two: bool,
    area: f64,
}

/// Faces that almost fit about an axis, and the area of the low ones; by the number of sectors that they vote for where none is stated.
fn almost(
    surface: &[Face],
    axis: &AxisFrame,
    sectors: Option<usize>,
    within: f64,
) -> Option<(NearMiss, f64)> {
    let within = NEAR * within;
    let sectors = sectors.or_else(|| number(surface, axis, within, ALMOST_OPPOSITE))?;
    let (fits, area) = matched(surface, axis, sectors, within, ALMOST_OPPOSITE);
    let turned = |face: &Face| axis.turn_point(face.centre.into(), TAU / sectors as f64);
    let away = fits.iter().map(|&(low, high)| distance(turned(&surface[low]), surface[high].centre.into()));
    Some((NearMiss { sectors, faces: fits.len(), farthest: away.fold(0.0, f64::max) }, area))
}

fn no_faces(sectors: Option<usize>, near: Option<NearMiss>, tolerance: f64, axes: usize) -> FromMeshError {
    FromMeshError::NoFaces { sectors, near, tolerance, axes }
}

/// Axes to be tried: the given or stated one, else x, y and z through the origin, z first.
fn candidates(file: &MeshFile, settings: &MeshSettings) -> Vec<Axis> {
    let stated = file.symmetry.as_ref().map(|stated| {
        let [from, to] = stated.axis;
        Axis { origin: from, direction: std::array::from_fn(|k| to[k] - from[k]) }
    });
    match settings.axis.clone().or(stated) {
        Some(axis) => vec![axis],
        None => [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
            .map(|direction| Axis { origin: [0.0; 3], direction })
            .into(),
    }
}

pub(super) fn frame(axis: &Axis) -> Result<AxisFrame, FromMeshError> {
    AxisFrame::new(axis.origin, axis.direction).ok_or(FromMeshError::AxisWithoutDirection)
}

/// Number of sectors that faces turned about an axis vote for by their areas: the smallest one with a good share, since flanks of a blade
/// may fit each other by a smaller turn.
fn number(surface: &[Face], axis: &AxisFrame, within: f64, opposite: f64) -> Option<usize> {
    let places: Vec<([f64; 3], Vector3<f64>, f64)> = (surface.iter())
        .map(|face| (axis.coordinates(face.centre.into()), face.cylindrical_normal(axis), face.area))
        .filter(|(_, normal, _)| normal[1].abs() > CIRCUMFERENTIAL)
        .collect();
    let cell = |[r, _, z]: [f64; 3]| [r, z].map(|x| (x / (2.0 * within)).floor() as i64);
    let mut cells: HashMap<[i64; 2], Vec<usize>> = HashMap::new();
    for (k, (at, ..)) in places.iter().enumerate() {
        cells.entry(cell(*at)).or_default().push(k);
    }
    let mut votes: BTreeMap<usize, f64> = BTreeMap::new();
    for (k, (low, normal, area)) in places.iter().enumerate() {
        let [i, j] = cell(*low);
        let around = (-1..=1).flat_map(|a| (-1..=1).map(move |b| [i + a, j + b]));
        let ring = around.filter_map(|cell| cells.get(&cell)).flatten().filter(|&&other| other > k);
        let near = |high: &[f64; 3]| (high[0] - low[0]).abs() <= within && (high[2] - low[2]).abs() <= within;
        for (high, other, _) in ring.map(|&other| &places[other]).filter(|(high, ..)| near(high)) {
            if (normal + other).norm() > opposite {
                continue;
            }
            for turn in [high[1] - low[1], low[1] - high[1]] {
                let angle = turn.rem_euclid(TAU);
                let sectors = (TAU / angle).round();
                let fits = (2.0..=MOST_SECTORS).contains(&sectors)
                    && (angle - TAU / sectors).abs() * low[0] <= within;
                if fits {
                    *votes.entry(sectors as usize).or_default() += area;
                }
            }
        }
    }
    let most = votes.values().copied().fold(0.0, f64::max);
    votes.into_iter().find(|(_, area)| *area >= SHARE * most).map(|(sectors, _)| sectors)
}

/// Refuses a face that the turn lays onto another that looks the opposite way, but whose nodes are elsewhere: the wheel goes on there, and its
/// faces are not meshed alike.
fn facing(
    mesh: &SectorMesh,
    surface: &[Face],
    fits: &[(usize, usize)],
    axis: &AxisFrame,
    sectors: usize,
    within: f64,
) -> Result<(), FromMeshError> {
    let taken: HashSet<usize> = fits.iter().flat_map(|&(low, high)| [low, high]).collect();
    let left: Vec<&Face> =
        surface.iter().zip(0..).filter(|(_, k)| !taken.contains(k)).map(|(face, _)| face).collect();
    let angle = TAU / sectors as f64;
    let turned = axis.turned_global(angle);
    let opposite = Opposite::new(mesh, left.clone());
    for low in left.iter().filter(|face| face.cylindrical_normal(axis)[1] < -FACING) {
        let at = Vector3::from(axis.turn_point(low.centre.into(), angle));
        let Some(high) = opposite.at(at, turned.tr_mul(&low.normal), FLAT) else { continue };
        let to = |node: u32| axis.turn_point(mesh.nodes[node as usize], angle);
        let partners = grid(mesh, high.skin.nodes.iter().copied(), within);
        let off = low.skin.nodes.iter().map(|&node| (node, partners.nearest_of_all(to(node))));
        let Some((node, nearest)) = off.max_by(|a, b| a.1.distance.total_cmp(&b.1.distance)) else {
            continue;
        };
        return Err(FromMeshError::NoPartner {
            node: mesh.node_ids[node as usize],
            sectors,
            nearest: mesh.node_ids[nearest.node as usize],
            distance: nearest.distance,
            tolerance: within,
        });
    }
    Ok(())
}

/// Pairs of nodes on the faces, and the largest distance of a turned low node from its partner.
fn paired(
    mesh: &SectorMesh,
    surface: &[Face],
    fits: &[(usize, usize)],
    axis: &AxisFrame,
    sectors: usize,
    within: f64,
) -> Result<(Vec<(u32, u32)>, f64), FromMeshError> {
    let nodes = |side: fn(&(usize, usize)) -> usize| {
        let mut nodes: Vec<u32> =
            fits.iter().flat_map(|pair| surface[side(pair)].skin.nodes.clone()).collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    };
    let (low, high) = (nodes(|pair| pair.0), nodes(|pair| pair.1));
    let places = grid(mesh, high.iter().copied(), within);
    let mut pairs = Vec::with_capacity(low.len());
    let mut taken = HashSet::new();
    let mut farthest: f64 = 0.0;
    for &node in &low {
        let to = axis.turn_point(mesh.nodes[node as usize], TAU / sectors as f64);
        let partner = places.at(to).map_err(|near| FromMeshError::NoPartner {
            node: mesh.node_ids[node as usize],
            sectors,
            nearest: mesh.node_ids[near.node as usize],
            distance: near.distance,
            tolerance: within,
        })? as u32;
        // A node on the axis is its own copy.
        if partner == node {
            continue;
        }
        if !taken.insert(partner) {
            return Err(FromMeshError::SharedPartner { node: mesh.node_ids[partner as usize], sectors });
        }
        farthest = farthest.max(distance(mesh.nodes[partner as usize], to));
        pairs.push((node, partner));
    }
    // Only nodes on the axis are on both faces.
    let on_both = |node: &&u32| taken.contains(node);
    let left_over = |node: &&u32| !taken.contains(node) && low.binary_search(node).is_err();
    match low.iter().find(on_both).or_else(|| high.iter().find(left_over)) {
        Some(&node) => Err(FromMeshError::BothFaces { node: mesh.node_ids[node as usize] }),
        None => Ok((pairs, farthest)),
    }
}
