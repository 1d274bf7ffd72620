//! Indices of campaigns that tell how much of a variance each parameter makes.

use std::f64::consts::PI;

use rubmap_numerics::sensitivity_indices::{decompose, design};

use crate::claim::{Check, Claim, Computed, Subject};

pub(crate) const ROWS: &[Claim] = &[Claim {
    name: "sensitivity-indices",
    covers: &[Subject::Kind("campaign")],
    claim: "Sensitivity indices of a campaign are shares of the variance.",
    reference: "closed form: function of Ishigami and Homma (1990), V₁ = ½(1 + bπ⁴/5)², V₂ = a²/8, V₁₃ = 8b²π⁸/225",
    quantity: "largest error of three first-order and three total indices, 4096 blocks",
    check: Check::Computed(Computed {
        error: ishigami,
        wrong: "coefficient a",
        limit: 6e-3,
        reason: "sampling by 4096 blocks of Sobol points",
    }),
}];

fn ishigami(wrong: f64) -> anyhow::Result<f64> {
    let (a, b) = (7.0, 0.1);
    let f = |point: &Vec<f64>| {
        let [x, y, z] = [point[0], point[1], point[2]].map(|u| PI * (2.0 * u - 1.0));
        Some(x.sin() + wrong * a * y.sin().powi(2) + b * z.powi(4) * x.sin())
    };
    let values: Vec<_> = design(4096, 3, 1).iter().map(f).collect();
    let found = decompose(&values, 3).ok_or_else(|| anyhow::anyhow!("no indices"))?;
    let v1 = 0.5 * (1.0 + b * PI.powi(4) / 5.0f64).powi(2);
    let (v2, v13) = (a * a / 8.0, 8.0 * b * b * PI.powi(8) / 225.0);
    let all = v1 + v2 + v13;
    let exact = [[v1, v1 + v13], [v2, v2], [0.0, v13]];
    let errors = found.inputs.iter().zip(exact).flat_map(|(found, [first, total])| {
        [found.first_order.value - first / all, found.total.value - total / all]
    });
    Ok(errors.fold(0.0, |most: f64, error| most.max(error.abs())))
}
