//! Accuracy and its cost in time: are orders as theory has them, estimates honest, targets met?

mod honesty;
mod orders;
mod sweeps;
mod wheel;
