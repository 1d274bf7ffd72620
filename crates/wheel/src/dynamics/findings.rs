//! Findings about a sector: its size in SI units, and what in its matrices looks wrong, in words.

use std::f64::consts::TAU;
use std::fmt;

use serde::{Deserialize, Serialize};

/// Share of stiffening or softening below which it counts as none.
const NONE: f64 = 1e-3;

/// Most nodes that a sentence names.
const SHOWN: usize = 8;

/// Fewest inner nodes of which it is said that they are out of balance.
const FEWEST_JUDGED: usize = 10;

/// Largest distance of a share from the number that is reported for it.
const SHARE: f64 = 0.05;

/// Radians per second of one revolution per minute.
const RPM: f64 = std::f64::consts::TAU / 60.0;

/// Young's moduli of solids that turn, from rubber to diamond, Pa.
const USUAL_MODULUS: [f64; 2] = [1e6, 1.3e12];

/// Densities of solids, from foam to osmium, kg/m³.
const USUAL_DENSITY: [f64; 2] = [10.0, 2.3e4];

/// Wave speeds √(E/ρ), from rubber to diamond, m/s.
const USUAL_WAVE_SPEED: [f64; 2] = [20.0, 2e4];

/// Speeds of the tips of wheels, m/s: no metal bears more than about 800.
const USUAL_TIP_SPEED: [f64; 2] = [1.0, 1500.0];

/// Radii of wheels, m.
const USUAL_RADIUS: [f64; 2] = [1e-3, 20.0];

/// Mass over cube of the radius, kg/m³: more would be denser than a cylinder of osmium that is as long as it is wide.
const MOST_MASS: f64 = 1.5e5;

/// Findings about a package.
#[derive(Debug, Clone, PartialEq)]
pub struct Findings {
    /// Findings about the stiffness at each speed above 0.
    pub spin: Vec<SpinAtSpeed>,
    /// Noise of matrices of few digits; none where all digits are there, or no node is free.
    pub digits: Option<DigitNoise>,
    /// Counts of inner nodes in balance, where they are too few.
    pub unbalanced: Option<Unbalanced>,
    /// Too few pairs of face nodes in balance, if so.
    pub open_joint: Option<OpenJoint>,
    /// Mass that differs by direction, if so.
    pub uneven_mass: Option<UnevenMass>,
    /// Contact nodes and normals that no blade tip has.
    pub odd_contact: OddContact,
    /// Size and materials in SI units; none where a unit is not known.
    pub in_si: Option<InSi>,
}

impl Findings {
    /// Sentences about the findings that look wrong, except those about K(Ω).
    pub fn warnings(&self) -> Vec<String> {
        let digits = self.digits.iter().map(DigitNoise::warning);
        let unbalanced = self.unbalanced.iter().map(Unbalanced::warning);
        let unbalanced = unbalanced.chain(self.open_joint.iter().map(OpenJoint::warning));
        let unbalanced = unbalanced.chain(self.uneven_mass.iter().map(UnevenMass::warning));
        let unbalanced = unbalanced.chain(self.odd_contact.warnings());
        unbalanced.chain(digits).chain(self.in_si.iter().flat_map(InSi::warnings)).collect()
    }
}

/// Counts of inner nodes of which fewer than a tenth are in balance, in every known reading of the rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Unbalanced {
    /// Number of nodes in balance.
    balanced: usize,
    /// Number of nodes inside the sector with three components.
    inner: usize,
}

impl Unbalanced {
    /// Returns the counts if fewer than a tenth of ten or more inner nodes are in balance: the inner nodes of an elastic solid are, but for
    /// a few beside clamps and supports.
    pub fn of(balanced: usize, inner: usize) -> Option<Self> {
        (inner >= FEWEST_JUDGED && 10 * balanced < inner).then_some(Self { balanced, inner })
    }

    fn warning(&self) -> String {
        format!(
            "rigid motions of the sector make forces at all but {} of {} inner nodes, where an elastic solid has them beside clamps and supports \
             alone: check that the DOF table lists the rows as the matrices have them, and `frame`, `axis` and positions",
            self.balanced, self.inner
        )
    }
}

/// Pairs of nodes on the cyclic faces of which fewer than a tenth are in balance, although most nodes inside the sector are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct OpenJoint {
    /// Pairs in balance.
    balanced: usize,
    /// Pairs with three components.
    pairs: usize,
}

impl OpenJoint {
    /// Returns the counts if fewer than a tenth of ten or more `pairs` are in balance, and more than half of the `inner` nodes are.
    pub fn of(balanced: usize, pairs: usize, balanced_inner: usize, inner: usize) -> Option<Self> {
        let fits = pairs < FEWEST_JUDGED || 10 * balanced >= pairs || 2 * balanced_inner <= inner;
        (!fits).then_some(Self { balanced, pairs })
    }

    fn warning(&self) -> String {
        format!(
            "with the sectors joined, rigid motions of the wheel make forces at all but {} of {} pairs of nodes on the cyclic faces, where an \
             elastic solid has them beside clamps and supports alone: check that the rows of the high face are those of its nodes, in their \
             order, frame and sign, and that the part of one face is not in both diagonal blocks",
            self.balanced, self.pairs
        )
    }
}

/// Nodes whose mass is not the same in all directions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct UnevenMass {
    /// Nodes of which this is so.
    pub uneven: usize,
    /// Nodes with three components.
    pub nodes: usize,
}

impl UnevenMass {
    fn warning(&self) -> String {
        format!(
            "the mass at {} of {} nodes is not the same in all directions, where that of a solid is: check that the rows of the mass matrix \
             are in the order and frame of those of the stiffness",
            self.uneven, self.nodes
        )
    }
}

/// Contact nodes and normals that no blade tip has, by the ids of the nodes.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct OddContact {
    /// Nodes at which the line from leading to trailing edge doubles back.
    pub doubling_back: Vec<u64>,
    /// Nodes whose normal is opposite to that of the node before.
    pub flipped: Vec<u64>,
    /// Nodes whose normal runs along the line.
    pub along_tip: Vec<u64>,
    /// Nodes whose normal runs around the axis.
    pub around_axis: Vec<u64>,
}

impl OddContact {
    fn warnings(&self) -> impl Iterator<Item = String> + '_ {
        let of = [
            (
                &self.doubling_back,
                "the line of contact nodes doubles back at",
                "list them from leading to trailing edge",
            ),
            (&self.flipped, "contact normals turn over at", "let all point from the blade to the casing"),
            (
                &self.along_tip,
                "contact normals run along the line of contact nodes at",
                "let each be that of its node",
            ),
            (
                &self.around_axis,
                "contact normals run around the axis at",
                "let them point from the tip to the casing",
            ),
        ];
        of.into_iter().filter(|(nodes, ..)| !nodes.is_empty()).map(|(nodes, what, advice)| {
            let shown: Vec<String> = nodes.iter().take(SHOWN).map(u64::to_string).collect();
            let more = if nodes.len() > SHOWN { ", …" } else { "" };
            let node = if nodes.len() == 1 { "node" } else { "nodes" };
            format!("{what} {node} {}{more}: {advice}", shown.join(", "))
        })
    }
}

/// Finding about the stiffness at one speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpinAtSpeed {
    /// Speed, rad/s.
    pub speed_rad_s: f64,
    /// Verdict on the stiffness at this speed.
    pub finding: SpinFinding,
}

/// Verdict on a stiffness at speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SpinFinding {
    /// Geometric stiffness and spin softening on the undeformed geometry, within the residual.
    Undeformed {
        /// Residual of the identity, relative to its right-hand side.
        residual: f64,
    },
    /// Geometric stiffness and spin softening on the undeformed geometry, but not as much of each as mass and speed say.
    Shares {
        /// Share of geometric stiffness, 1 where it is right.
        stiffening: f64,
        /// Share of spin softening, 1 where it is right.
        softening: f64,
        /// Residual of the identity, relative to its right-hand side.
        residual: f64,
    },
    /// Stiffness of something else: the deformed geometry, stresses of another load or of a sector whose ties were open.
    Other {
        /// Residual of the identity, relative to its right-hand side.
        residual: f64,
    },
    /// Stiffness that was not checked: no row is free of clamps and cyclic faces.
    NotChecked,
    /// Stiffness that was not checked: round-off of the entries hides the identity.
    Hidden,
}

impl SpinFinding {
    /// Whether the finding makes frequencies wrong at the given speeds already.
    pub fn is_wrong_at_speed(self) -> bool {
        matches!(self, Self::Shares { .. })
    }

    /// Residual of a stiffness that passed the check.
    pub fn residual(self) -> Option<f64> {
        match self {
            Self::Undeformed { residual } => Some(residual),
            _ => None,
        }
    }

    /// Whether the stiffness was checked and fits no shares.
    pub fn is_other(self) -> bool {
        matches!(self, Self::Other { .. })
    }
}

impl fmt::Display for SpinFinding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Undeformed { residual } => {
                write!(
                    f,
                    "geometric stiffness and spin softening on the undeformed geometry (residual {residual:.1e})"
                )
            }
            Self::Shares { stiffening, softening, residual } => {
                shares(f, stiffening, softening)?;
                write!(f, " (residual {residual:.2})")
            }
            Self::Other { residual } => write!(
                f,
                "NOT that of the undeformed geometry under this speed (residual {residual:.1e}); between the speeds it will be \
                 wrong (docs/method.md, Centrifugal stiffening)"
            ),
            Self::NotChecked => f.write_str("not checked, no node is free of clamps and faces"),
            Self::Hidden => f.write_str("not checked, the matrices have too few digits"),
        }
    }
}

fn shares(f: &mut fmt::Formatter<'_>, stiffening: f64, softening: f64) -> fmt::Result {
    let near = |share: f64, is: f64| (share - is).abs() <= SHARE * is.max(1.0);
    if near(stiffening, 1.0) && near(softening, 0.0) {
        return f.write_str("WITHOUT spin softening: export K_e + K_σ − Ω²M_spin (CalculiX: repeat *DLOAD, CENTRIF in the exporting step)");
    }
    if near(stiffening, 1.0) && near(softening, 2.0) {
        return f
            .write_str("with TWICE the spin softening: the exporting program subtracts Ω²M_spin already, do not subtract it again");
    }
    if near(stiffening, 0.0) && near(softening, 1.0) {
        return f.write_str("WITHOUT geometric stiffness: export under the centrifugal pre-stress");
    }
    if stiffening.abs().max(softening.abs()) <= NONE {
        return f.write_str("that at rest: it does NOT change with speed");
    }
    if stiffening > 0.0 && (stiffening / softening - 1.0).abs() <= SHARE {
        let factor = stiffening.sqrt();
        let rpm = [
            (RPM, "the speeds are in rpm, and belong in rad/s"),
            (1.0 / RPM, "the stiffness was computed at speeds in rad/s taken for rpm"),
        ];
        let hint = rpm.iter().find(|(of, _)| (factor / of - 1.0).abs() < 0.01).map_or("", |(_, hint)| *hint);
        write!(f, "that of {factor:.4} times this speed by mass and positions")?;
        return if hint.is_empty() {
            f.write_str(": check the speeds and the units of the mass")
        } else {
            write!(f, ": probably {hint}")
        };
    }
    write!(
        f,
        "NOT that of this speed: by mass and positions it has {stiffening:.3} times the geometric stiffness and {softening:.3} times the \
         spin softening"
    )
}

/// Noise of the stiffness matrix at rest.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct DigitNoise {
    /// Median over the nodes in balance of the forces against rigid motions, as a part of Σ|K_ij| times the size of the sector.
    pub residual: f64,
    /// Change that the noise may make to the square of an angular frequency, rad²/s².
    pub square_rad2_s2: f64,
    /// Whether the entries have all digits, so that the forces have another cause.
    #[serde(default)]
    pub has_all_digits: bool,
}

impl DigitNoise {
    /// Relative change that the noise may make to the natural frequency `frequency_hz`, Hz.
    pub fn change_of(&self, frequency_hz: f64) -> f64 {
        0.5 * self.square_rad2_s2 / (TAU * frequency_hz).powi(2)
    }

    /// Sentence about the noise.
    pub fn warning(&self) -> String {
        let at = |frequency_hz: f64| 100.0 * self.change_of(frequency_hz);
        if self.has_all_digits {
            return format!(
                "rigid motions leave forces of {:.1e} of the entries of the stiffness matrix at rest, which has all digits, so that double \
                 precision would leave 1e-14: check that it is the matrix at rest, without springs to ground, and that positions are those \
                 of the undeformed model",
                self.residual
            );
        }
        format!(
            "the stiffness matrix at rest has few digits: rigid motions leave forces of {:.1e} of its entries, where double precision \
             leaves 1e-14. This may change a frequency of 100 Hz by {:.2} % and one of 1000 Hz by {:.4} %: export all digits",
            self.residual,
            at(100.0),
            at(1000.0)
        )
    }
}

/// Size and materials in SI units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct InSi {
    /// Mass of the whole wheel without nodes that are clamped, kg.
    pub mass_kg: f64,
    /// Largest distance of a contact node from the axis, m.
    pub contact_radius_m: f64,
    /// Speed of that node at the highest speed of the stiffness matrices, m/s; absent where that is 0, and for models stored by an earlier
    /// version.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tip_speed_m_s: Option<f64>,
    /// Whole wheel by its elements; absent without elements, and for models stored by an earlier version.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wheel: Option<WheelInSi>,
    /// Materials of the element sets, in the order of their names.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub materials: Vec<MaterialInSi>,
}

/// Body of the whole wheel in SI units, clamped elements included.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct WheelInSi {
    /// Volume, m³.
    pub volume_m3: f64,
    /// Mass, kg.
    pub mass_kg: f64,
    /// Place of the centre of mass along the axis, from the axis's origin, m.
    pub centre_m: f64,
    /// Moment of inertia about the axis, kg m².
    pub polar_inertia_kg_m2: f64,
}

/// Material of an element set in SI units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct MaterialInSi {
    /// Name of the element set.
    pub set: String,
    /// Young's modulus, Pa.
    pub youngs_modulus_pa: f64,
    /// Density, kg/m³.
    pub density_kg_m3: f64,
    /// Wave speed √(E/ρ), m/s: some 5,000 in metals.
    pub wave_speed_m_s: f64,
}

impl InSi {
    /// Sentences about values that no wheel has.
    fn warnings(&self) -> Vec<String> {
        let mut found = Vec::new();
        let mut expect = |value: f64, [least, most]: [f64; 2], of: &str, unit: &str, solids: &str| {
            if !(least..=most).contains(&value) {
                found.push(format!(
                    "{of} is {value:.3e} {unit}; {solids} from {least:e} to {most:e} {unit}: check the value and the units"
                ));
            }
        };
        for MaterialInSi { set, youngs_modulus_pa, density_kg_m3, wave_speed_m_s } in &self.materials {
            let of = |what: &str| format!("{what} of \"{set}\"");
            expect(*youngs_modulus_pa, USUAL_MODULUS, &of("Young's modulus"), "Pa", "solids have");
            expect(*density_kg_m3, USUAL_DENSITY, &of("the density"), "kg/m³", "solids have");
            expect(*wave_speed_m_s, USUAL_WAVE_SPEED, &of("√(E/ρ)"), "m/s", "solids have");
        }
        expect(self.contact_radius_m, USUAL_RADIUS, "the radius of the contact nodes", "m", "wheels have");
        if let Some(speed) = self.tip_speed_m_s {
            expect(
                speed,
                USUAL_TIP_SPEED,
                "the speed of the tips at the highest speed of the stiffness",
                "m/s",
                "wheels have",
            );
        }
        let most = MOST_MASS * self.contact_radius_m.powi(3);
        if self.mass_kg > most {
            found.push(format!(
                "the wheel has a mass of {:.3e} kg within a radius of {:.3e} m, more than any solid of that size: check the units",
                self.mass_kg, self.contact_radius_m
            ));
        }
        found
    }
}
