//! Common properties of all drawings: they can be read, name their content and units, explain the marks that occur and nothing else, and
//! survive empty results.

use roxmltree::Document;
use rubmap_analysis::result::{ForceMap, Point, Quantity, SpeedHistories, SpeedSpectra, WearMap};
use rubmap_wheel::dynamics::sector::Units;

use super::branched::{marched, over_clearance, resonance};
use super::fixtures::{contact, recorded, sector, spectra, worn};
use super::impeller::{SECTORS, impeller};
use super::passed::{many_rates, passed, stayed, through_points};
use super::pens::svg::{
    around, backbones, branches, campbell, campbell_fixed_frame, critical_speeds, error_over_step,
    fixed_frame_map, force_map, haigh, histories, interaction_map, map_sheet, run_ups, section, spectrogram,
    spectrum, speed_histories, trajectories, wear_map, work_precision,
};
use super::stresses::{of_sweep, stressed_critical, stressed_map};
use super::studies::{RUNS, first_revolutions, study};
use super::{SPEEDS_RPM, critical, decoded, map, modes, of_class, point, units, waves};
use crate::{
    ForceQuantity, Frame, HaighColour, HistoryQuantity, LevelColour, PngError, SectionView, SpectrogramUnit,
    SurfaceView, VerticalAxis, Window, png, surface,
};

pub(super) fn credentials() -> Point {
    serde_json::from_value(point(1, "completed")).unwrap()
}

pub(super) fn mm() -> Units {
    serde_json::from_value(units()).unwrap()
}

/// Drawing, the beginning of its title, and the titles of its axes.
type Drawing = (String, &'static str, &'static [&'static str]);

fn all() -> Vec<Drawing> {
    let (short, spectra) = (recorded([0, 4], 360), spectra(6));
    let by_speed = |axis| {
        interaction_map(
            &map(),
            Some(&critical()),
            Some(&modes()),
            axis,
            Window::default(),
            LevelColour::Plain,
        )
    };
    let history = |what| speed_histories(&short, what, 0);
    let turned = |frame| spectrum(&spectra, &credentials(), &mm(), 0, frame);
    vec![
        (
            run_ups(&passed(&[5.0, 50.0], true), 0, &stayed()),
            "Run-ups: radial",
            &["rotational speed Ω, rpm", "half peak to peak, mm"],
        ),
        (
            run_ups(&passed(&many_rates(), false), 1, &[]),
            "Run-downs: axial",
            &["rotational speed Ω, rpm", "half peak to peak, mm"],
        ),
        (
            spectrogram(&passed(&[50.0], true), 0, 0, SpectrogramUnit::Order),
            "Spectrogram of a run-up at 50 rad/s²: radial",
            &["rotational speed Ω, rpm", "engine order k", "½ p–p, mm"],
        ),
        (
            spectrogram(&through_points(), 0, 0, SpectrogramUnit::Hz),
            "Spectrogram of a run with a changing speed: radial",
            &["time, s", "frequency (rotating frame), Hz", "½ p–p, mm", "Ω, rpm"],
        ),
        (
            by_speed(VerticalAxis::EngineOrder),
            "Interaction map: radial",
            &["rotational speed Ω, rpm", "engine order k"],
        ),
        (
            by_speed(VerticalAxis::Frequency),
            "Interaction map",
            &["rotational speed Ω, rpm", "frequency (rotating frame), Hz"],
        ),
        (
            fixed_frame_map(
                &map(),
                Some(&critical()),
                VerticalAxis::EngineOrder,
                Window::default(),
                LevelColour::Plain,
            ),
            "Interaction map in the fixed frame: radial",
            &["rotational speed Ω, rpm", "multiple of the rotational frequency in the fixed frame"],
        ),
        (
            map_sheet(&vec![map(); 5], Window::default(), LevelColour::Plain),
            "Maps by nodal diameter",
            &["rotational speed Ω, rpm", "engine order k"],
        ),
        (
            campbell(&waves()),
            "Campbell diagram",
            &["rotational speed Ω, rpm", "natural frequency in the rotating frame, Hz"],
        ),
        (
            campbell_fixed_frame(&modes()),
            "Campbell diagram in the fixed frame",
            &["rotational speed Ω, rpm", "frequency in the fixed frame, Hz"],
        ),
        (
            backbones(&super::backbones()),
            "Backbone curves at 14,000 rpm",
            &["change of the natural frequency, %", "amplitude where the mode moves most, mm"],
        ),
        (
            critical_speeds(&critical()),
            "Critical speeds",
            &["rotational speed Ω, rpm", "level at the peak, mm rms"],
        ),
        (
            branches(&resonance(true), 0, &marched()),
            "Branches over speed: radial displacement",
            &["rotational speed Ω, rpm", "half peak to peak, mm"],
        ),
        (
            branches(&over_clearance(), 1, &[]),
            "Branches over clearance: axial displacement",
            &["clearance / that of the scene", "half peak to peak, mm"],
        ),
        (
            turned(Frame::Rotating),
            "Spectrum in the rotating frame",
            &["engine order k in the rotating frame", "amplitude, mm", "nodal diameters, mm"],
        ),
        (
            turned(Frame::Fixed),
            "Spectrum in the fixed frame",
            &["multiple of the rotational frequency in the fixed frame", "nodal diameters, mm"],
        ),
        (
            history(HistoryQuantity::Displacement),
            "Revolutions 0 to 4: radial displacement",
            &["revolutions since the start", "displacement, mm"],
        ),
        (
            history(HistoryQuantity::Velocity),
            "Revolutions 0 to 4: radial velocity",
            &["revolutions since the start", "velocity, mm/s"],
        ),
        (
            history(HistoryQuantity::Force),
            "Revolutions 0 to 4: force on contact node 0",
            &["revolutions since the start", "force, N"],
        ),
        (
            history(HistoryQuantity::Contact),
            "Revolutions 0 to 4: contact of the wheel",
            &["contact nodes that touch", "length in contact, mm"],
        ),
        (
            history(HistoryQuantity::Energy),
            "Revolutions 0 to 4: energy",
            &["stored: kinetic and potential, N·mm", "added up since the start, N·mm"],
        ),
        (
            histories(&first_revolutions(&[1, 2], 20, 9), 0),
            "First 2 revolutions",
            &["revolutions", "displacement, mm"],
        ),
        (
            trajectories(&short),
            "Tip trajectories",
            &["angle in the fixed frame, in the direction of rotation", "outward displacement, mm"],
        ),
        (
            force_map(&contact(4), ForceQuantity::Peak),
            "Contact over speed: largest contact force",
            &["force, N", "contact node (0: leading edge)"],
        ),
        (
            force_map(&contact(4), ForceQuantity::Impulse),
            "Contact over speed: contact impulse",
            &["impulse, N·s"],
        ),
        (
            force_map(&contact(4), ForceQuantity::Share),
            "Contact over speed: share of time",
            &["share of time"],
        ),
        (
            force_map(&contact(4), ForceQuantity::Consumption),
            "Contact over speed: largest share",
            &["share of the clearance"],
        ),
        (
            wear_map(&worn(60, 4), &credentials(), &mm()),
            "Wear of the coating, 11,000 rpm",
            &["deepest, mm", "contact node (0: leading edge)"],
        ),
        (
            section(&sector(5), SectionView::Meridional),
            "Meridional section: a disk <and> a blade",
            &["axial coordinate z, mm", "radius r, mm"],
        ),
        (section(&sector(5), SectionView::Cyclic), "Cyclic faces", &["x, mm", "y, mm"]),
        (around(&sector(5)), "Casing around the circumference: a disk <and> a blade", &["x, mm", "y, mm"]),
        (
            surface(&impeller(0..SECTORS, 4, 2.0), SurfaceView::Front),
            "Nodal diameter 2, mode 1",
            &["x, mm", "y, mm"],
        ),
        (
            surface(&impeller(0..1, 4, 2.0), SurfaceView::Meridional),
            "Nodal diameter 2, mode 1",
            &["axial coordinate z, mm", "radius r, mm"],
        ),
        (
            haigh(&of_sweep(&stressed_map()), HaighColour::Utilisation),
            "Haigh diagram",
            &["mean stress (signed von Mises), MPa", "alternating stress, MPa"],
        ),
        (
            interaction_map(
                &stressed_map(),
                Some(&stressed_critical()),
                Some(&modes()),
                VerticalAxis::EngineOrder,
                Window::default(),
                LevelColour::Utilisation,
            ),
            "Interaction map",
            &["rotational speed Ω, rpm", "engine order k"],
        ),
        (
            work_precision(&study(&RUNS, true), 0, Quantity::Amplitude),
            "Work and precision: steady amplitude",
            &["relative error: steady amplitude"],
        ),
        (
            error_over_step(&study(&RUNS, false), 0, Quantity::Amplitude),
            "Error over time step: steady amplitude",
            &["time step, revolutions", "relative error: steady amplitude"],
        ),
    ]
}

#[test]
fn all_say_what_they_are_and_in_which_units() {
    for (drawing, title, axes) in all() {
        let read = Document::parse(&drawing).unwrap();
        // Embedded images may contain any sequence of letters.
        let attributes =
            read.descendants().flat_map(|node| node.attributes()).map(|attribute| attribute.value());
        let mut written = attributes.filter(|value| !value.starts_with("data:"));
        assert!(written.all(|value| !value.contains("NaN") && !value.ends_with("inf")), "{title}");
        let named = read.root_element().first_element_child().and_then(|node| node.text()).unwrap();
        assert!(named.starts_with(title), "{named}");
        let texts: Vec<_> = read
            .descendants()
            .filter(|node| node.has_tag_name("text"))
            .filter_map(|node| node.text())
            .collect();
        assert_eq!(texts.iter().filter(|text| **text == named).count(), 1, "{named} stands above");
        let found: Vec<_> = read
            .descendants()
            .filter(|node| node.attribute("class") == Some("axis"))
            .filter_map(|node| node.text())
            .collect();
        assert!(axes.iter().all(|axis| found.contains(axis)), "{named}: {found:?}");
    }
}

/// Texts stay within the edges of a drawing, as far as their widths are known.
#[test]
fn no_text_leaves_the_drawing() {
    for (drawing, title, _) in all() {
        let read = Document::parse(&drawing).unwrap();
        let width: f64 = read.root_element().attribute("width").unwrap().parse().unwrap();
        let level =
            |node: &roxmltree::Node| node.has_tag_name("text") && node.attribute("transform").is_none();
        for node in read.descendants().filter(level) {
            // Texts in marks of a key are placed by a group.
            if node.ancestors().skip(1).any(|above| above.attribute("transform").is_some()) {
                continue;
            }
            let number = |name| node.attribute(name).and_then(|value| value.parse::<f64>().ok());
            let size = number("font-size").unwrap_or(13.0);
            let wide = crate::svg::text_width(node.text().unwrap_or_default(), size);
            let x = number("x").unwrap();
            let (left, right) = match node.attribute("text-anchor") {
                Some("end") => (x - wide, x),
                Some("middle") => (x - 0.5 * wide, x + 0.5 * wide),
                _ => (x, x + wide),
            };
            assert!(
                left >= -2.0 && right <= width + 2.0,
                "{title}: {:?} from {left} to {right}",
                node.text()
            );
        }
    }
}

pub(super) fn key(drawing: &str) -> Vec<String> {
    let read = Document::parse(drawing).unwrap();
    let entries = read.descendants().filter(|node| node.attribute("class") == Some("key"));
    entries.filter_map(|node| node.text()).map(str::to_owned).collect()
}

fn has(keys: &[String], words: &str) -> bool {
    keys.iter().any(|key| key.contains(words))
}

#[test]
fn a_map_explains_what_is_there_only() {
    let axis = VerticalAxis::EngineOrder;
    let full = key(&interaction_map(
        &map(),
        Some(&critical()),
        Some(&modes()),
        axis,
        Window::default(),
        LevelColour::Plain,
    ));
    let words = [
        "critical speed",
        "not resolved",
        "not settled",
        "driven by the lobes",
        "linear criterion",
        "natural",
        "no result",
    ];
    for words in words {
        assert!(has(&full, words), "{words}: {full:?}");
    }
    let lines = ["multiples of the lobe count", "other engine orders"];
    let mut healthy = map();
    healthy.amplitude[2] = healthy.amplitude[1].clone();
    assert_eq!(
        key(&interaction_map(&healthy, None, None, axis, Window::default(), LevelColour::Plain)),
        lines
    );
    let bare = key(&interaction_map(&map(), None, None, axis, Window::default(), LevelColour::Plain));
    assert_eq!(bare, [&lines[..], &["no result"]].concat());
    let mut quiet = critical();
    quiet.critical_speeds.clear();
    quiet.driven_crossings.clear();
    let linear =
        key(&interaction_map(&healthy, Some(&quiet), None, axis, Window::default(), LevelColour::Plain));
    assert_eq!(linear, [&["linear criterion (i, j, n) at k = i·n"], &lines[..]].concat());
    // Beyond the window there is nothing to explain.
    let window = Window { speeds_rpm: Some((9_600.0, 10_400.0)), engine_orders: None };
    assert_eq!(
        key(&interaction_map(&map(), Some(&critical()), None, axis, window, LevelColour::Plain)),
        lines
    );
    let window = Window { engine_orders: Some((2.6, 2.9)), ..window };
    assert_eq!(
        key(&interaction_map(&map(), Some(&critical()), None, axis, window, LevelColour::Plain)),
        [""; 0]
    );
}

#[test]
fn other_keys_explain_what_is_there_only() {
    let mut modes = modes();
    assert!(has(&key(&campbell(&modes)), "driven") && has(&key(&campbell(&modes)), "linear criterion"));
    (modes.crossings, modes.driven_crossings) = (Vec::new(), Vec::new());
    let bare = key(&campbell(&modes));
    assert!(!has(&bare, "driven") && !has(&bare, "linear") && !has(&bare, "engine order"), "{bare:?}");
    assert!(!has(&key(&campbell_fixed_frame(&modes)), "stands still"));

    let found = key(&critical_speeds(&critical()));
    assert!(has(&found, "not settled") && has(&found, "not resolved") && !has(&found, "estimated error"));
    let mut critical = critical();
    critical.critical_speeds.truncate(1);
    critical.critical_speeds[0].amplitude_error = Some(0.2);
    critical.linear_crossings.clear();
    let found = key(&critical_speeds(&critical));
    assert!(has(&found, "estimated error") && !has(&found, "linear") && !has(&found, "not "), "{found:?}");

    let consumed = |share: f64| {
        let mut map = contact(3);
        for row in map.rows.iter_mut().flatten() {
            row.clearance_consumption = vec![share; 3];
            row.summary.linear_clearance_consumption = None;
        }
        key(&force_map(&map, ForceQuantity::Consumption))
    };
    assert!(has(&consumed(1.2), "undeformed casing") && !has(&consumed(0.3), "undeformed casing"));
    assert!(!has(&consumed(0.3), "linear") && has(&consumed(0.3), "no result"));

    let spectra = spectra(6);
    let found = key(&spectrum(&spectra, &credentials(), &mm(), 0, Frame::Rotating));
    assert_eq!(found.iter().filter(|words| words.len() == 1).count(), 3, "three that move: {found:?}");
    let bands = |revolutions| key(&speed_histories(&recorded(revolutions, 360), HistoryQuantity::Force, 0));
    assert!(has(&bands([0, 40]), "lowest to highest") && !has(&bands([0, 2]), "lowest to highest"));
    let still = |mut sector: rubmap_analysis::result::SectorGeometry| {
        sector.contact.iter_mut().for_each(|place| place.clearance = None);
        key(&section(&sector, SectionView::Meridional))
    };
    assert!(
        has(&key(&section(&sector(5), SectionView::Meridional)), "casing")
            && !has(&still(sector(5)), "casing")
    );
}

#[test]
fn marks_after_a_speed_without_result_have_their_own_words() {
    let drawing = force_map(&contact(3), ForceQuantity::Peak);
    let read = Document::parse(&drawing).unwrap();
    let speeds = of_class(&read, "point").map(|mark| {
        let words = mark.last_element_child().and_then(|title| title.text()).unwrap();
        words.split_once(" rpm").unwrap().0.parse().unwrap()
    });
    let speeds: Vec<f64> = speeds.collect();
    let computed = [0, 1, 3, 4].map(|speed| SPEEDS_RPM[speed].round());
    assert!(speeds.len() >= 4 && speeds.chunks(4).all(|curve| curve == computed), "{speeds:?}");
}

/// Lines of nodal diameter n at engine order k are seen at k ± n.
#[test]
fn the_fixed_frame_shifts_by_the_nodal_diameter() {
    let drawing = spectrum(&spectra(6), &credentials(), &mm(), 0, Frame::Fixed);
    let read = Document::parse(&drawing).unwrap();
    let at = |words: &str| {
        let title =
            read.descendants().find(|node| node.text().is_some_and(|text| text.starts_with(words))).unwrap();
        let stem = title.parent().unwrap().first_element_child().unwrap();
        super::number(stem, "x1")
    };
    let tick = |label: &str| super::tick(&read, label);
    let forwards = at("nodal diameter 2, engine order 4: 0.300 mm, if it travels forwards");
    let backwards = at("nodal diameter 2, engine order 4: 0.300 mm, if it travels backwards");
    assert!(super::is_near(forwards, tick("6")) && super::is_near(backwards, tick("2")));
    assert!(super::is_near(at("nodal diameter 0, engine order 10"), tick("10")));
}

/// Crossings of n = 1 lie where |f − iΩ/2π| falls to zero, and lines go down to them.
#[test]
fn standing_waves_come_down_to_zero() {
    let mut modes = modes();
    // f = 100 Hz, i = 1: still at 6,000 rpm, between the speeds 5,000 and 7,500 rpm.
    let speeds = [0.0, 2_500.0, 5_000.0, 7_500.0];
    modes.speeds_rad_s = speeds.map(super::rad_s).to_vec();
    modes.frequencies_hz = vec![vec![vec![300.0], vec![100.0]]; 4];
    (modes.crossings, modes.driven_crossings) = (Vec::new(), Vec::new());
    let drawing = campbell_fixed_frame(&modes);
    let read = Document::parse(&drawing).unwrap();
    let title =
        read.descendants().find(|node| node.text() == Some("nodal diameter 1, family 1: |f − iΩ/2π|"));
    let line = super::corners(title.unwrap().parent().unwrap());
    assert_eq!(line.len(), 5, "one corner more, at zero");
    let zero = 2.0 * super::level(&read, "50") - super::level(&read, "100");
    assert!((line[3].1 - zero).abs() < 0.1, "{line:?} {zero}");
    assert!(super::is_near(line[3].0, super::tick(&read, "6,000")), "{line:?}");
}

/// Casing before a tip: clearance less lobes; motion is drawn at the angle of the tip.
#[test]
fn trajectories_stand_where_the_tip_is() {
    let mut recorded = recorded([3, 4], 8);
    recorded.sensors.truncate(1);
    recorded.sensors[0].displacement = vec![0.0, 0.1, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let tip = recorded.sensors[0].tip.as_mut().unwrap();
    tip.angle_rad = std::f64::consts::FRAC_PI_2;
    // Two lobes of 0.4.
    let wave = |i: u32| (std::f64::consts::TAU * f64::from(i) / 360.0).cos().max(0.0);
    tip.heights = (0..720).map(|i| 0.4 * wave(i).powi(4)).collect();
    let drawing = trajectories(&recorded);
    let read = Document::parse(&drawing).unwrap();
    let path = super::of_class(&read, "trajectory").next().unwrap();
    let highest = super::corners(path).into_iter().min_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
    // The tip stands at 90° and has moved on by two eighths of a revolution.
    assert!(super::is_near(highest.0, super::tick(&read, "180°")), "{highest:?}");
    assert!(super::is_near(highest.1, super::level(&read, "0.1")), "{highest:?}");
    let wall = super::corners(super::of_class(&read, "casing").next().unwrap());
    let lowest = wall.iter().map(|corner| corner.1).fold(0.0, f64::max);
    assert!(super::is_near(lowest, super::level(&read, "−0.1")), "0.3 less lobes of 0.4: {lowest}");
}

/// Casing of two lobes of 0.4 in a clearance of 0.3, before a tip that stands at 90°: nearest after a quarter of a revolution.
#[test]
fn histories_have_the_casing_that_the_tip_meets() {
    let mut recorded = recorded([3, 4], 8);
    let tip = recorded.sensors[0].tip.as_mut().unwrap();
    tip.angle_rad = std::f64::consts::FRAC_PI_2;
    let wave = |i: u32| (std::f64::consts::TAU * f64::from(i) / 360.0).cos().max(0.0);
    tip.heights = (0..720).map(|i| 0.4 * wave(i).powi(4)).collect();
    let drawing = speed_histories(&recorded, HistoryQuantity::Displacement, 0);
    let read = Document::parse(&drawing).unwrap();
    let wall = super::corners(super::of_class(&read, "casing").next().unwrap());
    assert_eq!(wall.len(), 8);
    assert!(super::is_near(wall[1].1, super::level(&read, "−0.1")), "{wall:?}");
    assert!(
        super::is_near(wall[1].0, 0.5 * (super::tick(&read, "3.2") + super::tick(&read, "3.3"))),
        "{wall:?}"
    );
    let clearance = super::corners(super::of_class(&read, "casing").nth(1).unwrap());
    assert!(
        clearance.iter().all(|corner| super::is_near(corner.1, super::level(&read, "0.3"))),
        "{clearance:?}"
    );
}

/// Silhouette where the axes have its corners, and no dots of the nodes that it bounds.
#[test]
fn a_section_with_elements_is_an_area() {
    let mut geometry = sector(5);
    geometry.silhouette = vec![vec![[10.0, 20.0], [60.0, 20.0], [60.0, 80.0], [10.0, 80.0]]];
    geometry.disk = vec![vec![[30.0, 20.0], [60.0, 20.0], [60.0, 80.0]]];
    let drawing = section(&geometry, SectionView::Meridional);
    let read = Document::parse(&drawing).unwrap();
    let ring = super::corners(super::of_class(&read, "silhouette").next().unwrap());
    assert!(
        super::is_near(ring[2].0, super::tick(&read, "60"))
            && super::is_near(ring[2].1, super::level(&read, "80")),
        "{ring:?}"
    );
    assert_eq!(super::of_class(&read, "area").count(), 2);
    assert!(
        super::of_class(&read, "internal").next().is_none()
            && super::of_class(&read, "axis").next().is_some()
    );
}

/// Results with the fewest and emptiest entries make drawings without numbers that are not finite.
#[test]
fn drawings_of_next_to_nothing_are_drawings() {
    let mut drawings = vec![
        map_sheet(&[], Window::default(), LevelColour::Plain),
        section(&sector(1), SectionView::Meridional),
        around(&sector(1)),
        around(&sector(0)),
    ];
    for view in [SectionView::Meridional, SectionView::Cyclic] {
        let mut geometry = sector(0);
        drawings.push(section(&geometry, view));
        geometry.nodes.truncate(1);
        drawings.push(section(&geometry, view));
        geometry.nodes.clear();
        geometry.name.clear();
        drawings.push(section(&geometry, view));
    }

    let mut modes = modes();
    modes.speeds_rad_s.truncate(1);
    modes.frequencies_hz = vec![vec![vec![0.0]]];
    drawings.extend([campbell(&modes), campbell_fixed_frame(&modes)]);
    modes.speeds_rad_s.clear();
    modes.frequencies_hz.clear();
    drawings.extend([campbell(&modes), campbell_fixed_frame(&modes)]);

    let mut critical = critical();
    critical.critical_speeds.truncate(1);
    critical.critical_speeds[0].rms = 0.0;
    drawings.push(critical_speeds(&critical));
    critical.critical_speeds.clear();
    drawings.push(critical_speeds(&critical));
    (critical.linear_crossings, critical.driven_crossings) = (Vec::new(), Vec::new());
    drawings.push(critical_speeds(&critical));

    let axes = [VerticalAxis::EngineOrder, VerticalAxis::Frequency];
    let windows = [(0.0, 0.5), (1e6, 2e6), (5.0, 5.0), (f64::NAN, 1.0), (-1.0, 3.0), (11_000.0, 11_001.0)];
    for (axis, range) in axes.into_iter().flat_map(|axis| windows.map(|range| (axis, range))) {
        let window = Window { speeds_rpm: Some(range), engine_orders: Some(range) };
        drawings.push(interaction_map(
            &map(),
            Some(&critical),
            Some(&modes),
            axis,
            window,
            LevelColour::Plain,
        ));
        drawings.push(map_sheet(&[map()], window, LevelColour::Plain));
    }

    let silent = |orders: Vec<f64>| -> SpeedSpectra {
        let (bins, mut spectra) = (orders.len(), spectra(1));
        spectra.engine_orders = orders;
        spectra.sensors[0].amplitude = vec![0.0; bins];
        spectra.sensors[0].nodal_diameters = vec![vec![0.0; bins]];
        spectra
    };
    for spectra in [silent(Vec::new()), silent(vec![0.0]), silent(vec![0.0, 1.0])] {
        for (sensor, frame) in [(0, Frame::Rotating), (0, Frame::Fixed), (9, Frame::Fixed)] {
            drawings.push(spectrum(&spectra, &credentials(), &mm(), sensor, frame));
        }
    }

    let nothing = |revolutions: [u32; 2]| -> SpeedHistories {
        let mut recorded = recorded([0, 1], 1);
        (recorded.revolutions, recorded.samples_per_revolution) = (revolutions, 0);
        recorded.sensors.iter_mut().for_each(|sensor| sensor.displacement.fill(0.0));
        (recorded.contact, recorded.energy) = (None, None);
        recorded
    };
    for recorded in [nothing([0, 0]), nothing([3, 1]), recorded([0, 1], 1)] {
        for what in [
            HistoryQuantity::Displacement,
            HistoryQuantity::Velocity,
            HistoryQuantity::Force,
            HistoryQuantity::Contact,
            HistoryQuantity::Energy,
        ] {
            drawings.extend([speed_histories(&recorded, what, 0), speed_histories(&recorded, what, 99)]);
        }
        drawings.push(trajectories(&recorded));
    }

    let mut none: ForceMap = contact(1);
    for quantity in
        [ForceQuantity::Peak, ForceQuantity::Impulse, ForceQuantity::Share, ForceQuantity::Consumption]
    {
        drawings.extend([force_map(&contact(1), quantity), force_map(&contact(0), quantity)]);
        none.rows = vec![None; 5];
        drawings.push(force_map(&none, quantity));
        (none.rows, none.speeds_rad_s) = (Vec::new(), Vec::new());
        drawings.push(force_map(&none, quantity));
    }
    for depths in [Vec::new(), vec![Vec::new()], vec![vec![0.0]], vec![vec![0.0; 3]; 7]] {
        drawings.push(wear_map(&WearMap { depths }, &credentials(), &mm()));
    }
    for runs in [&RUNS[..0], &RUNS[..1], &RUNS[6..], &RUNS[3..4]] {
        drawings.extend(Quantity::ALL.map(|quantity| error_over_step(&study(runs, false), 0, quantity)));
    }
    drawings.push(error_over_step(&study(&RUNS, false), 7, Quantity::History));

    for drawing in drawings {
        let read = Document::parse(&drawing).unwrap();
        let title = read.root_element().first_element_child().and_then(|node| node.text()).unwrap();
        for wrong in ["NaN", "inf ", "inf\"", "-inf"] {
            assert!(!drawing.contains(wrong), "{wrong} in {title}: {drawing}");
        }
        let image = png(&drawing, 200).unwrap_or_else(|error| panic!("{title}: {error}"));
        assert_eq!(decoded(&image).0, 200);
    }
}

/// Images have the requested width, the proportions of the drawing, and its texts, which alone are lost without them.
#[test]
fn images_have_the_right_size_and_texts() {
    for (drawing, title, _) in all() {
        let image = png(&drawing, 400).unwrap();
        let (width, height, pixels) = decoded(&image);
        let read = Document::parse(&drawing).unwrap();
        let size = |name| read.root_element().attribute(name).unwrap().parse::<f64>().unwrap();
        assert_eq!(width, 400);
        assert!((f64::from(height) - 400.0 * size("height") / size("width")).abs() <= 1.0, "{title}");
        assert!(pixels.chunks(4).all(|pixel| pixel[3] == 255), "{title} is on white");
        let silent = drawing.replace("<text ", "<desc ").replace("</text>", "</desc>");
        let (_, _, without) = decoded(&png(&silent, 400).unwrap());
        let lost = pixels.chunks(4).zip(without.chunks(4)).filter(|(a, b)| a != b).count();
        assert!(lost > 500, "{title}: {lost} pixels are texts");
        assert_eq!(png(&drawing, 400).unwrap(), image, "{title} is the same again");
    }
}

/// Large results make no larger drawings.
#[test]
fn large_results_make_no_large_drawings() {
    let mut many = spectra(1);
    many.engine_orders = (0..20_000).map(|bin| 0.05 * f64::from(bin)).collect();
    many.sensors[0].amplitude = (0..20_000).map(|bin| 1.0 + f64::from(bin % 7)).collect();
    many.sensors[0].nodal_diameters = vec![many.sensors[0].amplitude.clone(); 20];
    let mut dense = sector(3);
    let (first, mut nodes) = (dense.nodes[10], Vec::new());
    for i in 0..200_000u32 {
        let position = [20.0 + 1e-4 * f64::from(i), 0.1, f64::from(i % 100)];
        nodes.push(rubmap_analysis::result::SectorNode { position, ..first });
    }
    dense.nodes = nodes;
    for drawing in [
        spectrum(&many, &credentials(), &mm(), 0, Frame::Rotating),
        spectrum(&many, &credentials(), &mm(), 0, Frame::Fixed),
        section(&dense, SectionView::Meridional),
        speed_histories(&recorded([0, 50], 2048), HistoryQuantity::Force, 0),
        trajectories(&recorded([0, 50], 2048)),
        wear_map(&worn(20_000, 20), &credentials(), &mm()),
        force_map(&contact(5000), ForceQuantity::Peak),
    ] {
        assert!(drawing.len() < 4_000_000, "{} bytes: {}", drawing.len(), &drawing[..300]);
    }
}

#[test]
fn what_is_no_image_is_refused() {
    assert_eq!(png("<svg/>", 5), Err(PngError::Width { width: 5 }));
    assert!(matches!(png("no drawing", 100), Err(PngError::Svg(_))));
    let high = r#"<svg xmlns="http://www.w3.org/2000/svg" width="1" height="9000"/>"#;
    assert!(matches!(png(high, 4096), Err(PngError::Size { .. })));
}
