//! Stress at one speed of a sweep, and the margin that it leaves.

use serde::{Deserialize, Serialize};

use rubmap_solid::material::{FatigueStrength, GivenStrengths, Material};
use rubmap_solid::mesh::{ElementSet, SectorMesh};
use rubmap_wheel::dynamics::sector::Units;

/// Stress of the mesh's nodes over the last revolution, as the mean over the elements around a node; static stress of the centrifugal load included.
/// Nodes near the contact line, where forces act on points, are left out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct PointStress {
    /// The largest von Mises stress of all places, blades and instants.
    pub largest: StressPeak,
    /// The largest von Mises stress over yield strength of all places whose material has one; absent where none has.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub largest_over_yield: Option<f64>,
    /// Largest von Mises stress of the centrifugal load alone.
    pub largest_static: f64,
    /// Stress cycles of the most utilised places by descending utilisation; without strengths, of those with the largest alternating stress.
    #[cfg_attr(feature = "schema", schema(max_items = 20))]
    pub cycles: Vec<StressCycle>,
    /// Places with the largest von Mises stress among those that were followed, by descending stress; the errors of two settings are compared there.
    /// Empty in results that an earlier version stored.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[cfg_attr(feature = "schema", schema(max_items = 20))]
    pub leading: Vec<LeadingPlace>,
    /// Radius about the contact nodes within which nodes are left out, in the model's unit of length.
    pub excluded_radius: f64,
    /// Number of nodes of a sector that are left out.
    pub excluded_nodes: u32,
    /// Number of places of a sector that were followed over all blades and instants; a bound rules the others out.
    pub followed_nodes: u32,
    /// Strengths that `utilisation` lacks, in words; absent where none is missing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lacking: Option<String>,
}

/// The largest stress, with its place and time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct StressPeak {
    /// Von Mises stress, in the model's units.
    pub von_mises: f64,
    /// Id of the node.
    pub node: u64,
    /// Position of the node in the first sector, x, y, z as in the package.
    pub position: [f64; 3],
    /// Blade with the largest stress.
    pub sector: u32,
    /// Time of the largest stress, revolutions since the start.
    pub revolution: f64,
}

/// A place with its largest stress of all blades and instants.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct LeadingPlace {
    /// Id of the node.
    pub node: u64,
    /// Name of the node's element set.
    pub set: String,
    /// Largest von Mises stress of the place, in the model's units.
    pub von_mises: f64,
}

/// Stress cycle of one place over a revolution.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct StressCycle {
    /// Id of the node.
    pub node: u64,
    /// Position of the node in the first sector, x, y, z as in the package.
    pub position: [f64; 3],
    /// Blade on which the place is.
    pub sector: u32,
    /// Name of the element set whose strengths count.
    pub set: String,
    /// Mean stress: (max + min)/2 of the von Mises stress with the sign of the mean normal stress.
    pub mean: f64,
    /// Alternating stress: (max − min)/2 of the von Mises stress with the sign of the mean normal stress.
    pub alternating: f64,
    /// Mean principal stress: (max + min)/2 of the principal stress that is largest in magnitude.
    pub principal_mean: f64,
    /// Alternating principal stress: (max − min)/2 of the principal stress that is largest in magnitude.
    pub principal_alternating: f64,
    /// Utilisation by Goodman: `alternating`/fatigue strength + `mean`/ultimate strength, a mean below 0 counted as 0; at 1 nothing is left. Absent
    /// without these strengths.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub utilisation: Option<f64>,
    /// Largest von Mises stress over yield strength; absent without yield strength.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub over_yield: Option<f64>,
}

impl PointStress {
    /// Largest difference from a `finer` setting, of the largest stress and of the stress at every place that leads in both: the difference of a
    /// single number vanishes by chance where another place or instant takes over.
    pub(crate) fn difference(&self, finer: &Self) -> f64 {
        let there = |here: &LeadingPlace| {
            let same = |there: &&LeadingPlace| there.node == here.node && there.set == here.set;
            finer.leading.iter().find(same).map(|there| (here.von_mises - there.von_mises).abs())
        };
        let of_largest = (self.largest.von_mises - finer.largest.von_mises).abs();
        self.leading.iter().filter_map(there).fold(of_largest, f64::max)
    }

    /// Largest utilisation of all cycles; none without strengths.
    pub fn utilisation(&self) -> Option<f64> {
        self.cycles.iter().filter_map(|cycle| cycle.utilisation).max_by(f64::total_cmp)
    }
}

/// Sorts by descending utilisation, items whose utilisation is unknown last; equal ones stay in their order.
pub fn most_utilised_first<T>(all: &mut [T], utilisation: impl Fn(&T) -> Option<f64>) {
    let rank = |of: &T| utilisation(of).unwrap_or(f64::NEG_INFINITY);
    all.sort_by(|a, b| rank(b).total_cmp(&rank(a)));
}

/// Strengths of the material of an element set, as far as the model gives them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Strengths {
    /// Name of the element set.
    pub set: String,
    /// Fatigue strength: the amplitude of a fully reversed stress.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fatigue: Option<f64>,
    /// Ultimate strength.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ultimate: Option<f64>,
    /// Yield strength.
    #[serde(default, rename = "yield", skip_serializing_if = "Option::is_none")]
    pub yield_: Option<f64>,
    /// Source of the fatigue strength.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub source: Option<String>,
}

impl Strengths {
    /// Reads the strengths of all element sets of a mesh.
    pub fn of(mesh: &SectorMesh) -> Vec<Self> {
        let of_set = |set: &ElementSet| {
            let Material { yield_strength, ultimate_strength, fatigue_strength, .. } = &set.material;
            Self::named(&set.name, *yield_strength, *ultimate_strength, fatigue_strength.as_ref())
        };
        mesh.sets.iter().map(of_set).collect()
    }

    /// Strengths of the same set as they are `given`.
    pub(crate) fn given(&self, given: &GivenStrengths) -> Self {
        let GivenStrengths { yield_strength, ultimate_strength, fatigue_strength } = given;
        Self::named(&self.set, *yield_strength, *ultimate_strength, fatigue_strength.as_ref())
    }

    fn named(
        set: &str,
        yield_: Option<f64>,
        ultimate: Option<f64>,
        fatigue: Option<&FatigueStrength>,
    ) -> Self {
        Self {
            set: set.to_owned(),
            fatigue: fatigue.map(|fatigue| fatigue.amplitude),
            ultimate,
            yield_,
            source: fatigue.map(|fatigue| fatigue.source.clone()),
        }
    }
}

/// Unit of stress, force over length².
pub fn stress_unit(units: &Units) -> String {
    match (units.force.as_str(), units.length.as_str()) {
        ("N", "mm") => "MPa".to_owned(),
        ("N", "m") => "Pa".to_owned(),
        (force, length) => format!("{force}/{length}²"),
    }
}

/// Unit in which stress is drawn, and how many of it the model's unit is: megapascals instead of pascals, of which a wheel bears hundreds of
/// millions.
pub fn drawn_stress_unit(units: &Units) -> (String, f64) {
    match stress_unit(units).as_str() {
        "Pa" => ("MPa".to_owned(), 1e-6),
        unit => (unit.to_owned(), 1.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranks_keep_the_order_of_what_is_alike() {
        let mut speeds = [(1, None), (2, Some(0.5)), (3, Some(1.5)), (4, None), (5, Some(0.5))];
        most_utilised_first(&mut speeds, |(_, used)| *used);
        assert_eq!(speeds.map(|(speed, _)| speed), [3, 2, 5, 1, 4]);
    }

    #[test]
    fn strengths_are_those_of_the_sets() {
        let fatigue = FatigueStrength { amplitude: 110.0, source: "a table".to_owned() };
        let known = Material {
            youngs_modulus: 70e3,
            poissons_ratio: 0.3,
            density: 2.7e-9,
            yield_strength: Some(320.0),
            ultimate_strength: Some(360.0),
            fatigue_strength: Some(fatigue),
        };
        let unknown = Material {
            yield_strength: None,
            ultimate_strength: None,
            fatigue_strength: None,
            ..known.clone()
        };
        let set = |name: &str, material| ElementSet { name: name.to_owned(), material };
        let mesh = SectorMesh {
            sectors: 9,
            node_ids: Vec::new(),
            nodes: Vec::new(),
            axis: ([0.0; 3], [0.0, 0.0, 1.0]),
            cyclic: Vec::new(),
            elements: Vec::new(),
            sets: vec![set("BLADE", known), set("DISK", unknown)],
        };
        let found = serde_json::to_value(Strengths::of(&mesh)).unwrap();
        let expected = serde_json::json!([
            {"set": "BLADE", "fatigue": 110.0, "ultimate": 360.0, "yield": 320.0, "source": "a table"},
            {"set": "DISK"},
        ]);
        assert_eq!(found, expected);
    }

    #[test]
    fn pascals_are_drawn_as_megapascals() {
        let units = |force: &str, length: &str| Units {
            force: force.to_owned(),
            length: length.to_owned(),
            time: "s".to_owned(),
            mass: "t".to_owned(),
        };
        assert_eq!(drawn_stress_unit(&units("N", "m")), ("MPa".to_owned(), 1e-6));
        assert_eq!(drawn_stress_unit(&units("N", "mm")), ("MPa".to_owned(), 1.0));
        assert_eq!(drawn_stress_unit(&units("lbf", "in")), ("lbf/in²".to_owned(), 1.0));
    }
}
