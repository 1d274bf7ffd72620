//! Cards that are no part of a mesh: refused, left out, or skipped.

use super::card::Card;

/// Way to go with a card.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Other {
    /// Content that changes the model.
    Refused(&'static str, &'static str),
    /// Element of a line or surface.
    LeftOut,
    /// Material that is refused where a solid element has it.
    Material,
    /// Load, parameter, property or request.
    Skipped,
    /// Card that is not known.
    Unknown,
}

const SOLIDS_ONLY: &str = "a model is of solid elements only: model it by these, or take it out of the file";
const MATRIX: &str = "take it out of the file and give it to `rubmap import matrices` beside the mesh";
const ONE_MESH: &str = "make it one mesh, with the nodes of both sides in common";

/// Beginnings of the names of cards that are refused, what they are, and the way to go.
const REFUSED: [(&[&str], &str, &str); 9] = [
    (&["RBE", "RBAR", "RROD", "RTRPLT", "RJOINT"], "a rigid element", SOLIDS_ONLY),
    (&["RSPLINE", "RSSCON", "MPC"], "a multi-point constraint", SOLIDS_ONLY),
    (&["CELAS", "CBUSH", "GENEL"], "a spring", SOLIDS_ONLY),
    (&["CDAMP", "CVISC"], "a damper", SOLIDS_ONLY),
    (&["CONM", "CMASS"], "a point mass", SOLIDS_ONLY),
    (&["CFAST", "CWELD", "CSEAM", "CINTC"], "a connector", ONE_MESH),
    (&["BCONTACT", "BCTSET", "BCTABLE", "BGSET", "BGADD", "CGAP"], "contact or glue", ONE_MESH),
    (&["DMI"], "a matrix", MATRIX),
    (
        &["PLSOLID", "PLCOMPS", "PCOMPS"],
        "a property of layers or of large strains",
        "give solid elements a PSOLID",
    ),
];

/// Names of elements of lines and surfaces.
const LEFT_OUT: [&str; 17] = [
    "CQUAD4", "CQUAD8", "CQUADR", "CQUAD", "CQUADX", "CTRIA3", "CTRIA6", "CTRIAR", "CTRIAX", "CTRIAX6",
    "CSHEAR", "CBAR", "CBEAM", "CBEND", "CROD", "CTUBE", "PLOTEL",
];

/// Beginnings of the names of cards that are skipped. Properties begin with P.
const SKIPPED: [&str; 33] = [
    "P", "EIG", "FORCE", "MOMENT", "RFORCE", "GRAV", "LOAD", "TEMP", "TABLE", "TABD", "FREQ", "TSTEP",
    "NLPARM", "NLSTEP", "DLOAD", "RLOAD", "TLOAD", "DAREA", "SLOAD", "LSEQ", "SPCD", "ACCEL", "SUPORT",
    "ASET", "BSET", "CSET", "QSET", "OMIT", "USET", "DELAY", "DPHASE", "DEFORM", "MDLPRM",
];

impl Other {
    /// Way to go with a card.
    pub(super) fn of(card: &Card) -> Self {
        let name = card.name.as_str();
        let begins = |beginnings: &[&str]| beginnings.iter().any(|beginning| name.starts_with(beginning));
        if LEFT_OUT.contains(&name) || name == "CONROD" {
            return Self::LeftOut;
        }
        if let Some((_, what, advice)) = REFUSED.iter().find(|(names, ..)| begins(names)) {
            return Self::Refused(what, advice);
        }
        if ["MAT2", "MAT3", "MAT8", "MAT9", "MAT10", "MAT11", "MATT1", "MATHP", "MATHE"].contains(&name) {
            return Self::Material;
        }
        if begins(&SKIPPED) { Self::Skipped } else { Self::Unknown }
    }
}
