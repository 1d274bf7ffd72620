//! Limits of a step: its products of mode shapes and modal coordinates alone, over the same memory; the same with
//! everything in the first-level cache; and the share of them that the step attains.

use std::cell::RefCell;

use pulp::Arch;
use rubmap::dynamics::modal_wheel::ModalWheel;

use crate::products::{GROUP, Products, REPEATS, Registers, Task, blocks, count};
use crate::scene::{FREE, Scene};
use crate::steps::{moving, production};
use crate::timing::{Contender, medians, timed};

const ROUNDS: usize = 7;
/// Number of revolutions, so many that the set-up of a run does not count.
const REVOLUTIONS: usize = 50;

/// Flops and bytes of a step of [`rubmap`] in free flight with damping: the oscillators (8 flops; z and d read and
/// written, swing written, three coefficients read, which the parts of a pair share), the products (`of_products`), and
/// the gaps of all contact nodes from the Fourier columns.
fn count_step(wheel: &ModalWheel, nodes: usize, of_products: (f64, f64)) -> (f64, f64) {
    let (unknowns, sectors) = (wheel.unknowns() as f64, wheel.sectors as f64);
    let modes: usize = wheel.harmonics.iter().map(|harmonic| harmonic.omega.len()).sum();
    let (flops, bytes) = of_products;
    let gaps = sectors * nodes as f64 * (2.0 * sectors + 4.0);
    // The bytes of the products count z once.
    (flops + 8.0 * unknowns + gaps, bytes + 8.0 * (4.0 * unknowns + 3.0 * modes as f64))
}

pub(crate) fn measure() {
    let scene = Scene::new(60, 1);
    let rows = scene.reduced.wheel.contact.len();
    assert_eq!((scene.modal.unknowns(), rows % GROUP), (900, 0));
    let blocks = blocks(&scene.modal, rows);
    let everything: Vec<usize> = (0..blocks.len()).collect();
    // The first single block stands for all single ones, the first pair for all pairs.
    let same: Vec<usize> =
        scene.modal.harmonics.iter().map(|harmonic| usize::from(!harmonic.single)).collect();
    let cases = [
        ("reading the rows", Task::Read, &everything),
        ("reading the rows, first-level cache", Task::Read, &same),
        ("product", Task::Project, &everything),
        ("product, first-level cache", Task::Project, &same),
        ("back product and product", Task::BackAndForth, &everything),
        ("back product and product, first-level cache", Task::BackAndForth, &same),
    ];
    let counts = cases.map(|(_, task, order)| count(task, &blocks, order));
    let stepping = scene.schemes()[0];
    let (casing, moving) = (scene.casing(FREE), moving(&scene));
    let blocks = RefCell::new(blocks);
    let mut contenders: Vec<Contender<'_>> = Vec::new();
    for (_, task, order) in cases {
        let blocks = &blocks;
        contenders.push(Box::new(move || {
            let products = Products { task, blocks: &mut blocks.borrow_mut(), order, rows };
            timed(|| Arch::new().dispatch(products)).1 / REPEATS as f64
        }));
    }
    contenders.push(Box::new(|| production(&scene, stepping, &casing, &moving, REVOLUTIONS).time));
    contenders.push(Box::new(|| {
        let (flops, time) = timed(|| Arch::new().dispatch(Registers));
        time / flops
    }));
    let times = medians(ROUNDS, &mut contenders);
    drop(contenders);

    println!(
        "\nKernel: the products of a step, {rows} rows by {} modes of every nodal diameter, {:.0} KB of rows.\n",
        scene.modal.harmonics[0].omega.len(),
        1e-3 * counts[0].1
    );
    println!("| what | µs | GFlop/s | GB/s |");
    println!("|---|---|---|---|");
    println!("| multiply-adds on registers | | {:.1} | |", 1e-9 / times[cases.len() + 1]);
    let line = |what: &str, time: f64, (flops, bytes): (f64, f64)| {
        let rate = if flops > 0.0 { format!("{:.1}", 1e-9 * flops / time) } else { String::new() };
        println!("| {what} | {:.3} | {rate} | {:.1} |", 1e6 * time, 1e-9 * bytes / time);
    };
    for (((what, _, _), count), time) in cases.into_iter().zip(counts).zip(&times) {
        line(what, *time, count);
    }
    let (step, product) = (times[cases.len()], counts[2]);
    let whole = count_step(&scene.modal, rows, product);
    line("`central_differences`, free flight", step, whole);
    println!(
        "\nThe step does {:.0} % of the product's GFlop/s and {:.0} % of its GB/s; the product alone is {:.0} % of its time.",
        100.0 * whole.0 / step / (product.0 / times[2]),
        100.0 * whole.1 / step / (product.1 / times[2]),
        100.0 * times[2] / step
    );
}
