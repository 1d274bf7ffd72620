//! Trace of contact over a return map: all that the linearised flow needs to know of it.

use faer::Mat;
use rubmap_numerics::dense::Dense;

/// Contact nodes that touched together.
#[derive(Debug, Clone)]
pub struct Touching {
    /// Sector and contact node of each.
    pub places: Vec<(usize, usize)>,
    /// Stiffness: forces per predicted penetration, W⁻¹ among the nodes.
    pub stiffness: Mat<f64>,
}

/// Contact during a return map, step by step.
#[derive(Debug, Clone, Default)]
pub struct Trace {
    /// Sets of nodes, in the order in which they touched.
    pub sets: Vec<Touching>,
    /// Steps at whose end a set touched, counted from 1 (0: the start), with the number of the set.
    pub instants: Vec<(usize, usize)>,
}

impl Trace {
    /// Whether the same nodes touched at the same steps: between two such states the flow is affine.
    pub fn is_alike(&self, other: &Self) -> bool {
        let places = |trace: &Self| trace.sets.iter().map(|set| set.places.clone()).collect::<Vec<_>>();
        self.instants == other.instants && places(self) == places(other)
    }

    pub(super) fn clear(&mut self) {
        self.sets.clear();
        self.instants.clear();
    }

    /// Records that `places` touched at the end of `step`, `w` being W among them, and whether it is symmetric.
    pub(super) fn touch(
        &mut self,
        step: usize,
        places: impl Iterator<Item = (usize, usize)>,
        w: impl Fn(usize, usize) -> f64,
        symmetric: bool,
    ) {
        let places: Vec<_> = places.collect();
        if places.is_empty() {
            return;
        }
        if self.sets.last().is_none_or(|last| last.places != places) {
            let w = Mat::from_fn(places.len(), places.len(), w);
            let definite = symmetric.then(|| f64::definite_inverse(w.as_ref())).flatten();
            // Not symmetric, or as far from definite as round-off.
            let stiffness = definite.unwrap_or_else(|| f64::inverse(w.as_ref()));
            self.sets.push(Touching { places, stiffness });
        }
        self.instants.push((step, self.sets.len() - 1));
    }
}
