//! Commands by which the program is a client of a service: a file per command.

mod cancel;
mod find;
mod gate;
mod get;
mod init;
mod kind;
mod ls;
mod open;
mod pause;
mod plan;
mod report;
mod rm;
mod show;
mod submit;
mod upload;
mod watch;

pub(super) use cancel::CancelArgs;
pub(super) use get::GetArgs;
pub(super) use init::{InitArgs, init};
pub(super) use ls::LsArgs;
pub(super) use open::OpenArgs;
pub(super) use pause::{ContinueArgs, PauseArgs};
pub(super) use plan::PlanArgs;
pub(super) use report::ReportArgs;
pub(super) use rm::RmArgs;
pub(super) use show::ShowArgs;
pub(super) use submit::{SubmitArgs, SweepArgs};
pub(super) use upload::UploadArgs;
pub(super) use watch::WatchArgs;
