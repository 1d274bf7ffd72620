//! Time to accuracy: the time that every scheme takes to a given relative error of a history, beside the literal dense scheme.

use rubmap::analysis::request::SchemeChoice;
use rubmap::analysis::request::auto_or::AutoOr;
use rubmap::dynamics::schemes::Scheme;

use crate::history::{REVOLUTIONS, SAMPLES, error, history, sampled, sensors};
use crate::literal::Literal;
use crate::scene::{Scene, Stepping, TOUCHING, name};
use crate::timing::{Contender, medians, timed};

const LEVELS: [f64; 3] = [1e-2, 1e-3, 1e-4];
/// Steps per revolution of the reference.
const REFERENCE_STEPS: usize = 409_600;
/// Steps per revolution of the ladder: the first rung, and how many, each √2 times the one before.
const FIRST_RUNG: f64 = 400.0;
const RUNGS: i32 = 17;
const KEPT_MODES: [usize; 3] = [20, 30, 40];
const ROUNDS: usize = 5;

/// Errors of a scheme on its ladder of steps.
struct Ladder {
    scheme: Scheme,
    /// Steps per revolution with the error for each.
    rungs: Vec<(usize, f64)>,
}

impl Ladder {
    fn climb(scene: &Scene, scheme: Scheme, reference: &[f64]) -> Self {
        let contact = &scene.reduced.wheel.contact;
        let smallest = scheme.smallest_stable_steps(&scene.modal, contact);
        let rungs = (0..RUNGS)
            .map(|rung| sampled(FIRST_RUNG * 2f64.powf(0.5 * f64::from(rung))))
            .filter(|&steps| steps as u64 >= smallest)
            .map(|steps| (steps, error(&history(scene, Stepping { scheme, steps }).values, reference)))
            .collect();
        Self { scheme, rungs }
    }

    fn finest(&self) -> f64 {
        self.rungs.last().expect("a ladder reaches beyond every stability limit").1
    }

    /// Number of steps from which on the error stays below `level`, by logarithmic interpolation; `None` if it does not.
    fn steps_to(&self, level: f64) -> Option<usize> {
        let first = match self.rungs.iter().rposition(|&(_, error)| error >= level) {
            None => return Some(self.rungs[0].0),
            Some(last_above) => self.rungs.get(last_above..last_above + 2)?,
        };
        let [(above, worse), (below, better)] = [first[0], first[1]];
        let share = (worse / level).ln() / (worse / better).ln();
        Some(sampled(above as f64 * (below as f64 / above as f64).powf(share)))
    }
}

pub(crate) fn measure() {
    let scene = Scene::new(60, 1);
    assert_eq!(scene.modal.unknowns(), 900);
    let at_reference = |scheme| history(&scene, Stepping { scheme, steps: REFERENCE_STEPS });
    let reference = at_reference(Scheme::CentralDifferences);
    let apart = error(&at_reference(Scheme::ExactModal).values, &reference.values);
    println!(
        "\nTime to accuracy: 900 unknowns, {REVOLUTIONS} revolutions from rest, contact in {:.0} % of the steps; error: rms \
         over nine sensors and {SAMPLES} samples a revolution over that of the reference, `central_differences` at \
         {REFERENCE_STEPS} steps per revolution. There `exact_modal` is {apart:.1e} from it.\n",
        100.0 * reference.contact_share
    );
    assert!(apart < 0.1 * LEVELS[LEVELS.len() - 1], "the reference is no truth for the smallest error");

    let mut schemes = vec![Scheme::CentralDifferences, Scheme::ExactModal];
    schemes.extend(KEPT_MODES.map(|kept_modes| Scheme::MasslessBoundary { kept_modes }));
    schemes.push(scene.automatic(SchemeChoice::MasslessBoundary, AutoOr::Auto).scheme);
    let ladders: Vec<_> =
        schemes.into_iter().map(|scheme| Ladder::climb(&scene, scheme, &reference.values)).collect();
    print_ladders(&ladders);
    for ladder in &ladders[..2] {
        let first = ladder.rungs[0].1;
        assert!(
            ladder.finest() < 1e-2 * first,
            "{}: the errors do not decrease with the step",
            name(ladder.scheme)
        );
    }
    print_times(&scene, &ladders, &reference.values, literal_step(&scene));
}

fn print_ladders(ladders: &[Ladder]) {
    println!("| steps/rev | {} |", ladders.iter().map(|l| name(l.scheme)).collect::<Vec<_>>().join(" | "));
    println!("|---{}|", "|---".repeat(ladders.len()));
    let finest = ladders.iter().max_by_key(|ladder| ladder.rungs.len()).expect("there are schemes");
    for (steps, _) in &finest.rungs {
        let errors = ladders.iter().map(|ladder| {
            let rung = ladder.rungs.iter().find(|rung| rung.0 == *steps);
            rung.map_or("unstable".into(), |(_, error)| format!("{error:.1e}"))
        });
        println!("| {steps} | {} |", errors.collect::<Vec<_>>().join(" | "));
    }
}

/// Seconds per step of the literal dense scheme over the scene, whose history is shown to be that of production.
fn literal_step(scene: &Scene) -> f64 {
    let Stepping { scheme, steps } = scene.automatic(SchemeChoice::CentralDifferences, AutoOr::Auto);
    let steps = sampled(steps as f64);
    let production = history(scene, Stepping { scheme, steps });
    let mut literal = Literal::new(scene, steps);
    literal.face(scene, &scene.casing(TOUCHING));
    let sensors = sensors(scene);
    let samples = REVOLUTIONS * SAMPLES;
    let mut values = vec![0.0; sensors.len() * samples];
    let mut time = 0.0;
    for sample in 0..samples {
        time += timed(|| literal.advance(steps / SAMPLES)).1;
        for (index, sensor) in sensors.iter().enumerate() {
            values[index * samples + sample] =
                literal.scheme.contact_displacement(sensor.sector, sensor.direction.node)[0];
        }
    }
    let apart = error(&values, &production.values);
    let per_step = time / (REVOLUTIONS * steps) as f64;
    println!(
        "\nLiteral dense: {:.0} µs a step. At {steps} steps per revolution its history is {apart:.1e} from that of \
         `central_differences`: it needs the same steps.\n",
        1e6 * per_step
    );
    assert!(apart < 1e-6, "the two are not the same scheme");
    per_step
}

/// Prints wall times per revolution, of runs at the steps that the ladders ask for.
fn print_times(scene: &Scene, ladders: &[Ladder], reference: &[f64], literal_step: f64) {
    println!("| error | scheme | steps/rev | error there | ms/rev | literal dense/scheme | floor |");
    println!("|---|---|---|---|---|---|---|");
    for level in LEVELS {
        let dense_steps = ladders[0].steps_to(level).expect("the scheme of the reference reaches it");
        let dense = dense_steps as f64 * literal_step;
        println!("| {level:.0e} | literal dense | {dense_steps} | | {:.0} | 1 | |", 1e3 * dense);
        let needed: Vec<_> = ladders.iter().map(|ladder| ladder.steps_to(level)).collect();
        let mut contenders: Vec<Contender<'_>> = Vec::new();
        for (ladder, steps) in ladders.iter().zip(&needed) {
            if let &Some(steps) = steps {
                let stepping = Stepping { scheme: ladder.scheme, steps };
                contenders.push(Box::new(move || history(scene, stepping).time / REVOLUTIONS as f64));
            }
        }
        let mut times = medians(ROUNDS, &mut contenders).into_iter();
        for (ladder, steps) in ladders.iter().zip(&needed) {
            let scheme = name(ladder.scheme);
            let floor = match ladder.scheme {
                Scheme::MasslessBoundary { .. } => format!("{:.1e}", ladder.finest()),
                Scheme::CentralDifferences | Scheme::ExactModal => String::new(),
            };
            let Some(steps) = *steps else {
                println!("| {level:.0e} | {scheme} | — | | | | {floor} |");
                continue;
            };
            let time = times.next().expect("one for every scheme that reaches the level");
            let reached = error(&history(scene, Stepping { scheme: ladder.scheme, steps }).values, reference);
            assert!(reached < 2.0 * level, "{scheme}: {reached:.1e} at {steps} steps is not {level:.0e}");
            println!(
                "| {level:.0e} | {scheme} | {steps} | {reached:.1e} | {:.2} | {:.0} | {floor} |",
                1e3 * time,
                dense / time
            );
        }
    }
}
