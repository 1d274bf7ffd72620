//! The service from outside: real sockets, real files, real computations on a small model.

mod accuracy;
mod app;
mod chains;
mod checkpoints;
mod errors;
mod generation;
mod idempotency;
mod jobs;
mod kill;
mod metrics;
mod model;
mod models;
mod openapi;
mod plans;
mod refine;
mod studies;
mod sweeps;
mod transport;
