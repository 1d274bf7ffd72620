//! Claim about what the program computes.

use rubmap_mesh::MeshFormat;
use rubmap_mesh::matrices::MatrixFormat;

/// Reference of a claim that has none.
pub const NO_REFERENCE: &str = "no independent reference yet";

/// Claim, with the reference that it is held against.
#[derive(Debug, Clone, Copy)]
pub struct Claim {
    /// Name of the row, by which it is asked for.
    pub name: &'static str,
    /// Parts of the program that the row is about.
    pub covers: &'static [Subject],
    /// Claim, in a sentence.
    pub claim: &'static str,
    /// Reference, and where it is from.
    pub reference: &'static str,
    /// Quantity that is compared, and how its error is measured.
    pub quantity: &'static str,
    /// Comparison with the reference.
    pub check: Check,
}

/// Part of the program that must have a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Subject {
    /// Effect of a scene, by its name in requests.
    Effect(&'static str),
    /// Kind of job, by its name in requests.
    Kind(&'static str),
    /// Importer of meshes.
    Mesh(MeshFormat),
    /// Importer of matrices.
    Matrices(MatrixFormat),
}

/// Comparison of a claim with its reference.
#[derive(Debug, Clone, Copy)]
pub enum Check {
    /// Comparison by the program itself.
    Computed(Computed),
    /// Comparison by a test of the repository.
    Test {
        /// File of the test, from the root of the repository.
        file: &'static str,
        /// Name of the test.
        name: &'static str,
        /// Limit that the test asserts, and its reason.
        limit: &'static str,
    },
    /// Comparison of the program with itself by a test of the repository: consistency, no agreement with others.
    Consistency {
        /// File of the test, from the root of the repository.
        file: &'static str,
        /// Name of the test.
        name: &'static str,
        /// Limit that the test asserts, and its reason.
        limit: &'static str,
    },
    /// No independent reference yet.
    None,
}

/// Problem that the program computes beside its reference.
#[derive(Debug, Clone, Copy)]
pub struct Computed {
    /// Error of the program against the reference, relative. One number of the problem is multiplied by the argument before the program gets
    /// it, but not the reference: 1 for the row, anything else to see that the row would fail.
    pub error: fn(f64) -> anyhow::Result<f64>,
    /// Number of the problem that the argument multiplies.
    pub wrong: &'static str,
    /// Largest error with which the claim holds.
    pub limit: f64,
    /// Reason for the limit.
    pub reason: &'static str,
}
