//! The model package of PACKAGE.md: read, check, rotate to cylindrical components; and write.

pub mod raw;
