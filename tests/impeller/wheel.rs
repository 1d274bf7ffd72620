//! The default impeller.

use rubmap::impeller::{ImpellerParameters, generate};

use crate::eigen::{harmonic, hertz, lowest};

/// Prints the table of frequencies; run with `--ignored --nocapture`.
#[test]
#[ignore = "a table for people, not a check"]
fn print_frequencies() {
    let p = match std::env::var("IMPELLER_JSON") {
        Ok(text) => serde_json::from_str(&text).unwrap(),
        Err(_) => ImpellerParameters::default(),
    };
    let start = std::time::Instant::now();
    let package = generate(&p).unwrap();
    println!(
        "rows {} cyclic pairs {} entries {} in {:?}",
        package.dofs.len(),
        package.manifest.cyclic.len(),
        package.stiffness[0].entries.len(),
        start.elapsed()
    );
    for (k, speed) in package.stiffness.iter().zip(&package.manifest.speeds_rad_s) {
        println!("Ω = {speed}");
        for i in 0..=p.sectors / 2 {
            let values = lowest(&harmonic(&package, k, i), &harmonic(&package, &package.mass, i), 8);
            println!(
                "  {i}: {:?}",
                values.map(|v| hertz(&v).iter().map(|f| format!("{f:.1}")).collect::<Vec<_>>())
            );
        }
    }
}
