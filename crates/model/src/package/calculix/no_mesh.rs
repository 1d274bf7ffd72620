//! Reasons why an import leaves the mesh out.

/// Reason why the package has no mesh, and so no stress.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NoMesh {
    /// Deck without `*ELEMENT`.
    #[error("the deck has no elements")]
    NoElements,
    /// Element type that is not known.
    #[error("elements of type {kind} are not known")]
    Type {
        /// Type in the deck.
        kind: String,
    },
    /// Element number that is given twice.
    #[error("element {element} is defined twice")]
    Twice {
        /// Number of the element.
        element: u64,
    },
    /// Element without section.
    #[error("element {element} is in no *SOLID SECTION")]
    NoSection {
        /// Number of the element.
        element: u64,
    },
    /// Section of a material that the deck does not define.
    #[error("the deck has no *MATERIAL, NAME={material}")]
    NoMaterial {
        /// Name of the material.
        material: String,
    },
    /// Material that is not isotropic.
    #[error(
        "the elasticity of material {material} is of type {kind}; only isotropic materials have stress here"
    )]
    Anisotropic {
        /// Name of the material.
        material: String,
        /// Type of `*ELASTIC`.
        kind: String,
    },
    /// Material constants that change with temperature.
    #[error("material {material} depends on temperature; give it constants of one temperature")]
    Temperature {
        /// Name of the material.
        material: String,
    },
    /// Material constant that is missing.
    #[error("material {material} has no {card}")]
    Lacking {
        /// Name of the material.
        material: String,
        /// Missing card: `*ELASTIC` or `*DENSITY`.
        card: &'static str,
    },
    /// Element of a wheel that cannot be assigned to a sector.
    #[error(
        "which sector element {element} belongs to cannot be told: none of its nodes is free and inside a sector"
    )]
    WhichSector {
        /// Number of the element.
        element: u64,
    },
    /// Wheel whose sectors have different numbers of elements.
    #[error("one sector has {sector} elements, and the wheel {wheel}, which is not {sectors} times as many")]
    Uneven {
        /// Number of elements of the sector.
        sector: usize,
        /// Number of elements of the deck that can move.
        wheel: usize,
        /// Number of sectors N.
        sectors: usize,
    },
    /// Mesh that the checks of every package refuse.
    #[error("{message}")]
    Refused {
        /// Message of the checks.
        message: String,
    },
}
