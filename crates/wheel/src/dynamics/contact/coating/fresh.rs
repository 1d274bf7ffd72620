//! Coating as it is laid on, without wear.

use std::f64::consts::TAU;

use crate::dynamics::sector::ContactNode;

/// Material of a coating, stresses in the model's units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CoatingMaterial {
    /// Young's modulus E, force/length².
    pub modulus: f64,
    /// Yield stress σ_Y of the unworn coating, force/length².
    pub yield_stress: f64,
    /// Plastic modulus K = dσ/dε_p of linear hardening, force/length².
    pub hardening: f64,
}

/// Coating without wear.
#[derive(Debug, Clone, PartialEq)]
pub struct Coating {
    pub(super) material: CoatingMaterial,
    pub(super) thickness: f64,
    pub(super) rods_around: usize,
    /// Area A of the rods of every row.
    pub(super) areas: Vec<f64>,
}

/// Error: a coating that cannot be simulated.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum CoatingError {
    /// Modulus, thickness or hardening that is not a positive number, or a negative yield stress.
    #[error(
        "the coating needs a positive modulus, hardening and thickness and a yield stress of 0 or more, not E = {}, K = {}, \
         t0 = {thickness} and σ_Y = {}", .material.modulus, .material.hardening, .material.yield_stress
    )]
    NotPositive {
        /// Material as given.
        material: CoatingMaterial,
        /// Thickness as given.
        thickness: f64,
    },
    /// Hardening so small that stresses no longer determine strains.
    #[error("the coating's hardening {hardening} must be at least {least}, a millionth of its modulus")]
    HardensTooLittle {
        /// Hardening K as given.
        hardening: f64,
        /// Least hardening K.
        least: f64,
    },
    /// Number of rods so small that blades would share rods.
    #[error(
        "{rods_around} rods around are too few for {sectors} blades: at least {least}, four from blade to blade"
    )]
    TooFewRods {
        /// Number of rods around, as given.
        rods_around: usize,
        /// Number N of sectors.
        sectors: usize,
        /// Least number of rods, 4N.
        least: usize,
    },
    /// Row of rods without area: the node is the only one, lies on the axis, or has the same radius and axial coordinate as its neighbours.
    #[error(
        "contact node {node} sweeps no area of the casing, so no coating can be in front of it: give at least two contact nodes \
         off the axis that differ in radius or axial coordinate"
    )]
    NoArea {
        /// Index of the contact node, from the leading edge from 0.
        node: usize,
    },
}

/// Least number of rods from one blade to the next.
pub const RODS_PER_SECTOR: usize = 4;

/// Least K/E: below it round-off of a strain is stress enough to matter.
pub const LEAST_HARDENING: f64 = 1e-6;

impl Coating {
    /// Coating of `thickness` cut into `rods_around` rods in front of each of `contact_nodes` (leading to trailing edge) of a wheel of `sectors`.
    ///
    /// The area of a node's rods is 2πr/`rods_around` times half the way to its neighbours in the meridional plane: all rods
    /// together cover the surface that the contact nodes sweep.
    pub fn new(
        material: CoatingMaterial,
        thickness: f64,
        rods_around: usize,
        contact_nodes: &[ContactNode],
        sectors: usize,
    ) -> Result<Self, CoatingError> {
        let positive = |value: f64| value > 0.0 && value.is_finite();
        let CoatingMaterial { modulus, yield_stress, hardening } = material;
        let valid = [modulus, hardening, thickness].into_iter().all(positive);
        if !valid || !(yield_stress == 0.0 || positive(yield_stress)) {
            return Err(CoatingError::NotPositive { material, thickness });
        }
        let least = LEAST_HARDENING * modulus;
        if hardening < least {
            return Err(CoatingError::HardensTooLittle { hardening, least });
        }
        let least = RODS_PER_SECTOR * sectors;
        if rods_around < least {
            return Err(CoatingError::TooFewRods { rods_around, sectors, least });
        }
        let areas = rod_areas(contact_nodes, rods_around);
        if let Some(node) = areas.iter().position(|&area| !positive(area)) {
            return Err(CoatingError::NoArea { node });
        }
        Ok(Self { material, thickness, rods_around, areas })
    }

    /// Depth of the metal behind the unworn surface, length.
    pub fn thickness(&self) -> f64 {
        self.thickness
    }
}

fn rod_areas(contact_nodes: &[ContactNode], rods_around: usize) -> Vec<f64> {
    let way = |pair: &[ContactNode]| {
        let [[r0, _, z0], [r1, _, z1]] = [pair[0].position, pair[1].position];
        (r1 - r0).hypot(z1 - z0)
    };
    let ways: Vec<f64> = contact_nodes.windows(2).map(way).collect();
    let area = |(node, contact): (usize, &ContactNode)| {
        let before = if node > 0 { ways[node - 1] } else { 0.0 };
        let after = ways.get(node).copied().unwrap_or(0.0);
        TAU * contact.position[0] / rods_around as f64 * 0.5 * (before + after)
    };
    contact_nodes.iter().enumerate().map(area).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const MATERIAL: CoatingMaterial = CoatingMaterial { modulus: 100.0, yield_stress: 1.0, hardening: 10.0 };

    fn nodes(meridian: &[[f64; 2]]) -> Vec<ContactNode> {
        let node = |&[r, z]: &[f64; 2]| ContactNode {
            id: 0,
            position: [r, 0.3 * z, z],
            normal: [1.0, 0.0, 0.0],
            dofs: [0; 3],
        };
        meridian.iter().map(node).collect()
    }

    /// Area of the swept surface by Guldin's rule: a cone between radii 3 and 6, slant height 5, has the area 2π·4.5·5.
    #[test]
    fn rods_cover_the_swept_surface() {
        let contact = nodes(&[[3.0, 0.0], [3.6, 0.8], [5.4, 3.2], [6.0, 4.0]]);
        let coating = Coating::new(MATERIAL, 0.1, 500, &contact, 10).unwrap();
        let covered = coating.areas.iter().sum::<f64>() * 500.0;
        assert!((covered / (TAU * 4.5 * 5.0) - 1.0).abs() < 1e-14, "{covered}");
    }

    #[test]
    fn refuses_what_is_no_coating() {
        let line = nodes(&[[3.0, 0.0], [3.0, 1.0]]);
        let with = |material, thickness, rods, contact: &[ContactNode]| {
            Coating::new(material, thickness, rods, contact, 10).unwrap_err()
        };
        for (material, thickness) in [
            (CoatingMaterial { modulus: -1.0, ..MATERIAL }, 0.1),
            (CoatingMaterial { yield_stress: f64::NAN, ..MATERIAL }, 0.1),
            (CoatingMaterial { hardening: 0.0, ..MATERIAL }, 0.1),
            (MATERIAL, f64::INFINITY),
        ] {
            assert!(matches!(with(material, thickness, 500, &line), CoatingError::NotPositive { .. }));
        }
        let soft = CoatingMaterial { hardening: 1e-5, ..MATERIAL };
        assert!(matches!(with(soft, 0.1, 500, &line), CoatingError::HardensTooLittle { .. }));
        let few = CoatingError::TooFewRods { rods_around: 39, sectors: 10, least: 40 };
        assert_eq!(with(MATERIAL, 0.1, 39, &line), few);
        for (contact, node) in [
            (nodes(&[[3.0, 0.0]]), 0),
            (nodes(&[[0.0, 0.0], [3.0, 1.0]]), 0),
            (nodes(&[[3.0, 0.0], [3.0, 1.0], [3.0, 1.0], [3.0, 1.0]]), 2),
        ] {
            assert_eq!(with(MATERIAL, 0.1, 500, &contact), CoatingError::NoArea { node });
        }
    }
}
