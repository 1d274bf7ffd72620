//! The effects that a scene may name: the list from which all else follows.

/// Hands the list to the macro `$to`. Every effect comes with its description in the contract, its name, and the type of its field in a request. The
/// name is a field of scenes (`request/scene.rs`, `resolved/scene.rs`) and the folder beside this file whose `EFFECT` is one of the table
/// (`table.rs`).
macro_rules! effects {
    ($to:ident) => {
        $to! {
            /// Whether the stiffness is K(Ω) by the package's three stiffness matrices (Eq. 3); otherwise it is the stiffness at rest.
            #[serde(default)]
            centrifugal_stiffening: bool,
            /// Modal damping; absent: none.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            damping: Option<crate::effects::damping::request::Damping>,
            /// The casing around the wheel; absent: the wheel spins freely.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            casing: Option<crate::effects::casing::request::Casing>,
            /// Clearances that close and open during the run; absent: they stay.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            clearance_change: Option<crate::effects::clearance_change::request::ClearanceChange>,
            /// Unilateral contact between blade tips and casing; absent: tips pass through it.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            contact: Option<crate::effects::contact::request::Contact>,
            /// Coriolis forces through the package's gyroscopic matrix: forward and backward waves split. Spin softening, their
            /// companion, is part of `centrifugal_stiffening`: name both.
            #[serde(default, skip_serializing_if = "is_false")]
            coriolis: bool,
            /// Coulomb friction at the contact; absent: none.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            friction: Option<crate::effects::friction::request::Friction>,
            /// Abradable coating of the casing; absent: blades touch the metal.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            abradable: Option<crate::effects::abradable::request::Abradable>,
            /// Elastic casing; absent: rigid.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            flexible_casing: Option<crate::effects::flexible_casing::request::FlexibleCasing>,
            /// Blades that bend far; absent: linear theory.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            geometric_nonlinearity: Option<crate::effects::geometric_nonlinearity::request::GeometricNonlinearity>,
            /// Stiffness deviations of the sectors; absent: a tuned wheel.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            mistuning: Option<crate::effects::mistuning::request::Mistuning>,
            /// Harmonic forces at engine orders.
            #[serde(default, skip_serializing_if = "Vec::is_empty")]
            engine_order_excitation: Vec<crate::effects::engine_order_excitation::request::EngineOrderExcitation>,
            /// Eccentric casing or whirling shaft; absent: the wheel turns about the casing's axis.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            orbit: Option<crate::effects::orbit::request::Orbit>,
            /// State that the wheel starts from; absent: rest.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            initial: Option<crate::effects::initial::request::Initial>,
            /// Part of the wheel that is simulated.
            #[serde(default, skip_serializing_if = "crate::effects::symmetry::request::Symmetry::is_full")]
            symmetry: crate::effects::symmetry::request::Symmetry,
            /// Asymmetry that `symmetry: probe` starts from; absent: its defaults.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            probe: Option<crate::effects::probe::request::Probe>,
        }
    };
}
pub(crate) use effects;
