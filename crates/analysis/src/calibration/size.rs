//! Size of a wheel and its effects, on which the price of a step depends.

use rubmap_wheel::dynamics::modal_wheel::ModalWheel;
use rubmap_wheel::dynamics::schemes::Scheme;

/// Size of a wheel, on which the cost of a step depends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct StepSize {
    pub(crate) sectors: usize,
    /// Contact nodes of a sector; 0 where nothing can touch.
    pub(crate) nodes: usize,
    /// Real unknowns that are integrated.
    pub(crate) unknowns: usize,
}

impl StepSize {
    /// Number of products of a step. Reading an unknown's own recursion takes about as long as its mode shape at two nodes.
    pub(crate) fn products(self) -> f64 {
        (self.unknowns * (self.nodes + 2)) as f64
    }

    /// Number of products that take the Fourier coordinates to the normal displacements of all sectors.
    pub(crate) fn transforms(self) -> f64 {
        (self.sectors * self.sectors * self.nodes.next_multiple_of(8)) as f64
    }
}

/// Size of a wheel, on which the costs of effects depend.
#[derive(Debug, Clone, Copy)]
pub(crate) struct EffectSize {
    pub(crate) step: StepSize,
    /// Count of entries in the gyroscopic matrices of all nodal diameters.
    pub(crate) squares: usize,
}

impl EffectSize {
    /// Size of `wheel`, or the part of it that is simulated, with `nodes` contact nodes a sector that may touch.
    pub(crate) fn of(wheel: &ModalWheel, scheme: Scheme, nodes: usize) -> Self {
        let integrated = wheel
            .harmonics
            .iter()
            .map(|h| (scheme.integrated_modes(h.omega.len()), if h.single { 1 } else { 2 }));
        let unknowns = integrated.clone().map(|(modes, parts)| modes * parts).sum();
        // A pair reads the real and the imaginary part of its matrix.
        let squares = integrated.map(|(modes, parts)| modes * modes * parts).sum();
        Self { step: StepSize { sectors: wheel.sectors, nodes, unknowns }, squares }
    }

    /// Number of gaps of all sectors, padded as they are stored.
    pub(crate) fn gaps(self) -> usize {
        self.step.sectors * self.step.nodes.next_multiple_of(8)
    }
}
