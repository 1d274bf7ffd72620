//! Matrices as scipy writes them: the same model as their Matrix Market twin, and every way to get them wrong.

use std::io::{Cursor, Write};

use rubmap::package::raw::{MatrixFormat, RawMatrix};
use rubmap::package::{self, Limits};
use zip::CompressionMethod::{Deflated, Stored};

use crate::sample::{Files, Shape, import_within, package as sample};

/// Bytes of one array in numpy's format, by its own hand: version 1, padding as numpy's.
fn npy(descr: &str, shape: &str, bytes: &[u8]) -> Vec<u8> {
    let head = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': {shape}, }}");
    let mut out = b"\x93NUMPY\x01\x00\x76\x00".to_vec();
    out.extend(format!("{head:<117}\n").bytes());
    out.extend(bytes);
    out
}

fn vector<const B: usize>(descr: &str, values: impl IntoIterator<Item = [u8; B]>) -> Vec<u8> {
    let bytes: Vec<[u8; B]> = values.into_iter().collect();
    npy(descr, &format!("({},)", bytes.len()), bytes.as_flattened())
}

/// Arrays of a matrix, in a form that tests can spoil.
#[derive(Clone)]
struct Arrays(Vec<(&'static str, Vec<u8>)>);

impl Arrays {
    fn put(&mut self, name: &'static str, bytes: Vec<u8>) {
        self.0.retain(|(other, _)| *other != name);
        self.0.push((name, bytes));
    }

    fn zip(&self, method: zip::CompressionMethod) -> Vec<u8> {
        let mut zip = zip::ZipWriter::new(Cursor::new(Vec::new()));
        for (name, content) in &self.0 {
            let options = zip::write::SimpleFileOptions::default().compression_method(method);
            zip.start_file(format!("{name}.npy"), options).expect("a name");
            zip.write_all(content).expect("in memory");
        }
        zip.finish().expect("in memory").into_inner()
    }

    fn scheme(format: &str, size: i64) -> Self {
        let size = size.to_le_bytes();
        Self(vec![
            ("format", npy(&format!("|S{}", format.len()), "()", format.as_bytes())),
            ("shape", vector("<i8", [size, size])),
        ])
    }

    /// Arrays in coordinate format with 64-bit indices and double values.
    fn coo(size: usize, entries: &[(u32, u32, f64)]) -> Self {
        let mut arrays = Self::scheme("coo", size as i64);
        arrays.put("row", vector("<i8", entries.iter().map(|e| i64::from(e.0).to_le_bytes())));
        arrays.put("col", vector("<i8", entries.iter().map(|e| i64::from(e.1).to_le_bytes())));
        arrays.put("data", vector("<f8", entries.iter().map(|e| e.2.to_le_bytes())));
        arrays
    }

    /// Arrays of compressed rows or columns with 32-bit indices.
    fn compressed(format: &str, size: usize, entries: &[(u32, u32, f64)]) -> Self {
        let of = |e: &(u32, u32, f64)| if format == "csr" { (e.0, e.1) } else { (e.1, e.0) };
        let mut sorted = entries.to_vec();
        sorted.sort_by_key(|e| of(e).0);
        let starts = (0..=size as u32).map(|k| sorted.iter().filter(|e| of(e).0 < k).count() as i32);
        let mut arrays = Self::scheme(format, size as i64);
        arrays.put("indptr", vector("<i4", starts.map(i32::to_le_bytes)));
        arrays.put("indices", vector("<i4", sorted.iter().map(|e| (of(e).1 as i32).to_le_bytes())));
        arrays.put("data", vector("<f8", sorted.iter().map(|e| e.2.to_le_bytes())));
        arrays
    }
}

fn both_triangles(matrix: &RawMatrix) -> Vec<(u32, u32, f64)> {
    let mirrored = matrix.entries.iter().filter(|e| e.0 != e.1).map(|&(r, c, v)| (c, r, v));
    matrix.entries.iter().copied().chain(mirrored).collect()
}

/// Files of the sample with its first stiffness replaced by the arrays given.
fn with_rest(arrays: &[u8]) -> Files {
    let mut files = Files::good();
    files.0.remove("k0.mtx");
    files.put("k0.npz", arrays);
    files.json(|json| json["stiffness"][0] = "k0.npz".into());
    files
}

fn rest_matrix(arrays: &[u8]) -> Result<RawMatrix, String> {
    let mut file = tempfile::NamedTempFile::new().expect("a temporary file");
    file.write_all(&with_rest(arrays).zip(Deflated)).expect("written");
    let read = package::read_raw(file.path(), &Limits::default()).map_err(|error| error.to_string())?;
    Ok(read.stiffness[0].clone())
}

#[test]
fn a_package_written_with_npz_matrices_reads_back_to_the_last_bit() {
    let mut package = sample(Shape { sectors: 7, direction: [0.1, 0.2, 0.3], seed: 9, ..Shape::default() });
    package.stiffness[2].entries[3].2 = -0.0;
    package.mass.entries[1].2 = 5e-324;
    package.manifest.store_matrices_as(MatrixFormat::Npz);
    assert_eq!((&package.manifest.mass[..], &package.manifest.stiffness[2][..]), ("m.npz", "k2.npz"));
    let bytes = || {
        let mut bytes = Cursor::new(Vec::new());
        package::write(&package, &mut bytes).expect("written");
        bytes.into_inner()
    };
    assert_eq!(bytes(), bytes(), "the same package, the same bytes");
    let mut file = tempfile::NamedTempFile::new().expect("a temporary file");
    file.write_all(&bytes()).expect("written");
    let read = package::read_raw(file.path(), &Limits::default()).expect("read");
    assert_eq!(format!("{read:?}"), format!("{package:?}"), "signs of zero included");
    package.manifest.store_matrices_as(MatrixFormat::Mtx);
    assert_eq!(package.manifest.mass, "m.mtx");
}

#[test]
fn npz_and_matrix_market_are_one_sector_with_two_addresses() {
    let package = sample(Shape::default());
    let text = Files::of(&package).import().expect("good");
    let mut compact = package;
    compact.manifest.store_matrices_as(MatrixFormat::Npz);
    let compact = Files::of(&compact).import().expect("good");
    assert_ne!(text.digest, compact.digest);
    assert_eq!(text.sector.contact, compact.sector.contact);
    for (a, b) in text.sector.stiffness.iter().zip(&compact.sector.stiffness) {
        assert_eq!(a.own.to_dense(), b.own.to_dense());
        assert_eq!(a.next.to_dense(), b.next.to_dense());
    }
}

#[test]
fn how_the_arrays_are_zipped_does_not_change_the_address() {
    let arrays = Arrays::coo(18, &sample(Shape::default()).stiffness[0].entries);
    let reference = with_rest(&arrays.zip(Stored)).import().expect("good").digest;
    assert_eq!(with_rest(&arrays.zip(Deflated)).import().expect("good").digest, reference);
    let mut other = arrays.clone();
    other.0.reverse();
    other.put("_is_array", npy("|b1", "()", &[1]));
    assert_eq!(with_rest(&other.zip(Deflated)).import().expect("good").digest, reference);
    let mut changed = sample(Shape::default()).stiffness[0].entries.clone();
    changed[5].2 += 1e-9;
    let changed = with_rest(&Arrays::coo(18, &changed).zip(Stored)).import().expect("good").digest;
    assert_ne!(changed, reference);
}

#[test]
fn every_scheme_triangle_and_type_is_the_same_matrix() {
    let reference = sample(Shape::default()).stiffness[0].clone();
    let lower = reference.entries.clone();
    let upper: Vec<_> = lower.iter().map(|&(r, c, v)| (c, r, v)).collect();
    let full = both_triangles(&reference);
    let mut with_zeros = upper.clone();
    // Zeros stored in the empty triangle mean nothing.
    with_zeros.extend([(5, 2, 0.0), (17, 3, -0.0)]);
    for entries in [&lower, &upper, &full, &with_zeros] {
        let [coo, csr, csc] = [
            Arrays::coo(18, entries),
            Arrays::compressed("csr", 18, entries),
            Arrays::compressed("csc", 18, entries),
        ]
        .map(|arrays| rest_matrix(&arrays.zip(Deflated)).expect("good"));
        assert_eq!((&coo, &csr, &csc), (&reference, &reference, &reference));
    }
    let mut single = Arrays::coo(18, &full);
    single.put("data", vector("<f4", full.iter().map(|e| (e.2 as f32).to_le_bytes())));
    let rounded: Vec<f64> = reference.entries.iter().map(|e| f64::from(e.2 as f32)).collect();
    let read = rest_matrix(&single.zip(Stored)).expect("good");
    assert_eq!(read.entries.iter().map(|e| e.2).collect::<Vec<_>>(), rounded);
    let mut foreign = Arrays::coo(18, &lower);
    foreign.put("data", vector(">f8", lower.iter().map(|e| e.2.to_be_bytes())));
    assert_eq!(rest_matrix(&foreign.zip(Stored)).expect("good"), reference);
}

#[test]
fn repeated_entries_are_summed_and_a_diagonal_is_a_diagonal() {
    let reference = sample(Shape::default()).stiffness[0].clone();
    // Halves are exact, so the sums are the reference to the bit.
    let halves = |entries: &[(u32, u32, f64)]| -> Vec<_> {
        let half = entries.iter().map(|&(r, c, v)| (r, c, 0.5 * v));
        half.clone().chain(half).collect()
    };
    for entries in [halves(&reference.entries), halves(&both_triangles(&reference))] {
        let read = [Arrays::coo(18, &entries), Arrays::compressed("csr", 18, &entries)]
            .map(|arrays| rest_matrix(&arrays.zip(Stored)).expect("good"));
        assert_eq!(read, [reference.clone(), reference.clone()]);
    }
    let diagonal: Vec<_> = (0..18).map(|k| (k, k, 1.0 + f64::from(k))).collect();
    assert_eq!(rest_matrix(&Arrays::coo(18, &diagonal).zip(Stored)).expect("good").entries, diagonal);
}

#[test]
fn what_is_stored_behind_the_last_pointer_is_ignored_as_by_scipy() {
    let reference = sample(Shape::default()).stiffness[0].clone();
    let mut arrays = Arrays::compressed("csc", 18, &reference.entries);
    let indices = reference.entries.iter().map(|e| e.0 as i32).chain([4]);
    arrays.put("indices", vector("<i4", indices.map(i32::to_le_bytes)));
    arrays
        .put("data", vector("<f8", reference.entries.iter().map(|e| e.2).chain([7.0]).map(f64::to_le_bytes)));
    assert_eq!(rest_matrix(&arrays.zip(Stored)).expect("good"), reference);
}

#[test]
fn a_bad_file_is_refused_with_its_reason() {
    let entries = sample(Shape::default()).stiffness[0].entries.clone();
    let coo = Arrays::coo(18, &entries);
    let csr = Arrays::compressed("csr", 18, &entries);
    let changed = |arrays: &Arrays, name: &'static str, bytes: Vec<u8>| {
        let mut arrays = arrays.clone();
        arrays.put(name, bytes);
        arrays.zip(Stored)
    };
    let without = |arrays: &Arrays, name: &str| {
        let mut arrays = arrays.clone();
        arrays.0.retain(|(other, _)| *other != name);
        arrays.zip(Stored)
    };
    let scheme =
        |format: &str| changed(&coo, "format", npy(&format!("|S{}", format.len()), "()", format.as_bytes()));
    let entry = |k: usize, value: (u32, u32, f64)| {
        let mut entries = entries.clone();
        entries[k] = value;
        Arrays::coo(18, &entries).zip(Stored)
    };
    let asymmetric = {
        let mut full = both_triangles(&sample(Shape::default()).stiffness[0]);
        full[1].2 = 7.0;
        let mirrored = full.iter().find(|e| (e.1, e.0) == (full[1].0, full[1].1)).expect("present").2;
        (Arrays::compressed("csc", 18, &full).zip(Deflated), mirrored)
    };
    let starts = |change: fn(&mut Vec<i32>)| {
        let mut starts: Vec<i32> =
            (0..=18).map(|k| entries.iter().filter(|e| e.0 < k).count() as i32).collect();
        change(&mut starts);
        changed(&csr, "indptr", vector("<i4", starts.into_iter().map(i32::to_le_bytes)))
    };
    let brackets = npy("<f8", "(1,)", &[]).len();
    let nested = {
        let head = format!("{{'descr': {}{}, 'shape': (171,), }}\n", "[".repeat(4000), "]".repeat(4000));
        let mut bytes = b"\x93NUMPY\x02\x00".to_vec();
        bytes.extend((head.len() as u32).to_le_bytes());
        bytes.extend(head.bytes());
        changed(&coo, "data", bytes)
    };
    assert_eq!(brackets, 128, "numpy pads headers to multiples of 64 bytes");
    let short = |name, count: usize| {
        let whole = &coo.0.iter().find(|(other, _)| *other == name).expect("present").1;
        changed(&coo, name, whole[..count].to_vec())
    };
    let cases: Vec<(Vec<u8>, String)> = vec![
        (b"hello".to_vec(), "k0.npz: the file is not a zip of arrays as scipy.sparse.save_npz writes it".into()),
        (without(&coo, "format"), "k0.npz: the array format is missing; save the matrix with".into()),
        (without(&coo, "col"), "k0.npz: the array col is missing".into()),
        (without(&csr, "indptr"), "k0.npz: the array indptr is missing".into()),
        (changed(&coo, "notes", vec![1]), "k0.npz: notes.npy is no array of a coo matrix; save the matrix alone".into()),
        (scheme("bsr"), "k0.npz: the storage format \"bsr\" is not supported; convert the matrix with .tocsr()".into()),
        (scheme("dia"), "k0.npz: the storage format \"dia\" is not supported".into()),
        (
            changed(&coo, "shape", vector("<i8", [18_i64, 17].map(i64::to_le_bytes))),
            "k0.npz: the matrix is 18 × 17, not square".into(),
        ),
        (
            changed(&coo, "shape", vector("<i8", [19_i64, 19].map(i64::to_le_bytes))),
            "k0.npz: the matrix has 19 rows, but the DOF table lists 18 DOF".into(),
        ),
        (changed(&coo, "shape", npy("<i8", "()", &[0; 8])), "k0.npz: the array shape has the shape ()".into()),
        (entry(7, (3, 18, 1.0)), "k0.npz: col[7] is 18, outside the 18 × 18 matrix (numpy counts from 0)".into()),
        (
            changed(&coo, "row", vector("<i8", [-1_i64].map(i64::to_le_bytes))),
            "k0.npz: row[0] is -1, outside the 18 × 18 matrix".into(),
        ),
        (entry(7, (9, 2, f64::NAN)), "k0.npz: entry (10, 3) is not a finite number".into()),
        (
            asymmetric.0,
            format!("k0.npz: the matrix is not symmetric: entry (2, 1) is 7e0, entry (1, 2) is {:e} (the worst of 1)", asymmetric.1),
        ),
        (
            changed(&coo, "data", npy("<c16", "(171,)", &[0; 16 * 171])),
            "k0.npz: the array data has the type \"<c16\"; it must be float64 or float32; convert real data with".into(),
        ),
        (
            changed(&coo, "row", npy("<f8", "(171,)", &[0; 8 * 171])),
            "k0.npz: the array row has the type \"<f8\"; it must be int32 or int64".into(),
        ),
        (
            changed(&coo, "data", npy("<f8", "(170,)", &[0; 8 * 170])),
            "k0.npz: the array data has the shape (170); expected is (171,), as of row".into(),
        ),
        (
            changed(&coo, "data", npy("<f8", "(19, 9)", &[0; 8 * 171])),
            "k0.npz: the array data has the shape (19, 9); expected is one-dimensional".into(),
        ),
        (
            changed(&coo, "data", npy("<f8", "(171,)", &[0; 8 * 170])),
            "k0.npz: the array data does not hold the 171 elements its header announces".into(),
        ),
        (
            changed(&coo, "data", npy("<f8", "(171,)", &[0; 8 * 172])),
            "k0.npz: the array data does not hold the 171 elements its header announces".into(),
        ),
        (short("data", 5), "k0.npz: the array data is not in numpy's npy format (it does not start with".into()),
        (short("data", 100), "k0.npz: the array data is not in numpy's npy format (its header is cut off)".into()),
        (nested, "k0.npz: the array data has the type \"".into()),
        (starts(|s| s[0] = 1), "k0.npz: indptr[0] is 1; the pointers must ascend from 0".into()),
        (starts(|s| s[4] = 2), "k0.npz: indptr[4] is 2; the pointers must ascend from 0".into()),
        (starts(|s| s[18] = 172), "k0.npz: indptr[18] is 172; the pointers must ascend from 0 to at most the 171".into()),
        (starts(|s| s.truncate(18)), "k0.npz: the array indptr has the shape (18); expected is (19,)".into()),
    ];
    for (bytes, message) in cases {
        let found = rest_matrix(&bytes).expect_err(&message);
        assert!(found.starts_with(&message), "\n    expected {message}\n    found    {found}");
    }
}

#[test]
fn an_array_that_inflates_without_end_meets_the_limit_of_the_archive() {
    let mut arrays = Arrays::coo(18, &sample(Shape::default()).stiffness[0].entries);
    arrays.put("data", npy("<f8", "(171,)", &vec![0; 64 << 20]));
    let small = arrays.zip(Deflated);
    assert!(small.len() < 1 << 20);
    let limits = Limits { expanded_bytes: 16 << 20, ..Limits::default() };
    let mut many = Arrays::coo(18, &[]);
    let zeros = vec![0; 64 << 20];
    for array in ["row", "col"] {
        many.put(array, npy("<i8", &format!("({},)", zeros.len() / 8), &zeros));
    }
    for bytes in [small, many.zip(Deflated)] {
        let error = import_within(&with_rest(&bytes).zip(Deflated), &limits).expect_err("refused");
        let text = error.to_string();
        let too_large = text.contains("expands beyond the limit of 16777216 bytes");
        assert!(too_large || text.contains("does not hold the 171 elements"), "{text}");
    }
    let limits = Limits { matrix_entries: 100, ..Limits::default() };
    let error = import_within(&with_rest(&many.zip(Deflated)).zip(Deflated), &limits).expect_err("refused");
    assert!(error.to_string().contains("entries, more than the 100 this server accepts"), "{error}");
}
