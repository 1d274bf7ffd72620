//! Addresses of object stores, of which there are none.

/// Address of an object store, which cannot exist in this build.
#[derive(Debug, Clone, Copy)]
pub enum Address {}
