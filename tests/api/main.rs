//! The service from outside: real sockets, real files, real computations on a small model.

mod app;
mod errors;
mod idempotency;
mod jobs;
mod kill;
mod model;
mod models;
mod openapi;
mod sweeps;
