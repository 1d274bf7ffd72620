//! Element types of CalculiX and Abaqus.

use rubmap_solid::element::ElementKind;

/// Element type of a deck.
pub(super) enum DeckKind {
    /// Solid, read as `kind`; `note` says so where the type is another.
    Solid { kind: ElementKind, note: bool },
    /// Point, line or surface, which a model has no use for.
    LeftOut,
    /// Type that couples nodes or has no counterpart.
    Refused,
}

/// Beginnings of the names of lines and surfaces.
const LEFT_OUT: [&str; 17] = [
    "S3", "S4", "S6", "S8", "S9", "STRI", "M3D", "CPE", "CPS", "CAX", "B2", "B3", "T2", "T3", "SFM3D", "R3D",
    "SURF",
];

/// Type by its name in capitals.
pub(super) fn kind(name: &str) -> DeckKind {
    let solid = |kind| DeckKind::Solid { kind, note: false };
    let read_as = |kind| DeckKind::Solid { kind, note: true };
    if let Some(kind) = ElementKind::named(name).filter(|&kind| kind != ElementKind::QM6) {
        return solid(kind);
    }
    match name {
        "C3D8R" | "C3D8IH" | "C3D8RH" | "C3D8T" | "C3D8RT" => read_as(ElementKind::C3D8I),
        "C3D8H" => read_as(ElementKind::C3D8),
        "C3D4H" | "C3D4T" => read_as(ElementKind::C3D4),
        "C3D6H" | "C3D6T" => read_as(ElementKind::C3D6),
        "C3D10M" | "C3D10H" | "C3D10MH" | "C3D10I" | "C3D10HS" | "C3D10T" | "C3D10MT" => {
            read_as(ElementKind::C3D10)
        }
        "C3D15H" => read_as(ElementKind::C3D15),
        "C3D20H" | "C3D20T" => read_as(ElementKind::C3D20),
        "C3D20RH" | "C3D20RT" => read_as(ElementKind::C3D20R),
        name if LEFT_OUT.iter().any(|begins| name.starts_with(begins)) => DeckKind::LeftOut,
        _ => DeckKind::Refused,
    }
}
