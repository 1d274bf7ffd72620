//! Reports read back.

use crate::SurfaceView;
use roxmltree::Document;

use super::impeller::impeller;
use super::stresses::{strengths, stressed_critical, stressed_map};
use super::{backbones, critical, map, modes};
use crate::report;
use rubmap_analysis::result::{
    Backbones, CriticalSpeeds, FieldSurface, InteractionMap, Strengths, SweepLevel, ValidityMeasure,
    ValidityVerdict,
};

/// Converts a page to XML: elements of HTML without an end get one.
fn as_xml(page: &str) -> String {
    let page = page.strip_prefix("<!DOCTYPE html>").expect("a document type");
    page.replace("initial-scale=1\">", "initial-scale=1\"/>").replace("utf-8\">", "utf-8\"/>")
}

/// Level of a wheel with a verdict whose sentence has characters of HTML, as names of ranges may.
fn level(map: &InteractionMap) -> SweepLevel {
    serde_json::from_value(serde_json::json!({"speeds": [], "verdict": {
        "verdict": "act", "sentence": "Act: in range \"<b>cruise</b>\" at 20,567 rpm.", "ranges_given": true, "ranges": [],
        "critical_speeds": [], "worst": [], "would_decide": [], "units": map.units, "settings": map.settings, "version": "0",
    }}))
    .unwrap()
}

#[test]
fn a_report_of_a_sweep_says_all_and_needs_nothing() {
    let hostile = "</h1><script>alert(1)</script> & \"Ω\"";
    let head = report::Head {
        title: hostile.to_owned(),
        facts: vec![("job", hostile.to_owned())],
        notes: Some(hostile.to_owned()),
    };
    let (map, tables, campbell) = (map(), [critical()], modes());
    let page = report::sweep(
        &head,
        &report::Sweep {
            level: &level(&map),
            map: &map,
            critical: &tables,
            forces: None,
            histories: &[],
            campbell: Some(&campbell),
            strengths: &[],
            surfaces: &[],
        },
    );
    let xml = as_xml(&page);
    let read = Document::parse(&xml).unwrap();
    assert!(!page.contains("<script"), "texts stay texts");
    let all = |name: &str| read.descendants().filter(|node| node.has_tag_name(name)).count();
    assert_eq!(read.descendants().find(|node| node.has_tag_name("h1")).unwrap().text(), Some(hostile));
    let sheet =
        read.descendants().find(|node| node.has_tag_name("h1")).unwrap().next_sibling_element().unwrap();
    assert_eq!(sheet.attribute("class"), Some("sheet"));
    let first = sheet.first_element_child().unwrap();
    assert_eq!((first.tag_name().name(), first.attribute("class")), ("p", Some("verdict act")));
    let said: String =
        first.descendants().filter(|node| node.is_text()).filter_map(|node| node.text()).collect();
    assert_eq!(said, "Act: in range \"<b>cruise</b>\" at 20,567 rpm.");
    let drawings = read.descendants().filter(|node| node.tag_name().name() == "svg").count();
    assert_eq!(drawings, 3, "level, map and natural frequencies");
    for word in ["src=", "@import", "url(http", "<link", "<iframe"] {
        assert!(!page.contains(word), "{word}");
    }
    // One speed without a result, one that has not settled, one peak that is not resolved.
    let text: String = read.descendants().filter_map(|node| node.text()).collect::<Vec<_>>().join(" ");
    for words in [
        "No result at 12000 rpm: grew beyond <bounds>",
        "1 speeds had not settled",
        "1 critical speeds are not resolved",
        "4 of 5",
        "3 periodic, 1 not settled",
        "at 4 speeds, in 50.0 to 50.0 % of the steps",
        "\"peak_prominence\"",
        "clearance (leading 0.3, trailing 0.2), lobes (",
    ] {
        assert!(text.contains(words), "{words}: {text}");
    }
    assert!(all("table") >= 5, "facts, asked, credentials, critical speeds, crossings, responses");
    let rows = |rpm: &str| {
        read.descendants().filter(|node| node.has_tag_name("td") && node.text() == Some(rpm)).count()
    };
    assert_eq!((rows("11000"), rows("13000"), rows("12000")), (2, 2, 0), "peaks, and largest responses");
}

#[test]
fn a_report_of_a_modal_analysis_has_its_crossings() {
    let campbell = modes();
    let page = report::modal_analysis(&report::Head::default(), &campbell, None);
    let xml = as_xml(&page);
    let read = Document::parse(&xml).unwrap();
    let text: String = read.descendants().filter_map(|node| node.text()).collect::<Vec<_>>().join(" ");
    assert!(text.contains("Crossings that the lobes can drive") && text.contains("None."), "{text}");
    for crossing in &campbell.driven_crossings {
        assert!(text.contains(&format!("{:.1}", crossing.frequency_hz)));
    }
}

/// Report of a modal analysis with backbone curves: figure and table; none without curves.
#[test]
fn a_report_of_a_modal_analysis_has_its_backbone_curves() {
    let text = |backbones: Option<&Backbones>| {
        let xml = as_xml(&report::modal_analysis(&report::Head::default(), &modes(), backbones));
        let read = Document::parse(&xml).unwrap();
        read.descendants().filter_map(|node| node.text()).collect::<Vec<_>>().join("|")
    };
    let found = backbones();
    let with = text(Some(&found));
    assert!(with.contains("Backbone curves at 14,000 rpm"), "{with}");
    for end in ["the largest amplitude is reached", "no larger motion was found"] {
        assert!(with.contains(end), "{end}: {with}");
    }
    // 4 % at an amplitude of 1, and 6 % there of a curve that ends at 0.6.
    for change in ["+5.76 %", "+2.16 %"] {
        assert!(with.contains(change), "{change}: {with}");
    }
    let empty = Backbones { curves: Vec::new(), ..found };
    for without in [None, Some(&empty)] {
        assert!(!text(without).contains("Backbone"));
    }
}

fn page(
    map: &InteractionMap,
    tables: &[CriticalSpeeds],
    strengths: &[Strengths],
    surfaces: &[(FieldSurface, SurfaceView)],
) -> String {
    let found = report::Sweep {
        level: &level(map),
        map,
        critical: tables,
        forces: None,
        histories: &[],
        campbell: None,
        strengths,
        surfaces,
    };
    as_xml(&report::sweep(&report::Head::default(), &found))
}

/// Measures that were not evaluated are named, whether linear theory is said to hold or not.
#[test]
fn a_report_says_what_validity_lacks() {
    let mut map = stressed_map();
    for point in &mut map.points[..2] {
        let found = point.validity.as_mut().unwrap();
        found.lacking = serde_json::from_value(serde_json::json!([
            {"what": "displacement_over_thickness", "reason": "the package has no mesh"},
        ]))
        .unwrap();
    }
    let mut critical = stressed_critical();
    critical.critical_speeds[0].validity = Some(ValidityVerdict::Linear);
    critical.critical_speeds[0].validity_lacking = vec![ValidityMeasure::DisplacementOverThickness];
    let page = page(&map, &[critical], &strengths(), &[]);
    let read = Document::parse(&page).unwrap();
    let texts = read.descendants().filter(|node| node.is_text()).filter_map(|node| node.text());
    let words = texts.collect::<Vec<_>>().join(" ");
    for expected in [
        "Of 4 speeds: linear theory holds as far as is known at 2 speeds, linear theory doubtful at 1 speeds",
        "largest displacement of a tip over the blade's thickness: the package has no mesh",
        "At some speeds linear theory is judged without the blade's thickness; the section on it says why.",
    ] {
        assert!(words.contains(expected), "{expected}: {words}");
    }
    // The table of critical speeds names them, too.
    assert_eq!(words.matches("linear theory holds as far as is known").count(), 2);
}

/// Sections on stress, margin, linear theory and pictures hold their numbers; without numbers there is no section.
#[test]
fn a_report_says_what_is_left_and_what_is_not_valid() {
    let text = |page: &str| {
        let read = Document::parse(page).unwrap();
        read.descendants().filter_map(|node| node.text()).collect::<Vec<_>>().join(" ")
    };
    let surfaces = [(impeller(0..1, 4, 2.0), SurfaceView::Front)];
    let full = page(&stressed_map(), &[stressed_critical()], &strengths(), &surfaces);
    let words = text(&full);
    for expected in [
        "Stress and margin",
        "200 MPa (von Mises) at 14000 rpm: node 200 at (1.00, 2.00, 3.00) mm of the first sector, blade 4, revolution 19.25",
        "210 MPa at this speed",
        "1.08 at 14000 rpm; at 1 nothing is left",
        "17 nodes of a sector within 2.50 mm of a contact node",
        "Haigh diagram",
        "Is linear theory valid?",
        "Of 4 speeds: linear theory holds at 2 speeds, linear theory doubtful at 1 speeds, beyond linear theory at 1 speeds.",
        "14000 rpm: beyond linear theory: largest displacement of a tip over the blade's thickness is 12.9, above 2.00",
        "1 speeds: beyond linear theory; the section on it has the numbers.",
        "Shapes and stresses",
        "Nodal diameter 2, mode 1",
    ] {
        assert!(words.contains(expected), "{expected}: {words}");
    }
    let read = Document::parse(&full).unwrap();
    let drawings = read.descendants().filter(|node| node.tag_name().name() == "svg").count();
    assert_eq!(drawings, 5, "level, map, Haigh diagram, and a sector from two sides");
    // Drawings share the page, so equal ids must mean equal elements.
    let mut named = std::collections::BTreeMap::new();
    for node in
        read.descendants().filter(|node| node.has_tag_name(("http://www.w3.org/2000/svg", "linearGradient")))
    {
        let stops: Vec<_> = node.children().filter_map(|stop| stop.attribute("stop-color")).collect();
        let known = named.entry(node.attribute("id").unwrap()).or_insert_with(|| stops.clone());
        assert_eq!(*known, stops);
    }
    assert!(named.len() >= 3, "{named:?}");
    let bare = text(&page(&map(), &[critical()], &[], &[]));
    for absent in ["Stress", "linear theory", "Shapes", "utilisation"] {
        assert!(!bare.contains(absent), "{absent}");
    }
}
