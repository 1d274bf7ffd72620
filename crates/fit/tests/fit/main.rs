//! Fits of small generated wheels, as one program.

mod common;
mod recovery;
mod repeat;
mod requests;
