//! Baseline: the paper's scheme (Eqs 8–10) with dense matrices over the whole wheel.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};
use rubmap::dynamics::casing::Casing;

use crate::oracle::{DenseScheme, DenseWheel, free_gaps};
use crate::scene::{DAMPING, SPEED, Scene};

/// The literal scheme from rest, with the casing tabulated beforehand.
pub(crate) struct Literal {
    pub(crate) scheme: DenseScheme,
    steps: usize,
    /// Gaps c − p by step of the revolution: while the restriction grows, and after.
    gaps: [Vec<Vec<f64>>; 2],
    taken: usize,
}

impl Literal {
    pub(crate) fn new(scene: &Scene, steps: usize) -> Self {
        let wheel = DenseWheel::new(&scene.reduced.wheel, SPEED, scene.stiffening);
        let h = TAU / (SPEED * steps as f64);
        Self {
            scheme: DenseScheme::new(&wheel, &wheel.modal_damping(DAMPING), &scene.reduced.wheel, h),
            steps,
            gaps: [Vec::new(), Vec::new()],
            taken: 0,
        }
    }

    /// Puts `casing` in its place and begins to count revolutions.
    pub(crate) fn face(&mut self, scene: &Scene, casing: &Casing) {
        assert!(casing.ramp_revolutions <= 1.0, "the second revolution stands for all that follow");
        let at = |revolution: usize, step: usize| {
            free_gaps(casing, &scene.reduced.wheel, revolution as f64 + step as f64 / self.steps as f64)
        };
        self.gaps = [0, 1].map(|revolution| (1..=self.steps).map(|step| at(revolution, step)).collect());
        self.taken = 0;
    }

    /// Takes `steps` steps; returns the share of them with contact.
    pub(crate) fn advance(&mut self, steps: usize) -> f64 {
        self.scheme.contact_steps = 0;
        for _ in 0..steps {
            let gaps = &self.gaps[usize::from(self.taken >= self.steps)];
            self.scheme.step(&gaps[self.taken % self.steps], active_set);
            self.taken += 1;
        }
        self.scheme.contact_steps as f64 / steps as f64
    }
}

/// Solves contact by Eq. 10 on the penetrating nodes, then exchanges until the problem is complementary: a fair contact
/// solver for the baseline, as Gauss–Seidel would slow it down.
fn active_set(w: &DMatrix<f64>, gap: &DVector<f64>, lambda: &mut DVector<f64>) {
    let mut active: Vec<usize> = (0..gap.len()).filter(|&i| gap[i] < 0.0).collect();
    for _ in 0..100 {
        let block = w.select_columns(&active).select_rows(&active);
        let rhs = DVector::from_iterator(active.len(), active.iter().map(|&i| -gap[i]));
        let solved = block.cholesky().expect("W is positive definite").solve(&rhs);
        lambda.fill(0.0);
        for (&i, &l) in active.iter().zip(&solved) {
            lambda[i] = l;
        }
        let after = gap + w * &*lambda;
        let keep = |i: &usize| if lambda[*i] != 0.0 { lambda[*i] > 0.0 } else { after[*i] < -1e-12 };
        let next: Vec<usize> = (0..gap.len()).filter(keep).collect();
        if next == active {
            return;
        }
        active = next;
    }
}
