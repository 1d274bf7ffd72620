//! `rubmap generate`: a model package from a few parameters.

use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use anyhow::Context;
use clap::Args;
use serde_json::Value;

use crate::cli::stdout::narrate;
use crate::impeller::{ImpellerRequest, PaperCasing, Preset, generate as generate_package};
use crate::package::raw::MatrixFormat;

/// Parameters of a model, and where its package is written.
#[derive(Debug, Args)]
pub struct GenerateArgs {
    /// Package to write
    #[arg(long, default_value = "impeller.zip")]
    pub out: PathBuf,
    /// JSON file with any of the generator's parameters, and a preset's name; what it leaves out comes from the preset
    #[arg(long)]
    pub parameters: Option<PathBuf>,
    /// Impeller to start from; overrides the file [default: small]
    #[arg(long)]
    pub preset: Option<Preset>,
    /// Number of sectors (main blades); overrides the file
    #[arg(long)]
    pub sectors: Option<usize>,
    /// Outlet radius, in the model's unit of length (mm); overrides the file
    #[arg(long)]
    pub outlet_radius: Option<f64>,
    /// Highest speed of the stiffness matrices in rad/s; overrides the file
    #[arg(long)]
    pub speed: Option<f64>,
    /// Number of contact nodes from leading to trailing edge; overrides the file
    #[arg(long)]
    pub contact_nodes: Option<usize>,
    /// Write the gyroscopic matrix too, for Coriolis forces; overrides the file
    #[arg(long)]
    pub gyroscopic: bool,
    /// Format in which the package stores its matrices
    #[arg(long, value_enum, default_value_t = MatrixFormat::Npz)]
    pub matrices: MatrixFormat,
    /// Print the parameters as JSON and stop: a start for a --parameters file
    #[arg(long)]
    pub print_parameters: bool,
}

/// Generates the package and writes it.
///
/// # Errors
/// Unreadable or impossible parameters, or a file that cannot be written.
pub fn generate(args: GenerateArgs) -> anyhow::Result<()> {
    let parameters = args.request()?.resolve()?;
    if args.print_parameters {
        narrate(&serde_json::to_string_pretty(&parameters)?)?;
        return Ok(());
    }
    let mut package = generate_package(&parameters)?;
    package.manifest.store_matrices_as(args.matrices);
    let file = File::create(&args.out).with_context(|| format!("cannot create {}", args.out.display()))?;
    crate::package::write(&package, BufWriter::new(file))
        .with_context(|| format!("cannot write {}", args.out.display()))?;
    narrate(&format!(
        "{}: {} sectors, {} DOF a sector, {} contact nodes, speeds up to {} rad/s ({:.0} rpm)",
        args.out.display(),
        package.manifest.sectors,
        package.dofs.len(),
        package.manifest.contact.len(),
        parameters.top_speed_rad_s,
        parameters.top_speed_rad_s * 30.0 / std::f64::consts::PI,
    ))?;
    let casing = PaperCasing::of(&parameters);
    narrate(&format!(
        "The paper's casing for it: clearance {} (leading) to {} (trailing), restriction {} {}",
        casing.leading_clearance, casing.trailing_clearance, casing.restriction, parameters.units.length,
    ))?;
    Ok(())
}

impl GenerateArgs {
    /// Request from the file, changed by the single options.
    fn request(&self) -> anyhow::Result<ImpellerRequest> {
        let mut request = match &self.parameters {
            Some(path) => read(path)?,
            None => ImpellerRequest::default(),
        };
        if let Some(preset) = self.preset {
            request.preset = preset;
        }
        let options = [
            ("sectors", self.sectors.map(Value::from)),
            ("outlet_radius", self.outlet_radius.map(Value::from)),
            ("top_speed_rad_s", self.speed.map(Value::from)),
            ("contact_nodes", self.contact_nodes.map(Value::from)),
            ("gyroscopic", self.gyroscopic.then(|| Value::from(true))),
        ];
        for (field, value) in options {
            if let Some(value) = value {
                request.overrides.insert(field.to_owned(), value);
            }
        }
        Ok(request)
    }
}

fn read(path: &Path) -> anyhow::Result<ImpellerRequest> {
    let text = std::fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))?;
    serde_json::from_str(&text).with_context(|| format!("{} is not a parameter set", path.display()))
}
