//! `rubmap import`: a model package from the files of a finite-element program, or a casing from a table.

mod arguments;
mod calculix;
mod casing;
mod findings;
mod looks;
mod matrices;
mod mesh;
mod shroud;

use clap::Subcommand;

use calculix::CalculixArgs;
use casing::CasingArgs;
use matrices::MatricesArgs;
use mesh::MeshArgs;

/// Program or table that the files come from.
#[derive(Debug, Subcommand)]
pub(super) enum ImportCommand {
    /// CalculiX: mesh from a deck (.inp), matrices from *FREQUENCY, SOLVER=MATRIXSTORAGE (.dof, .sti, .mas)
    Calculix(Box<CalculixArgs>),
    /// A mesh of one sector: CalculiX or Abaqus (.inp), Gmsh (.msh), Nastran (.bdf), Ansys (.cdb) or VTK (.vtu); matrices are assembled here
    Mesh(Box<MeshArgs>),
    /// A mesh of one sector with the matrices of Abaqus, Nastran or Ansys
    Matrices(Box<MatricesArgs>),
    /// A measured casing: heights over angle and place along the chord (.csv), as `scene.casing.measured` of a request
    Casing(CasingArgs),
}

/// Makes what the files say, checks it as an upload would be, writes it and prints a description.
pub(super) fn import(command: ImportCommand) -> anyhow::Result<()> {
    match command {
        ImportCommand::Calculix(args) => calculix::import(*args),
        ImportCommand::Mesh(args) => mesh::import(*args),
        ImportCommand::Matrices(args) => matrices::import(*args),
        ImportCommand::Casing(args) => casing::import(&args),
    }
}
