//! Cost of a step and cost of accuracy, every scheme beside the literal dense step of the paper (Eqs 8–10, two dense
//! products), in one run, which needs an otherwise idle machine.
//!
//! `cargo bench --bench step -- [330] [540] [900] [1140] [1560] [sectors] [price] [kernel] [accuracy] [reductions] [sweep]`, all if none
//! is named. Contenders take turns, so that what disturbs the machine disturbs all; times are medians. Prints:
//!
//! - for the paper's sizes (unknowns of ten sectors): time per step and per revolution of every scheme, in free flight
//!   and with contact in nine steps of ten (`900`: a minute);
//! - `sectors`: cost of a step over the number of sectors;
//! - `price`: cost of a step with each effect of a scene (half a minute);
//! - `kernel`: the rate that this core attains on the products of a step, and the rate that the step attains;
//! - `accuracy`: steps and time that every scheme takes to 1e-2, 1e-3 and 1e-4 of a history;
//! - `reductions`: differences of the histories of coarse and fine reductions, and their cost;
//! - `sweep`: speeds per second of two workers over those of one.

mod accuracy;
mod history;
mod kernel;
mod literal;
mod price;
mod products;
mod reductions;
mod scene;
mod sectors;
mod steps;
mod sweep;
mod timing;

#[path = "../../tests/oracle/mod.rs"]
#[allow(dead_code, reason = "shared with the tests, which use all of it")]
mod oracle;

/// The paper's sizes N(n_b + 3k) with N = 10, n_b = 30: modes 3k per nodal diameter.
const SIZES: [(usize, usize); 5] = [(330, 3), (540, 24), (900, 60), (1140, 84), (1560, 126)];

fn main() {
    // Cargo adds `--bench`.
    let asked: Vec<String> = std::env::args().skip(1).filter(|argument| !argument.starts_with('-')).collect();
    let sections: [(&str, fn()); 6] = [
        ("sectors", sectors::measure),
        ("price", price::measure),
        ("kernel", kernel::measure),
        ("accuracy", accuracy::measure),
        ("reductions", reductions::measure),
        ("sweep", sweep::measure),
    ];
    let known = |name: &str| {
        SIZES.iter().any(|(unknowns, _)| unknowns.to_string() == name)
            || sections.iter().any(|(section, _)| *section == name)
    };
    if let Some(unknown) = asked.iter().find(|name| !known(name)) {
        eprintln!("there is no section {unknown:?}; see the head of benches/step/main.rs");
        std::process::exit(2);
    }
    let wanted = |name: &str| asked.is_empty() || asked.iter().any(|argument| argument == name);
    let sizes: Vec<_> = SIZES.into_iter().filter(|(unknowns, _)| wanted(&unknowns.to_string())).collect();
    if !sizes.is_empty() {
        steps::measure(&sizes);
    }
    for (name, measure) in sections {
        if wanted(name) {
            measure();
        }
    }
}
