//! `$MeshFormat`: version, encoding and order of bytes.

use crate::error::{MeshFileError, MeshProblem};
use crate::fields;

use super::source::Source;

/// Version of the format.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Version {
    /// Version 2.2.
    Two,
    /// Version 4.1.
    Four,
}

/// Reads the section.
pub(super) fn read(source: &mut Source<'_>) -> Result<Version, MeshFileError> {
    if source.section().as_deref() != Some("MeshFormat") {
        let expected = "$MeshFormat at the beginning".to_owned();
        return Err(MeshProblem::Expected { expected }.at(1, ""));
    }
    source.text_row("the version of the format")?;
    let word = source.word("the version of the format")?;
    let version = match word.as_ref() {
        "2.2" => Version::Two,
        "4.1" => Version::Four,
        other => {
            let what = format!("version {} of the MSH format", fields::quoted(other));
            let advice = "save the mesh as version 4.1 (Mesh.MshFileVersion=4.1) or 2.2";
            return Err(source.error(MeshProblem::NotCarried { what, advice }));
        }
    };
    let expected = "0 for ASCII or 1 for binary";
    let encoding = source.text_size(expected)?;
    let bytes = source.text_size("the number of bytes of a number")?;
    source.end_row()?;
    match encoding {
        0 => {}
        1 => binary(source, bytes)?,
        _ => return Err(source.error(MeshProblem::NotA { text: encoding.to_string(), expected })),
    }
    source.end()?;
    Ok(version)
}

/// Reads the mark of the order of bytes.
fn binary(source: &mut Source<'_>, bytes: u64) -> Result<(), MeshFileError> {
    let refused = |what: String, advice| MeshProblem::NotCarried { what, advice };
    if bytes != 8 {
        let what = format!("a binary file with numbers of {bytes} bytes");
        return Err(source.error(refused(what, "save the mesh as ASCII (Mesh.Binary=0)")));
    }
    source.set_binary();
    match source.integer("the mark of the order of bytes")? {
        1 => Ok(()),
        0x0100_0000 => {
            let what = "a binary file of a big-endian machine".to_owned();
            Err(source.error(refused(what, "save the mesh as ASCII (Mesh.Binary=0)")))
        }
        _ => {
            let expected = "the binary number 1 that marks the order of bytes".to_owned();
            Err(source.error(MeshProblem::Expected { expected }))
        }
    }
}
