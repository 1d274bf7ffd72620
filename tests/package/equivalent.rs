//! Equivalent packages: different files that say the same thing.

use rubmap::package::{self, Limits};
use zip::CompressionMethod::Stored;

use crate::sample::{Files, Shape, import, package as sample};

fn gzipped(content: &[u8]) -> Vec<u8> {
    use std::io::Write;
    let mut gz = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    gz.write_all(content).expect("in memory");
    gz.finish().expect("in memory")
}

/// Text of a `symmetric` file as `general`, entries in reverse order, in other capitals and with comments.
fn general(text: &str) -> String {
    let mut lines = text.lines();
    let (_, size) = (lines.next(), lines.next().expect("sizes"));
    let rows = size.split(' ').next().expect("rows");
    let mut entries = Vec::new();
    for line in lines {
        let [row, column, value] = line.split(' ').collect::<Vec<_>>().try_into().expect("three words");
        entries.push(format!("{row}\t{column}   {value}"));
        if row != column {
            entries.push(format!("{column} {row} {value}"));
        }
    }
    entries.reverse();
    let head = format!(
        "%%matrixmarket MATRIX Coordinate Real GENERAL\n% exported\n\n{rows} {rows} {}\n",
        entries.len()
    );
    head + &entries.join("\r\n\n% more\n")
}

#[test]
fn writing_and_reading_keeps_every_bit() {
    let mut package = sample(Shape { sectors: 7, direction: [0.1, 0.2, 0.3], seed: 9, ..Shape::default() });
    package.manifest.axis.origin = [0.1 + 0.2, -1e-300, 5e-324];
    package.mass.entries[1].2 = 5e-324;
    package.stiffness[2].entries[3].2 = -0.0;
    package.stiffness[1].entries[3].2 = f64::MAX;
    let file = tempfile::NamedTempFile::new().expect("a temporary file");
    package::write(&package, file.as_file()).expect("written");
    let read = package::read_raw(file.path(), &Limits::default()).expect("read");
    assert_eq!(read, package);
    assert_eq!(format!("{read:?}"), format!("{package:?}"), "signs of zero included");
}

#[test]
fn storage_does_not_change_the_digest() {
    let good = Files::good();
    let reference = good.import().expect("good").digest;
    assert_eq!(reference.len(), 64);
    assert!(reference.bytes().all(|byte| byte.is_ascii_digit() || (b'a'..=b'f').contains(&byte)));
    assert_eq!(import(&good.zip(Stored)).expect("stored").digest, reference);
    let mut squeezed = good.clone();
    for name in ["m.mtx", "k1.mtx"] {
        let content = squeezed.0.remove(name).expect("present");
        squeezed.put(&format!("{name}.gz"), gzipped(&content));
    }
    assert_eq!(squeezed.import().expect("found as .gz").digest, reference);
    squeezed.json(|json| json["mass"] = "m.mtx.gz".into());
    assert_eq!(import(&squeezed.zip(Stored)).expect("named .gz").digest, reference);
    let mut minified = good.clone();
    minified.json(|_| ());
    assert_eq!(minified.import().expect("minified").digest, reference);
}

#[test]
fn content_does_change_the_digest() {
    let reference = Files::good().import().expect("good").digest;
    let changes: [&dyn Fn(&mut Files); 5] = [
        &|files| files.replace("sector.json", "sample", "other"),
        &|files| files.replace("sector.json", "0.6", "0.6001"),
        &|files| files.line("k2.mtx", 3, "1 1 2e6"),
        &|files| files.replace("nodes.csv", "7,", "8,"),
        &|files| {
            let matrix = files.0.remove("k0.mtx").expect("present");
            files.put("rest.mtx", matrix);
            files.replace("sector.json", "k0.mtx", "rest.mtx");
        },
    ];
    for change in changes {
        let mut files = Files::good();
        change(&mut files);
        assert_ne!(files.import().expect("still good").digest, reference);
    }
}

#[test]
fn either_triangle_both_triangles_and_any_layout_are_the_same_matrix() {
    let reference = Files::good().import().expect("good").sector;
    let mut files = Files::good();
    for name in ["m.mtx", "k0.mtx"] {
        files.put(name, general(&files.text(name)));
    }
    let upper: Vec<String> = (files.text("k1.mtx").lines().enumerate())
        .map(|(k, line)| match line.split(' ').collect::<Vec<_>>()[..] {
            [row, column, value] if k > 1 => format!(" {column} {row} {} ", value.replace('e', "D")),
            _ => line.to_owned(),
        })
        .collect();
    files.put("k1.mtx", upper.join("\n"));
    files.put("nodes.csv", format!("id, x, y, z\r\n{}", files.text("nodes.csv").replace('\n', "\r\n\r\n")));
    files.put("dofs.csv", format!("node,component\n{}", files.text("dofs.csv")));
    let sector = files.import().expect("the same package").sector;
    assert_eq!(sector.contact, reference.contact);
    let matrices = |s: &rubmap::dynamics::sector::SectorModel| {
        let all = std::iter::once(&s.mass).chain(&s.stiffness);
        all.flat_map(|m| [m.own.to_dense(), m.next.to_dense()]).collect::<Vec<_>>()
    };
    assert_eq!(matrices(&sector), matrices(&reference));
}

#[test]
fn one_speed_and_shared_stiffness_files_are_valid() {
    let mut rigid = Files::good();
    rigid.json(|json| json["stiffness"] = serde_json::json!(["k0.mtx", "k0.mtx", "k0.mtx"]));
    rigid.0.remove("k1.mtx");
    rigid.0.remove("k2.mtx");
    assert_eq!(rigid.import().expect("no stiffening at three speeds").sector.stiffness.len(), 3);
    rigid.json(|json| {
        json["stiffness"] = serde_json::json!(["k0.mtx"]);
        json["speeds_rad_s"] = serde_json::json!([0]);
    });
    assert_eq!(rigid.import().expect("one speed").sector.speeds_rad_s, [0.0]);
}

#[test]
fn folders_and_dots_inside_the_archive_are_fine() {
    let mut files = Files::good();
    let matrix = files.0.remove("m.mtx").expect("present");
    files.put("matrices/m.mtx", matrix);
    files.json(|json| json["mass"] = "./matrices/m.mtx".into());
    files.import().expect("a file in a folder");
}

/// Units mm, kN, ms, kg are a consistent system whose frequencies come out per millisecond; speeds stay rad/s, so its
/// mass is brought to force·s²/length: mm, N, s, t with the same numbers for stiffness in kN has mass 1e6 times larger.
#[test]
fn milliseconds_become_seconds() {
    let seconds = Files::good().import().expect("good").sector;
    let mut files = Files::good();
    files.json(|json| {
        json["units"] = serde_json::json!({"length": "mm", "force": "kN", "time": "ms", "mass": "kg"});
    });
    let sector = files.import().expect("consistent").sector;
    assert_eq!((sector.units.time.as_str(), sector.units.mass.as_str()), ("s", "kN·s²/mm"));
    assert_eq!(sector.stiffness[0].own.val(), seconds.stiffness[0].own.val());
    for (a, b) in sector.mass.own.val().iter().zip(seconds.mass.own.val()) {
        assert!((a - 1e-6 * b).abs() <= 1e-15 * a.abs());
    }
}
