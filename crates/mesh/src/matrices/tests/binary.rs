//! OUTPUT4 files in binary form.

use super::expected;
use super::samples::MAPPING;
use crate::matrices::read;

/// Record of a Fortran program.
fn record(parts: &[&[u8]]) -> Vec<u8> {
    let content = parts.concat();
    let length = (content.len() as u32).to_le_bytes();
    [&length[..], &content, &length].concat()
}

fn integers<const N: usize>(numbers: [i32; N]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

fn doubles<const N: usize>(numbers: [f64; N]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

fn dense() -> Vec<u8> {
    [
        record(&[&integers([4, 4, 6, 2]), b"K       "]),
        record(&[&integers([1, 1, 8]), &doubles([4.0, -1.0, 0.0, -2.5])]),
        record(&[&integers([2, 1, 4]), &doubles([-1.0, 5.0])]),
        record(&[&integers([3, 3, 2]), &doubles([6.0])]),
        record(&[&integers([4, 1, 8]), &doubles([-2.5, 0.0, 0.0, 7.0])]),
        record(&[&integers([5, 1, 2]), &doubles([1.0])]),
    ]
    .concat()
}

/// Strings in single precision, of one triangle.
fn strings(long: bool) -> Vec<u8> {
    let head = |words: i32, row: i32| {
        if long { integers([words + 1, row]) } else { integers([row + 65_536 * (words + 1)]) }
    };
    let extra = if long { 2 } else { 1 };
    let single = |number: f32| number.to_le_bytes();
    let column = |column: i32, row: i32, number: f32| {
        record(&[&integers([column, 0, 1 + extra]), &head(1, row), &single(number)])
    };
    let first = integers([1, 0, 3 + 2 * extra]);
    [
        record(&[&integers([4, if long { -4 } else { 4 }, 6, 1]), b"K       "]),
        record(&[&first, &head(2, 1), &single(4.0), &single(-1.0), &head(1, 4), &single(-2.5)]),
        column(2, 2, 5.0),
        column(3, 3, 6.0),
        column(4, 4, 7.0),
        record(&[&integers([5, 1, 1]), &single(1.0)]),
    ]
    .concat()
}

#[test]
fn binary_files_give_the_same_matrix() {
    for bytes in [dense(), strings(false), strings(true)] {
        assert_eq!(read(&bytes, Some(MAPPING.as_bytes())), Ok(expected("Nastran OUTPUT4")));
    }
}

#[test]
fn a_damaged_file_is_no_panic() {
    for bytes in [dense(), strings(false), strings(true)] {
        for end in 0..bytes.len() {
            assert!(read(&bytes[..end], Some(MAPPING.as_bytes())).is_err());
        }
        for place in 0..bytes.len() {
            for wrong in 0..=255 {
                let mut bytes = bytes.clone();
                bytes[place] = wrong;
                let _ = read(&bytes, Some(MAPPING.as_bytes()));
            }
        }
    }
    let mut bytes = dense();
    let place = bytes.len() - 4 - 8 - 12 - 4 - 4 - 8;
    bytes[place..place + 8].copy_from_slice(&f64::NAN.to_le_bytes());
    let refusal = read(&bytes, Some(MAPPING.as_bytes())).unwrap_err();
    assert_eq!(refusal.to_string(), "Nastran OUTPUT4: \"NaN\" is not an entry");
}
