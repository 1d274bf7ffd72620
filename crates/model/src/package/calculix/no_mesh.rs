//! Why an import leaves the mesh out.

/// Why the package has no mesh, and so no stress.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NoMesh {
    /// No `*ELEMENT`.
    #[error("the deck has no elements")]
    NoElements,
    /// A type that is not known.
    #[error("elements of type {kind} are not known")]
    Type {
        /// The type.
        kind: String,
    },
    /// An element number that is given twice.
    #[error("element {element} is defined twice")]
    Twice {
        /// Its number.
        element: u64,
    },
    /// An element without section.
    #[error("element {element} is in no *SOLID SECTION")]
    NoSection {
        /// Its number.
        element: u64,
    },
    /// A section of a material that the deck does not define.
    #[error("the deck has no *MATERIAL, NAME={material}")]
    NoMaterial {
        /// Its name.
        material: String,
    },
    /// A material that is not isotropic.
    #[error(
        "the elasticity of material {material} is of type {kind}; only isotropic materials have stress here"
    )]
    Anisotropic {
        /// Its name.
        material: String,
        /// The type of `*ELASTIC`.
        kind: String,
    },
    /// Constants that change with temperature.
    #[error("material {material} depends on temperature; give it constants of one temperature")]
    Temperature {
        /// Its name.
        material: String,
    },
    /// A constant that is lacking.
    #[error("material {material} has no {card}")]
    Lacking {
        /// Its name.
        material: String,
        /// `*ELASTIC` or `*DENSITY`.
        card: &'static str,
    },
    /// A wheel whose elements cannot be told apart by sector.
    #[error(
        "which sector element {element} belongs to cannot be told: none of its nodes is free and inside a sector"
    )]
    WhichSector {
        /// Its number.
        element: u64,
    },
    /// A wheel whose sectors have different numbers of elements.
    #[error("one sector has {sector} elements, and the wheel {wheel}, which is not {sectors} times as many")]
    Uneven {
        /// Elements kept.
        sector: usize,
        /// Elements of the deck that can move.
        wheel: usize,
        /// N.
        sectors: usize,
    },
    /// What the checks of every package say of the mesh.
    #[error("{message}")]
    Refused {
        /// Their words.
        message: String,
    },
}
