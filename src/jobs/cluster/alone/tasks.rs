//! Tasks that machines share, which cannot exist in this build.

use crate::store::Store;
use crate::store::jobs::JobId;

/// Tasks of all machines, which cannot exist in this build.
#[derive(Debug)]
pub(in crate::jobs) enum SharedTasks {}

impl SharedTasks {
    /// Tasks that the processes of a store share: none.
    pub(in crate::jobs) fn of(_: &Store) -> Option<Self> {
        None
    }

    pub(in crate::jobs) async fn give_back(&self) {
        match *self {}
    }

    pub(in crate::jobs) fn prepare(&self, _: JobId, _: Option<String>) {
        match *self {}
    }

    pub(in crate::jobs) fn run(&self, _: JobId, _: bool, _: Vec<u32>) {
        match *self {}
    }

    pub(in crate::jobs) fn withdraw(&self, _: JobId) {
        match *self {}
    }
}
