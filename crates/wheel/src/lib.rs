//! Cyclic wheel that rubs against its casing.
//!
//! [`dynamics`] reduces a sector per nodal diameter and integrates the wheel in time; [`response`] reads what came out.
//!
//! Natural frequencies of ten hubs, each on a spring to the ground and springs to its neighbours, with a blade each:
//!
//! ```
//! use faer::sparse::{SparseColMat, Triplet};
//! use rubmap_wheel::dynamics::modal_wheel::{ModalWheel, RotationEffects};
//! use rubmap_wheel::dynamics::reduction::{NoCheckpoints, ReductionOptions, reduce};
//! use rubmap_wheel::dynamics::sector::{ContactNode, CyclicMatrix, SectorModel, SectorParts, Units};
//!
//! // Node 0 is the hub and node 1 the blade, of mass 1 each and alike in r, θ and z.
//! let matrix = |entries: &[(usize, usize, f64)]| {
//!     let alike = |&(row, column, value)| (0..3).map(move |d| Triplet::new(3 * row + d, 3 * column + d, value));
//!     let entries: Vec<_> = entries.iter().flat_map(alike).collect();
//!     SparseColMat::try_new_from_triplets(6, 6, &entries)
//! };
//! let (ground, blade, neighbour) = (1.0, 1.0, 0.2);
//! let hub = ground + blade + 2.0 * neighbour;
//! let sector = SectorModel::new(SectorParts {
//!     name: "ten hubs".into(),
//!     sectors: 10,
//!     units: Units { length: "m".into(), force: "N".into(), time: "s".into(), mass: "kg".into() },
//!     mass: CyclicMatrix { own: matrix(&[(0, 0, 1.0), (1, 1, 1.0)])?, next: matrix(&[])? },
//!     stiffness: vec![CyclicMatrix {
//!         own: matrix(&[(0, 0, hub), (0, 1, -blade), (1, 0, -blade), (1, 1, blade)])?,
//!         next: matrix(&[(0, 0, -neighbour)])?,
//!     }],
//!     gyroscopic: None,
//!     speeds_rad_s: vec![0.0],
//!     contact: vec![ContactNode { id: 1, position: [1.0, 0.0, 0.0], normal: [1.0, 0.0, 0.0], dofs: [3, 4, 5] }],
//!     axis: Vec::new(),
//!     node_of_dof: vec![0, 0, 0, 1, 1, 1],
//! })?;
//!
//! let reduced = reduce(&sector, &ReductionOptions::new(3), &NoCheckpoints, &|_, _| true)?;
//! let wheel = ModalWheel::at(&reduced, 0.0, RotationEffects::stiffening(false))?;
//! for modes in &wheel.harmonics {
//!     // One mass against the other: (h − ω²)(blade − ω²) = blade², the neighbours in step but for the angle between them.
//!     let angle = std::f64::consts::TAU * modes.harmonic as f64 / 10.0;
//!     let h = hub - 2.0 * neighbour * angle.cos();
//!     let lowest = 0.5 * (h + blade - ((h - blade).powi(2) + 4.0 * blade * blade).sqrt());
//!     assert!((modes.omega[0].powi(2) - lowest).abs() < 1e-12);
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod dynamics;
pub mod response;
pub mod revision;
pub mod vectors;
