//! Which code computed a result.

/// Version of the code, stamped on every result.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
