//! Reader of numpy's files, written from its documentation and not from our own reader.

use std::collections::BTreeMap;
use std::io::{Cursor, Read};

/// Arrays of a file by their names.
pub(crate) struct Npz(BTreeMap<String, Array>);

/// Array of a file.
#[derive(Debug)]
pub(crate) struct Array {
    pub(crate) shape: Vec<usize>,
    descr: String,
    bytes: Vec<u8>,
}

impl Npz {
    pub(crate) fn read(file: &[u8]) -> Self {
        let mut zip = zip::ZipArchive::new(Cursor::new(file)).unwrap();
        let mut arrays = BTreeMap::new();
        for index in 0..zip.len() {
            let mut entry = zip.by_index(index).unwrap();
            let name = entry.name().unwrap().strip_suffix(".npy").unwrap().to_owned();
            let mut bytes = Vec::new();
            entry.read_to_end(&mut bytes).unwrap();
            arrays.insert(name, Array::parse(&bytes));
        }
        Self(arrays)
    }

    pub(crate) fn names(&self) -> Vec<&str> {
        self.0.keys().map(String::as_str).collect()
    }

    #[track_caller]
    pub(crate) fn array(&self, name: &str) -> &Array {
        self.0.get(name).unwrap_or_else(|| panic!("no {name} in {:?}", self.0.keys()))
    }
}

impl Array {
    fn parse(bytes: &[u8]) -> Self {
        assert_eq!(&bytes[..8], b"\x93NUMPY\x01\x00");
        let end = 10 + usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
        let header = std::str::from_utf8(&bytes[10..end]).unwrap();
        assert!(header.contains("'fortran_order': False") && header.ends_with('\n') && end % 64 == 0);
        let after = |key: &str| header.split_once(key).unwrap().1;
        let descr = after("'descr': '").split('\'').next().unwrap().to_owned();
        let shape = after("'shape': (").split(')').next().unwrap();
        let shape = shape.split(',').map(str::trim).filter(|size| !size.is_empty());
        let shape: Vec<usize> = shape.map(|size| size.parse().unwrap()).collect();
        let bytes = bytes[end..].to_vec();
        let width: usize = match descr.strip_prefix("<U") {
            Some(characters) => 4 * characters.parse::<usize>().unwrap(),
            None => descr[2..].parse().unwrap(),
        };
        assert_eq!(bytes.len(), width * shape.iter().product::<usize>(), "{header}");
        Self { shape, descr, bytes }
    }

    #[track_caller]
    pub(crate) fn reals(&self) -> Vec<f64> {
        assert_eq!(self.descr, "<f8");
        self.bytes.as_chunks::<8>().0.iter().map(|bytes| f64::from_le_bytes(*bytes)).collect()
    }

    #[track_caller]
    pub(crate) fn whole(&self) -> Vec<i64> {
        assert_eq!(self.descr, "<i8");
        self.bytes.as_chunks::<8>().0.iter().map(|bytes| i64::from_le_bytes(*bytes)).collect()
    }

    #[track_caller]
    pub(crate) fn ids(&self) -> Vec<u64> {
        assert_eq!(self.descr, "<u8");
        self.bytes.as_chunks::<8>().0.iter().map(|bytes| u64::from_le_bytes(*bytes)).collect()
    }

    #[track_caller]
    pub(crate) fn texts(&self) -> Vec<String> {
        let width = 4 * self.descr.strip_prefix("<U").unwrap().parse::<usize>().unwrap();
        let text = |bytes: &[u8]| {
            let characters = bytes.as_chunks::<4>().0.iter().map(|bytes| u32::from_le_bytes(*bytes));
            characters.filter(|one| *one != 0).map(|one| char::from_u32(one).unwrap()).collect()
        };
        self.bytes.chunks(width).map(text).collect()
    }
}
