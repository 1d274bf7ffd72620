//! Reasons why a speed cannot be integrated.

use crate::digits::short;
use crate::request::auto_or::MOST_STEPS;
use rubmap_wheel::dynamics::contact::coating::CoatingError;
use rubmap_wheel::dynamics::contact::friction::FrictionError;
use rubmap_wheel::dynamics::error::ModelError;
use rubmap_wheel::dynamics::schemes::Scheme;

/// Reason why a speed cannot be integrated, and what to change. It ends the speed, not the sweep.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub(crate) enum NotRunnable {
    /// Model error: the reduced sector cannot be evaluated at this speed.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// Sensor at a node of which no rows of the basis were read.
    #[error("the basis of the reduction was not read at node {id}, where a sensor is")]
    UnreadNode { id: u64 },
    /// Stress that was not read beside the reduction.
    #[error("the stress of the reduction was not read, and this sweep records it")]
    UnreadStress,
    /// Cold clearances without the growth of the tips, which was not read beside the reduction.
    #[error("the growth of the tips was not read, and this scene has its clearances cold")]
    UnreadGrowth,
    /// Euler force that was not read beside the reduction.
    #[error("the Euler force was not read, and this run-up has it")]
    UnreadEulerForce,
    /// Bending of second order that was not read beside the reduction.
    #[error("the bending of second order was not read, and this scene has it")]
    UnreadBending,
    /// Sensor along the normal of a node that has none.
    #[error("node {id}, where a sensor is, has no normal: only contact nodes have")]
    NoNormal { id: u64 },
    /// Friction error: the wheel cannot slide.
    #[error(transparent)]
    Friction(#[from] FrictionError),
    /// Coating that cannot be simulated.
    #[error(transparent)]
    Coating(#[from] CoatingError),
    /// Fixed step beyond the stability limit.
    #[error("{steps} steps per revolution are unstable at this speed; at least {smallest} are needed")]
    Unstable { steps: u32, smallest: u64 },
    /// Scheme without any stable step.
    #[error("{}", no_stable_step(*.0))]
    NoStableStep(Scheme),
    /// Step that carries no mode of a boundary without mass.
    #[error(
        "{steps} steps per revolution carry no mode of a boundary without mass: take more, or another scheme"
    )]
    NoModeCarried { steps: f64 },
    /// Speed that would need more steps than a request may ask for.
    #[error(
        "this speed would need {steps:.1e} steps per revolution, more than {MOST_STEPS}: it is too slow for the highest frequency \
         of the reduced wheel, or the lobes are too narrow"
    )]
    TooManySteps { steps: f64 },
    /// Heights of the casing at all steps that take too much memory.
    #[error(
        "the casing's table would take {size} values at {steps} steps per revolution: take fewer steps, a multiple of the \
         {sectors} sectors, or wider lobes"
    )]
    Table { size: usize, steps: usize, sectors: usize },
    /// Initial mode that does not exist.
    #[error(
        "nodal diameter {nodal_diameter} of the reduced wheel has {families} modal families, not {family}"
    )]
    NoSuchFamily { nodal_diameter: u32, families: usize, family: u32 },
    /// Initial mode that is not kept.
    #[error(
        "the initial mode is family {family} of nodal diameter {nodal_diameter}, of which {kept_modes} are kept: keep more, or take \
         another scheme"
    )]
    FamilyNotKept { family: u32, nodal_diameter: u32, kept_modes: usize },
    /// Initial mode that is not integrated.
    #[error(
        "the initial mode, family {family} of nodal diameter {nodal_diameter}, is too fast for the step and would follow statically: \
         take more steps_per_revolution"
    )]
    FamilyFollows { family: u32, nodal_diameter: u32 },
    /// Initial mode that is too large.
    #[error(
        "the initial mode stands inside the casing at rest: at this speed /scene/initial/amplitude is at most {} in the model's unit of length",
        short(0.9995 * largest)
    )]
    InsideCasing { largest: f64 },
    /// Initial state that belongs to another reduction.
    #[error("the neighbouring speed ended in a state of another reduction: run the sweep again")]
    OtherReduction,
}

/// Message of [`NotRunnable::NoStableStep`].
fn no_stable_step(scheme: Scheme) -> String {
    match scheme {
        Scheme::MasslessBoundary { kept_modes } => format!(
            "with {kept_modes} modes per nodal diameter kept, those left out give the boundary no flexibility: keep fewer, \
             leave kept_modes away, or reduce with more modes_per_speed"
        ),
        Scheme::CentralDifferences | Scheme::ExactModal => {
            "no number of steps per revolution is stable: the speed is too slow".to_owned()
        }
    }
}
