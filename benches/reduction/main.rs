//! Whole reduction at k = 20 beside the plain way (a complex sparse factorisation of each nodal diameter and speed,
//! single-vector Lanczos), in one run: wall time, CPU time, phases and peak memory.
//!
//! `cargo bench --bench reduction -- [small] [medium] [half] [paper] [plain]`: the sizes asked for (small and medium if
//! none is), `plain` with the baseline. `-- solve`: the limits of its solves.

use std::cell::RefCell;
use std::process::Command;
use std::time::Instant;

use rubmap::dynamics::reduction::{NoCheckpoints, ReductionError, ReductionOptions, reduce};
use rubmap::dynamics::sector::SectorModel;
use rubmap::impeller::{ImpellerParameters, MeshDensities, Preset, generate};
use rubmap::package::to_sector;

mod solve;

#[path = "../../tests/oracle/mod.rs"]
#[allow(dead_code, reason = "shared with the tests, which use all of it")]
mod oracle;

const MODES: usize = 20;
/// Phases by what their progress texts contain.
const PHASES: [&str; 6] =
    ["ordering", "factorisation", "modes of nodal diameter", "full sector", "counting", "projecting"];
/// Phases that only prove the result. The full sector's modes at the given speeds, searched together with the basis's, are not among them.
const CHECKS: [&str; 2] = ["full sector", "counting"];

fn sector(parameters: &ImpellerParameters) -> SectorModel {
    let package = generate(parameters).expect("the sizes are sound");
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

/// Value of a line of /proc/self/status, MB.
fn memory(name: &str) -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find(|line| line.starts_with(name)).unwrap_or("");
    line.split_whitespace().nth(1).and_then(|kb| kb.parse::<f64>().ok()).unwrap_or(f64::NAN) / 1e3
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with('-')).collect();
    let asked = |name: &str| arguments.iter().any(|argument| argument == name);
    let half = MeshDensities {
        between_contact_nodes: 3,
        blade_height: 11,
        disk: 6,
        ..Preset::Paper.parameters().mesh
    };
    let sizes = [
        ("small", Preset::Small.parameters()),
        ("medium", Preset::Medium.parameters()),
        ("half", ImpellerParameters { mesh: half, ..Preset::Paper.parameters() }),
        ("paper", Preset::Paper.parameters()),
    ];
    if asked("solve") {
        solve::measure();
    }
    let none = !asked("solve") && !sizes.iter().any(|(name, _)| asked(name));
    let wanted: Vec<_> =
        sizes.iter().filter(|(n, _)| asked(n) || (none && ["small", "medium"].contains(n))).collect();
    if wanted.len() > 1 {
        // Each size runs in a process of its own, so that it does not count memory that another leaves behind.
        let this = std::env::current_exe().expect("a benchmark is a file");
        for (name, _) in wanted {
            let plain = asked("plain").then_some("plain");
            let ended = Command::new(&this).arg(name).args(plain).status().expect("it runs");
            assert!(ended.success(), "{name}: {ended}");
        }
        return;
    }
    let start = Instant::now();
    for (name, parameters) in wanted {
        let sector = sector(parameters);
        println!(
            "{name}: {} own DOF, N = {}, resident before {:.0} MB",
            sector.own_dofs(),
            sector.sectors,
            memory("VmRSS")
        );
        let limited = ReductionOptions { memory_bytes: Some(0), ..ReductionOptions::new(MODES) };
        let refused = reduce(&sector, &limited, &NoCheckpoints, &|_, _| true);
        if let Err(ReductionError::Memory { needed_bytes, .. }) = refused {
            println!("  estimated need {:.0} MB", needed_bytes as f64 / 1e6);
        }
        let begin = now(start);
        // Phase and times at its start; (phase, wall, CPU) of the phases done.
        let current = RefCell::new(("ordering", begin));
        let done: RefCell<Vec<(&str, f64, f64)>> = RefCell::default();
        let enter = |phase: &'static str| {
            let mut current = current.borrow_mut();
            let (wall, cpu) = now(start);
            let mut done = done.borrow_mut();
            let entry = match done.iter().position(|(known, _, _)| *known == current.0) {
                Some(index) => &mut done[index],
                None => {
                    done.push((current.0, 0.0, 0.0));
                    done.last_mut().expect("just pushed")
                }
            };
            entry.1 += wall - current.1.0;
            entry.2 += cpu - current.1.1;
            *current = (phase, (wall, cpu));
        };
        let watch = |_: f64, text: &str| {
            if let Some(phase) = PHASES.iter().find(|phase| text.contains(**phase)) {
                enter(phase);
            }
            true
        };
        let wheel =
            reduce(&sector, &ReductionOptions::new(MODES), &NoCheckpoints, &watch).expect("a sound sector");
        enter("");
        let end = now(start);
        let (wall, cpu) = (end.0 - begin.0, end.1 - begin.1);
        let mut proper = cpu;
        for (phase, wall, cpu) in done.borrow().iter() {
            println!("  {wall:7.2} s wall {cpu:7.2} s CPU  {phase}");
            if CHECKS.contains(phase) {
                proper -= cpu;
            }
        }
        let residual = wheel.harmonics.iter().fold(0.0f64, |m, h| m.max(h.largest_mode_residual()));
        let difference =
            wheel.comparison.iter().filter_map(|c| c.largest_difference()).fold(0.0f64, |m, d| m.max(d.0));
        println!(
            "{name}: {wall:.1} s wall, {cpu:.1} s CPU, of it {proper:.1} s without the checks of their own, peak {:.0} MB",
            memory("VmHWM")
        );
        println!("  largest residual {residual:.1e}, largest difference of ten frequencies {difference:.1e}");
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
            println!(
                "{name}: plain {plain:.1} s CPU, {:.1} times as much; {:.1} times without the checks it does not make",
                plain / cpu,
                plain / proper
            );
        }
    }
}
