//! Client of the HTTP contract, from the user's side: nothing that curl could not do. All commands that speak to a service do it by this.

mod answer;
mod download;
mod error;
mod follow;
mod http;
mod job;
mod problem;
mod server;
mod upload;

pub(super) use answer::Answer;
pub(super) use download::{Target, new_file};
pub(super) use error::ClientError;
pub(super) use http::Client;
pub(super) use job::{Job, JobError, Model};
pub(super) use server::ServerArgs;
pub(super) use upload::UploadLabels;
