//! Revision of the numbers that a computation gives.

/// Revision of the numerics: raised with every change after which the same request gives other numbers. Results stored under another
/// revision are computed again.
pub const REVISION: u32 = 7;

/// Version of the code with the revision of its numerics, stamped on every result.
pub const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), "+numerics.7");

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_version_says_the_revision() {
        assert_eq!(VERSION, format!("{}+numerics.{REVISION}", env!("CARGO_PKG_VERSION")));
    }
}
