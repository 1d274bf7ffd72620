//! Forms of a download: the forms that a result has, and the choice among them by `format` in the query or else by `Accept`.

use axum::http::{HeaderMap, header};
use serde::Deserialize;
use utoipa::ToSchema;

use super::problem::{Kind, Problem, ProblemItem};

/// Form of a download.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub(super) enum Form {
    /// All numbers of a result.
    Json,
    /// One table of a result, for spreadsheets.
    Csv,
    /// All numbers of a result as arrays of numpy.
    Npz,
    /// Drawing of a result.
    Svg,
    /// Picture of a result, in pixels.
    Png,
    /// Figure for Plotly: `data` and `layout`.
    Plotly,
    /// Field on all elements: VTK's UnstructuredGrid, for ParaView and pyvista.
    Vtu,
    /// Field on the skin: VTK's PolyData.
    Vtp,
    /// Field over time: a zip with ParaView's list of files and the files.
    Pvd,
}

impl Form {
    /// Forms of most results. Where a client takes several equally, it gets the first.
    pub(super) const ALL: [Self; 6] = [Self::Json, Self::Csv, Self::Npz, Self::Svg, Self::Png, Self::Plotly];

    /// Forms that are neither drawings nor figures.
    pub(super) const NUMBERS: [Self; 3] = [Self::Json, Self::Csv, Self::Npz];

    /// Forms of a field.
    pub(super) const FIELDS: [Self; 6] = [Self::Vtu, Self::Vtp, Self::Npz, Self::Pvd, Self::Svg, Self::Png];

    /// Forms of a mesh.
    pub(super) const MESH: [Self; 3] = [Self::Vtu, Self::Vtp, Self::Npz];

    /// Forms of a result that is a list, and a field for each of its entries.
    pub(super) const LIST_AND_FIELDS: [Self; 7] =
        [Self::Json, Self::Vtu, Self::Vtp, Self::Npz, Self::Pvd, Self::Svg, Self::Png];

    /// Word for the form in a query.
    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Json => "json",
            Self::Csv => "csv",
            Self::Npz => "npz",
            Self::Svg => "svg",
            Self::Png => "png",
            Self::Plotly => "plotly",
            Self::Vtu => "vtu",
            Self::Vtp => "vtp",
            Self::Pvd => "pvd",
        }
    }

    /// Media type of the form; those of numpy and VTK are not registered.
    pub(super) fn media_type(self) -> &'static str {
        match self {
            Self::Json => "application/json",
            Self::Csv => "text/csv",
            Self::Npz => "application/x-npz",
            Self::Svg => "image/svg+xml",
            Self::Png => "image/png",
            Self::Plotly => "application/vnd.plotly.v1+json",
            Self::Vtu => "application/x-vtu",
            Self::Vtp => "application/x-vtp",
            Self::Pvd => super::stream::ZIP,
        }
    }

    /// Content type of an answer in this form.
    pub(super) fn content_type(self) -> &'static str {
        match self {
            Self::Csv => "text/csv; charset=utf-8",
            form => form.media_type(),
        }
    }

    /// Whether the form is a drawing.
    pub(super) fn is_drawing(self) -> bool {
        matches!(self, Self::Svg | Self::Png)
    }

    /// Whether the form is to be looked at: a drawing, or a figure of the same.
    pub(super) fn is_shown(self) -> bool {
        self.is_drawing() || self == Self::Plotly
    }

    /// Chooses the form of a result that has `those`: the one that the query asks for, or else the one that `Accept` prefers.
    pub(super) fn choose(query: Option<Self>, headers: &HeaderMap, those: &[Self]) -> Result<Self, Problem> {
        match query {
            Some(form) if those.contains(&form) => Ok(form),
            Some(form) => Err(not_acceptable("format", form.word(), those)),
            None => preferred(headers, those),
        }
    }
}

fn preferred(headers: &HeaderMap, those: &[Form]) -> Result<Form, Problem> {
    let accept: Vec<&str> =
        headers.get_all(header::ACCEPT).iter().filter_map(|value| value.to_str().ok()).collect();
    let accept = accept.join(",");
    if accept.trim().is_empty() {
        return those.first().copied().ok_or_else(|| not_acceptable("Accept", "", those));
    }
    let ranges: Vec<Range> = accept.split(',').filter_map(Range::parse).collect();
    let quality = |form: Form| {
        // The most specific range that names it counts.
        let named = ranges.iter().filter_map(|range| Some((range.names(form)?, range.quality)));
        named.max_by_key(|(specific, _)| *specific).map_or(0, |(_, quality)| quality)
    };
    let best = those.iter().rev().copied().max_by_key(|form| quality(*form));
    best.filter(|form| quality(*form) > 0).ok_or_else(|| not_acceptable("Accept", accept.trim(), those))
}

fn not_acceptable(parameter: &str, asked: &str, those: &[Form]) -> Problem {
    let list =
        |of: fn(Form) -> &'static str| those.iter().map(|form| of(*form)).collect::<Vec<_>>().join(", ");
    let detail = format!("this result comes as {} ({})", list(Form::word), list(Form::media_type));
    let asked = super::problem::excerpt(asked);
    Problem::new(Kind::NotAcceptable, format!("{parameter}: {detail}, not as {asked}")).with(ProblemItem {
        parameter: Some(parameter.to_owned()),
        detail,
        ..ProblemItem::default()
    })
}

/// Media range of an `Accept` header.
struct Range<'a> {
    media_type: &'a str,
    /// Quality of the range, in thousandths.
    quality: u32,
}

impl<'a> Range<'a> {
    fn parse(text: &'a str) -> Option<Self> {
        let mut parts = text.split(';').map(str::trim);
        let media_type = parts.next().filter(|media_type| media_type.contains('/'))?;
        let quality = parts.find_map(|part| part.strip_prefix("q=").or_else(|| part.strip_prefix("Q=")));
        // What is no number wants nothing.
        let quality = quality.map_or(1.0, |quality| quality.parse().unwrap_or(0.0));
        Some(Self { media_type, quality: (1e3 * f64::clamp(quality, 0.0, 1.0)) as u32 })
    }

    /// How specifically the range names a form; `None` if it does not.
    fn names(&self, form: Form) -> Option<u8> {
        let wanted = form.media_type();
        let all_of = |kind: &str| wanted.split('/').next().is_some_and(|own| own.eq_ignore_ascii_case(kind));
        match self.media_type.split_once('/')? {
            ("*", "*") => Some(0),
            (kind, "*") => all_of(kind).then_some(1),
            _ => self.media_type.eq_ignore_ascii_case(wanted).then_some(2),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chosen(accept: &str, those: &[Form]) -> Option<Form> {
        let mut headers = HeaderMap::new();
        headers.insert(header::ACCEPT, accept.parse().unwrap());
        Form::choose(None, &headers, those).ok()
    }

    /// Checks the order of preference of RFC 9110, 12.5.1.
    #[test]
    fn accept_is_read_by_quality_and_specificity() {
        let all = &Form::ALL;
        assert_eq!(Form::choose(None, &HeaderMap::new(), all).unwrap(), Form::Json);
        for (accept, form) in [
            ("*/*", Some(Form::Json)),
            ("", Some(Form::Json)),
            ("image/png", Some(Form::Png)),
            ("image/*", Some(Form::Svg)),
            ("IMAGE/PNG;q=0.9, text/csv;q=0.95", Some(Form::Csv)),
            ("application/json;q=0, */*;q=0.1", Some(Form::Csv)),
            ("application/*;q=0.2, application/x-npz", Some(Form::Npz)),
            ("application/vnd.plotly.v1+json", Some(Form::Plotly)),
            ("application/vnd.plotly.v1+json;q=0.5, application/json;q=0.4", Some(Form::Plotly)),
            ("text/html, */*;q=0.8", Some(Form::Json)),
            ("text/html", None),
            ("application/json;q=nan", None),
            ("nonsense", None),
        ] {
            assert_eq!(chosen(accept, all), form, "{accept}");
        }
        assert_eq!(chosen("image/*", &[Form::Json, Form::Png]), Some(Form::Png));
        assert_eq!(chosen("text/csv", &[Form::Json, Form::Png]), None);
        assert_eq!(chosen("application/vnd.plotly.v1+json", &Form::LIST_AND_FIELDS), None);
    }

    #[test]
    fn the_query_is_above_the_header() {
        let mut headers = HeaderMap::new();
        headers.insert(header::ACCEPT, "image/png".parse().unwrap());
        assert_eq!(Form::choose(Some(Form::Csv), &headers, &Form::ALL).unwrap(), Form::Csv);
        let problem = Form::choose(Some(Form::Csv), &headers, &[Form::Json, Form::Png]).unwrap_err();
        assert_eq!(problem.status, 406);
        assert!(problem.detail.contains("json, png") && problem.detail.contains("not as csv"), "{problem:?}");
    }
}
