//! Results that depend neither on the number of workers nor on where a fit was cut.

use crate::common::{Kept, request, targets, wheel};
use rubmap_fit::{Evaluation, FitResult, Problem, fit};
use serde_json::json;

fn problem() -> Problem {
    let sought = wheel(&json!({"rim_thickness": 7.8, "root_thickness": 1.9}));
    let bounds = json!({"rim_thickness": [5.0, 9.0], "root_thickness": [1.2, 2.4]});
    let mut request = request(wheel(&json!({})), bounds, targets(&sought, &[0.0, 24_000.0]));
    request.starts = 2;
    request.candidates = 3;
    request.iterations = 2;
    Problem::new(request).unwrap()
}

/// Result as bytes, and the evaluations that it took.
fn run(workers: usize, known: Vec<Evaluation>) -> (String, Vec<Evaluation>) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(workers).build().unwrap();
    let kept = Kept::default();
    let result: FitResult = pool.install(|| fit(&problem(), known, &kept)).unwrap();
    (serde_json::to_string(&result).unwrap(), kept.0.into_inner().unwrap())
}

#[test]
fn workers_and_cuts_change_no_byte() {
    let (alone, evaluations) = run(1, Vec::new());
    let (together, again) = run(2, Vec::new());
    assert_eq!(alone, together);
    assert_eq!(evaluations.len(), again.len());

    // A fit that was killed after a third of its evaluations computes the others alone.
    let cut = evaluations.len() / 3;
    let (resumed, left) = run(2, evaluations[..cut].to_vec());
    assert_eq!(alone, resumed);
    assert_eq!(left.len(), evaluations.len() - cut);
}
