//! Strict reader of VTK's files.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use reqwest::StatusCode;

use super::app::Api;

/// Downloads the body of an answer.
pub(super) async fn raw(api: &Api, path: &str) -> Vec<u8> {
    let answer = api.request("GET", path).send().await.unwrap();
    let status = answer.status();
    let body = answer.bytes().await.unwrap().to_vec();
    assert_eq!(status, StatusCode::OK, "{path}: {}", String::from_utf8_lossy(&body));
    body
}

/// VTK file, read by what the documentation of the format says.
pub(super) struct Vtk {
    pub(super) text: String,
}

impl Vtk {
    pub(super) fn new(body: Vec<u8>) -> Self {
        Self { text: String::from_utf8(body).unwrap() }
    }

    pub(super) fn attribute(&self, name: &str) -> usize {
        let document = roxmltree::Document::parse(&self.text).unwrap();
        let piece = document.descendants().find(|node| node.has_tag_name("Piece")).unwrap();
        piece.attribute(name).unwrap().parse().unwrap()
    }

    pub(super) fn has(&self, name: &str) -> bool {
        self.text.contains(&format!("Name=\"{name}\""))
    }

    pub(super) fn bytes(&self, name: &str, kind: &str) -> Vec<u8> {
        let document = roxmltree::Document::parse(&self.text).unwrap();
        let file = document.root_element();
        assert_eq!(
            (file.attribute("byte_order"), file.attribute("header_type")),
            (Some("LittleEndian"), Some("UInt64"))
        );
        let array = document.descendants().find(|node| node.attribute("Name") == Some(name)).unwrap();
        assert_eq!((array.attribute("type"), array.attribute("format")), (Some(kind), Some("binary")));
        let bytes = STANDARD.decode(array.text().unwrap().trim()).unwrap();
        let (length, bytes) = bytes.split_at(8);
        assert_eq!(u64::from_le_bytes(length.try_into().unwrap()), bytes.len() as u64, "{name}");
        bytes.to_vec()
    }

    pub(super) fn reals(&self, name: &str) -> Vec<f64> {
        let bytes = self.bytes(name, "Float64");
        bytes.as_chunks::<8>().0.iter().map(|bytes| f64::from_le_bytes(*bytes)).collect()
    }

    pub(super) fn whole(&self, name: &str) -> Vec<usize> {
        let bytes = self.bytes(name, "Int64");
        bytes.as_chunks::<8>().0.iter().map(|bytes| i64::from_le_bytes(*bytes) as usize).collect()
    }

    pub(super) fn ids(&self, name: &str) -> Vec<u64> {
        let bytes = self.bytes(name, "UInt64");
        bytes.as_chunks::<8>().0.iter().map(|bytes| u64::from_le_bytes(*bytes)).collect()
    }

    pub(super) fn counts(&self, name: &str) -> Vec<i32> {
        let bytes = self.bytes(name, "Int32");
        bytes.as_chunks::<4>().0.iter().map(|bytes| i32::from_le_bytes(*bytes)).collect()
    }

    pub(super) fn vectors(&self, name: &str) -> Vec<[f64; 3]> {
        self.reals(name).as_chunks::<3>().0.to_vec()
    }

    /// Indices of the points of every cell.
    pub(super) fn cells(&self) -> Vec<Vec<usize>> {
        let connectivity = self.whole("connectivity");
        let mut begin = 0;
        let cell = |end: usize| connectivity[std::mem::replace(&mut begin, end)..end].to_vec();
        let offsets = self.whole("offsets");
        assert_eq!(offsets.last(), Some(&connectivity.len()));
        offsets.into_iter().map(cell).collect()
    }
}
