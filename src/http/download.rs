//! Downloads of results: the choice of a form, clients that have the result already, and the headers of the answer.

use std::io::{self, Write};

use axum::body::{Body, Bytes};
use axum::extract::{FromRequestParts, Query};
use axum::http::request::Parts;
use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use sha2::{Digest, Sha256};
use utoipa::IntoParams;

use super::form::Form;
use super::problem::{Kind, Problem};
use super::state::AppState;
use super::stream::{self, Leave};
use crate::analysis::request::SpeedUnit;
use crate::export::{self, Export};
use crate::plot::{self, Figure, PngError};
use crate::store::jobs::Job;
use crate::version;

/// Width of a picture by default, pixels.
const WIDTH: u32 = 1200;

/// Bytes that rendering takes per pixel of a square: the canvas, layers of it, and the file; sheets are higher than wide.
const BYTES_PER_PIXEL: u64 = 16;

/// Bytes that a figure takes: it has no more lines, samples and cells than a screen shows.
const FIGURE_BYTES: u64 = 32 << 20;

/// Form in which to download a result.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(super) struct DownloadQuery {
    /// Form of the result; default: the form that the `Accept` header prefers or, without a preference, the first.
    #[param(inline)]
    format: Option<Form>,
    /// Width of a png in pixels; default 1200.
    #[param(minimum = 200, maximum = 4000)]
    width: Option<u32>,
    /// Unit of speeds: csv has them in it, by default in rpm; json and npz have them in it as well, beside everything whose name ends with
    /// `_rad_s`, under a name that ends with `_rpm` or `_hz`.
    #[param(inline)]
    units: Option<SpeedUnit>,
}

/// Download that a client asks for: parameters, and headers with the forms it accepts and the entity tags it has.
#[derive(Debug)]
pub(super) struct Download {
    query: DownloadQuery,
    headers: HeaderMap,
    /// Path and parameters of the request without `format`, sorted.
    target: String,
}

impl<S: Send + Sync> FromRequestParts<S> for Download {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, _: &S) -> Result<Self, Problem> {
        let invalid = |error: axum::extract::rejection::QueryRejection| {
            Problem::new(Kind::InvalidParameter, error.body_text())
        };
        let Query(query) = Query::try_from_uri(&parts.uri).map_err(invalid)?;
        let Query(mut all) = Query::<Vec<(String, String)>>::try_from_uri(&parts.uri).map_err(invalid)?;
        all.retain(|(name, _)| name != "format");
        all.sort_unstable();
        let headers = [header::ACCEPT, header::IF_NONE_MATCH].into_iter().flat_map(|name| {
            let values = parts.headers.get_all(&name).iter().cloned();
            values.map(move |value| (name.clone(), value))
        });
        let target = format!("{} {all:?}", parts.uri.path());
        Ok(Self { query, target, headers: HeaderMap::from_iter(headers) })
    }
}

/// Name of the state of a job, if its results do not change any more.
pub(super) fn lasting(job: &Job) -> Option<String> {
    job.status.is_final().then(|| format!("job {} {}", job.id, job.updated_at))
}

/// Download whose form is chosen.
#[derive(Debug)]
pub(super) struct Answer {
    pub(super) form: Form,
    pub(super) unit: Option<SpeedUnit>,
    width: u32,
    /// Entity tag of a result that does not change any more.
    tag: Option<String>,
}

/// Work that is left to do for a download.
pub(super) enum Next {
    /// Nothing: this is the answer.
    Done(Response),
    /// Everything: the result is to be read and written.
    Make(Answer),
}

impl Download {
    /// Chooses among the forms that a result has, and answers at once where that is possible. `lasting` names a state of the result
    /// that does not change any more.
    pub(super) fn begin(
        self,
        state: &AppState,
        lasting: Option<String>,
        those: &[Form],
    ) -> Result<Next, Problem> {
        let form = Form::choose(self.query.format, &self.headers, those)?;
        let tag = lasting.map(|state| tag(&[&state, &self.target, form.word(), version::LINE]));
        let DownloadQuery { width, units: unit, .. } = self.query;
        let answer = Answer { form, unit, width: width.unwrap_or(WIDTH), tag };
        let Some(tag) = &answer.tag else { return Ok(Next::Make(answer)) };
        if has(&self.headers, tag) {
            return Ok(Next::Done(answer.described(StatusCode::NOT_MODIFIED.into_response())));
        }
        let kept = form.is_drawing().then(|| state.renderings.get(tag)).flatten();
        Ok(match kept {
            Some(drawing) => {
                let content_type = [(header::CONTENT_TYPE, form.content_type())];
                Next::Done(answer.described((content_type, Body::from(drawing)).into_response()))
            }
            None => Next::Make(answer),
        })
    }
}

impl Answer {
    /// Bytes that making the answer takes, beside the result from which it is made.
    pub(super) fn bytes(&self) -> u64 {
        match self.form {
            Form::Png => BYTES_PER_PIXEL * u64::from(self.width).pow(2),
            Form::Plotly => FIGURE_BYTES,
            _ => 0,
        }
    }

    /// Answers with the numbers of the result in json, csv (in units for reading) or npz.
    pub(super) fn numbers<T>(self, leave: Leave, result: T) -> Response
    where
        T: Export + Serialize + Send + 'static,
    {
        let Self { form, unit, .. } = self;
        self.written(leave, move |out| match form {
            Form::Csv => export::write_csv(&result, unit, out),
            Form::Npz => export::write_npz(&export::add_to_arrays(result.arrays(), unit), out),
            _ => json(&result, unit, out),
        })
    }

    /// Answers with the result as JSON, with speeds in another unit as well if that is requested.
    pub(super) fn document(self, leave: Leave, result: impl Serialize + Send + 'static) -> Response {
        let unit = self.unit;
        self.written(leave, move |out| json(&result, unit, out))
    }

    /// Answers with the figure that `make` makes.
    pub(super) fn figure(self, leave: Leave, make: impl FnOnce() -> Figure + Send + 'static) -> Response {
        self.written(leave, move |out| Ok(serde_json::to_writer(out, &make())?))
    }

    /// Answers with the output of `write`, sent while it is written.
    pub(super) fn written(
        self,
        leave: Leave,
        write: impl FnOnce(&mut dyn Write) -> io::Result<()> + Send + 'static,
    ) -> Response {
        self.described(stream::written(leave, self.form.content_type(), write))
    }

    /// Answers with a body that is there as a whole.
    pub(super) fn whole(self, leave: Leave, body: impl AsRef<[u8]> + Send + 'static) -> Response {
        self.described(stream::whole(leave, self.form.content_type(), body))
    }

    /// Answers with the drawing that `draw` makes, and stores it for the next request if the result does not change any more.
    pub(super) async fn drawn(
        self,
        state: &AppState,
        leave: Leave,
        draw: impl FnOnce() -> Result<String, Problem> + Send + 'static,
    ) -> Result<Response, Problem> {
        let Self { form, width, .. } = self;
        let make = move || {
            let svg = draw()?;
            let drawing = match form {
                Form::Png => Bytes::from(plot::png(&svg, width).map_err(not_rendered)?),
                _ => Bytes::from(svg),
            };
            Ok::<_, Problem>((drawing, leave))
        };
        let (drawing, leave) = stream::blocking(make).await??;
        if let Some(tag) = &self.tag {
            state.renderings.keep(tag, drawing.clone());
        }
        Ok(self.whole(leave, drawing))
    }

    /// Adds the headers that caches need: `Vary`, and the entity tag if there is one.
    fn described(&self, mut response: Response) -> Response {
        let headers = response.headers_mut();
        headers.append(header::VARY, HeaderValue::from_static("accept"));
        if let Some(tag) = self.tag.as_deref().and_then(|tag| HeaderValue::from_str(tag).ok()) {
            headers.insert(header::ETAG, tag);
        }
        response
    }
}

/// Problem of a drawing that cannot be rendered.
fn not_rendered(error: PngError) -> Problem {
    match error {
        PngError::Width { .. } | PngError::Size { .. } => Problem::parameter("width", error.to_string()),
        PngError::Svg(_) | PngError::Write(_) => {
            tracing::error!(%error, "a drawing cannot be rendered");
            Problem::new(Kind::Internal, "the drawing cannot be rendered; the service's log says more")
        }
    }
}

/// Writes JSON, with speeds in `unit` as well.
fn json(result: &impl Serialize, unit: Option<SpeedUnit>, out: &mut dyn Write) -> io::Result<()> {
    match unit {
        None => Ok(serde_json::to_writer(out, result)?),
        Some(unit) => Ok(serde_json::to_writer(out, &with_unit(result, unit)?)?),
    }
}

/// Document with its speeds in `unit` as well.
pub(super) fn with_unit(document: &impl Serialize, unit: SpeedUnit) -> io::Result<Value> {
    let mut document = serde_json::to_value(document)?;
    export::add_to_json(&mut document, unit);
    Ok(document)
}

/// Entity tag: digest of all that an answer depends on.
fn tag(parts: &[&str]) -> String {
    let mut digest = Sha256::new();
    for part in parts {
        digest.update(part);
        digest.update([0]);
    }
    format!("\"{:x}\"", digest.finalize())
}

/// Whether the client has the entity with this tag (RFC 9110, 13.1.2).
pub(super) fn has(headers: &HeaderMap, tag: &str) -> bool {
    let values = headers.get_all(header::IF_NONE_MATCH).iter().filter_map(|value| value.to_str().ok());
    let mut listed = values.flat_map(|value| value.split(',')).map(str::trim);
    listed.any(|one| one == "*" || one.strip_prefix("W/").unwrap_or(one) == tag)
}
