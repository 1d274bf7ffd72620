//! A cyclic wheel that rubs against its casing.
//!
//! [`dynamics`] reduces a sector per nodal diameter and integrates the wheel in time; [`response`] reads what came out.

pub mod dynamics;
pub mod response;
pub mod revision;
