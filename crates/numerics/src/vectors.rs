//! Vectors that the inner loops run on.

use std::sync::OnceLock;

use pulp::Arch;

/// Kind of vectors of this process.
static KIND: OnceLock<Arch> = OnceLock::new();

/// Error: loops that have run on vectors before scalars were asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the loops of this process run on vectors of the processor already")]
pub struct AlreadyChosen;

/// Vectors of this process: the widest that the processor has, unless [`choose_scalars`] was called before.
pub fn arch() -> Arch {
    *KIND.get_or_init(Arch::new)
}

/// Lets all loops of this process run on scalars, to see that results do not hang on the kind of vectors. Dense factorisations, which are
/// faer's, keep those of the processor.
///
/// # Errors
/// [`AlreadyChosen`] where a loop has run on others.
pub fn choose_scalars() -> Result<(), AlreadyChosen> {
    let kind = KIND.get_or_init(|| Arch::Scalar);
    if matches!(kind, Arch::Scalar) { Ok(()) } else { Err(AlreadyChosen) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scalars_are_refused_once_vectors_are_in_use() {
        let kind = arch();
        assert_eq!(choose_scalars().is_ok(), matches!(kind, Arch::Scalar));
    }
}
