//! The whole reduction at k = 20 beside the plain way (a complex sparse factorisation of each nodal diameter and
//! speed, single-vector Lanczos), in one run: wall time, CPU time, phases and peak memory.
//!
//! `cargo bench --bench reduction -- [small] [medium] [paper] [plain]`: the sizes asked for (small and medium if
//! none is), `plain` with the baseline.

use std::cell::RefCell;
use std::time::Instant;

use rubmap::dynamics::reduction::{NoCheckpoints, ReductionOptions, reduce};
use rubmap::dynamics::sector::SectorModel;
use rubmap::impeller::{Preset, generate};
use rubmap::package::to_sector;

#[path = "../tests/oracle/mod.rs"]
#[allow(dead_code, reason = "shared with the tests, which use all of it")]
mod oracle;

const MODES: usize = 20;

fn sector(preset: Preset) -> SectorModel {
    let package = generate(&preset.parameters()).expect("a preset is sound");
    to_sector(package).expect("a generated package is valid")
}

/// Wall and CPU seconds since the start of the process.
fn now(start: Instant) -> (f64, f64) {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields: Vec<&str> = stat.rsplit(") ").next().unwrap_or("").split(' ').collect();
    let ticks =
        |index: usize| fields.get(index).and_then(|field| field.parse::<f64>().ok()).unwrap_or(f64::NAN);
    (start.elapsed().as_secs_f64(), (ticks(11) + ticks(12)) / 100.0)
}

/// A line of /proc/self/status in MB.
fn memory(name: &str) -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find(|line| line.starts_with(name)).unwrap_or("");
    line.split_whitespace().nth(1).and_then(|kb| kb.parse::<f64>().ok()).unwrap_or(f64::NAN) / 1e3
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with('-')).collect();
    let asked = |name: &str| arguments.iter().any(|argument| argument == name);
    let presets = [("small", Preset::Small), ("medium", Preset::Medium), ("paper", Preset::Paper)];
    let none = !presets.iter().any(|(name, _)| asked(name));
    let start = Instant::now();
    for (name, preset) in presets.into_iter().filter(|&(n, _)| asked(n) || (none && n != "paper")) {
        let sector = sector(preset);
        println!(
            "{name}: {} own DOF, N = {}, resident before {:.0} MB",
            sector.own_dofs(),
            sector.sectors,
            memory("VmRSS")
        );
        let last = RefCell::new((String::new(), now(start)));
        let begin = now(start);
        let watch = |share: f64, phase: &str| {
            let mut last = last.borrow_mut();
            if last.0 != phase {
                let (wall, cpu) = now(start);
                if !last.0.is_empty() {
                    println!("  {:7.2} s wall {:7.2} s CPU  {}", wall - last.1.0, cpu - last.1.1, last.0);
                }
                *last = (phase.to_owned(), (wall, cpu));
            }
            share <= 1.0
        };
        let wheel = reduce(&sector, &ReductionOptions::new(MODES), &NoCheckpoints, &watch).unwrap();
        let end = now(start);
        let (wall, cpu) = (end.0 - begin.0, end.1 - begin.1);
        println!(
            "  {:7.2} s wall {:7.2} s CPU  {}",
            end.0 - last.borrow().1.0,
            end.1 - last.borrow().1.1,
            last.borrow().0
        );
        println!("{name}: {wall:.1} s wall, {cpu:.1} s CPU, peak {:.0} MB", memory("VmHWM"));
        let residual = wheel.harmonics.iter().fold(0.0f64, |m, h| m.max(h.largest_mode_residual()));
        let difference =
            wheel.comparison.iter().filter_map(|c| c.largest_difference()).fold(0.0f64, |m, d| m.max(d.0));
        println!("  largest residual {residual:.1e}, largest difference of ten frequencies {difference:.2e}");
        if asked("plain") {
            let begin = now(start);
            for harmonic in 0..wheel.harmonics.len() {
                oracle::plain::reduce(&sector, harmonic, MODES, 1e-5, oracle::plain::Solver::Lanczos);
                let (wall, cpu) = now(start);
                println!(
                    "  plain, to nodal diameter {harmonic}: {:.1} s wall, {:.1} s CPU",
                    wall - begin.0,
                    cpu - begin.1
                );
            }
            let plain = now(start).1 - begin.1;
            println!("{name}: plain {plain:.1} s CPU, {:.1} times as much", plain / cpu);
        }
    }
}
