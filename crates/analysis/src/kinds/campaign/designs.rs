//! Designs to be simulated: values of all parameters.

use crate::request::{DesignKind, Parameter};
use crate::resolved::Distribution;
use rubmap_numerics::sampling::{latin_hypercube, sobol_point};
use rubmap_numerics::sensitivity_indices;

/// Number of levels of a grid along a parameter.
pub(crate) fn levels(parameter: &Parameter, distribution: &Distribution) -> f64 {
    distribution.own_levels().unwrap_or_else(|| parameter.levels.unwrap_or(1).into())
}

/// Designs of a layout, `[design][parameter]`, by quantiles of points of the unit cube; none for a list, whose designs are given.
pub(crate) fn designs(
    kind: DesignKind,
    (size, seed): (usize, u32),
    parameters: &[Parameter],
    distributions: &[Distribution],
) -> Vec<Vec<f64>> {
    let dimensions = distributions.len();
    let points = match kind {
        DesignKind::Grid => return grid(parameters, distributions),
        DesignKind::List => return Vec::new(),
        DesignKind::LatinHypercube => latin_hypercube(size, dimensions, seed.into()),
        DesignKind::Sobol => (0..size).map(|index| sobol_point(index, dimensions, seed)).collect(),
        DesignKind::Indices => sensitivity_indices::design(size, dimensions, seed),
    };
    points.iter().map(|point| quantiles(point, distributions)).collect()
}

/// Values of the added design `index`, except for the parameter of the threshold: they continue along a Sobol sequence.
pub(crate) fn added(index: usize, seed: u32, distributions: &[&Distribution]) -> Vec<f64> {
    quantiles(&sobol_point(index, distributions.len(), seed), distributions.iter().copied())
}

/// Values of parameters at a point of the unit cube.
pub(super) fn quantiles<'a>(
    point: &[f64],
    distributions: impl IntoIterator<Item = &'a Distribution>,
) -> Vec<f64> {
    point.iter().zip(distributions).map(|(&u, distribution)| distribution.quantile(u)).collect()
}

fn grid(parameters: &[Parameter], distributions: &[Distribution]) -> Vec<Vec<f64>> {
    let mut designs = vec![Vec::new()];
    for (parameter, distribution) in parameters.iter().zip(distributions) {
        let levels = levels(parameter, distribution) as usize;
        let along = |design: Vec<f64>| {
            (0..levels).map(move |level| {
                let mut design = design.clone();
                design.push(distribution.level(level, levels));
                design
            })
        };
        designs = designs.into_iter().flat_map(along).collect();
    }
    designs
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn a_grid_has_all_combinations() {
        let parameter = |levels: Option<u32>| -> Parameter {
            serde_json::from_value(json!({"name": "p", "at": ["/scene/x"], "levels": levels})).unwrap()
        };
        let parameters = [parameter(Some(3)), parameter(None)];
        let distributions = [Distribution::Uniform(0.0, 1.0), Distribution::Values(vec![5.0, 7.0])];
        let found = designs(DesignKind::Grid, (0, 0), &parameters, &distributions);
        let expected = [[0.0, 5.0], [0.0, 7.0], [0.5, 5.0], [0.5, 7.0], [1.0, 5.0], [1.0, 7.0]];
        assert_eq!(found, expected);
    }

    #[test]
    fn what_is_drawn_lies_where_its_distribution_says() {
        let distributions = [Distribution::Uniform(2.0, 4.0), Distribution::Whole(1.0, 4.0)];
        for (kind, count) in
            [(DesignKind::LatinHypercube, 64), (DesignKind::Sobol, 64), (DesignKind::Indices, 4 * 64)]
        {
            let found = designs(kind, (64, 5), &[], &distributions);
            assert_eq!(found.len(), count);
            assert!(found.iter().all(|design| (2.0..4.0).contains(&design[0])));
            for whole in 1..=4 {
                let hits = found.iter().filter(|design| design[1] == f64::from(whole)).count();
                assert_eq!(hits, count / 4, "{kind:?}");
            }
        }
    }
}
