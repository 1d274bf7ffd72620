//! Fuzzes the reader of one mesh format and the search for a sector in what it reads: any bytes, an answer or a refusal.

#![no_main]

use std::collections::BTreeMap;

use rubmap::from_mesh::{MeshSettings, sector};
use rubmap::impeller::Material;
use rubmap::mesh::{MeshFormat, read_as};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let none = |_: &str| Err("no other file".to_owned());
    if let Ok(file) = read_as(MeshFormat::Vtu, bytes, &none) {
        let titanium = Material::default().to_solid();
        let materials = BTreeMap::from([("*".to_owned(), titanium)]);
        let _ = sector(&file, &MeshSettings { materials, ..MeshSettings::new(1000.0) });
    }
});
