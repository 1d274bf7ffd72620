//! Drawings of branches.

use roxmltree::Document;
use serde_json::json;

use super::branched::{marched, over_clearance, resonance, way};
use super::figures::{numbers, trace};
use super::pens::figure;
use super::pens::svg::branches;
use super::{corners, of_class, tick};
use rubmap_analysis::result::{Branches, Point, Stability};

/// Changes of a line from solid to dashed are where the bifurcation and its mark are.
#[test]
fn lines_change_where_the_bifurcation_is() {
    let of = resonance(true);
    let drawing = branches(&of, 0, &[]);
    let read = Document::parse(&drawing).unwrap();
    let of_first = |node: &roxmltree::Node| {
        let title = node.first_element_child().and_then(|title| title.text());
        node.has_tag_name("path") && title.is_some_and(|title| title.starts_with("branch 1"))
    };
    let mut left: Vec<_> = read.descendants().filter(of_first).collect();
    // The branch begins at the lowest speed; every line goes on where the one before ends.
    left.sort_by(|a, b| corners(*b)[0].0.total_cmp(&corners(*a)[0].0));
    let mut lines = vec![left.pop().unwrap()];
    while let Some(next) =
        left.iter().position(|line| corners(*lines.last().unwrap()).last() == corners(*line).first())
    {
        lines.push(left.remove(next));
    }
    let kinds: Vec<_> = lines.iter().map(|line| line.attribute("class").unwrap()).collect();
    assert_eq!(
        kinds,
        ["stable", "unstable", "stable", "unstable", "stability undecided", "unstable", "stable"]
    );
    assert!(
        lines.iter().all(|line| line.attribute("stroke-dasharray").is_some()
            == (line.attribute("class") != Some("stable")))
    );
    let (zero, per_rpm) = {
        let (a, b) = (tick(&read, "18,000"), tick(&read, "24,000"));
        (a - 18_000.0 * (b - a) / 6_000.0, (b - a) / 6_000.0)
    };
    let flip = corners(lines[0]).pop().unwrap();
    assert!((flip.0 - zero - per_rpm * way(true, 0.5)).abs() < 0.05);
    assert!((0.5 * (super::level(&read, "0.4") + super::level(&read, "0.6")) - flip.1).abs() < 0.05);
    assert_eq!(corners(lines[1])[0], flip);
    let fold = corners(lines[2]).pop().unwrap();
    let furthest = lines.iter().flat_map(|line| corners(*line)).map(|place| place.0).fold(0.0, f64::max);
    assert!(fold.0 == furthest, "the branch turns back at its fold");
}

#[test]
fn marks_say_how_far_off_they_may_be() {
    let drawing = branches(&resonance(true), 0, &[]);
    let read = Document::parse(&drawing).unwrap();
    let told: Vec<_> = of_class(&read, "mark")
        .filter_map(|mark| mark.last_element_child().and_then(|title| title.text()))
        .collect();
    let count = |words: &str| told.iter().filter(|title| title.contains(words)).count();
    assert_eq!(
        (count("fold:"), count("flip:"), count("Neimark–Sacker:"), count("maximum:")),
        (2, 2, 2, 1),
        "{told:?}"
    );
    assert_eq!(count("rpm ± 0.024"), 0, "the unit stands behind the error");
    assert_eq!(count(" ± 0.024 rpm"), 6);
    assert_eq!(count("δ = 0.191"), 2, "only where lines split: {told:?}");
    assert_eq!(count("stability is lost at once: |μ| = 0.620"), 2);
    assert_eq!(count("the search came no closer than 1.2e-5"), 1);
    assert!(
        !drawing.contains("1 branch ") && drawing.contains("2 branches") && drawing.contains("139 points")
    );
}

/// Keys and headings name the lines and marks that occur, and nothing else.
#[test]
fn keys_explain_the_branches_that_are_there() {
    let of = |branches: &Branches, sensor, marched: &[Point]| {
        super::drawings::key(&super::pens::svg::branches(branches, sensor, marched))
    };
    let full = of(&resonance(true), 0, &marched());
    for words in [
        "branch 1",
        "branch 2, after 2 lobes",
        "stable",
        "unstable",
        "undecided",
        "fold",
        "flip",
        "Neimark",
        "maximum",
        "no further",
        "speed of the sweep",
        "not settled",
    ] {
        assert!(full.iter().any(|key| key.contains(words)), "{words}: {full:?}");
    }
    assert!(!full.iter().any(|key| key.contains("branching")));
    let mut short = resonance(false);
    short.branches[0].points.truncate(5);
    short.branches[0].bifurcations.clear();
    short.branches[0].maxima.clear();
    assert_eq!(of(&short, 0, &[]), ["branch 1", "stable"]);
    assert!(branches(&short, 0, &[]).contains("still being followed"));
    let clear = branches(&over_clearance(), 0, &marched());
    assert!(clear.contains("clearance / that of the scene") && clear.contains("at 24,000 rpm"));
    assert!(!clear.contains("of the sweep"), "speeds are dots over speed only");
}

/// Values that are not finite interrupt lines; the rest stays where it was.
#[test]
fn what_is_no_number_is_not_drawn() {
    for spoil in 0..4 {
        let mut of = resonance(true);
        for branch in &mut of.branches {
            match spoil {
                0 => branch.points[5].half_peak_to_peak[0] = f64::NAN,
                1 => branch.points[5].value = f64::INFINITY,
                2 => branch.points.iter_mut().for_each(|point| point.half_peak_to_peak.clear()),
                _ => branch
                    .bifurcations
                    .iter_mut()
                    .for_each(|one| (one.value, one.error) = (f64::NAN, f64::NAN)),
            }
            branch.points[9].stability = Stability::Narrow;
        }
        let mut speeds = marched();
        speeds[1].responses[0].half_peak_to_peak = f64::NAN;
        for sensor in [0, 1, 9] {
            let drawing = branches(&of, sensor, &speeds);
            assert!(
                Document::parse(&drawing).is_ok() && !drawing.contains("NaN") && !drawing.contains("inf"),
                "{spoil}"
            );
            serde_json::to_vec(&figure::branches(&of, sensor, &speeds)).unwrap();
        }
    }
    let mut none = resonance(false);
    none.branches[0].points.clear();
    let drawing = branches(&none, 0, &[]);
    assert!(drawing.contains("no point of a branch"));
    none.branches.clear();
    assert!(Document::parse(&branches(&none, 0, &[])).is_ok());
    assert_eq!(json!(figure::branches(&none, 0, &[]))["data"], json!([]));
}

#[test]
fn figures_have_the_points_and_their_words() {
    let of = resonance(true);
    let figure = json!(figure::branches(&of, 0, &marched()));
    let stable = trace(&figure, "branch 1, stable");
    assert!((stable["x"][0].as_f64().unwrap() - way(true, 0.168)).abs() < 1e-6);
    let words = stable["hovertext"][0].as_str().unwrap();
    assert!(
        words.contains("branch 1, 15,") && words.contains("0.168 mm, stable, largest |μ| = 0.930"),
        "{words}"
    );
    assert_eq!(trace(&figure, "branch 1, unstable")["line"]["dash"], json!("dash"));
    let flips = trace(&figure, "flip");
    assert!((numbers(&flips["x"])[1] - way(true, 0.7)).abs() < 1e-6);
    let folds = numbers(&trace(&figure, "fold")["x"]);
    assert_eq!(folds.len(), 2);
    let meta = &figure["layout"]["meta"];
    assert_eq!(
        (&meta["kind"], &meta["parameter"], &meta["units"]["x"]),
        (&json!("branches"), &json!("speed"), &json!("rpm"))
    );
    let dots = numbers(&trace(&figure, "speed of the sweep")["x"]);
    assert!(dots.len() >= 10 && dots.iter().all(|rpm| (15_500.0..=26_601.0).contains(rpm)), "{dots:?}");
    assert_eq!(numbers(&trace(&figure, "the same, not settled")["x"]).len(), 1);
}

/// Branches of a hundred thousand points make no large drawings.
#[test]
fn long_branches_make_no_large_drawings() {
    let mut long = resonance(true);
    let points = long.branches[0].points.clone();
    long.branches[0].points = points
        .windows(2)
        .flat_map(|pair| {
            (0..800u32).map(|k| {
                let share = f64::from(k) / 800.0;
                let mut point = pair[0].clone();
                point.value += share * (pair[1].value - pair[0].value);
                point.half_peak_to_peak[0] +=
                    share * (pair[1].half_peak_to_peak[0] - pair[0].half_peak_to_peak[0]);
                point
            })
        })
        .collect();
    assert!(branches(&long, 0, &[]).len() < 400_000);
    assert!(serde_json::to_vec(&figure::branches(&long, 0, &[])).unwrap().len() < 2 << 20);
}
