//! Impeller that commands make where none is given, in the casing that the paper would give it.

use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use anyhow::Context;
use serde_json::{Value, json};

use crate::cli::stdout::narrate;
use crate::impeller::{ImpellerParameters, Material, PaperCasing, generate};
use rubmap_solid::material::FatigueStrength;

/// Impeller of the default size with the strengths of its titanium: of annealed Ti-6Al-4V, the least that its standard allows, and a fatigue
/// strength that handbooks give for polished specimens.
fn parameters() -> ImpellerParameters {
    let source = "Ti-6Al-4V, annealed: typical of polished specimens at R = -1 and 1e7 cycles";
    let material = Material {
        yield_strength: Some(828.0),
        ultimate_strength: Some(895.0),
        fatigue_strength: Some(FatigueStrength { amplitude: 500.0, source: source.to_owned() }),
        ..Material::default()
    };
    ImpellerParameters { material, ..ImpellerParameters::default() }
}

/// Makes the impeller and leaves its package in the out folder.
pub(in crate::cli) fn make_package(out: &Path) -> anyhow::Result<PathBuf> {
    let path = out.join("impeller.zip");
    let package = generate(&parameters())?;
    let file = File::create(&path).with_context(|| format!("cannot create {}", path.display()))?;
    crate::package::write(&package, BufWriter::new(file))
        .with_context(|| format!("cannot write {}", path.display()))?;
    narrate(&format!(
        "package   {}: {} sectors of {} DOF, {} contact nodes",
        path.display(),
        package.manifest.sectors,
        package.dofs.len(),
        package.manifest.contact.len()
    ))?;
    Ok(path)
}

/// Scene with a casing ovalised by more than the clearance, so that two lobes push every tip twice a revolution.
pub(in crate::cli) fn scene() -> Value {
    let casing = PaperCasing::of(&ImpellerParameters::default());
    json!({
        "centrifugal_stiffening": true,
        "damping": {"modal_ratio": 0.005},
        "casing": {
            "clearance": {"leading": casing.leading_clearance, "trailing": casing.trailing_clearance},
            "lobes": {"count": 2, "amplitude": casing.restriction, "width_rad": 0.35},
        },
        "contact": {},
    })
}
