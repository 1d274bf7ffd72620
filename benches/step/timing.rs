//! Times of several contenders in one run.

use std::time::Instant;

/// Measures something once, in seconds per unit of it.
pub(crate) type Contender<'a> = Box<dyn FnMut() -> f64 + 'a>;

/// Runs `work`; returns its result and the seconds it takes.
pub(crate) fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let start = Instant::now();
    let done = work();
    (done, start.elapsed().as_secs_f64())
}

/// Medians of the values that `contenders` return over `rounds` in which they take turns, after one that does not count.
pub(crate) fn medians(rounds: usize, contenders: &mut [Contender<'_>]) -> Vec<f64> {
    let mut values = vec![Vec::with_capacity(rounds); contenders.len()];
    for round in 0..=rounds {
        for (contender, values) in contenders.iter_mut().zip(&mut values) {
            let value = contender();
            if round > 0 {
                values.push(value);
            }
        }
    }
    values.into_iter().map(median).collect()
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
