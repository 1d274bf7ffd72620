//! Claims among processes, of which there is one.

/// Claim of this process against others, which cannot exist in this build.
#[derive(Debug)]
pub enum Claim {}
