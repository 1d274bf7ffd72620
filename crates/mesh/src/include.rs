//! Files that a mesh file includes.

/// Source of included files: content by the name under which a file includes another, or the reason why it cannot be had.
pub type Include<'a> = dyn Fn(&str) -> Result<Vec<u8>, String> + 'a;
