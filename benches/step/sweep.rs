//! Scaling of a sweep with workers: `run_speed`, which is what a job does with each speed, on one and on two threads.

use std::sync::atomic::{AtomicUsize, Ordering};

use rubmap::analysis::monitor::Unwatched;
use rubmap::analysis::request::SchemeChoice;
use rubmap::analysis::request::auto_or::AutoOr;
use rubmap::analysis::resolved::ResolvedSweep;
use rubmap::analysis::result::{PointStatus, SpeedResult};
use rubmap::analysis::run::{ReducedSector, run_speed};

use crate::scene::{SPEED, Scene};
use crate::timing::{Contender, medians, timed};

const SPEEDS: usize = 24;
const REVOLUTIONS: usize = 10;
const WORKERS: [usize; 2] = [1, 2];
const ROUNDS: usize = 5;

pub(crate) fn measure() {
    let scene = Scene::new(60, 1);
    let speeds = (0..SPEEDS).map(|index| SPEED * (1.0 - 0.2 * index as f64 / SPEEDS as f64)).collect();
    let request = scene.request(SchemeChoice::Auto, AutoOr::Auto, REVOLUTIONS, speeds);
    let mut results = WORKERS.map(|_| Vec::new());
    let mut contenders: Vec<Contender<'_>> = Vec::new();
    for (workers, results) in WORKERS.into_iter().zip(&mut results) {
        let (reduced, request) = (&scene.reduced, &request);
        contenders.push(Box::new(move || {
            let (swept, time) = timed(|| sweep(reduced, request, workers));
            *results = swept;
            time
        }));
    }
    let times = medians(ROUNDS, &mut contenders);
    drop(contenders);
    assert!(results[0].iter().all(|result| result.point.status == PointStatus::Completed));
    assert_eq!(results[0], results[1], "the number of workers changes results");
    println!("\nA sweep of {SPEEDS} speeds, {REVOLUTIONS} revolutions each, 900 unknowns, `auto`:\n");
    println!("| workers | s | speeds/s | over one worker |");
    println!("|---|---|---|---|");
    for (workers, time) in WORKERS.into_iter().zip(&times) {
        println!("| {workers} | {time:.2} | {:.1} | {:.2} |", SPEEDS as f64 / time, times[0] / time);
    }
}

/// Results of all speeds, in order, from `workers` threads that take the next speed when they are done with one.
fn sweep(reduced: &ReducedSector, request: &ResolvedSweep, workers: usize) -> Vec<SpeedResult> {
    let next = AtomicUsize::new(0);
    let worker = || {
        let mut done = Vec::new();
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            if index >= SPEEDS {
                return done;
            }
            let mut result = run_speed(reduced, request, index, None, &Unwatched).expect("nobody cancels");
            // Wall time is all that may differ from run to run.
            result.point.wall_time_s = 0.0;
            done.push(result);
        }
    };
    let mut results: Vec<SpeedResult> = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..workers).map(|_| scope.spawn(worker)).collect();
        threads.into_iter().flat_map(|thread| thread.join().expect("a speed panicked")).collect()
    });
    results.sort_by_key(|result| result.point.index);
    results
}
