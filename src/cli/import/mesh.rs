//! `rubmap import mesh`: a model package from a mesh of one sector.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use clap::Args;

use super::arguments::{axis, units};
use super::findings::describe_findings;
use super::{looks, shroud};
use crate::cli::speed::speed;
use crate::cli::stdout::{narrate, print};
use crate::dynamics::sector::Units;
use crate::from_mesh::{self, MeshSettings};
use crate::mesh::MeshFile;
use crate::package::raw::{Axis, MatrixFormat, RawPackage};
use crate::solid::material::Material;
use crate::solid::rule::MassRule;

/// Mesh file, and settings that it does not have.
#[derive(Debug, Args)]
pub(in crate::cli) struct MeshArgs {
    /// Mesh of one sector; its content tells the format
    file: PathBuf,
    /// Highest speed of the stiffness matrices, such as 5000 (rad/s) or 48000rpm
    #[arg(long, value_parser = speed, required_unless_present_any = ["settings", "look"])]
    top_speed: Option<f64>,
    /// Print patches and sharp edges of the skin, what was found and what making the model costs, and make none
    #[arg(long)]
    look: bool,
    /// Integrate mass at the points of stiffness in every element, as CalculiX does [default: at more points where these leave motions without
    /// mass]
    #[arg(long)]
    mass_as_calculix: bool,
    #[command(flatten)]
    options: MeshOptions,
    /// Package to write
    #[arg(long, required_unless_present = "look")]
    out: Option<PathBuf>,
    /// Format in which the package stores its matrices
    #[arg(long, value_enum, default_value_t = MatrixFormat::Npz)]
    matrices: MatrixFormat,
}

/// Settings of a sector that its mesh file does not have.
#[derive(Debug, Args)]
pub(super) struct MeshOptions {
    /// Number of sectors [default: found from the cyclic faces; a single blade has 1]
    #[arg(long)]
    sectors: Option<usize>,
    /// Axis: a point and the direction about which rotation is positive, x,y,z,dx,dy,dz [default: stated by the file, or found
    /// from the cyclic faces, with the largest component of its direction positive]
    #[arg(long, value_parser = axis, allow_hyphen_values = true)]
    axis: Option<Axis>,
    /// Material of an element set, or of a material of the file: NAME=E,NU,DENSITY; without NAME= of all elements [default: those of the
    /// file]
    #[arg(long = "material", value_name = "[NAME=]E,NU,DENSITY", value_parser = material)]
    materials: Vec<(String, [f64; 3])>,
    /// Temperature at which materials that the file tabulates are taken
    #[arg(long, allow_hyphen_values = true)]
    temperature: Option<f64>,
    /// Node set of the clamp [default: the nodes that the file holds, or else the bore]
    #[arg(long)]
    clamp_set: Option<String>,
    /// Nodes of the smooth patches of the skin that are clamped, instead of a set: `--look` has their numbers
    #[arg(long, value_name = "NODE,…", value_delimiter = ',', conflicts_with = "clamp_set")]
    clamp_at: Vec<u64>,
    /// Node set along the blade's tip: a line of nodes, or the whole tip, of which the middle is taken [default: the longest tip that is
    /// found]
    #[arg(long)]
    contact_set: Option<String>,
    /// Two nodes between which the contact line runs along the sharp edges of the skin, instead of a set
    #[arg(long, value_name = "NODE,NODE", value_parser = two_nodes, conflicts_with = "contact_set")]
    contact_between: Option<[u64; 2]>,
    /// Node of the smooth patch of the skin that is the tip, instead of a set: `--look` has its number
    #[arg(long, value_name = "NODE,…", value_delimiter = ',', conflicts_with_all = ["contact_set", "contact_between"])]
    contact_at: Vec<u64>,
    /// Curve of the shroud, instead of a set: a file with r and z of a point per line (.csv, a line of names first is allowed), in the units of
    /// the mesh; the tip that is nearest to it has the contact line
    #[arg(long, value_name = "FILE", conflicts_with_all = ["contact_set", "contact_between", "contact_at"])]
    shroud: Option<PathBuf>,
    /// Largest number of contact nodes, evenly spaced [default: 10]
    #[arg(long)]
    contact_nodes: Option<usize>,
    /// Units of length, force, time and mass of the file [default: mm,N,s,t]
    #[arg(long, value_parser = units)]
    units: Option<Units>,
    /// Name of the model [default: that of the file]
    #[arg(long)]
    name: Option<String>,
    /// JSON file of settings, as `POST /v1/models` takes them; options of this command go before it
    #[arg(long)]
    settings: Option<PathBuf>,
}

/// Makes the package, checks it as an upload would be, writes it and prints what was found.
pub(super) fn import(args: MeshArgs) -> anyhow::Result<()> {
    let MeshArgs { file: path, top_speed, look, mass_as_calculix, options, out, matrices } = args;
    let name = path.display().to_string();
    let file = read(&path)?;
    let mut settings = options.settings(&path, top_speed)?;
    if mass_as_calculix {
        settings.mass = MassRule::AsStiffness;
    }
    let Some(out) = out.filter(|_| !look) else {
        let seen = from_mesh::look(&file, &settings).with_context(|| name)?;
        return print(&looks::described(&seen));
    };
    let sector = from_mesh::sector(&file, &settings).with_context(|| name.clone())?;
    narrate(&sector.found.to_string())?;
    let package = sector.package().with_context(|| name)?;
    write(package, &out, matrices)
}

/// Reads a mesh file and those that it includes, from its own folder.
pub(super) fn read(path: &Path) -> anyhow::Result<MeshFile> {
    let name = path.display();
    let bytes = std::fs::read(path).with_context(|| format!("cannot read {name}"))?;
    let folder = path.parent().unwrap_or(Path::new("")).to_owned();
    let include = |file: &str| std::fs::read(folder.join(file)).map_err(|error| error.to_string());
    crate::mesh::read(&bytes, &include).with_context(|| name.to_string())
}

/// Checks a package as an upload would be, writes it and prints the findings.
pub(super) fn write(mut package: RawPackage, out: &Path, format: MatrixFormat) -> anyhow::Result<()> {
    package.manifest.store_matrices_as(format);
    let findings = crate::package::look_at(package.clone())
        .context("the model of this mesh does not pass the checks of a package")?;
    let file = File::create(out).with_context(|| format!("cannot create {}", out.display()))?;
    crate::package::write(&package, BufWriter::new(file))
        .with_context(|| format!("cannot write {}", out.display()))?;
    let mut text = String::new();
    describe_findings(&mut text, &findings)?;
    narrate(&text)?;
    narrate(&format!("Written: {}", out.display()))?;
    Ok(())
}

impl MeshOptions {
    /// Settings of the file of settings, with those of the command line before them.
    pub(super) fn settings(self, mesh: &Path, top_speed: Option<f64>) -> anyhow::Result<MeshSettings> {
        let mut settings = match &self.settings {
            None => MeshSettings::new(top_speed.unwrap_or_default()),
            Some(path) => {
                let text = std::fs::read(path).with_context(|| format!("cannot read {}", path.display()))?;
                // A top speed that is left out is refused by its value, where a model is made.
                MeshSettings::of_look(&text).with_context(|| path.display().to_string())?
            }
        };
        settings.top_speed_rad_s = top_speed.unwrap_or(settings.top_speed_rad_s);
        let stem = mesh.file_stem().map(|stem| stem.to_string_lossy().into_owned());
        settings.name = self.name.or(settings.name).or(stem);
        settings.sectors = self.sectors.or(settings.sectors);
        settings.axis = self.axis.or(settings.axis);
        if self.clamp_set.is_some() || !self.clamp_at.is_empty() {
            (settings.clamp_set, settings.clamp_at) = (self.clamp_set, self.clamp_at);
        }
        let is_chosen = self.contact_set.is_some() || self.contact_between.is_some();
        if is_chosen || !self.contact_at.is_empty() || self.shroud.is_some() {
            (settings.contact_set, settings.contact_between) = (self.contact_set, self.contact_between);
            settings.contact_at = self.contact_at;
            settings.shroud = self.shroud.as_deref().map(shroud::read).transpose()?;
        }
        settings.contact_nodes = self.contact_nodes.unwrap_or(settings.contact_nodes);
        settings.units = self.units.unwrap_or(settings.units);
        if let Some(temperature) = self.temperature {
            settings.temperatures = BTreeMap::from([("*".to_owned(), temperature)]);
        }
        let mut given = BTreeSet::new();
        for (name, constants) in self.materials {
            if !given.insert(name.clone()) {
                bail!("--material gives {name} twice");
            }
            settings.materials.insert(name, made(constants));
        }
        Ok(settings)
    }
}

fn made([youngs_modulus, poissons_ratio, density]: [f64; 3]) -> Material {
    Material {
        youngs_modulus,
        poissons_ratio,
        density,
        yield_strength: None,
        ultimate_strength: None,
        fatigue_strength: None,
    }
}

/// Reads a material: `NAME=E,NU,DENSITY`, or without a name for all elements.
fn material(text: &str) -> Result<(String, [f64; 3]), String> {
    let (name, constants) = text.rsplit_once('=').unwrap_or(("*", text));
    let numbers: Result<Vec<f64>, _> = constants.split(',').map(|number| number.trim().parse()).collect();
    match numbers.as_deref() {
        Ok(&[e, nu, density]) => Ok((name.trim().to_owned(), [e, nu, density])),
        _ => {
            Err("expected Young's modulus, Poisson's ratio and density, such as 114000,0.32,4.43e-9"
                .to_owned())
        }
    }
}

fn two_nodes(text: &str) -> Result<[u64; 2], String> {
    let numbers: Result<Vec<u64>, _> = text.split(',').map(|number| number.trim().parse()).collect();
    let pair = numbers.ok().and_then(|numbers| <[u64; 2]>::try_from(numbers).ok());
    pair.ok_or_else(|| "expected two node numbers, such as 97,1084".to_owned())
}
