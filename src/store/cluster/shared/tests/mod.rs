//! Tests of the store on a PostgreSQL server and with object storage.

mod connections;
mod copied;
mod objects;
mod queue;
mod upgrades;
