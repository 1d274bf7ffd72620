//! Stress in the coordinates of reductions, as files beside their bases:
//! `bases/<model>-<modes_per_speed>/<version>-<layout of bases>-stress-<layout>-<nodal diameter>` and `…-static`.
//!
//! ```text
//! header   "rubstres" | places, u64 | unknowns, u64 | SHA-256 of M_r | SHA-256 of what stands before
//! place    σ_rr … σ_zr: real, imaginary part of every unknown, f32 | the first 8 bytes of SHA-256(place, u64 | numbers)
//! ```
//!
//! All numbers are little-endian. The static part is SHA-256 of the M_r of nodal diameter 0, of the rest, and the rest.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::os::unix::fs::FileExt;
use std::path::{Path, PathBuf};
use std::slice;

use sha2::{Digest, Sha256};

use super::bases::{BasisFolder, CHECK, HEADER, check, damaged, header};
use super::folders::file_name;
use crate::analysis::stress::{HarmonicStress, StaticWheel};
use crate::dynamics::reduction::{ReducedHarmonic, ReducedWheel};

/// Layout of the files, and of the order of the places in them: raise it when one of them changes.
const LAYOUT: i64 = 1;

const MAGIC: &[u8; 8] = b"rubstres";
const DIGEST: usize = 32;
/// Number of components of a stress.
const COMPONENTS: usize = 6;

impl BasisFolder {
    /// Whether the stress of a nodal diameter is stored, at this number of places.
    pub fn has_stress(&self, reduced: &ReducedHarmonic, places: usize) -> bool {
        self.objects.reading(&[self.harmonic_path(reduced)], || self.open_stress(reduced, places)).is_ok()
    }

    /// Stores the stress of a nodal diameter at all places.
    ///
    /// # Errors
    /// Lack of room, or a failure of the disk.
    pub fn keep_stress(&self, reduced: &ReducedHarmonic, stress: &HarmonicStress) -> io::Result<()> {
        let (unknowns, places) = (stress.unknowns(), stress.places());
        let bytes = HEADER + places * place_bytes(unknowns);
        let path = self.harmonic_path(reduced);
        self.write_file(path.clone(), bytes as u64, |file| {
            let mut out = BufWriter::with_capacity(1 << 20, file);
            out.write_all(&header(MAGIC, places, unknowns, &reduced.mark()))?;
            let mut numbers = Vec::with_capacity(place_bytes(unknowns));
            for place in 0..places {
                numbers.clear();
                numbers.extend(stress.of_place(place).flat_map(f32::to_le_bytes));
                numbers.extend(check(place, &numbers));
                out.write_all(&numbers)?;
            }
            out.flush()
        })?;
        self.share(&path);
        Ok(())
    }

    /// Reads the stress of a nodal diameter at the places with indices `kept`.
    ///
    /// # Errors
    /// A file that is missing, is not what was written, or belongs to another reduction.
    pub fn stress(
        &self,
        reduced: &ReducedHarmonic,
        places: usize,
        kept: &[usize],
    ) -> io::Result<HarmonicStress> {
        let unknowns = reduced.mass.ncols();
        let length = place_bytes(unknowns);
        let mut bytes = vec![0; length];
        self.objects.reading(&[self.harmonic_path(reduced)], || {
            let file = self.open_stress(reduced, places)?;
            HarmonicStress::gather(unknowns, kept.len(), |slot, numbers| {
                let place = kept[slot];
                file.read_exact_at(&mut bytes, (HEADER + place * length) as u64)?;
                let (found, sum) = bytes.split_at(length - CHECK);
                if sum != check(place, found) {
                    return Err(damaged("its bytes are not those that were written"));
                }
                for (number, bytes) in numbers.iter_mut().zip(found.chunks_exact(size_of::<f32>())) {
                    *number = f32::from_le_bytes(std::array::from_fn(|byte| bytes[byte]));
                }
                Ok(())
            })
        })
    }

    /// Removes the stress of all nodal diameters of `reduced`.
    ///
    /// # Errors
    /// Failures of the disk; a missing file is no error.
    pub fn remove_stress(&self, reduced: &ReducedWheel) -> io::Result<()> {
        for reduced in &reduced.harmonics {
            let path = self.harmonic_path(reduced);
            match std::fs::remove_file(&path) {
                Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
                _ => self.objects.remove_blocking(&path)?,
            }
        }
        Ok(())
    }

    /// Stores the static response of the wheel to its centrifugal load.
    ///
    /// # Errors
    /// As of [`Self::keep_stress`].
    pub fn keep_static_wheel(&self, reduced: &ReducedWheel, fixed: &StaticWheel) -> io::Result<()> {
        let bytes = postcard::to_stdvec(fixed).map_err(io::Error::other)?;
        let size = (2 * DIGEST + bytes.len()) as u64;
        let path = self.stress_path(STATIC);
        self.write_file(path.clone(), size, |mut file| {
            file.write_all(&reduced.harmonics[0].mark())?;
            file.write_all(&Sha256::digest(&bytes))?;
            file.write_all(&bytes)
        })?;
        self.share(&path);
        Ok(())
    }

    /// Reads the static response of the wheel to its centrifugal load.
    ///
    /// # Errors
    /// As of [`Self::stress`].
    pub fn static_wheel(&self, reduced: &ReducedWheel) -> io::Result<StaticWheel> {
        let path = self.stress_path(STATIC);
        self.objects.reading(slice::from_ref(&path), || read_static(&path, reduced))
    }

    /// Uploads a file for other processes. A process that does not find it makes it again.
    fn share(&self, path: &Path) {
        if let Err(error) = self.objects.publish_blocking(path) {
            tracing::warn!(file = file_name(path), %error, "stress stays in the data folder of this process");
        }
    }

    fn stress_path(&self, part: &str) -> PathBuf {
        self.named(&format!("stress-{LAYOUT}-{part}"))
    }

    fn harmonic_path(&self, reduced: &ReducedHarmonic) -> PathBuf {
        self.stress_path(&reduced.harmonic.to_string())
    }

    fn open_stress(&self, reduced: &ReducedHarmonic, places: usize) -> io::Result<File> {
        let file = File::open(self.harmonic_path(reduced))?;
        let unknowns = reduced.mass.ncols();
        let mut found = [0; HEADER];
        file.read_exact_at(&mut found, 0)?;
        if found != header(MAGIC, places, unknowns, &reduced.mark()) {
            return Err(damaged("it is not of this reduction"));
        }
        if file.metadata()?.len() != (HEADER + places * place_bytes(unknowns)) as u64 {
            return Err(damaged("its length is not the one it had"));
        }
        Ok(file)
    }
}

const STATIC: &str = "static";

fn read_static(path: &Path, reduced: &ReducedWheel) -> io::Result<StaticWheel> {
    let bytes = std::fs::read(path)?;
    let (mark, rest) = bytes.split_at_checked(DIGEST).ok_or_else(|| damaged("it is cut"))?;
    let (sum, numbers) = rest.split_at_checked(DIGEST).ok_or_else(|| damaged("it is cut"))?;
    if mark != reduced.harmonics[0].mark() {
        return Err(damaged("it is not of this reduction"));
    }
    if sum != &Sha256::digest(numbers)[..] {
        return Err(damaged("its bytes are not those that were written"));
    }
    postcard::from_bytes(numbers).map_err(|_| damaged("it does not read"))
}

fn place_bytes(unknowns: usize) -> usize {
    COMPONENTS * 2 * size_of::<f32>() * unknowns + CHECK
}

#[cfg(test)]
mod tests {
    use faer::{Mat, c64};

    use super::*;
    use crate::dynamics::centrifugal::StiffnessPolynomial;
    use crate::store::reserve::Reserve;

    fn harmonic(mass: f64) -> ReducedHarmonic {
        ReducedHarmonic {
            harmonic: 2,
            mass: Mat::from_fn(3, 3, |i, j| c64::new(if i == j { mass } else { 0.0 }, 0.0)),
            stiffness: StiffnessPolynomial { coefficients: Vec::new() },
            gyroscopic: None,
            certificates: Vec::new(),
        }
    }

    #[test]
    fn chosen_places_read_back_and_damage_is_seen() {
        let root = tempfile::tempdir().unwrap();
        let folder = BasisFolder::of(root.path(), "model-20", Reserve::of(root.path()));
        let number = |place: usize, k: usize| (100 * place + k) as f32 * 0.5;
        let fill = |place: usize, numbers: &mut [f32]| {
            numbers.iter_mut().enumerate().for_each(|(k, into)| *into = number(place, k));
            Ok::<_, std::convert::Infallible>(())
        };
        let Ok(stress) = HarmonicStress::gather(3, 4, fill);
        let reduced = harmonic(1.0);
        assert!(!folder.has_stress(&reduced, 4));
        folder.keep_stress(&reduced, &stress).unwrap();
        let found = folder.stress(&reduced, 4, &[1, 3]).unwrap();
        for (slot, place) in [1, 3].into_iter().enumerate() {
            let expected: Vec<f32> = (0..36).map(|k| number(place, k)).collect();
            assert_eq!(found.of_place(slot).collect::<Vec<_>>(), expected);
        }
        // Files of another reduction, or of another mesh.
        assert!(!folder.has_stress(&harmonic(2.0), 4) && !folder.has_stress(&reduced, 5));
        let path = folder.stress_path("2");
        let mut bytes = std::fs::read(&path).unwrap();
        let length = bytes.len();
        bytes[length - CHECK - 1] ^= 1;
        std::fs::write(&path, bytes).unwrap();
        assert!(folder.stress(&reduced, 4, &[0, 1, 2]).is_ok());
        assert_eq!(folder.stress(&reduced, 4, &[3]).unwrap_err().kind(), io::ErrorKind::InvalidData);
    }
}
