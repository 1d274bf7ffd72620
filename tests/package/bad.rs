//! Checks of docs/package.md as a list of bad packages: each carries the exact message it must produce.

use serde_json::json;

use crate::sample::Files;

/// Spoiled package, with the message and the place (file, line, field) it must be refused with.
pub(crate) struct Case {
    spoil: fn(&mut Files),
    message: &'static str,
    place: (Option<&'static str>, Option<u64>, Option<&'static str>),
}

pub(crate) const fn case(
    spoil: fn(&mut Files),
    message: &'static str,
    place: (Option<&'static str>, Option<u64>, Option<&'static str>),
) -> Case {
    Case { spoil, message, place }
}

fn check(cases: &[Case]) {
    check_on(&Files::good(), cases);
}

/// Checks each case, on a copy of `good`.
pub(crate) fn check_on(good: &Files, cases: &[Case]) {
    let mut wrong = String::new();
    for Case { spoil, message, place } in cases {
        let mut files = good.clone();
        spoil(&mut files);
        let (text, found) = match files.import() {
            Ok(_) => ("accepted".to_owned(), (None, None, None)),
            Err(error) => {
                let place = (error.file().map(str::to_owned), error.line(), error.field().map(str::to_owned));
                (error.to_string(), place)
            }
        };
        let found = (found.0.as_deref(), found.1, found.2.as_deref());
        if (text.as_str(), found) != (*message, *place) {
            wrong += &format!("\n    expected {message:?}, {place:?}\n    found    {text:?}, {found:?}\n");
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

const JSON: Option<&str> = Some("sector.json");

#[test]
fn files() {
    check(&[
        case(
            |f| drop(f.0.remove("sector.json")),
            "sector.json: the archive holds no file sector.json; add it under exactly this name",
            (JSON, None, Some("")),
        ),
        case(
            |f| {
                f.0 = std::mem::take(&mut f.0)
                    .into_iter()
                    .map(|(name, content)| (format!("impeller/{name}"), content))
                    .collect()
            },
            "sector.json: the archive holds no file sector.json; there is one in the folder \"impeller\": zip the files, not their folder",
            (JSON, None, Some("")),
        ),
        case(
            |f| drop(f.0.remove("k1.mtx")),
            "sector.json, /stiffness/1: the archive holds no file k1.mtx; add it under exactly this name",
            (Some("k1.mtx"), None, Some("/stiffness/1")),
        ),
        case(
            |f| drop(f.0.remove("dofs.csv")),
            "sector.json, /dofs: the archive holds no file dofs.csv; add it under exactly this name",
            (Some("dofs.csv"), None, Some("/dofs")),
        ),
        case(
            |f| f.put("notes.txt", "hello"),
            "notes.txt: sector.json does not name this file; remove it from the archive or name it",
            (Some("notes.txt"), None, None),
        ),
        case(
            |f| f.put("../m.mtx", "hello"),
            "../m.mtx: the archive holds a file with an absolute or parent path; paths inside a package must stay inside it",
            (Some("../m.mtx"), None, None),
        ),
        case(
            |f| f.put("/etc/passwd", "hello"),
            "/etc/passwd: the archive holds a file with an absolute or parent path; paths inside a package must stay inside it",
            (Some("/etc/passwd"), None, None),
        ),
        case(
            |f| f.json(|j| j["mass"] = json!("../m.mtx")),
            "sector.json, /mass: \"../m.mtx\" is not a file name inside the package",
            (JSON, None, Some("/mass")),
        ),
        case(
            |f| f.json(|j| j["mass"] = json!("k0.mtx")),
            "sector.json, /stiffness/0: the file \"k0.mtx\" is already named as the mass matrix",
            (JSON, None, Some("/stiffness/0")),
        ),
        case(
            |f| {
                let content = f.0.remove("m.mtx").unwrap_or_default();
                f.put("m.mtx.gz", content);
            },
            "m.mtx.gz: this file is damaged (invalid gzip header); make the archive again",
            (Some("m.mtx.gz"), None, None),
        ),
    ]);
}

#[test]
fn manifest() {
    check(&[
        case(
            |f| f.put("sector.json", "{\n\"name\": }"),
            "sector.json, /name: expected value (line 2, column 9)",
            (JSON, Some(2), Some("/name")),
        ),
        case(
            |f| f.json(|j| j["colour"] = json!("red")),
            "sector.json, /colour: unknown field `colour`, expected one of `name`, `sectors`, `units`, `axis`, `speeds_rad_s`, `frame`, `mass`, `stiffness`, `gyroscopic`, `nodes`, `dofs`, `cyclic`, `contact`, `mesh` (line 1, column 67)",
            (JSON, Some(1), Some("/colour")),
        ),
        case(
            |f| f.json(|j| drop(j.as_object_mut().map(|o| o.remove("frame")))),
            "sector.json, /frame: missing field `frame` (line 1, column 378)",
            (JSON, Some(1), Some("/frame")),
        ),
        case(
            |f| f.json(|j| j["sectors"] = json!(2.5)),
            "sector.json, /sectors: invalid type: floating point `2.5`, expected an integer from 0 (line 1, column 267)",
            (JSON, Some(1), Some("/sectors")),
        ),
        case(
            |f| f.json(|j| j["sectors"] = json!(0)),
            "sector.json, /sectors: a wheel has at least one sector",
            (JSON, None, Some("/sectors")),
        ),
        case(
            |f| f.json(|j| j["units"]["mass"] = json!("kg")),
            "sector.json, /units: the units are not consistent: force must be mass·length/time², but 1 kg·mm/s² is 0.001 N; with mm, N and s the mass is in t",
            (JSON, None, Some("/units")),
        ),
        case(
            |f| f.json(|j| j["units"]["time"] = json!("mm")),
            "sector.json, /units/time: \"mm\" is not a unit of time",
            (JSON, None, Some("/units/time")),
        ),
        case(
            |f| f.json(|j| j["units"]["time"] = json!("tick")),
            "sector.json, /units/time: the unit of time \"tick\" is not known, so speeds in rad/s cannot be compared with the matrices: use s, ms or us",
            (JSON, None, Some("/units/time")),
        ),
        case(
            |f| f.json(|j| j["units"]["force"] = json!(" ")),
            "sector.json, /units/force: the unit has no name",
            (JSON, None, Some("/units/force")),
        ),
        case(
            |f| f.json(|j| j["axis"]["direction"] = json!([0, 0, 0])),
            "sector.json, /axis/direction: the axis direction has length zero; give the direction about which rotation is positive",
            (JSON, None, Some("/axis/direction")),
        ),
        case(
            |f| f.replace("sector.json", "0.6", "1e999"),
            "sector.json, /contact/0/normal/0: number out of range (line 50, column 13)",
            (JSON, Some(50), Some("/contact/0/normal/0")),
        ),
        case(
            |f| f.json(|j| j["speeds_rad_s"] = json!([0, 1000])),
            "sector.json, /speeds_rad_s: 2 speeds are given; a package has one (0) or three (0, Ω1/2, Ω1)",
            (JSON, None, Some("/speeds_rad_s")),
        ),
        case(
            |f| f.json(|j| j["speeds_rad_s"] = json!([])),
            "sector.json, /speeds_rad_s: 0 speeds are given; a package has one (0) or three (0, Ω1/2, Ω1)",
            (JSON, None, Some("/speeds_rad_s")),
        ),
        case(
            |f| f.json(|j| j["speeds_rad_s"] = json!([0, 2000, 1000])),
            "sector.json, /speeds_rad_s/2: the speeds are not ascending: 1000 rad/s follows 2000 rad/s",
            (JSON, None, Some("/speeds_rad_s/2")),
        ),
        case(
            |f| f.json(|j| j["speeds_rad_s"] = json!([0, 0, 1000])),
            "sector.json, /speeds_rad_s/1: the speeds are not ascending: 0 rad/s follows 0 rad/s",
            (JSON, None, Some("/speeds_rad_s/1")),
        ),
        case(
            |f| f.json(|j| j["speeds_rad_s"] = json!([500, 1000, 2000])),
            "sector.json, /speeds_rad_s/0: the first speed is 500 rad/s; the first stiffness matrix must be the one at rest (0)",
            (JSON, None, Some("/speeds_rad_s/0")),
        ),
        case(
            |f| f.json(|j| j["stiffness"] = json!(["k0.mtx", "k1.mtx"])),
            "sector.json, /stiffness: 2 stiffness matrices are named for 3 speeds; name one per speed, in the same order",
            (JSON, None, Some("/stiffness")),
        ),
    ]);
}

/// Name of so many letters.
fn long(letters: usize) -> String {
    "é".repeat(letters)
}

#[test]
fn texts_are_bounded() {
    let mut files = Files::good();
    files.json(|j| j["name"] = json!(long(200)));
    files.json(|j| j["units"]["force"] = json!(long(40)));
    assert!(files.import().is_ok());
    check(&[
        case(
            |f| f.json(|j| j["name"] = json!(long(201))),
            "sector.json, /name: the text has more than 200 characters",
            (JSON, None, Some("/name")),
        ),
        case(
            |f| f.json(|j| j["units"]["force"] = json!(long(41))),
            "sector.json, /units/force: the text has more than 40 characters",
            (JSON, None, Some("/units/force")),
        ),
    ]);
}

#[test]
fn errors_repeat_no_more_than_a_line_of_what_was_written() {
    let long = || "q".repeat(30_000);
    let spoilt: [&dyn Fn(&mut Files); 14] = [
        &|f| f.json(|j| j[long()] = json!(1)),
        &|f| f.json(|j| j["frame"] = json!(long())),
        &|f| f.json(|j| j["sectors"] = json!(long())),
        &|f| f.json(|j| j["units"]["time"] = json!(long())),
        &|f| f.json(|j| j["mass"] = json!(long())),
        &|f| f.json(|j| j["mass"] = json!(format!("../{}", long()))),
        &|f| f.json(|j| j["speeds_rad_s"] = json!(vec![0; 30_000])),
        &|f| f.put(&long(), "surplus"),
        &|f| f.put(&format!("/{}", long()), "outside"),
        &|f| {
            let dofs = f.0.remove("dofs.csv").unwrap_or_default();
            f.put(&format!("{}/dofs.csv", long()), dofs);
        },
        &|f| f.line("nodes.csv", 2, &format!("2,{},0,0", long())),
        &|f| f.line("dofs.csv", 2, &format!("1,{}", long())),
        &|f| f.line("k0.mtx", 1, &format!("%%MatrixMarket matrix {}", long())),
        &|f| f.line("k0.mtx", 9, &long()),
    ];
    for (k, spoil) in spoilt.iter().enumerate() {
        let mut files = Files::good();
        spoil(&mut files);
        let error = files.import().expect_err("refused");
        let text = error.to_string();
        assert!(text.chars().count() < 500, "case {k}: {} characters", text.chars().count());
        let place = error.file().map_or(0, str::len) + error.field().map_or(0, str::len);
        assert!(place < 200, "case {k}: {place} bytes of file and field");
    }
}

#[test]
fn tables() {
    check(&[
        case(
            |f| f.line("nodes.csv", 3, "3,1,2"),
            "nodes.csv, line 3: 3 comma-separated values where 4 are expected (id,x,y,z)",
            (Some("nodes.csv"), Some(3), None),
        ),
        case(
            |f| f.line("nodes.csv", 3, "3,1,2,nan"),
            "nodes.csv, line 3: z is \"nan\", not a finite number",
            (Some("nodes.csv"), Some(3), None),
        ),
        case(
            |f| f.line("nodes.csv", 3, "-3,1,2,3"),
            "nodes.csv, line 3: \"-3\" is not a node id (an integer from 0)",
            (Some("nodes.csv"), Some(3), None),
        ),
        case(
            |f| f.line("nodes.csv", 7, "\n2,1,2,3"),
            "nodes.csv, line 8: node 2 is already defined on line 2",
            (Some("nodes.csv"), Some(8), None),
        ),
        case(
            |f| f.line("nodes.csv", 1, "id,z,y,x"),
            "nodes.csv, line 1: the header names its columns in another order than id,x,y,z; reorder them",
            (Some("nodes.csv"), Some(1), None),
        ),
        case(
            |f| f.line("nodes.csv", 1, "id,r,theta,z"),
            "nodes.csv, line 1: the header names \"r\", where id,x,y,z are read: write Cartesian coordinates",
            (Some("nodes.csv"), Some(1), None),
        ),
        case(
            |f| f.put("dofs.csv", "\n"),
            "dofs.csv, line 1: the table has no rows",
            (Some("dofs.csv"), Some(1), None),
        ),
        case(
            |f| f.line("dofs.csv", 5, "2,4"),
            "dofs.csv, line 5: component \"4\" is not 1, 2 or 3",
            (Some("dofs.csv"), Some(5), None),
        ),
        case(
            |f| f.line("dofs.csv", 5, "99,2"),
            "dofs.csv, line 5: node 99 is not in the node table",
            (Some("dofs.csv"), Some(5), None),
        ),
        case(
            |f| f.line("dofs.csv", 5, "1,2"),
            "dofs.csv, line 5: component 2 of node 1 is already row 2 (line 2)",
            (Some("dofs.csv"), Some(5), None),
        ),
    ]);
}

#[test]
fn matrices() {
    const K0: Option<&str> = Some("k0.mtx");
    check(&[
        case(
            |f| f.put("k0.mtx", ""),
            "k0.mtx, line 1: the file does not start with a Matrix Market header such as \"%%MatrixMarket matrix coordinate real symmetric\"",
            (K0, Some(1), None),
        ),
        case(
            |f| f.line("k0.mtx", 1, "18 18 171"),
            "k0.mtx, line 1: the file does not start with a Matrix Market header such as \"%%MatrixMarket matrix coordinate real symmetric\"",
            (K0, Some(1), None),
        ),
        case(
            |f| f.line("k0.mtx", 1, "%%MatrixMarket matrix array real general"),
            "k0.mtx, line 1: the format \"array\" is not supported; write \"matrix coordinate real symmetric\" or \"general\"",
            (K0, Some(1), None),
        ),
        case(
            |f| f.line("k0.mtx", 1, "%%MatrixMarket matrix coordinate complex symmetric"),
            "k0.mtx, line 1: the field \"complex\" is not supported; write \"matrix coordinate real symmetric\" or \"general\"",
            (K0, Some(1), None),
        ),
        case(
            |f| f.line("k0.mtx", 1, "%%MatrixMarket matrix coordinate real skew-symmetric"),
            "k0.mtx, line 1: the symmetry \"skew-symmetric\" is not supported; write \"matrix coordinate real symmetric\" or \"general\"",
            (K0, Some(1), None),
        ),
        case(
            |f| f.line("k0.mtx", 2, "18 18"),
            "k0.mtx, line 2: the line after the header must be \"rows columns entries\", three integers",
            (K0, Some(2), None),
        ),
        case(
            |f| f.line("k0.mtx", 2, "18 17 171"),
            "k0.mtx, line 2: the matrix is 18 × 17, not square",
            (K0, Some(2), None),
        ),
        case(
            |f| f.line("k0.mtx", 2, "17 17 171"),
            "k0.mtx, line 2: the matrix has 17 rows, but the DOF table lists 18 DOF",
            (K0, Some(2), None),
        ),
        case(
            |f| f.line("m.mtx", 2, "% made by hand\n19 19 171"),
            "m.mtx, line 3: the matrix has 19 rows, but the DOF table lists 18 DOF",
            (Some("m.mtx"), Some(3), None),
        ),
        case(
            |f| f.line("k0.mtx", 2, "18 18 170"),
            "k0.mtx, line 173: this is one entry more than the 170 announced at the top",
            (K0, Some(173), None),
        ),
        case(
            |f| f.line("k0.mtx", 2, "18 18 172"),
            "k0.mtx, line 173: the file ends after 171 of the 172 entries announced at the top",
            (K0, Some(173), None),
        ),
        case(
            |f| f.line("k0.mtx", 7, "5 1 1,5"),
            "k0.mtx, line 7: \"5 1 1,5\" is not an entry \"row column value\"",
            (K0, Some(7), None),
        ),
        case(
            |f| f.line("k0.mtx", 7, "5 1"),
            "k0.mtx, line 7: \"5 1\" is not an entry \"row column value\"",
            (K0, Some(7), None),
        ),
        case(
            |f| f.line("k0.mtx", 7, "19 1 1"),
            "k0.mtx, line 7: entry (19, 1) is outside the 18 × 18 matrix; rows and columns count from 1",
            (K0, Some(7), None),
        ),
        case(
            |f| f.line("k0.mtx", 7, "5 0 1"),
            "k0.mtx, line 7: entry (5, 0) is outside the 18 × 18 matrix; rows and columns count from 1",
            (K0, Some(7), None),
        ),
        case(
            |f| f.line("k0.mtx", 7, "5 1 NaN"),
            "k0.mtx, line 7: entry (5, 1) is not a finite number",
            (K0, Some(7), None),
        ),
        case(
            |f| f.line("k0.mtx", 7, "5 1 -1e400"),
            "k0.mtx, line 7: entry (5, 1) is not a finite number",
            (K0, Some(7), None),
        ),
        case(
            |f| f.line("k0.mtx", 7, "6 1 1"),
            "k0.mtx, line 8: entry (6, 1) is given twice (first on line 7); assemble the matrix so that every entry appears once",
            (K0, Some(8), None),
        ),
        case(
            |f| f.line("k0.mtx", 7, "1 6 1"),
            "k0.mtx, line 8: entry (6, 1) is given twice (first on line 7); a symmetric file holds one triangle only: write one of the two, or declare the matrix general",
            (K0, Some(8), None),
        ),
        case(
            |f| {
                f.put(
                    "k0.mtx",
                    "%%MatrixMarket matrix coordinate real general\n18 18 3\n1 1 2\n2 1 1\n\n1 2 1.5\n",
                )
            },
            "k0.mtx, line 4: the matrix is not symmetric: entry (2, 1) is 1e0 (line 4), entry (1, 2) is 1.5e0 (line 6) (the worst of 1)",
            (K0, Some(4), None),
        ),
        case(
            |f| {
                f.put(
                    "k0.mtx",
                    "%%MatrixMarket matrix coordinate real general\n18 18 3\n1 1 2\n2 2 1\n1 2 1.5\n",
                )
            },
            "k0.mtx, line 5: the matrix is not symmetric: entry (2, 1) is 0e0, entry (1, 2) is 1.5e0 (line 5) (the worst of 1)",
            (K0, Some(5), None),
        ),
        case(
            |f| {
                f.put(
                    "k0.mtx",
                    "%%MatrixMarket matrix coordinate real general\n18 18 3\n1 2 2\n2 1 2\n1 2 2\n",
                )
            },
            "k0.mtx, line 5: entry (1, 2) is given twice (first on line 3); assemble the matrix so that every entry appears once",
            (K0, Some(5), None),
        ),
    ]);
}

#[test]
fn mass() {
    const M: Option<&str> = Some("m.mtx");
    check(&[
        case(
            |f| f.line("m.mtx", 3, "1 1 -3e-8"),
            "m.mtx: the mass of the assembled wheel is -9.679404808811571e-9 on the diagonal of node 1 (row 1), not positive; give every DOF mass or condense massless ones out",
            (M, None, None),
        ),
        case(
            |f| {
                let matrix = f
                    .text("m.mtx")
                    .lines()
                    .filter(|l| !l.contains("10 "))
                    .map(|l| format!("{l}\n"))
                    .collect::<String>();
                let entries = matrix.lines().count() - 2;
                f.put("m.mtx", matrix.replace("18 18 171", &format!("18 18 {entries}")));
            },
            "m.mtx: the mass of the assembled wheel is 0e0 on the diagonal of node 4 (row 10), not positive; give every DOF mass or condense massless ones out",
            (M, None, None),
        ),
        case(
            |f| f.line("m.mtx", 4, "2 1 1e-7"),
            "m.mtx: the mass of the assembled wheel is negative for some motion: the entry 1.0079560902217548e-7 between node 1 (row 2) and node 1 (row 1) is larger than their diagonals allow",
            (M, None, None),
        ),
        // Every pair of these entries is sound, all three are not: 20 on the diagonal, −15 between three DOF of node 3.
        case(
            |f| {
                for (row, column) in [(8, 7), (9, 7), (9, 8)] {
                    let head = format!("\n{row} {column} ");
                    let text = f.text("m.mtx");
                    let at = text.find(&head).unwrap_or_default() + head.len();
                    let end = at + text[at..].find('\n').unwrap_or_default();
                    f.put("m.mtx", format!("{}-1.5e-8{}", &text[..at], &text[end..]));
                }
            },
            "m.mtx: the mass of the assembled wheel is negative, by more than round-off, for a motion that node 3 (row 9) takes part in (nodal diameter 0): is the density positive everywhere, is this the mass matrix, and is it written with twelve digits or more?",
            (M, None, None),
        ),
    ]);
}

#[test]
fn cyclic_faces() {
    check(&[
        case(
            |f| f.json(|j| j["cyclic"][1][0] = json!(99)),
            "sector.json, /cyclic/1/0: node 99 is not in the node table",
            (JSON, None, Some("/cyclic/1/0")),
        ),
        case(
            |f| f.json(|j| j["cyclic"][1][1] = json!(98)),
            "sector.json, /cyclic/1/1: node 98 is not in the node table",
            (JSON, None, Some("/cyclic/1/1")),
        ),
        case(
            |f| f.json(|j| j["cyclic"][1] = json!([2, 2])),
            "sector.json, /cyclic/1: node 2 is paired with itself; the high node is another node, the low one turned by +2π/N; a node on the axis is in no pair",
            (JSON, None, Some("/cyclic/1")),
        ),
        case(
            |f| f.json(|j| j["cyclic"][1] = json!([1, 6])),
            "sector.json, /cyclic/1/0: node 1 is already a low node; every face node belongs to exactly one pair",
            (JSON, None, Some("/cyclic/1/0")),
        ),
        case(
            |f| f.json(|j| j["cyclic"][1] = json!([2, 5])),
            "sector.json, /cyclic/1/1: node 5 is already a high node; every face node belongs to exactly one pair",
            (JSON, None, Some("/cyclic/1/1")),
        ),
        case(
            |f| f.json(|j| j["cyclic"][1] = json!([5, 6])),
            "sector.json, /cyclic/1/0: node 5 is already a high node; every face node belongs to exactly one pair",
            (JSON, None, Some("/cyclic/1/0")),
        ),
        case(
            |f| f.json(|j| j["cyclic"] = json!([[1, 6], [2, 5]])),
            "sector.json, /cyclic/1: high node 5 is 5.099e0 away from low node 2 turned by +2π/3 about the axis (tolerance 2.153e-4; the worst pair); check sectors, axis and the pairing of the nodes",
            (JSON, None, Some("/cyclic/1")),
        ),
        case(
            |f| f.json(|j| j["cyclic"] = json!([[5, 1], [6, 2]])),
            "sector.json, /cyclic/1: high node 2 is 1.905e1 away from low node 6 turned by +2π/3 about the axis (tolerance 2.153e-4; the worst pair); every pair fits the turn by −2π/N: swap low and high, or reverse the axis direction",
            (JSON, None, Some("/cyclic/1")),
        ),
        case(
            |f| f.json(|j| j["axis"]["direction"] = json!([0, 0, -1])),
            "sector.json, /cyclic/1: high node 6 is 1.905e1 away from low node 2 turned by +2π/3 about the axis (tolerance 2.153e-4; the worst pair); every pair fits the turn by −2π/N: swap low and high, or reverse the axis direction",
            (JSON, None, Some("/cyclic/1")),
        ),
        case(
            |f| f.json(|j| j["sectors"] = json!(4)),
            "sector.json, /cyclic/1: high node 6 is 5.694e0 away from low node 2 turned by +2π/4 about the axis (tolerance 2.153e-4; the worst pair); check sectors, axis and the pairing of the nodes",
            (JSON, None, Some("/cyclic/1")),
        ),
        case(
            |f| {
                // Row 18 (node 5, component 3) becomes a DOF of the clamped node.
                f.line("dofs.csv", 18, "7,1");
            },
            "sector.json, /cyclic/0: low node 1 has the components 1, 2, 3 and high node 5 has 1, 2 in the DOF table; clamp the same components on both faces",
            (JSON, None, Some("/cyclic/0")),
        ),
        case(
            |f| {
                f.line("nodes.csv", 1, "1,0,0,0");
                f.line("nodes.csv", 6, "5,0,0,0");
            },
            "sector.json, /cyclic/0: nodes 1 and 5 are free but lie on the axis, a point that all sectors share: make them one node, in no pair",
            (JSON, None, Some("/cyclic/0")),
        ),
        case(
            |f| f.json(|j| j["cyclic"] = json!([[1, 5]])),
            "sector.json, /cyclic: node 2 turned by +2π/3 is node 6, both are free, and they are no pair: the wheel would have a slit there; name every pair of nodes on the two faces, those at the middle of edges too, or clamp both nodes",
            (JSON, None, Some("/cyclic")),
        ),
        case(
            // A node of the second pair is moved to the axis, where it is free in one direction across it.
            |f| {
                f.json(|j| j["cyclic"] = json!([[1, 5]]));
                f.line("nodes.csv", 2, "2,0,0,5");
                f.line("dofs.csv", 4, "7,1");
            },
            "sector.json, /dofs: node 2 lies on the axis and has the components 2, 3 in the DOF table, which the turn by one sector does not map onto each other; clamp it along the axis, in both directions across it, or wholly",
            (JSON, None, Some("/dofs")),
        ),
        case(
            // Low and high are swapped, and one node is 0.1 off.
            |f| {
                f.json(|j| j["cyclic"] = json!([[5, 1], [6, 2]]));
                let line = f.text("nodes.csv").lines().nth(4).expect("node 6").to_owned();
                let (rest, z) = line.rsplit_once(',').expect("fields");
                let off = format!("{rest},{}", z.parse::<f64>().expect("a number") + 0.1);
                f.line("nodes.csv", 5, &off);
            },
            "sector.json, /cyclic/1: high node 2 is 1.000e-1 away from low node 6 turned by −2π/3 about the axis (tolerance 2.156e-4; the worst pair); the pairs fit the turn by −2π/N better than that by +2π/N: swap low and high, or reverse the axis direction, and check the positions of the nodes",
            (JSON, None, Some("/cyclic/1")),
        ),
    ]);
}

#[test]
fn contact() {
    check(&[
        case(
            |f| f.json(|j| j["contact"] = json!([])),
            "sector.json, /contact: no contact node is named; nothing could ever touch the casing",
            (JSON, None, Some("/contact")),
        ),
        case(
            |f| f.json(|j| j["contact"][1]["node"] = json!(99)),
            "sector.json, /contact/1/node: node 99 is not in the node table",
            (JSON, None, Some("/contact/1/node")),
        ),
        case(
            |f| f.json(|j| j["contact"][1]["node"] = json!(4)),
            "sector.json, /contact/1/node: contact node 4 is already named at /contact/0",
            (JSON, None, Some("/contact/1/node")),
        ),
        case(
            |f| f.json(|j| j["contact"][1]["node"] = json!(7)),
            "sector.json, /contact/1/node: contact node 7 is clamped: the DOF table has its components none, contact needs 1, 2, 3",
            (JSON, None, Some("/contact/1/node")),
        ),
        case(
            |f| f.line("dofs.csv", 8, "7,2"),
            "sector.json, /contact/1/node: contact node 3 is clamped: the DOF table has its components 1, 3, contact needs 1, 2, 3",
            (JSON, None, Some("/contact/1/node")),
        ),
        case(
            |f| f.json(|j| j["contact"][1]["node"] = json!(2)),
            "sector.json, /contact/1/node: contact node 2 lies on the low cyclic face; contact nodes must be inside the sector",
            (JSON, None, Some("/contact/1/node")),
        ),
        case(
            |f| f.json(|j| j["contact"][1]["node"] = json!(6)),
            "sector.json, /contact/1/node: contact node 6 lies on the high cyclic face; contact nodes must be inside the sector",
            (JSON, None, Some("/contact/1/node")),
        ),
        case(
            |f| f.json(|j| j["contact"][1]["normal"] = json!([0, 0, 1.01])),
            "sector.json, /contact/1/normal: the normal has length 1.01, not 1 (within 0.001)",
            (JSON, None, Some("/contact/1/normal")),
        ),
        case(
            |f| f.json(|j| j["contact"][1]["normal"] = json!([0, 0, 0])),
            "sector.json, /contact/1/normal: the normal has length 0, not 1 (within 0.001)",
            (JSON, None, Some("/contact/1/normal")),
        ),
    ]);
}
