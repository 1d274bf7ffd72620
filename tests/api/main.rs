//! The service from outside: real sockets, real files, real computations on a small model.

mod accuracy;
mod app;
mod bodies;
mod chains;
mod checkpoints;
mod errors;
mod faults;
mod generation;
mod idempotency;
mod jobs;
mod keeping;
mod kill;
mod metrics;
mod model;
mod models;
mod openapi;
mod owners;
mod parameters;
mod plans;
mod program;
mod refine;
mod sensors;
mod small_disk;
mod studies;
mod sweeps;
mod transport;
