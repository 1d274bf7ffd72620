//! Damaged files: refused or read, without a panic and without memory by their claims.

use super::samples::{MAPPING, SAMPLES};
use crate::matrices::read;

#[test]
fn a_file_cut_anywhere_is_no_panic() {
    for (text, mapping, _) in SAMPLES {
        for end in 0..text.len() {
            let _ = read(&text.as_bytes()[..end], mapping.map(str::as_bytes));
        }
    }
    let (text, ..) = SAMPLES[9];
    for end in 0..MAPPING.len() {
        let _ = read(text.as_bytes(), Some(&MAPPING.as_bytes()[..end]));
    }
}

#[test]
fn a_file_with_a_wrong_byte_is_no_panic() {
    let mut seed = 20_261_128_u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        seed >> 33
    };
    let likely = b"0123456789 -+,.*\n\r()DE%$\xff";
    for (text, mapping, _) in SAMPLES {
        for place in 0..text.len() {
            for _ in 0..20 {
                let mut bytes = text.as_bytes().to_vec();
                bytes[place] = likely[random() as usize % likely.len()];
                let _ = read(&bytes, mapping.map(str::as_bytes));
            }
            let mut bytes = text.as_bytes().to_vec();
            bytes[place] = random() as u8;
            let _ = read(&bytes, mapping.map(str::as_bytes));
        }
    }
}

#[test]
fn claims_of_size_cost_nothing() {
    let largest = u64::MAX;
    for text in [
        format!("%%MatrixMarket matrix coordinate real general\n{largest} {largest} {largest}\n1 1 1\n"),
        format!("t\n 1 1 1 1 0\nRSA {largest} {largest} {largest} 0\n({largest}I8)(1I8)(1D26.18)\n1\n"),
        "99999999999999996       2K       1P,2E12.4\n       1       199999999\n  1.0000E+00\n".to_owned(),
        "9999999999999999       6       2K       1P,2E12.4\n       1       099999999\n99999999       1\n"
            .to_owned(),
    ] {
        assert!(read(text.as_bytes(), Some(MAPPING.as_bytes())).is_err(), "{text}");
    }
}
