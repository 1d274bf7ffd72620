//! throwaway
use rubmap::analysis::{monitor::Unwatched, run};
use rubmap::dynamics::modal_wheel::ModalWheel;
use rubmap::dynamics::integrate::smallest_stable_steps;
fn main() {
    for f in ["impeller-a", "impeller-a-cartesian", "impeller-a-nlgeom"] {
        let p = format!("/work/shared/models/{f}.zip");
        let t = std::time::Instant::now();
        let m = rubmap::package::read(std::path::Path::new(&p), &Default::default()).unwrap();
        println!("{f} import {:.2?} digest {}", t.elapsed(), &m.digest[..8]);
        for k in [20] {
            let r = run::prepare(&m.sector, k, &Unwatched).unwrap();
            println!("k={k} {:.2} s unknowns {:?} wheel {} residual {:.1e} {:?} lin {:.2e} quad {:.2e} err {:.2e}", r.report.wall_time_s, r.report.unknowns, r.report.wheel_unknowns, r.report.largest_mode_residual, r.report.stiffening.verdict, r.report.stiffening.linear_ratio, r.report.stiffening.quadratic_ratio, r.report.stiffening.frequency_error);
            println!("{}", r.report.stiffening.message);
            for omega in [0.0, 3750.0] {
                let w = ModalWheel::at(&r.wheel, omega, true).unwrap();
                for h in &w.harmonics { println!("  {omega} ND{} {:?}", h.harmonic, h.omega[..6].iter().map(|w| (w/std::f64::consts::TAU*1000.0).round()/1000.0).collect::<Vec<_>>()); }
                println!("  wmax {:.3e} steps at 3000 rad/s: {}", w.largest_frequency(), smallest_stable_steps(w.largest_frequency(), 3000.0));
            }
        }
    }
}
