//! Damaged files: whatever comes out, no panic.

use super::super::read;
use super::decks::{CUBE, TETRAHEDRON};

fn whole() -> String {
    format!(
        "SOL 103\nCEND\nSET 1 = 1 THRU 3\nSPC = 1\nBEGIN BULK\n{CUBE}{TETRAHEDRON}CORD2C,4,,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n\
         CORD1R,5,1,2,9\nGRID*                  9               4              1.\n*                    0.5\n\
         CHEXA          2       1       1       2       3       4       5       6+A\n+A             7       8\n\
         PSOLID,1,7\nMAT1,7,210.+9,,.3,7850.\nSPC1,1,123,1,THRU,2\nSET1,2,5,6\nINCLUDE 'more'\nCQUAD4,3,1,1,2,3,4\nENDDATA"
    )
}

fn more(_: &str) -> Result<Vec<u8>, String> {
    Ok(b"GRID,20,5,1.,1.,1.\n".to_vec())
}

#[test]
fn cut_anywhere_a_file_is_refused() {
    let whole = whole();
    assert!(read(whole.as_bytes(), &more).is_ok());
    for length in 0..whole.len() {
        assert!(read(&whole.as_bytes()[..length], &more).is_err(), "{length}");
    }
}

#[test]
fn damaged_anywhere_a_file_is_read_or_refused() {
    let whole = whole().into_bytes();
    let mut state: u64 = 20_261_128;
    let mut random = move |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    for _ in 0..20_000 {
        let mut damaged = whole.clone();
        let place = random(damaged.len());
        damaged[place] = match random(3) {
            0 => 0,
            1 => b"-9$\n ,+*'\t"[random(10)],
            _ => random(256) as u8,
        };
        let _ = read(&damaged, &more);
    }
}

#[test]
fn a_file_without_lines_is_refused() {
    for bytes in [vec![0; 100_000], vec![b','; 100_000], vec![b'\t'; 100_000], Vec::new(), vec![0xff; 1000]] {
        assert!(read(&bytes, &more).is_err());
        assert!(read(&[b"GRID,1\nGRID", bytes.as_slice()].concat(), &more).is_err());
    }
}
