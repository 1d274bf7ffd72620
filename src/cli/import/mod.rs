//! `rubmap import`: a model package from the files of a finite-element program.

mod matrices;
mod mesh;

use std::fmt::{self, Write};
use std::fs::File;
use std::io::BufWriter;
use std::path::PathBuf;

use anyhow::{Context, bail};
use clap::{Args, Subcommand};

use super::speed::speed;
use super::stdout;
use crate::analysis::result::MeasuredCasing;
use crate::casing_table;
use crate::dynamics::findings::{Findings, MaterialInSi, SpinAtSpeed};
use crate::dynamics::sector::Units;
use crate::package::calculix::{self, CalculixModel, ImportSummary, Normals};
use crate::package::raw::{Axis, ManifestMesh, MatrixFormat, RawPackage};
use crate::solid::material::Material;
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

/// Table of a measured casing.
#[derive(Debug, Args)]
pub(super) struct CasingArgs {
    /// Table of heights inward of the casing of revolution: angle_deg (or angle_rad) and a column for every place along the chord from 0
    /// to 1 or contact node (node0, node1, …); or angle_deg, chord (or node), height
    table: PathBuf,
    /// JSON file to write [default: the output]
    #[arg(long)]
    out: Option<PathBuf>,
}

/// Files of CalculiX, and settings that the deck does not have.
#[derive(Debug, Args)]
pub(super) struct CalculixArgs {
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

/// Findings of a kind that are printed one by one, at most.
const MOST_SAID: usize = 10;

/// Order of contact nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum ContactOrder {
    /// Order along their line, from its end at the smaller radius (the leading edge of a compressor)
    Chord,
    /// Order in which the deck lists the set, which must be from leading to trailing edge
    Set,
}

/// Makes the package, checks it as an upload would be, writes it and prints a description.
pub(super) fn import(command: ImportCommand) -> anyhow::Result<()> {
    match command {
        ImportCommand::Calculix(args) => import_calculix(*args),
        ImportCommand::Mesh(args) => mesh::import(*args),
        ImportCommand::Matrices(args) => matrices::import(*args),
        ImportCommand::Casing(args) => import_casing(&args),
    }
}

/// Reads the table, prints what stands out in it, and writes it as requests take it.
fn import_casing(args: &CasingArgs) -> anyhow::Result<()> {
    let name = args.table.display();
    let text = std::fs::read(&args.table).with_context(|| format!("cannot read {name}"))?;
    let found = casing_table::read(&text).map_err(|errors| {
        let said: Vec<_> = errors.iter().map(|error| format!("{name}: {error}")).collect();
        anyhow::anyhow!(said.join("\n"))
    })?;
    eprint!("{}", surveyed(&found)?);
    let json = serde_json::to_string(&found.measured)?;
    match &args.out {
        Some(path) => std::fs::write(path, json).with_context(|| format!("cannot write {}", path.display())),
        None => stdout::print(&json),
    }
}

/// Description of a table of a measured casing.
fn surveyed(found: &MeasuredCasing) -> Result<String, fmt::Error> {
    let MeasuredCasing { measured, survey, filled, filled_count } = found;
    let place = |line: u32| match &measured.chord {
        Some(chord) => format!("{} of the chord", chord[line as usize]),
        None => format!("contact node {line}"),
    };
    let mut text = String::new();
    writeln!(
        text,
        "{} angles, {} lines; {}",
        measured.angles_rad.len(),
        measured.heights.len(),
        survey.interpolation
    )?;
    let heights = || measured.heights.iter().flatten();
    let (low, high) =
        heights().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &h| (low.min(h), high.max(h)));
    writeln!(text, "heights from {low} to {high}")?;
    for outlier in survey.outliers.iter().take(MOST_SAID) {
        let (angle, expected) = (outlier.angle_rad.to_degrees(), outlier.expected);
        let place = place(outlier.line);
        writeln!(
            text,
            "stands alone: {} at {angle:.3}°, {place}; its neighbours expect {expected:.6}",
            outlier.height
        )?;
    }
    for gap in survey.gaps.iter().take(MOST_SAID) {
        writeln!(
            text,
            "no points from {:.3}° to {:.3}°",
            gap.from_rad.to_degrees(),
            gap.to_rad.to_degrees()
        )?;
    }
    for height in filled.iter().take(MOST_SAID) {
        let angle = height.angle_rad.to_degrees();
        writeln!(
            text,
            "missing at {angle:.3}°, {}: the curve says {:.6}",
            place(height.line),
            height.height
        )?;
    }
    let counts = [survey.outlier_count, survey.gap_count, *filled_count];
    if counts.iter().any(|&count| count as usize > MOST_SAID) {
        writeln!(text, "in all: {} stand alone, {} gaps, {} missing", counts[0], counts[1], counts[2])?;
    }
    if let Some(over) = &survey.overshoot {
        let angle = over.angle_rad.to_degrees();
        writeln!(
            text,
            "the curve goes {:.6} beyond all points at {angle:.3}°, {}",
            over.by,
            place(over.line)
        )?;
    }
    Ok(text)
}

fn import_calculix(args: CalculixArgs) -> anyhow::Result<()> {
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
    print!("{}", describe(&package, &summary, &findings)?);
    println!("Written: {}", args.out.display());
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

/// Adds size, materials, K(Ω) and warnings to the description.
fn describe_findings(text: &mut String, findings: &Findings) -> fmt::Result {
    if let Some(in_si) = &findings.in_si {
        writeln!(
            text,
            "In SI units: {:.4} kg without clamped nodes, contact nodes up to {:.4} m from the axis",
            in_si.mass_kg, in_si.contact_radius_m
        )?;
        if let Some(wheel) = &in_si.wheel {
            writeln!(
                text,
                "The wheel by its elements: {:.4} kg, {:.4e} m³, centre {:.5} m along the axis, {:.4e} kg m² about it",
                wheel.mass_kg, wheel.volume_m3, wheel.centre_m, wheel.polar_inertia_kg_m2
            )?;
        }
        if let Some(speed) = in_si.tip_speed_m_s {
            writeln!(text, "Tip speed {speed:.1} m/s at the highest speed of the stiffness")?;
        }
        for MaterialInSi { set, youngs_modulus_pa, density_kg_m3, wave_speed_m_s } in &in_si.materials {
            writeln!(
                text,
                "{set}: E {youngs_modulus_pa:.3e} Pa, ρ {density_kg_m3:.4} kg/m³, √(E/ρ) {wave_speed_m_s:.0} m/s"
            )?;
        }
    }
    for SpinAtSpeed { speed_rad_s, finding } in &findings.spin {
        writeln!(text, "Stiffness at {speed_rad_s} rad/s: {finding}")?;
    }
    for warning in findings.warnings() {
        writeln!(text, "WARNING: {warning}")?;
    }
    Ok(())
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

fn speed_and_file(text: &str) -> Result<(f64, PathBuf), String> {
    let (at, job) = text.split_once('=').ok_or("expected SPEED=JOB, such as 2500=half")?;
    Ok((speed(at)?, PathBuf::from(job)))
}

fn axis(text: &str) -> Result<Axis, String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|number| number.trim().parse()).collect();
    match numbers.as_deref() {
        Ok(&[a, b, c, d, e, f]) => Ok(Axis { origin: [a, b, c], direction: [d, e, f] }),
        _ => Err("expected six numbers x,y,z,dx,dy,dz".to_owned()),
    }
}

fn units(text: &str) -> Result<Units, String> {
    let names: Vec<String> = text.split(',').map(|name| name.trim().to_owned()).collect();
    let [length, force, time, mass]: [String; 4] =
        names.try_into().map_err(|_| "expected length,force,time,mass, such as mm,N,s,t")?;
    Ok(Units { length, force, time, mass })
}
