//! Errors of a model or of a computation on it.

/// Error of a model that cannot be reduced, or of a speed at which it cannot be evaluated.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ModelError {
    /// Stiffness K_ii or K(Ω) that is not positive definite.
    #[error(
        "the stiffness of nodal diameter {nodal_diameter} at {speed_rad_s} rad/s is not positive definite: {hint}"
    )]
    StiffnessNotPositiveDefinite {
        /// Nodal diameter i.
        nodal_diameter: usize,
        /// Speed Ω, rad/s.
        speed_rad_s: f64,
        /// Usual cause.
        hint: &'static str,
    },
    /// Wheel that can move without deforming.
    #[error(
        "nodal diameter {nodal_diameter} has {modes} rigid-body modes at {speed_rad_s} rad/s: is the hub constrained, \
         and does every part of the sector hang on it?"
    )]
    RigidBodyModes {
        /// Nodal diameter i.
        nodal_diameter: usize,
        /// Speed Ω, rad/s.
        speed_rad_s: f64,
        /// Number of rigid-body modes.
        modes: usize,
    },
    /// Mass that is negative for some motion, by more than round-off.
    #[error(
        "the mass is negative, by more than round-off, for a motion of nodal diameter {nodal_diameter} that DOF {dof} takes \
         part in (counted from 0 in the DOF table without its rows of the high face): is the density positive everywhere?"
    )]
    NegativeMass {
        /// Nodal diameter i.
        nodal_diameter: usize,
        /// Own DOF of the sector, from 0.
        dof: usize,
    },
    /// Request for more modes than there are.
    #[error(
        "nodal diameter {nodal_diameter} has fewer modes with mass than `modes_per_speed` asks for; ask for fewer"
    )]
    ModesWithoutMass {
        /// Nodal diameter i.
        nodal_diameter: usize,
    },
    /// Reduced mass that is not positive definite.
    #[error(
        "the reduced mass of nodal diameter {nodal_diameter} is not positive definite: the contact nodes have a motion \
         without mass among so many modes; ask for fewer `modes_per_speed`, or integrate the elements' mass in full"
    )]
    MassNotPositiveDefinite {
        /// Nodal diameter i.
        nodal_diameter: usize,
    },
    /// Eigenvalue iteration that did not reach its tolerance.
    #[error(
        "the fixed-interface modes of nodal diameter {nodal_diameter} at {speed_rad_s} rad/s did not converge: \
         residual {residual:.1e} after {iterations} block iterations"
    )]
    ModesNotConverged {
        /// Nodal diameter i.
        nodal_diameter: usize,
        /// Speed Ω, rad/s.
        speed_rad_s: f64,
        /// Largest relative residual.
        residual: f64,
        /// Number of block iterations done.
        iterations: usize,
    },
    /// Count of eigenvalues below a shift that exceeds the modes found.
    #[error(
        "fixed-interface modes of nodal diameter {nodal_diameter} at {speed_rad_s} rad/s were missed and not found in \
         further searches; fewer `modes_per_speed` may avoid a cluster of them"
    )]
    ModesMissed {
        /// Nodal diameter i.
        nodal_diameter: usize,
        /// Speed Ω, rad/s.
        speed_rad_s: f64,
    },
    /// Request for Coriolis forces of a model without gyroscopic matrix.
    #[error("the model has no gyroscopic matrix, so there are no Coriolis forces to simulate")]
    NoGyroscopicMatrix,
    /// Dense decomposition of a small reduced matrix that failed.
    #[error("the eigenvalue decomposition of nodal diameter {nodal_diameter} at {speed_rad_s} rad/s failed")]
    DecompositionFailed {
        /// Nodal diameter i.
        nodal_diameter: usize,
        /// Speed Ω, rad/s.
        speed_rad_s: f64,
    },
}

impl ModelError {
    /// Whether matrices that were written with few digits may be the cause.
    pub fn may_come_of_few_digits(&self) -> bool {
        matches!(
            self,
            Self::StiffnessNotPositiveDefinite { .. }
                | Self::ModesNotConverged { .. }
                | Self::ModesMissed { .. }
                | Self::DecompositionFailed { .. }
        )
    }
}
