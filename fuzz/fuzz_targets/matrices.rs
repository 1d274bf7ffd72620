//! Fuzzes the readers of matrix files: any bytes, with a mapping where the bytes have a blank line, an answer or a refusal.

#![no_main]

use rubmap::mesh::matrices::read;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let middle = bytes.windows(2).position(|pair| pair == b"\n\n").unwrap_or(bytes.len());
    let (matrix, mapping) = bytes.split_at(middle);
    let _ = read(matrix, (!mapping.is_empty()).then_some(mapping));
});
