//! Gyroscopic matrix of a package: the ways to write it, and what is refused.

use rubmap::package::raw::{MatrixFormat, RawPackage};
use rubmap::package::{self, Limits, PackageError};
use serde_json::json;

use crate::sample::{Files, Shape, package as sample, with_gyroscopic};

fn good() -> RawPackage {
    with_gyroscopic(sample(Shape::default()), 5)
}

fn general(rows: usize, entries: &str) -> String {
    let count = entries.lines().count();
    format!("%%MatrixMarket matrix coordinate real general\n{rows} {rows} {count}\n{entries}")
}

#[test]
fn is_written_and_read_to_the_bit() {
    for format in [MatrixFormat::Mtx, MatrixFormat::Npz] {
        let mut package = good();
        package.manifest.store_matrices_as(format);
        let file = tempfile::NamedTempFile::new().expect("a temporary file");
        package::write(&package, file.as_file()).expect("written");
        assert_eq!(package::read_raw(file.path(), &Limits::default()).expect("read"), package);
    }
}

#[test]
fn either_triangle_and_both_are_the_same_matrix() {
    let files = Files::of(&good());
    assert!(
        files
            .text("g.mtx")
            .starts_with("%%MatrixMarket matrix coordinate real skew-symmetric\n18 18 153\n2 1 ")
    );
    let reference = files.import().expect("good").sector.into_parts().gyroscopic.expect("given");
    let (mut upper, mut both) = (String::new(), String::new());
    for line in files.text("g.mtx").lines().skip(2) {
        let [row, column, value] = line.split(' ').collect::<Vec<_>>().try_into().expect("three words");
        let negated = -value.parse::<f64>().expect("a number");
        upper += &format!("{column} {row} {negated:e}\n");
        both += &format!("{row} {column} {value}\n{column} {row} {negated:e}\n");
    }
    let head = "%%MatrixMarket matrix coordinate real skew-symmetric\n18 18 153\n";
    for text in [format!("{head}{upper}"), general(18, &(both + "3 3 0\n"))] {
        let mut files = files.clone();
        files.put("g.mtx", text);
        let found = files.import().expect("the same package").sector.into_parts().gyroscopic.expect("given");
        assert_eq!(found.own.to_dense(), reference.own.to_dense());
        assert_eq!(found.next.to_dense(), reference.next.to_dense());
    }
}

#[test]
fn is_part_of_the_address_where_it_is_given() {
    let address = |files: &Files| files.import().expect("good").digest;
    let with = Files::of(&good());
    let mut other = with.clone();
    other.line("g.mtx", 3, "2 1 1e-9");
    let mut without = with.clone();
    without.json(|json| drop(json.as_object_mut().map(|fields| fields.remove("gyroscopic"))));
    without.0.remove("g.mtx");
    assert_eq!(address(&without), address(&Files::good()));
    assert!(address(&with) != address(&other) && address(&with) != address(&without));
}

/// Milliseconds: with time in them the matrix is brought to seconds as the mass is.
#[test]
fn milliseconds_become_seconds() {
    let mut files = Files::of(&good());
    let seconds = files.import().expect("good").sector.into_parts().gyroscopic.expect("given");
    files.json(|json| {
        json["units"] = json!({"length": "mm", "force": "kN", "time": "ms", "mass": "kg"});
    });
    let found = files.import().expect("consistent").sector.into_parts().gyroscopic.expect("given");
    for (a, b) in
        found.own.val().iter().chain(found.next.val()).zip(seconds.own.val().iter().chain(seconds.next.val()))
    {
        assert!((a - 1e-6 * b).abs() <= 1e-15 * a.abs());
    }
}

#[test]
fn wrong_ones_are_refused() {
    type Place = (Option<&'static str>, Option<u64>, Option<&'static str>);
    type Case<'a> = (&'a dyn Fn(&mut Files), &'static str, Place);
    const G: Option<&str> = Some("g.mtx");
    let head = "%%MatrixMarket matrix coordinate real skew-symmetric\n";
    let cases: [Case<'_>; 13] = [
        (
            &|f| drop(f.0.remove("g.mtx")),
            "sector.json, /gyroscopic: the archive holds no file g.mtx; add it under exactly this name",
            (G, None, Some("/gyroscopic")),
        ),
        (
            &|f| f.json(|json| drop(json.as_object_mut().map(|fields| fields.remove("gyroscopic")))),
            "g.mtx: sector.json does not name this file; remove it from the archive or name it",
            (G, None, None),
        ),
        (
            &|f| f.json(|json| json["gyroscopic"] = json!("m.mtx")),
            "sector.json, /gyroscopic: the file \"m.mtx\" is already named as the mass matrix",
            (Some("sector.json"), None, Some("/gyroscopic")),
        ),
        (
            &|f| f.put("g.mtx", f.text("m.mtx")),
            "g.mtx, line 1: the symmetry \"symmetric\" is not supported; write \"matrix coordinate real skew-symmetric\" or \"general\"",
            (G, Some(1), None),
        ),
        (
            &|f| f.put("m.mtx", f.text("g.mtx")),
            "m.mtx, line 1: the symmetry \"skew-symmetric\" is not supported; write \"matrix coordinate real symmetric\" or \"general\"",
            (Some("m.mtx"), Some(1), None),
        ),
        (
            &|f| f.put("g.mtx", format!("{head}17 17 1\n2 1 1\n")),
            "g.mtx, line 2: the matrix has 17 rows, but the DOF table lists 18 DOF",
            (G, Some(2), None),
        ),
        (
            &|f| f.line("g.mtx", 4, "3 1 nan"),
            "g.mtx, line 4: entry (3, 1) is not a finite number",
            (G, Some(4), None),
        ),
        (
            &|f| f.put("g.mtx", format!("{head}18 18 2\n2 1 1\n1 2 -1\n")),
            "g.mtx, line 4: entry (2, 1) is given twice (first on line 3); a symmetric file holds one triangle only: write one of the two, or declare the matrix general",
            (G, Some(4), None),
        ),
        (
            &|f| f.put("g.mtx", format!("{head}18 18 2\n2 1 1\n3 3 1e-3\n")),
            "g.mtx, line 4: entry (3, 3) is 1e-3, but the diagonal of a skew-symmetric matrix is zero: is this the gyroscopic matrix?",
            (G, Some(4), None),
        ),
        (
            &|f| f.put("g.mtx", general(18, "2 1 1\n1 2 -1\n5 5 2\n")),
            "g.mtx, line 5: entry (5, 5) is 2e0, but the diagonal of a skew-symmetric matrix is zero: is this the gyroscopic matrix?",
            (G, Some(5), None),
        ),
        (
            &|f| f.put("g.mtx", general(18, "2 1 1\n1 2 1\n")),
            "g.mtx, line 3: the matrix is not skew-symmetric: entry (2, 1) is 1e0 (line 3), entry (1, 2) is 1e0 (line 4) (the worst of 1)",
            (G, Some(3), None),
        ),
        (
            &|f| f.put("g.mtx", general(18, "2 1 1\n1 2 -1\n7 3 -2\n")),
            "g.mtx, line 5: the matrix is not skew-symmetric: entry (7, 3) is -2e0 (line 5), entry (3, 7) is 0e0 (the worst of 1)",
            (G, Some(5), None),
        ),
        (
            &|f| f.put("g.mtx", general(18, "2 1 1\n1 2 -1.00001\n")),
            "g.mtx, line 3: the matrix is not skew-symmetric: entry (2, 1) is 1e0 (line 3), entry (1, 2) is -1.00001e0 (line 4) (the worst of 1)",
            (G, Some(3), None),
        ),
    ];
    for (spoil, message, place) in cases {
        let mut files = Files::of(&good());
        spoil(&mut files);
        let error = files.import().expect_err(message);
        assert_eq!(error.to_string(), message);
        assert_eq!((error.file(), error.line(), error.field()), place, "{message}");
    }
    // The remains of cancellation and of printing few digits are no asymmetry.
    let mut files = Files::of(&good());
    files.put("g.mtx", general(18, "2 1 1\n1 2 -1.0000001\n4 4 1e-13\n5 4 1e-13\n"));
    files.import().expect("skew-symmetric within round-off");
}

/// Name and matrix go together: a package made in memory must say the same in both places.
#[test]
fn name_and_matrix_go_together() {
    let refused = |package| match package::to_sector(package) {
        Ok(_) => panic!("accepted"),
        Err(error @ (PackageError::Manifest { .. } | PackageError::Archive { .. })) => error.to_string(),
        Err(error) => panic!("{error}"),
    };
    let named = RawPackage { gyroscopic: None, ..good() };
    assert!(refused(named).contains("/gyroscopic: the archive holds no file g.mtx"));
    let mut unnamed = good();
    unnamed.manifest.gyroscopic = None;
    assert!(refused(unnamed).contains("sector.json does not name this file"));
}
