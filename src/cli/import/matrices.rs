//! `rubmap import matrices`: a model package from a mesh of one sector and the matrices of another program.

use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use clap::Args;

use super::arguments::speed_and_file;
use super::mesh::{MeshOptions, read, write};
use crate::cli::stdout::narrate;
use crate::from_mesh::{FileMatrices, package_with_matrices};
use crate::mesh::matrices::{FileMatrix, read_named};
use crate::package::raw::MatrixFormat;

/// Mesh, matrices, and settings that they do not have.
#[derive(Debug, Args)]
pub(in crate::cli) struct MatricesArgs {
    /// Mesh of one sector, for positions, elements, cyclic faces and contact line
    mesh: PathBuf,
    /// Mass matrix: Abaqus (*MATRIX GENERATE), Nastran (DMIG, OUTPUT4), Ansys (Matrix Market, Harwell-Boeing)
    #[arg(long)]
    mass: PathBuf,
    /// Stiffness matrix at rest; may be the file of the mass, with names
    #[arg(long)]
    stiffness: PathBuf,
    /// Speed and file of a stiffness at speed, such as 2500=half.mtx or 24000rpm=half.mtx; give none, or two (Ω1/2 and Ω1)
    #[arg(long = "at", value_name = "SPEED=FILE", value_parser = speed_and_file)]
    at_speed: Vec<(f64, PathBuf)>,
    /// Name of the mass matrix in a file of several, such as MAAX
    #[arg(long)]
    mass_name: Option<String>,
    /// Name of the stiffness matrix in a file of several, such as KAAX
    #[arg(long)]
    stiffness_name: Option<String>,
    /// Lines of row, node and degree of freedom (1 5 UX) for formats whose rows have numbers only
    #[arg(long)]
    mapping: Option<PathBuf>,
    #[command(flatten)]
    options: MeshOptions,
    /// Package to write
    #[arg(long)]
    out: PathBuf,
    /// Format in which the package stores its matrices
    #[arg(long, value_enum, default_value_t = MatrixFormat::Npz)]
    matrices: MatrixFormat,
}

/// Makes the package, checks it as an upload would be, writes it and prints what was found.
pub(super) fn import(args: MatricesArgs) -> anyhow::Result<()> {
    if !matches!(args.at_speed.len(), 0 | 2) {
        bail!("give --at twice (half the highest speed and the highest), or not at all");
    }
    let mapping = args.mapping.as_deref().map(bytes).transpose()?;
    let matrix = |path: &Path, name: &Option<String>| -> anyhow::Result<FileMatrix> {
        let read = read_named(&bytes(path)?, mapping.as_deref(), name.as_deref());
        read.with_context(|| path.display().to_string())
    };
    let mass = matrix(&args.mass, &args.mass_name)?;
    let mut stiffness = vec![(0.0, matrix(&args.stiffness, &args.stiffness_name)?)];
    for (speed, path) in &args.at_speed {
        stiffness.push((*speed, matrix(path, &args.stiffness_name)?));
    }
    let file = read(&args.mesh)?;
    // Without a speed the top speed is none of the package's.
    let top_speed = args.at_speed.last().map_or(1.0, |(speed, _)| *speed);
    let settings = args.options.settings(&args.mesh, Some(top_speed))?;
    let (package, found) = package_with_matrices(file, &settings, &FileMatrices { mass, stiffness })
        .with_context(|| args.mesh.display().to_string())?;
    narrate(&found.to_string())?;
    write(package, &args.out, args.matrices)
}

fn bytes(path: &Path) -> anyhow::Result<Vec<u8>> {
    std::fs::read(path).with_context(|| format!("cannot read {}", path.display()))
}
