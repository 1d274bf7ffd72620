//! An abradable coating, as it is asked for.

use serde::{Deserialize, Serialize};

use crate::effects::asked::Plain;

/// Coating of elasto-plastic rods that stand on the casing and are worn by the blades (Legrand, Batailly, Pierre, J. Comput.
/// Nonlinear Dyn. 7, 2012); stresses in the model's units. The clearance is that to the unworn coating.
///
/// A rod of area A resists with Aσ, σ = E(ε − ε_p) up to the yield stress σ_Y + Kε_p; plastic strain ε_p stays and is worn off: the
/// worn depth is ε_p times the thickness. All blades press the same coating, new at the start of every speed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Abradable {
    /// Young's modulus E of the coating, force/length². Thermally sprayed aluminium-polyester: some GPa.
    pub modulus: f64,
    /// Yield stress σ_Y, force/length², from 0 to below the modulus, which a blade must overcome to wear anything at all: some 10 MPa for coatings
    /// made to be rubbed.
    pub yield_stress: f64,
    /// Plastic modulus K of linear hardening, force/length²: how much more a rod resists the deeper it is worn. At least a
    /// millionth of the modulus; usually fitted to a rub test, well below the modulus.
    pub hardening: f64,
    /// Thickness, length. Behind it is metal, which a blade meets once it has worn through.
    pub thickness: f64,
    /// Rods around the circumference, one row for every contact node along the chord; at least four for every sector, so that
    /// blades share none, and no more than there are steps per revolution, so that no step jumps one.
    ///
    /// A tip presses one rod at a time: the width 2πr/`rods_around` is that of the contact across the tip, and forces are
    /// proportional to it. 2000 of them are 0.3 mm wide at a radius of 100 mm; choose the number that makes a rod as wide as your
    /// tips are thick.
    #[serde(default = "default_rods_around")]
    #[cfg_attr(feature = "schema", schema(minimum = 4))]
    pub rods_around: u32,
}

fn default_rods_around() -> u32 {
    2000
}

impl Plain for Option<Abradable> {}
