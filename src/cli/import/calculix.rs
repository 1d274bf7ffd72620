//! `rubmap import calculix`: a model package from the mesh and the matrices of CalculiX.

use std::fmt::{self, Write};
use std::fs::File;
use std::io::BufWriter;
use std::path::PathBuf;

use anyhow::{Context, bail};
use clap::Args;

use super::arguments::{axis, speed_and_file, units};
use super::findings::describe_findings;
use crate::cli::stdout::narrate;
use crate::dynamics::findings::Findings;
use crate::dynamics::sector::Units;
use crate::package::calculix::{self, CalculixModel, ImportSummary, Normals};
use crate::package::raw::{Axis, ManifestMesh, MatrixFormat, RawPackage};
use crate::solid::material::Material;

/// Files of CalculiX, and settings that the deck does not have.
#[derive(Debug, Args)]
pub(in crate::cli) struct CalculixArgs {
    /// Deck with the mesh and its node sets (*INCLUDE is followed)
    deck: PathBuf,
    /// Job of the matrices at rest: the path of its .dof, .sti and .mas without extension
    #[arg(long)]
    rest: PathBuf,
    /// Speed and job of a stiffness at speed, such as 2500=half or 24000rpm=half; give none, or two (Ω1/2 and Ω1)
    #[arg(long = "at", value_name = "SPEED=JOB", value_parser = speed_and_file)]
    at_speed: Vec<(f64, PathBuf)>,
    /// The matrices are those of the whole wheel
    #[arg(long)]
    wheel: bool,
    /// Number of sectors [default: that of *CYCLIC SYMMETRY MODEL]
    #[arg(long)]
    sectors: Option<usize>,
    /// Axis: a point and the direction about which rotation is positive, x,y,z,dx,dy,dz [default: that of *CYCLIC SYMMETRY
    /// MODEL, or 0,0,0,0,0,1]
    #[arg(long, value_parser = axis, allow_hyphen_values = true)]
    axis: Option<Axis>,
    /// Node set of the low cyclic face [default: from the cyclic *TIE; with
    /// --sectors 1 no faces are needed]
    #[arg(long)]
    low_set: Option<String>,
    /// Node set of the high cyclic face, the low one turned by +2π/N [default: from the cyclic *TIE]
    #[arg(long)]
    high_set: Option<String>,
    /// Node set of one line of nodes along the blade tip
    #[arg(long)]
    contact_set: String,
    /// Use this many nodes of the contact set, evenly spaced [default: all]
    #[arg(long)]
    contact_count: Option<usize>,
    /// Order of the contact nodes
    #[arg(long, value_enum, default_value_t = ContactOrder::Chord)]
    contact_order: ContactOrder,
    /// CSV of the casing's meridional curve, lines r,z, to take the normals from [default: the curve through the
    /// contact nodes]
    #[arg(long, conflicts_with = "normals")]
    meridian: Option<PathBuf>,
    /// CSV of normals, lines node,nx,ny,nz
    #[arg(long)]
    normals: Option<PathBuf>,
    /// Add the gyroscopic matrix that the mass implies, for Coriolis forces
    #[arg(long)]
    gyroscopic: bool,
    /// JSON file of strengths by material or element set, {"NAME": {"yield_strength": …, "ultimate_strength": …,
    /// "fatigue_strength": {"amplitude": …, "source": "…"}}}, which decks do not have [default: none]
    #[arg(long)]
    strengths: Option<PathBuf>,
    /// Units of length, force, time and mass in the deck
    #[arg(long, default_value = "mm,N,s,t", value_parser = units)]
    units: Units,
    /// Name of the model [default: that of the deck]
    #[arg(long)]
    name: Option<String>,
    /// Package to write
    #[arg(long)]
    out: PathBuf,
    /// Format in which the package stores its matrices
    #[arg(long, value_enum, default_value_t = MatrixFormat::Npz)]
    matrices: MatrixFormat,
}

/// Order of contact nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum ContactOrder {
    /// Order along their line, from its end at the smaller radius (the leading edge of a compressor)
    Chord,
    /// Order in which the deck lists the set, which must be from leading to trailing edge
    Set,
}

/// Makes the package, checks it as an upload would be, writes it and prints a description.
pub(super) fn import(args: CalculixArgs) -> anyhow::Result<()> {
    let deck_name = args.deck.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let model = CalculixModel {
        deck: args.deck,
        rest: args.rest,
        at_speed: args.at_speed,
        whole_wheel: args.wheel,
        sectors: args.sectors,
        axis: args.axis,
        low_set: args.low_set,
        high_set: args.high_set,
        contact_set: args.contact_set,
        contact_count: args.contact_count,
        contact_as_listed: args.contact_order == ContactOrder::Set,
        normals: match (args.meridian, args.normals) {
            (Some(path), _) => Normals::Meridian(path),
            (None, Some(path)) => Normals::Table(path),
            (None, None) => Normals::ContactNodes,
        },
        gyroscopic: args.gyroscopic,
        strengths: args.strengths,
        units: args.units,
        name: args.name.unwrap_or(deck_name),
    };
    if !matches!(model.at_speed.len(), 0 | 2) {
        bail!("give --at twice (half the highest speed and the highest), or not at all");
    }
    let (mut package, summary) = calculix::import(&model)?;
    package.manifest.store_matrices_as(args.matrices);
    let findings = crate::package::look_at(package.clone())
        .context("the imported model does not pass the checks of a package")?;
    let file = File::create(&args.out).with_context(|| format!("cannot create {}", args.out.display()))?;
    crate::package::write(&package, BufWriter::new(file))
        .with_context(|| format!("cannot write {}", args.out.display()))?;
    narrate(&describe(&package, &summary, &findings)?)?;
    narrate(&format!("Written: {}", args.out.display()))?;
    Ok(())
}

/// Description of the imported model, which can be compared with what one knows of it.
fn describe(
    package: &RawPackage,
    summary: &ImportSummary,
    findings: &Findings,
) -> Result<String, fmt::Error> {
    let manifest = &package.manifest;
    let mut text = String::new();
    let [x, y, z] = manifest.axis.direction;
    let u = &manifest.units;
    writeln!(
        text,
        "{}: {} sectors, {} nodes and {} DOF a sector, {} pairs of face nodes; units {}, {}, {}, {}",
        manifest.name,
        manifest.sectors,
        package.nodes.len(),
        package.dofs.len(),
        manifest.cyclic.len(),
        u.length,
        u.force,
        u.time,
        u.mass,
    )?;
    writeln!(
        text,
        "Rotation is positive about ({x}, {y}, {z}); a wheel that turns the other way needs --axis reversed"
    )?;
    if summary.faces_swapped {
        writeln!(text, "Low and high face were exchanged: the high face must be the low one turned forward")?;
    }
    if let Some(difference) = summary.sectors_differ {
        writeln!(text, "Sectors of the wheel differ by {difference:.1e} of the largest force")?;
    }
    match (&manifest.mesh, &summary.no_mesh) {
        (Some(mesh), _) => {
            let elements = package.elements.as_ref().map_or(0, Vec::len);
            writeln!(text, "{elements} elements; {}", materials(mesh))?;
        }
        (None, Some(reason)) => writeln!(text, "WITHOUT mesh, and so without stress: {reason}")?,
        (None, None) => {}
    }
    describe_findings(&mut text, findings)?;
    writeln!(text, "Contact nodes from leading to trailing edge (check order and normals):")?;
    writeln!(text, "      node          r      theta          z      n_r  n_theta      n_z")?;
    for point in &summary.contact {
        let ([r, theta, z], [nr, nt, nz]) = (point.position, point.normal);
        writeln!(text, "{:>10} {r:10.4} {theta:10.5} {z:10.4} {nr:8.4} {nt:8.4} {nz:8.4}", point.node)?;
    }
    Ok(text)
}

/// List of element sets with the strengths that each has.
fn materials(mesh: &ManifestMesh) -> String {
    let of_set = |(name, material): (&String, &Material)| {
        let known: Vec<&str> = [
            ("yield", material.yield_strength.is_some()),
            ("ultimate", material.ultimate_strength.is_some()),
            ("fatigue", material.fatigue_strength.is_some()),
        ]
        .into_iter()
        .filter_map(|(strength, known)| known.then_some(strength))
        .collect();
        match &known[..] {
            [] => format!("{name} without strengths (--strengths), so without margins"),
            known => format!("{name} with {} strength", known.join(", ")),
        }
    };
    mesh.sets.iter().map(of_set).collect::<Vec<_>>().join("; ")
}
