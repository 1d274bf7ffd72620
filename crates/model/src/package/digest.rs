//! Content address of a package.
//!
//! The address depends on the *values* `sector.json` states, and on the decompressed bytes of every other file under its name. It does not depend on
//! how the archive is made (order, compression, times, folders' entries), on whether a file is stored as `m.mtx` or `m.mtx.gz` (`.gz` is
//! dropped from names, inside `sector.json` too), or on the layout of `sector.json` (white space, order of fields). For a `.npz` matrix its
//! arrays count, not how they are zipped (numpy writes the time of day there, and compresses or not). Two texts of the same numbers (`1.0`
//! and `1e0` in a matrix) are two contents.

use std::fmt::{self, Write};

use sha2::{Digest, Sha256};

use super::raw::Manifest;

/// Version of the rules above, changed with them, so that no old address can name a new content.
const RULES: &str = "rubmap package 1";

/// Lowercase hexadecimal SHA-256 of a package, from the manifest and the `(name, sha256)` of the other files.
pub(super) fn digest<'a>(manifest: &Manifest, files: impl Iterator<Item = (&'a str, [u8; 32])>) -> String {
    let mut total = Sha256::new();
    let mut part = |bytes: &[u8]| {
        // Lengths first: no two lists of parts can run together into the same bytes.
        total.update((bytes.len() as u64).to_le_bytes());
        total.update(bytes);
    };
    part(RULES.as_bytes());
    let mut manifest = manifest.clone();
    for name in [&mut manifest.mass, &mut manifest.nodes, &mut manifest.dofs]
        .into_iter()
        .chain(&mut manifest.stiffness)
        .chain(&mut manifest.gyroscopic)
        .chain(manifest.mesh.as_mut().map(|mesh| &mut mesh.elements))
    {
        *name = plain(name).to_owned();
    }
    part(format!("{:?}", Stated(&manifest)).as_bytes());
    let mut files: Vec<_> = files.map(|(name, hash)| (plain(name), hash)).collect();
    files.sort_unstable();
    files.dedup();
    for (name, hash) in files {
        part(name.as_bytes());
        part(&hash);
    }
    total.finalize().iter().fold(String::with_capacity(64), |mut hex, byte| {
        let _ = write!(hex, "{byte:02x}");
        hex
    })
}

/// Manifest as it is hashed: prints every field by name and every number shortest-round-trip; optional entries only where they are given,
/// so that older packages keep their address.
struct Stated<'a>(&'a Manifest);

impl fmt::Debug for Stated<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Manifest {
            name,
            sectors,
            units,
            axis,
            speeds_rad_s,
            frame,
            mass,
            stiffness,
            gyroscopic,
            nodes,
            dofs,
            cyclic,
            contact,
            mesh,
        } = self.0;
        let mut fields = f.debug_struct("Manifest");
        fields.field("name", name).field("sectors", sectors).field("units", units).field("axis", axis);
        fields.field("speeds_rad_s", speeds_rad_s).field("frame", frame);
        fields.field("mass", mass).field("stiffness", stiffness);
        if let Some(file) = gyroscopic {
            fields.field("gyroscopic", file);
        }
        fields.field("nodes", nodes).field("dofs", dofs).field("cyclic", cyclic).field("contact", contact);
        if let Some(mesh) = mesh {
            fields.field("mesh", mesh);
        }
        fields.finish()
    }
}

/// Name of a file without `.gz`.
fn plain(name: &str) -> &str {
    name.strip_suffix(".gz").unwrap_or(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Manifest without optional entries: older packages were addressed by all that `Debug` printed, when there was no gyroscopic entry.
    #[test]
    fn a_package_without_optional_entries_is_stated_as_ever() {
        let text = r#"{"name": "w", "sectors": 3, "units": {"length": "mm", "force": "N", "time": "s", "mass": "t"},
            "axis": {"origin": [0, 0, 0], "direction": [0, 0, 1]}, "speeds_rad_s": [0], "frame": "cartesian", "mass": "m",
            "stiffness": ["k"], "nodes": "n", "dofs": "d", "cyclic": [[1, 2]], "contact": [{"node": 3, "normal": [1, 0, 0]}]}"#;
        let mut manifest: Manifest = serde_json::from_str(text).unwrap();
        let derived = format!("{manifest:?}");
        assert_eq!(
            format!("{:?}", Stated(&manifest)),
            derived.replace("gyroscopic: None, ", "").replace(", mesh: None", "")
        );
        manifest.gyroscopic = Some("g".to_owned());
        assert_eq!(
            format!("{:?}", Stated(&manifest)),
            format!("{manifest:?}").replace(r#"Some("g")"#, r#""g""#).replace(", mesh: None", "")
        );
    }
}
