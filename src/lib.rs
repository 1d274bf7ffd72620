//! rubmap: at which rotational speeds do the blade tips of a centrifugal impeller interact dangerously
//! with their casing?
//!
//! A finite-element impeller sector goes in as a [`package`]; it is reduced once per nodal diameter
//! ([`dynamics::reduction`]), simulated against an ovalised casing at each speed of a sweep
//! ([`dynamics::integrate`]) and read as spectra, interaction maps and critical speeds ([`response`]).
//!
//! # Architecture
//!
//! ```text
//! crates/numerics ← crates/wheel (dynamics ← response) ← crates/analysis ← src (kinds ← store ← import ← jobs ← http ← app ← cli)
//!                        ↑ crates/model (package, assembly, impeller)      ↑ crates/plot
//! crates/solid (elements, stress) ← model, analysis
//! ```
//!
//! What is absent, and stays absent:
//!
//! - Left of `src` nothing knows HTTP, SQL, async, the clock's date or the environment.
//! - [`analysis`] is the one door between physics and service: plain data and the verbs that prepare a reduced
//!   sector, run one speed and summarise the speeds.
//! - Only [`store`] contains SQL; only [`http`] contains status codes; `http` never computes.
//! - Only the modules named `cluster` ask for the feature of that name: each has two implementations with the same items, `shared` with
//!   the feature and `alone` without, where what is shared has types without values.
//! - The step loop allocates nothing and contains no dense product over the whole wheel.

pub mod app;
pub mod casing_table;
pub mod cli;
pub mod config;
mod duration;
pub mod export;
pub mod http;
pub mod import;
pub mod jobs;
pub mod kinds;
mod memory;
mod pool;
pub mod store;
pub mod tokens;
pub mod version;

pub use rubmap_analysis as analysis;
pub use rubmap_mesh as mesh;
pub use rubmap_model::{assembly, from_mesh, impeller, package};
pub use rubmap_numerics as numerics;
pub use rubmap_plot as plot;
pub use rubmap_solid as solid;
pub use rubmap_wheel::{dynamics, response};
