//! Damaged files: whatever comes out, no panic.

use super::super::read;
use super::files::tetrahedron;

#[test]
fn cut_anywhere_a_file_is_refused() {
    for bytes in tetrahedron().all() {
        // Without its last newline a file is whole.
        for length in 0..bytes.len() - 1 {
            assert!(read(&bytes[..length]).is_err(), "{length} of {}", bytes.len());
        }
    }
}

#[test]
fn damaged_anywhere_a_file_is_read_or_refused() {
    let mut state: u64 = 20_261_128;
    let mut random = move |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    for bytes in tetrahedron().all() {
        for _ in 0..5_000 {
            let mut damaged = bytes.clone();
            let place = random(damaged.len());
            damaged[place] = match random(3) {
                0 => 0,
                1 => b"-9$\n .e"[random(7)],
                _ => random(256) as u8,
            };
            let _ = read(&damaged);
        }
    }
}

#[test]
fn a_file_without_lines_is_refused() {
    for bytes in [vec![0; 100_000], vec![b'$'; 100_000], Vec::new(), vec![0xff; 1000]] {
        assert!(read(&bytes).is_err());
        assert!(read(&[b"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$".as_slice(), &bytes].concat()).is_err());
    }
}
