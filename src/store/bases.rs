//! Bases of reductions, as files of which single rows can be read:
//! `bases/<model>-<modes_per_speed>/<version>-<layout>-harmonic-<nodal diameter>`.
//!
//! Files, not rows of the database: the bases of a large model take gigabytes, a sweep reads a few rows, and all can be computed again.
//!
//! ```text
//! header   "rubbasis" | DOF, u64 | unknowns, u64 | SHA-256 of M_r | SHA-256 of what stands before
//! row      real, imaginary part of every unknown, f64 | the first 8 bytes of SHA-256(DOF, u64 | row)        one for each own DOF
//! ```
//!
//! All numbers are little-endian. M_r tells whether a file belongs to the reduction beside which it lies.

use std::collections::BTreeSet;
use std::fs::File;
use std::io::{self, BufWriter, ErrorKind, Write};
use std::os::unix::fs::FileExt;
use std::path::{Path, PathBuf};

use faer::{Mat, MatRef, c64};
use sha2::{Digest, Sha256};

use super::error::StoreError;
use super::folders::{file_name, folder_name, model_of, prefix, remove_files_but, remove_folders};
use super::handle::Store;
use super::objects::Objects;
use super::reserve::Reserve;
use super::unfinished::{UNFINISHED, unfinished_file};
use crate::dynamics::node_rows::NodeRows;
use crate::dynamics::nodes::SectorNode;
use crate::dynamics::reduction::{BasisRows, ReducedHarmonic, ReducedWheel};

/// Name of the folder of all bases, in the data folder.
pub(super) const FOLDER: &str = "bases";

/// Layout of the files: raise it when it changes, so that old files are computed again instead of misread.
pub(super) const LAYOUT: i64 = 1;

const MAGIC: &[u8; 8] = b"rubbasis";
pub(super) const HEADER: usize = 8 + 8 + 8 + 32 + 32;
const COMPLEX: usize = 16;
/// Size of the checksum of a row, bytes.
pub(super) const CHECK: usize = 8;

/// Number of rows that are read at once.
const BLOCK: usize = 256;

/// Files of the basis of one reduction.
#[derive(Debug, Clone)]
pub struct BasisFolder {
    folder: PathBuf,
    reserve: Reserve,
    pub(super) objects: Objects,
}

impl Store {
    /// Basis of the reduction of `model`.
    pub fn basis(&self, model: &str, modes_per_speed: u32) -> BasisFolder {
        let folder =
            BasisFolder::of(&self.folder, &folder_name(model, modes_per_speed), self.reserve.clone());
        BasisFolder { objects: self.objects.clone(), ..folder }
    }

    /// Uploads the basis of a reduction to the object store, as far as it was stored, before its row says that it is there.
    pub async fn share_basis(
        &self,
        model: &str,
        modes_per_speed: u32,
        reduced: &ReducedWheel,
    ) -> Result<(), StoreError> {
        if !self.objects.are_shared() {
            return Ok(());
        }
        let basis = self.basis(model, modes_per_speed);
        for reduced in &reduced.harmonics {
            // Any other file there belongs to an earlier reduction.
            if basis.open_here(reduced).is_ok() {
                let path = basis.path(reduced.harmonic);
                self.objects.publish(&path).await.map_err(StoreError::Objects)?;
            }
        }
        Ok(())
    }

    fn bases_root(&self) -> PathBuf {
        self.folder.join(FOLDER)
    }

    /// Removes the bases of all reductions of a deleted model. Files that cannot be removed are left to the next start.
    pub(super) async fn remove_bases(&self, model: &str) {
        let gone = |name: &str| model_of(name) == model;
        let removed = async {
            remove_folders(&self.bases_root(), gone).await?;
            self.objects.remove_folders(&self.bases_root(), gone).await
        };
        if let Err(error) = removed.await {
            tracing::warn!(model.id = model, %error, "could not remove the bases of its reductions");
        }
    }

    /// Removes bases of deleted models and of other versions of the program, and unfinished files.
    pub(super) async fn remove_stale_bases(&self) -> Result<(), StoreError> {
        let models = sqlx::query_scalar("select id from models").fetch_all(&self.readers).await?;
        let models: BTreeSet<String> = models.into_iter().collect();
        let root = self.bases_root();
        remove_folders(&root, |name| !models.contains(model_of(name))).await?;
        remove_files_but(&root, &prefix(LAYOUT)).await?;
        Ok(())
    }
}

impl BasisFolder {
    /// Folder `name` of bases in the data folder `data`.
    pub(super) fn of(data: &Path, name: &str, reserve: Reserve) -> Self {
        Self { folder: data.join(FOLDER).join(name), reserve, objects: Objects::default() }
    }

    /// Stores the basis of a nodal diameter if possible: without it, reading nodes needs another reduction.
    pub(super) fn keep(&self, rows: &BasisRows<'_>) -> io::Result<()> {
        let harmonic = rows.harmonic();
        let bytes = (HEADER + rows.dofs() * row_bytes(rows.unknowns())) as u64;
        let written = self.write(rows, bytes);
        match &written {
            Ok(()) => {
                tracing::debug!(harmonic, bytes, folder = file_name(&self.folder), "kept a basis");
            }
            Err(error) => {
                tracing::warn!(harmonic, bytes, folder = %self.folder.display(), %error, "could not keep a basis; going on without");
            }
        }
        written
    }

    /// Refuses to start work that will store so many bytes, unless there is room for them.
    ///
    /// # Errors
    /// A disk that is too full.
    pub fn expect_room(&self, bytes: u64) -> io::Result<()> {
        self.reserve.expect_room_for(bytes)
    }

    /// Reads the basis of all nodal diameters of `reduced`, to check it.
    ///
    /// # Errors
    /// As of [`Self::rows`].
    pub fn check(&self, reduced: &ReducedWheel) -> io::Result<()> {
        reduced.harmonics.iter().try_for_each(|reduced| {
            let check = || self.open_here(reduced)?.each(|_, _| {});
            self.objects.reading(&[self.path(reduced.harmonic)], check)
        })
    }

    /// Rows of the basis of `reduced` at `nodes`.
    ///
    /// # Errors
    /// A file that is missing, is not what was written, or belongs to another reduction.
    pub fn rows(&self, reduced: &ReducedWheel, nodes: &[SectorNode]) -> io::Result<NodeRows> {
        let paths: Vec<PathBuf> =
            reduced.harmonics.iter().map(|reduced| self.path(reduced.harmonic)).collect();
        self.objects.reading(&paths, || {
            let files = reduced.harmonics.iter().map(|reduced| self.open_here(reduced));
            let files: Vec<OpenBasis> = files.collect::<io::Result<_>>()?;
            NodeRows::gather(nodes, reduced, |harmonic, dof| files[harmonic].row(dof))
        })
    }

    /// Product Υ̂ X for a nodal diameter of `reduced`: `own DOF × columns` of `unknowns × columns`. Rows are read and multiplied in blocks,
    /// never held.
    ///
    /// # Errors
    /// As of [`Self::rows`].
    pub fn product(
        &self,
        reduced: &ReducedWheel,
        harmonic: usize,
        columns: MatRef<'_, c64>,
    ) -> io::Result<Mat<c64>> {
        let reduced = &reduced.harmonics[harmonic];
        self.objects.reading(&[self.path(reduced.harmonic)], || {
            let file = self.open_here(reduced)?;
            let mut product = Mat::zeros(file.dofs, columns.ncols());
            file.each(|dof, row| {
                for (unknown, value) in row.chunks_exact(2).enumerate() {
                    let value = c64::new(value[0], value[1]);
                    for column in 0..columns.ncols() {
                        product[(dof, column)] += value * columns[(unknown, column)];
                    }
                }
            })?;
            Ok(product)
        })
    }

    /// Projection Υ̂ᴴ f for a nodal diameter of `reduced`: the load of the own DOF as a load on the unknowns. Rows are read as by
    /// [`Self::product`].
    ///
    /// # Errors
    /// As of [`Self::rows`], and a load of other DOF.
    pub fn project(&self, reduced: &ReducedHarmonic, load: &[f64]) -> io::Result<Vec<c64>> {
        self.objects.reading(&[self.path(reduced.harmonic)], || {
            let file = self.open_here(reduced)?;
            if load.len() != file.dofs {
                return Err(damaged("it has other DOF than the model"));
            }
            let mut projected = vec![c64::ZERO; file.unknowns];
            file.each(|dof, row| {
                for (sum, value) in projected.iter_mut().zip(row.chunks_exact(2)) {
                    *sum += c64::new(value[0], -value[1]) * load[dof];
                }
            })?;
            Ok(projected)
        })
    }

    /// Opens the basis of a nodal diameter.
    ///
    /// # Errors
    /// As of [`Self::rows`].
    pub fn open(&self, reduced: &ReducedHarmonic) -> io::Result<OpenBasis> {
        self.objects.reading(&[self.path(reduced.harmonic)], || self.open_here(reduced))
    }

    fn open_here(&self, reduced: &ReducedHarmonic) -> io::Result<OpenBasis> {
        OpenBasis::new(File::open(self.path(reduced.harmonic))?, reduced)
    }

    fn path(&self, harmonic: usize) -> PathBuf {
        self.named(&format!("harmonic-{harmonic}"))
    }

    /// Path of the file of this name.
    pub(super) fn named(&self, name: &str) -> PathBuf {
        self.folder.join(format!("{}{name}", prefix(LAYOUT)))
    }

    fn write(&self, rows: &BasisRows<'_>, bytes: u64) -> io::Result<()> {
        self.write_file(self.path(rows.harmonic()), bytes, |file| {
            let mut out = BufWriter::with_capacity(1 << 20, file);
            out.write_all(&header(MAGIC, rows.dofs(), rows.unknowns(), &rows.mark()))?;
            let mut row = Vec::with_capacity(row_bytes(rows.unknowns()));
            for dof in 0..rows.dofs() {
                row.clear();
                row.extend(rows.row(dof).flat_map(f64::to_le_bytes));
                row.extend(check(dof, &row));
                out.write_all(&row)?;
            }
            out.flush()
        })
    }

    /// Writes a file of `bytes` bytes, if there is room for it.
    pub(super) fn write_file(
        &self,
        path: PathBuf,
        bytes: u64,
        write: impl FnOnce(&File) -> io::Result<()>,
    ) -> io::Result<()> {
        self.expect_room(bytes)?;
        std::fs::create_dir_all(&self.folder)?;
        // The file is written whole and flushed before it gets its name: a name promises a basis, even after a power cut.
        let file = unfinished_file(&self.folder, UNFINISHED)?;
        write(file.as_file())?;
        file.as_file().sync_all()?;
        file.persist(path).map_err(|error| error.error)?;
        File::open(&self.folder)?.sync_all()
    }
}

/// Open file with the basis of one nodal diameter.
#[derive(Debug)]
pub struct OpenBasis {
    file: File,
    dofs: usize,
    unknowns: usize,
}

impl OpenBasis {
    /// Opens the basis in `file`, if it belongs to `reduced`.
    fn new(file: File, reduced: &ReducedHarmonic) -> io::Result<Self> {
        let mut found = [0; HEADER];
        file.read_exact_at(&mut found, 0)?;
        let dofs = u64::from_le_bytes(std::array::from_fn(|byte| found[8 + byte])) as usize;
        let unknowns = reduced.mass.ncols();
        if found != header(MAGIC, dofs, unknowns, &reduced.mark()) {
            return Err(damaged("it is not of this reduction"));
        }
        if file.metadata()?.len() != (HEADER + dofs * row_bytes(unknowns)) as u64 {
            return Err(damaged("its length is not the one it had"));
        }
        Ok(Self { file, dofs, unknowns })
    }

    /// Number of own DOF.
    pub fn dofs(&self) -> usize {
        self.dofs
    }

    /// Row of an own DOF: real and imaginary part of every unknown.
    ///
    /// # Errors
    /// A row that cannot be read, or is not what was written.
    pub fn row(&self, dof: usize) -> io::Result<Vec<f64>> {
        if dof >= self.dofs {
            return Err(damaged("it has no such row"));
        }
        let length = row_bytes(self.unknowns);
        let mut bytes = vec![0; length];
        self.file.read_exact_at(&mut bytes, (HEADER + dof * length) as u64)?;
        self.checked(dof, &bytes)
    }

    /// Passes all rows to `take`, one after the other.
    fn each(&self, mut take: impl FnMut(usize, &[f64])) -> io::Result<()> {
        let length = row_bytes(self.unknowns);
        let mut block = vec![0; length * BLOCK];
        for first in (0..self.dofs).step_by(BLOCK) {
            let bytes = &mut block[..length * BLOCK.min(self.dofs - first)];
            self.file.read_exact_at(bytes, (HEADER + first * length) as u64)?;
            for (dof, row) in (first..).zip(bytes.chunks_exact(length)) {
                take(dof, &self.checked(dof, row)?);
            }
        }
        Ok(())
    }

    /// Numbers of a row, if its checksum is right.
    fn checked(&self, dof: usize, bytes: &[u8]) -> io::Result<Vec<f64>> {
        let (row, sum) = bytes.split_at(COMPLEX * self.unknowns);
        if sum != check(dof, row) {
            return Err(damaged("its bytes are not those that were written"));
        }
        let number = |bytes: &[u8]| f64::from_le_bytes(std::array::from_fn(|byte| bytes[byte]));
        Ok(row.chunks_exact(8).map(number).collect())
    }
}

fn row_bytes(unknowns: usize) -> usize {
    COMPLEX * unknowns + CHECK
}

/// Header of a file with this number of rows.
pub(super) fn header(magic: &[u8; 8], rows: usize, unknowns: usize, mark: &[u8; 32]) -> [u8; HEADER] {
    let mut bytes = Vec::with_capacity(HEADER);
    bytes.extend(magic);
    bytes.extend((rows as u64).to_le_bytes());
    bytes.extend((unknowns as u64).to_le_bytes());
    bytes.extend(mark);
    bytes.extend(Sha256::digest(&bytes));
    std::array::from_fn(|byte| bytes[byte])
}

/// Checksum of the row of this number.
pub(super) fn check(number: usize, row: &[u8]) -> [u8; CHECK] {
    let sum = Sha256::new().chain_update((number as u64).to_le_bytes()).chain_update(row).finalize();
    std::array::from_fn(|byte| sum[byte])
}

pub(super) fn damaged(how: &str) -> io::Error {
    io::Error::new(ErrorKind::InvalidData, how)
}
