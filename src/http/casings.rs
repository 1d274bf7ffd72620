//! Measured casings from tables.

use axum::Json;
use axum::extract::{FromRequest, Request};
use utoipa::ToSchema;

use super::extract::whole_body;
use super::problem::{Kind, Problem, ProblemItem};
use super::state::AppState;
use super::stream;
use crate::analysis::result::MeasuredCasing;
use crate::casing_table::{self, TableError};

/// Table of a measured casing in CSV: heights as docs/effects.md describes them.
#[derive(ToSchema)]
#[schema(value_type = String)]
#[expect(dead_code, reason = "describes the body in the OpenAPI document only")]
pub(super) struct CasingTable(String);

/// Body of a request in CSV.
pub(super) struct CsvBody(axum::body::Bytes);

impl FromRequest<AppState> for CsvBody {
    type Rejection = Problem;

    async fn from_request(request: Request, state: &AppState) -> Result<Self, Problem> {
        whole_body(request, state, &["text/csv"]).await.map(Self)
    }
}

/// Make a measured casing from a table in CSV.
///
/// The table has heights, inward of the casing of revolution, over the angle and over positions along the chord or contact nodes:
/// *wide*, with the header `angle_deg,0,0.5,1` or `angle_deg,node0,node1`, or *long*, `angle_deg,chord,height` or
/// `angle_deg,node,height`; `angle_rad` for rad. Rows may be in any order; comma, semicolon or tab separates cells; an empty cell
/// is a missing height. The answer's `measured` can be given as it is to `scene.casing`. Nothing is stored.
#[utoipa::path(post, path = "/v1/casing-tables", operation_id = "read_casing_table", tag = "models",
    request_body(content = CasingTable, content_type = "text/csv"),
    responses(
        (status = 200, description = "The shape, and what stands out of it.", body = MeasuredCasing),
        (status = 415, description = "The body is not declared as text/csv.", body = Problem,
            content_type = "application/problem+json"),
        (status = 422, description = "The table cannot be read: `errors` has the line of each.", body = Problem,
            content_type = "application/problem+json"),
    ))]
pub(super) async fn read_casing_table(CsvBody(text): CsvBody) -> Result<Json<MeasuredCasing>, Problem> {
    let read = stream::blocking(move || casing_table::read(&text)).await?;
    read.map(Json).map_err(refused)
}

fn refused(errors: Vec<TableError>) -> Problem {
    let detail = errors.iter().take(3).map(TableError::to_string).collect::<Vec<_>>().join("; ");
    let items = errors.into_iter().map(|TableError { line, message }| ProblemItem {
        line,
        detail: message,
        ..ProblemItem::default()
    });
    Problem::new(Kind::InvalidTable, detail).with_all(items.collect())
}
