//! Damaged uploads that are not packages at all: never a panic, never past the limits.

use std::io::Write;
use std::sync::LazyLock;

use proptest::prelude::*;
use rubmap::package::Limits;
use rubmap::package::PackageError;
use rubmap::package::error::ArchiveProblem;
use rubmap::solid::load::volumes;
use rubmap::solid::stress::NodalStress;
use zip::CompressionMethod::{Deflated, Stored};

use crate::fixed::fixed;
use crate::sample::{Files, import, import_within};

fn problem(bytes: &[u8], limits: &Limits) -> (Option<String>, ArchiveProblem) {
    match import_within(bytes, limits).expect_err("refused") {
        PackageError::Archive { file, problem } => (file, problem),
        other => panic!("{other}"),
    }
}

#[test]
fn what_inflates_is_counted_not_what_is_announced() {
    let mut files = Files::good();
    // 64 MB of blanks deflate to 64 kB; gzipped once more inside, to next to nothing.
    let blanks = vec![b'\n'; 64 << 20];
    let mut gz = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
    gz.write_all(&blanks).expect("in memory");
    let gz = gz.finish().expect("in memory");
    let limits = Limits { expanded_bytes: 1 << 20, ..Limits::default() };
    let good = files.text("k0.mtx");
    files.put("k0.mtx", [good.as_bytes(), &blanks].concat());
    let refused = (Some("k0.mtx".into()), ArchiveProblem::TooLarge { limit_bytes: 1 << 20 });
    assert_eq!(problem(&files.zip(Deflated), &limits), refused);
    assert_eq!(problem(&files.zip(Stored), &limits), refused);
    files.0.remove("k0.mtx");
    files.put("k0.mtx.gz", gz);
    // An all-blank matrix is wrong too, but at its first line it has not yet expanded.
    assert!(import_within(&files.zip(Deflated), &limits).is_err());
    // Exactly at the limit is within it.
    let good = Files::good();
    let size = good.0.values().map(|content| content.len() as u64).sum();
    let at =
        |expanded_bytes| import_within(&good.zip(Deflated), &Limits { expanded_bytes, ..Limits::default() });
    assert!(at(size).is_ok());
    assert!(at(size - 1).is_err());
}

#[test]
fn a_gzip_bomb_is_cut_off_while_it_expands() {
    let mut files = Files::good();
    let text = files.text("k0.mtx");
    files.0.remove("k0.mtx");
    let mut gz = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
    gz.write_all(text.as_bytes()).expect("in memory");
    gz.write_all(&vec![b'\n'; 64 << 20]).expect("in memory");
    files.put("k0.mtx.gz", gz.finish().expect("in memory"));
    let limits = Limits { expanded_bytes: 1 << 20, ..Limits::default() };
    let refused = (Some("k0.mtx.gz".into()), ArchiveProblem::TooLarge { limit_bytes: 1 << 20 });
    assert_eq!(problem(&files.zip(Deflated), &limits), refused);
}

/// Expansion in proportion to the upload: text that deflates a thousandfold, such as one line written over and over, must
/// not cost a thousand times what a model of the upload's size does.
#[test]
fn an_upload_may_expand_in_proportion_to_its_size() {
    let mut files = Files::good();
    let good = files.text("nodes.csv");
    files.put("nodes.csv", [good.as_bytes(), &vec![b'\n'; 80 << 20]].concat());
    let bytes = files.zip(Deflated);
    let limit_bytes = (64 << 20) + 100 * bytes.len() as u64;
    assert!(limit_bytes < 80 << 20, "{limit_bytes}");
    let refused = (Some("nodes.csv".into()), ArchiveProblem::TooLarge { limit_bytes });
    assert_eq!(problem(&bytes, &Limits::default()), refused);
    let good = Files::good().zip(Deflated);
    assert!(
        import_within(&good, &Limits { expansion: 0, ..Limits::default() }).is_ok(),
        "small ones may always"
    );
}

/// Repeated rows: reading stops where a repetition is certain; what follows, here no entry at all, is not looked at.
#[test]
fn repeated_rows_are_refused_before_the_rest_is_read() {
    let header = "%%MatrixMarket matrix coordinate real";
    let refused = |files: &Files| files.import().expect_err("refused").to_string();
    let one_row = |symmetry: &str, row: &str| {
        let mut files = Files::good();
        let rows = format!("{row}\n").repeat(1000);
        files.put("k0.mtx", format!("{header} {symmetry}\n18 18 1001\n1 1 1\n{rows}not an entry\n"));
        refused(&files)
    };
    for symmetry in ["symmetric", "general"] {
        assert_eq!(
            one_row(symmetry, "6 1 2.5"),
            "k0.mtx, line 5: entry (6, 1) is given twice (first on line 4); assemble the matrix so that every entry \
             appears once"
        );
    }
    // No row follows itself, but more are announced than a matrix of 18 rows has places for.
    let mut files = Files::good();
    let rows = "2 1 1\n2 2 1\n3 1 1\n".repeat(100);
    files.put("k0.mtx", format!("{header} symmetric\n18 18 302\n1 1 1\n{rows}not an entry\n"));
    assert_eq!(
        refused(&files),
        "k0.mtx, line 7: entry (2, 1) is given twice (first on line 4); assemble the matrix so that every entry appears once"
    );
    // Tables are read before matrices.
    for (table, message) in [
        ("nodes.csv", "nodes.csv, line 4: node 3 is already defined on line 3"),
        ("dofs.csv", "dofs.csv, line 4: component 3 of node 1 is already row 3 (line 3)"),
    ] {
        let mut files = Files::good();
        let third = files.text(table).lines().nth(2).expect("three rows").to_owned();
        files.line(table, 3, &format!("{third}\n").repeat(1000));
        files.put("m.mtx", "not a matrix");
        assert_eq!(refused(&files), message);
    }
}

/// Entries above and below the diagonal: those that are named decide what is said about them.
#[test]
fn two_mentions_in_one_triangle_are_no_mirror_images() {
    let mut files = Files::good();
    let rows = "2 1 1\n3 1 1\n2 1 1\n3 3 1\n1 2 1";
    files.put("k0.mtx", format!("%%MatrixMarket matrix coordinate real symmetric\n18 18 5\n{rows}\n"));
    assert_eq!(
        files.import().expect_err("refused").to_string(),
        "k0.mtx, line 5: entry (2, 1) is given twice (first on line 3); assemble the matrix so that every entry appears once"
    );
}

#[test]
fn other_limits_hold() {
    let bytes = Files::good().zip(Deflated);
    let too_many = ArchiveProblem::TooManyFiles { entries: 7, limit: 6 };
    assert_eq!(problem(&bytes, &Limits { entries: 6, ..Limits::default() }), (None, too_many));
    let message = |limits| import_within(&bytes, &limits).expect_err("refused").to_string();
    let text = message(Limits { manifest_bytes: 10, ..Limits::default() });
    assert_eq!(text, "sector.json: the file is larger than 10 bytes");
    let text = message(Limits { table_rows: 6, ..Limits::default() });
    assert_eq!(text, "nodes.csv, line 7: the table has more than the 6 rows this server accepts");
    let text = message(Limits { matrix_entries: 170, ..Limits::default() });
    assert_eq!(
        text,
        "m.mtx, line 2: the matrix announces 171 entries, more than the 170 this server accepts"
    );
}

#[test]
fn duplicate_and_encrypted_entries_are_named() {
    // The zip writer refuses duplicates, so a name of equal length is changed in the bytes.
    let mut files = Files::good();
    files.put("k9.mtx", "surplus");
    let mut bytes = files.zip(Stored);
    let places: Vec<usize> = (0..bytes.len() - 6).filter(|&at| &bytes[at..at + 6] == b"k9.mtx").collect();
    assert_eq!(places.len(), 2, "local and central header");
    places.into_iter().for_each(|at| bytes[at + 1] = b'0');
    assert_eq!(problem(&bytes, &Limits::default()), (Some("k0.mtx".into()), ArchiveProblem::Repeated));

    let mut bytes = Files::good().zip(Stored);
    let headers: Vec<usize> = (0..bytes.len() - 46)
        .filter(|&at| &bytes[at..at + 4] == b"PK\x01\x02" && &bytes[at + 46..at + 51] == b"m.mtx")
        .collect();
    headers.into_iter().for_each(|at| bytes[at + 8] |= 1);
    assert_eq!(problem(&bytes, &Limits::default()), (Some("m.mtx".into()), ArchiveProblem::Encrypted));
}

#[test]
fn a_flipped_bit_is_noticed() {
    let bytes = Files::good().zip(Stored);
    let at = bytes.windows(8).position(|w| w == b"\n1 1 1.9" || w == b"\n1 1 2.0").expect("an entry");
    let mut bytes = bytes;
    bytes[at + 5] ^= 1;
    let (file, problem) = problem(&bytes, &Limits::default());
    assert!(matches!(problem, ArchiveProblem::Damaged { .. }), "{file:?} {problem}");
}

#[test]
fn files_that_are_not_zips_say_so() {
    for bytes in [&b""[..], b"{\"name\": 1}", b"PK\x03\x04", &[0x1f, 0x8b, 8, 0]] {
        let error = import(bytes).expect_err("refused");
        assert!(error.to_string().starts_with("the upload is not a zip file, or it is cut off ("), "{error}");
        assert_eq!((error.file(), error.line(), error.field()), (None, None, None));
    }
    assert!(matches!(
        rubmap::package::read("/nonexistent.zip".as_ref(), &Limits::default()),
        Err(PackageError::Io { .. })
    ));
}

static MESHED: LazyLock<Files> = LazyLock::new(crate::mesh::linear);

proptest! {
    #![proptest_config(fixed(300))]

    #[test]
    fn garbage_never_panics(bytes in proptest::collection::vec(any::<u8>(), 0..2000)) {
        prop_assert!(import(&bytes).is_err());
    }

    #[test]
    fn truncated_packages_are_refused(kept in 0.0..1.0_f64, stored: bool) {
        let bytes = Files::good().zip(if stored { Stored } else { Deflated });
        prop_assert!(import(&bytes[..(bytes.len() as f64 * kept) as usize]).is_err());
    }

    #[test]
    fn spoiled_archives_never_panic(spots in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8)) {
        let mut bytes = Files::good().zip(Deflated);
        for (at, byte) in spots {
            let at = at.index(bytes.len());
            bytes[at] = byte;
        }
        // The package may still be good: times and attributes of entries mean nothing.
        let _ = import(&bytes);
    }

    #[test]
    fn spoiled_texts_never_panic(
        file in 0..7_usize,
        spots in proptest::collection::vec((any::<prop::sample::Index>(), prop_oneof![any::<u8>(), prop::sample::select(&b"0123456789.-+eE ,%\n\r[]{}\"null"[..])]), 1..6),
    ) {
        let mut files = Files::good();
        let content = files.0.values_mut().nth(file).expect("seven files");
        for (at, byte) in spots {
            let at = at.index(content.len());
            content[at] = byte;
        }
        if let Err(error) = files.import() {
            prop_assert!(!error.to_string().is_empty());
            prop_assert!(error.line().is_none() || error.file().is_some());
        }
    }

    #[test]
    fn spoiled_meshes_never_panic(
        file in 0..3_usize,
        spots in proptest::collection::vec((any::<prop::sample::Index>(), prop::sample::select(&b"0123456789.-e,\nCDQMI"[..])), 1..4),
    ) {
        let mut files = MESHED.clone();
        let content = files.0.get_mut(["elements.csv", "nodes.csv", "sector.json"][file]).expect("it has a mesh");
        for (at, byte) in spots {
            let at = at.index(content.len());
            content[at] = byte;
        }
        match files.import() {
            Err(error) => {
                prop_assert!(!error.to_string().is_empty());
                prop_assert!(error.line().is_none() || error.file().is_some());
            }
            // A package that passes can be worked with.
            Ok(imported) => {
                let mesh = imported.mesh.expect("it is named");
                prop_assert!(volumes(&mesh).iter().all(|volume| *volume > 0.0));
                let operator = NodalStress::new(&mesh);
                let u = faer::Mat::zeros(3 * mesh.nodes.len(), 1);
                let stress = operator.apply(faer::c64::new(1.0, 0.0), u.as_ref());
                prop_assert_eq!(stress.norm_max(), 0.0);
            }
        }
    }
}
