//! Reports read back.

use roxmltree::Document;

use super::{critical, map, modes};
use crate::report;

/// The page as XML: HTML's elements without an end get one.
fn as_xml(page: &str) -> String {
    let page = page.strip_prefix("<!DOCTYPE html>").expect("a document type");
    page.replace("initial-scale=1\">", "initial-scale=1\"/>").replace("utf-8\">", "utf-8\"/>")
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
            map: &map,
            critical: &tables,
            forces: None,
            histories: &[],
            campbell: Some(&campbell),
        },
    );
    let xml = as_xml(&page);
    let read = Document::parse(&xml).unwrap();
    assert!(!page.contains("<script"), "texts stay texts");
    let all = |name: &str| read.descendants().filter(|node| node.has_tag_name(name)).count();
    assert_eq!(read.descendants().find(|node| node.has_tag_name("h1")).unwrap().text(), Some(hostile));
    let drawings = read.descendants().filter(|node| node.tag_name().name() == "svg").count();
    assert_eq!(drawings, 2, "map and natural frequencies");
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
    let page = report::modal_analysis(&report::Head::default(), &campbell);
    let xml = as_xml(&page);
    let read = Document::parse(&xml).unwrap();
    let text: String = read.descendants().filter_map(|node| node.text()).collect::<Vec<_>>().join(" ");
    assert!(text.contains("Crossings that the lobes can drive") && text.contains("None."), "{text}");
    for crossing in &campbell.driven_crossings {
        assert!(text.contains(&format!("{:.1}", crossing.frequency_hz)));
    }
}
