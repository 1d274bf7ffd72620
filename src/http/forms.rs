//! Forms of one kind of result. Every result has its numbers as json, csv and npz, and, except for bare tables, its drawing as svg
//! and png and the same as a figure for Plotly.
//!
//! To add a result: implement [`Export`] for it in `src/export`, take [`Download`] as an argument of its handler and
//! [`DownloadQuery`](super::download::DownloadQuery) as parameters of its route, and answer with
//! `Forms::drawn_by(draw).of_document(…)` if it is stored as a document, otherwise with `answer`.

use axum::response::Response;
use serde::Serialize;
use serde::de::DeserializeOwned;
use tokio::runtime::Handle;

use super::download::{Answer, Download, Next, lasting};
use super::extract::job_not_found;
use super::form::Form;
use super::problem::{Kind, Problem};
use super::state::AppState;
use super::stream;
use crate::analysis::kinds::document::Document;
use crate::analysis::kinds::sweep::{CRITICAL_SPEEDS, HISTORIES};
use crate::analysis::resolved::ResolvedSweep;
use crate::export::Export;
use crate::plot::Drawing;
use crate::store::jobs::{Job, JobId};
use crate::store::status::JobStatus;

/// Memory of a document, in multiples of its text: the row and the text.
pub(super) const TEXT_MEMORY: u64 = 2;

/// Memory of a document that is written in another form, in multiples of its text: the text, its numbers, and the other form.
pub(super) const READ_MEMORY: u64 = 6;

/// Makes the drawing of a result.
type Draw<T> = Box<dyn for<'a> FnOnce(&'a T) -> Drawing<'a> + Send>;

/// Changes a result before it is written.
type Change<T> = Box<dyn FnOnce(&mut T) + Send>;

/// Forms of a result.
pub(super) struct Forms<T> {
    /// Drawing of the result; `None` if it is only a table.
    draw: Option<Draw<T>>,
    /// Change that is made to a stored result before it is written.
    change: Option<Change<T>>,
}

impl<T: Export + Serialize + Send + 'static> Forms<T> {
    /// Forms of a result that `draw` draws.
    pub(super) fn drawn_by(draw: impl for<'a> FnOnce(&'a T) -> Drawing<'a> + Send + 'static) -> Self {
        Self { draw: Some(Box::new(draw)), change: None }
    }

    /// Forms of a result that has no drawing.
    pub(super) fn undrawn() -> Self {
        Self { draw: None, change: None }
    }

    fn those(&self) -> &'static [Form] {
        if self.draw.is_some() { &Form::ALL } else { &Form::NUMBERS }
    }

    /// Answers with the result of `read`, which may wait, and which takes `bytes` of memory together with everything made of it.
    /// `lasting` names the state of the result, if that does not change any more.
    pub(super) async fn answer(
        self,
        state: &AppState,
        download: Download,
        lasting: Option<String>,
        bytes: u64,
        read: impl FnOnce() -> Result<T, Problem> + Send + 'static,
    ) -> Result<Response, Problem> {
        match download.begin(state, lasting, self.those())? {
            Next::Done(response) => Ok(response),
            Next::Make(answer) => self.make(state, answer, bytes, read).await,
        }
    }

    /// Answers with the result of `read`, once the form is known.
    pub(super) async fn make(
        self,
        state: &AppState,
        answer: Answer,
        bytes: u64,
        read: impl FnOnce() -> Result<T, Problem> + Send + 'static,
    ) -> Result<Response, Problem> {
        let leave = state.answers.leave(&state.jobs, bytes + answer.bytes()).await;
        let (is_drawing, is_figure) = (answer.form.is_drawing(), answer.form == Form::Plotly);
        let draw = match self.draw {
            Some(draw) if is_drawing => {
                return answer.drawn(state, leave, move || Ok(draw(&read()?).svg())).await;
            }
            draw => draw.filter(|_| is_figure),
        };
        let (result, leave) = stream::blocking(move || Ok::<_, Problem>((read()?, leave))).await??;
        Ok(match draw {
            Some(draw) => answer.figure(leave, move || draw(&result).figure()),
            None => answer.numbers(leave, result),
        })
    }

    /// Answers with what `made` makes of a document that was computed at the end of a job.
    pub(super) async fn made_of<D: DeserializeOwned>(
        self,
        state: &AppState,
        download: Download,
        job: &Job,
        document: Document<'static>,
        made: impl FnOnce(D) -> Result<T, Problem> + Send + 'static,
    ) -> Result<Response, Problem> {
        let bytes = READ_MEMORY * stored_bytes(state, job, document).await?;
        let text = read(state, job.id, document);
        let read = move || made(serde_json::from_str(&text()?)?);
        self.answer(state, download, lasting(job), bytes, read).await
    }
}

impl<T: Export + Serialize + DeserializeOwned + Send + 'static> Forms<T> {
    /// Lets `change` put a document into another order before it is written.
    pub(super) fn changed_by(self, change: impl FnOnce(&mut T) + Send + 'static) -> Self {
        Self { change: Some(Box::new(change)), ..self }
    }

    /// Answers with a document that was computed at the end of a job: its JSON as it was stored, unless something changes it.
    pub(super) async fn of_document(
        mut self,
        state: &AppState,
        download: Download,
        job: &Job,
        document: Document<'static>,
    ) -> Result<Response, Problem> {
        let bytes = stored_bytes(state, job, document).await?;
        let text = read(state, job.id, document);
        match download.begin(state, lasting(job), self.those())? {
            Next::Done(response) => Ok(response),
            Next::Make(answer)
                if answer.form == Form::Json && answer.unit.is_none() && self.change.is_none() =>
            {
                let leave = state.answers.leave(&state.jobs, TEXT_MEMORY * bytes).await;
                let (text, leave) = stream::blocking(move || Ok::<_, Problem>((text()?, leave))).await??;
                Ok(answer.whole(leave, text))
            }
            Next::Make(answer) => {
                let change = self.change.take();
                let read = move || {
                    let mut result = serde_json::from_str(&text()?)?;
                    if let Some(change) = change {
                        change(&mut result);
                    }
                    Ok(result)
                };
                self.make(state, answer, READ_MEMORY * bytes, read).await
            }
        }
    }
}

/// Reader of a document's text, for a thread that may wait.
fn read(
    state: &AppState,
    job: JobId,
    document: Document<'static>,
) -> impl FnOnce() -> Result<String, Problem> + Send + 'static {
    let (store, runtime) = (state.store.clone(), Handle::current());
    move || runtime.block_on(store.document(job, document))?.ok_or_else(|| job_not_found(&job))
}

/// Bytes of a document's text; a problem with the reason if there is no document.
async fn stored_bytes(state: &AppState, job: &Job, document: Document<'static>) -> Result<u64, Problem> {
    if let Some(bytes) = state.store.document_bytes(job.id, document).await? {
        return Ok(bytes);
    }
    if let (Document { name: HISTORIES, part: speed }, JobStatus::Successful) = (document, job.status) {
        let detail = match job.request.get::<ResolvedSweep>() {
            Some(_) => format!(
                "nothing was recorded of speed {speed}: POST /v1/jobs/{}/histories with {{\"speeds\": [{speed}]}} records it",
                job.id
            ),
            None => {
                format!("the job has no histories of speed {speed}; its request says of which speeds it has")
            }
        };
        return Err(Problem::new(Kind::HistoryNotRecorded, detail));
    }
    let instead = match document.name {
        CRITICAL_SPEEDS => {
            ": critical speeds are said of all speeds together; the interaction map has those that are done"
        }
        _ => "",
    };
    Err(match job.status {
        JobStatus::Accepted | JobStatus::Running | JobStatus::Paused => {
            Problem::new(Kind::ResultNotReady, format!("the job is at {} %{instead}", job.progress))
        }
        JobStatus::Successful => {
            let detail =
                "an earlier version computed the job, which had no such result: post its request again";
            Problem::new(Kind::ResultUnavailable, detail)
        }
        JobStatus::Failed | JobStatus::Dismissed => {
            let status = job.status.as_str();
            Problem::new(Kind::ResultUnavailable, format!("the job is {status}{instead}"))
        }
    })
}
