//! Parts of a reduction kept on the way, so that one that was interrupted continues.

/// Keeps finished parts of one reduction: of one sector, with one set of options.
///
/// Parts have names of `[a-z0-9-]+`, such as `speed-1-harmonic-3`. Whatever was saved under a name gives the same
/// result as computing that part again, so an implementation may forget any of them at any time.
pub trait Checkpoints: Sync {
    /// The bytes saved as `part`, whole; `None` if there are none or they are damaged.
    fn load(&self, part: &str) -> Option<Vec<u8>>;

    /// Keeps `bytes` as `part`. One that cannot be kept is only computed again some day.
    fn save(&self, part: &str, bytes: Vec<u8>);
}

/// Keeps nothing.
#[derive(Debug, Clone, Copy, Default)]
pub struct NoCheckpoints;

impl Checkpoints for NoCheckpoints {
    fn load(&self, _part: &str) -> Option<Vec<u8>> {
        None
    }

    fn save(&self, _part: &str, _bytes: Vec<u8>) {}
}
