//! Bounds that keep the memory and the time of a request reasonable.

pub(crate) const MODES_PER_SPEED: u32 = 500;
pub(crate) const CONTROL_SPEEDS: u32 = 100;
pub(crate) const TARGET: std::ops::RangeInclusive<f64> = 1e-9..=0.5;
pub(crate) const SECONDS: std::ops::RangeInclusive<f64> = 1.0..=1e7;
pub(crate) const REVOLUTIONS: u32 = 100_000;
pub(crate) const ENGINE_ORDER: u32 = 1_000;
/// Most sensors. Each has a table of critical speeds, with the whole request in it.
pub(crate) const SENSORS: usize = 1_000;
/// Most recorded numbers of one speed, 8 bytes each.
pub(crate) const RECORDED: usize = 1 << 27;
pub(crate) const FAMILIES: u32 = 100;
pub(crate) const SUPERHARMONIC: u32 = 100;
pub(crate) const SUPERHARMONICS: usize = 16;
/// Most entries of the contact operator W: sectors times the square of contact nodes.
pub(crate) const DELASSUS: usize = 1 << 26;
/// Range of lengths and stresses other than 0, in any unit: far from where squares overflow or motion counts as decayed.
pub(crate) const LENGTH: std::ops::RangeInclusive<f64> = 1e-30..=1e30;
/// Most operating ranges.
pub(crate) const RANGES: usize = 100;
/// Most characters in the name of an operating range.
pub(crate) const RANGE_NAME: usize = 100;
pub(crate) const PERCENT: std::ops::RangeInclusive<f64> = 0.0..=100.0;
pub(crate) const PHASE_RAD: f64 = 1000.0;
