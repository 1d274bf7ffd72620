//! Files of fields that commands write: the ends of their names tell their formats.

use std::fs::File;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use clap::Args;
use zip::ZipArchive;

use super::client::Client;
use super::session::save;
use crate::cli::stdout::narrate;

/// Part of the wheel that is written, and where the work is done.
#[derive(Debug, Args)]
pub(super) struct FieldFileArgs {
    /// Sector to write alone, from 0 [default: all]
    #[arg(long)]
    sector: Option<u32>,
    /// Add stress, for which the package needs a mesh
    #[arg(long)]
    stress: bool,
    /// Phase in degrees
    #[arg(long, allow_negative_numbers = true)]
    phase: Option<f64>,
    /// Files of a .pvd over its time [default: 24]
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=96))]
    frames: Option<u16>,
    /// Folder in which model and reduction stay, so that a second run need not make them again [default: none stay]
    #[arg(long)]
    work: Option<PathBuf>,
    /// Threads that compute [default: one per core]
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(super) workers: Option<u16>,
}

/// Folder to work in: one that stays, or one that is removed when this is dropped.
pub(super) enum WorkFolder {
    Kept(PathBuf),
    Passing(tempfile::TempDir),
}

impl WorkFolder {
    pub(super) fn path(&self) -> &Path {
        match self {
            Self::Kept(path) => path,
            Self::Passing(folder) => folder.path(),
        }
    }
}

impl FieldFileArgs {
    /// Gives the folder to work in, and makes it if it is temporary.
    ///
    /// # Errors
    /// A folder that cannot be made.
    pub(super) fn folder(&self) -> anyhow::Result<WorkFolder> {
        Ok(match &self.work {
            Some(path) => WorkFolder::Kept(path.clone()),
            None => WorkFolder::Passing(tempfile::tempdir().context("cannot make a folder to work in")?),
        })
    }

    /// Downloads a field from `path`, to whose query more can be added, into `out`; for a `.pvd` its files beside it.
    ///
    /// # Errors
    /// A file that cannot be written, or what the service refuses.
    pub(super) async fn save(&self, client: &Client, path: &str, out: &Path) -> anyhow::Result<()> {
        let form = form(out)?;
        let mut path = format!("{path}format={form}&stress={}", self.stress);
        if let Some(sector) = self.sector {
            path += &format!("&sector={sector}");
        }
        if let Some(phase) = self.phase {
            path += &format!("&phase_deg={phase}");
        }
        if let Some(frames) = self.frames.filter(|_| form == "pvd") {
            path += &format!("&frames={frames}");
        }
        if form == "pvd" {
            let zip = tempfile::NamedTempFile::new().context("cannot make a file to work in")?;
            client.save(&path, zip.path()).await?;
            unpack(zip.path(), out)?;
        } else {
            client.save(&path, out).await?;
        }
        narrate(&format!("written   {}", out.display()))?;
        Ok(())
    }
}

/// Format that the end of a file's name tells.
///
/// # Errors
/// A name with any other end.
fn form(out: &Path) -> anyhow::Result<&'static str> {
    let known = ["vtu", "vtp", "npz", "pvd", "svg", "png"];
    let ending = out.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
    match known.into_iter().find(|form| *form == ending) {
        Some(form) => Ok(form),
        None => bail!("{}: the name must end with one of .{}", out.display(), known.join(", .")),
    }
}

/// Refuses at once a name that could not be written in the end: one that tells no format, or whose folder is not there.
///
/// # Errors
/// A name without a known end, or a folder that is not there.
pub(super) fn check(out: &Path) -> anyhow::Result<()> {
    form(out)?;
    let folder = out.parent().filter(|folder| !folder.as_os_str().is_empty());
    match folder.filter(|folder| !folder.is_dir()) {
        Some(folder) => bail!("cannot write {}: there is no folder {}", out.display(), folder.display()),
        None => Ok(()),
    }
}

/// Unpacks a series of files beside `out`: their names begin with that of the list.
fn unpack(zip: &Path, out: &Path) -> anyhow::Result<()> {
    let mut zip = ZipArchive::new(File::open(zip)?)?;
    let stem = out.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let renamed = |name: &str| name.replacen("series", &stem, 1);
    for index in 0..zip.len() {
        let mut entry = zip.by_index(index)?;
        let name = entry.name().context("a file of the series has no name")?.into_owned();
        if name.ends_with(".pvd") {
            let text = std::io::read_to_string(&mut entry)?;
            save(out, &text.replace("file=\"series", &format!("file=\"{stem}")))?;
            continue;
        }
        let path = out.with_file_name(renamed(&name));
        let mut file = File::create(&path).with_context(|| format!("cannot create {}", path.display()))?;
        std::io::copy(&mut entry, &mut file).with_context(|| format!("cannot write {}", path.display()))?;
    }
    Ok(())
}
