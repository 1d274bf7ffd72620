//! Page for the browser: our own files, and Plotly's script beside them.
//!
//! The page is a client like any other and no part of the contract. Anybody may read it; its own requests have a token where the
//! service wants one.

use std::collections::BTreeMap;
use std::io::{self, Read, Write};
use std::sync::{LazyLock, OnceLock};

use axum::Router;
use axum::body::{Body, Bytes};
use axum::extract::Path;
use axum::http::{HeaderMap, HeaderName, HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use axum::routing::get;
use flate2::Compression;
use flate2::read::GzDecoder;
use flate2::write::GzEncoder;
use rust_embed::RustEmbed;
use sha2::{Digest, Sha256};

use super::download;
use super::problem::{Kind, Problem};
use super::state::AppState;

/// File at `/`, which loads the others.
const INDEX: &str = "index.html";

/// Placeholder in the index for the address of Plotly's script.
const PLACE_OF_SCRIPT: &str = "{{plotly}}";

/// Cache control of files that browsers ask for again whenever the page is opened; the answer is 304 if they are the same.
const CHECKED: HeaderValue = HeaderValue::from_static("no-cache");

/// Cache control of files that have a digest of their content in their name.
const FOREVER: HeaderValue = HeaderValue::from_static("public, max-age=31536000, immutable");

/// Content security policy of the page: browsers load only its own parts and the answers of this service. The digests are of the
/// two texts that Plotly puts into style attributes: an empty one, and how the picture of a heat map is to be scaled.
const POLICY: HeaderValue = HeaderValue::from_static(
    "default-src 'none'; script-src 'self'; \
     style-src 'self' 'unsafe-hashes' 'sha256-47DEQpj8HBSa+/TImW+5JCeuQeRkm5NMpJWZG3hSuFU=' \
     'sha256-AR/cKIZjWPcPmBUPDA6oti9XBiTbJvz0Cro2J1VzzS8='; \
     img-src 'self' data: blob:; connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
);

#[derive(RustEmbed)]
#[folder = "web/"]
struct Files;

/// Page, compressed when it is first asked for.
static PAGE: LazyLock<io::Result<Page>> = LazyLock::new(Page::new);

/// Files of the page, by the rest of their path.
struct Page {
    files: BTreeMap<String, File>,
}

/// File of the page as it is sent.
struct File {
    content_type: HeaderValue,
    cache: HeaderValue,
    /// Entity tag without the mark of weakness; the plain and the compressed file have the same.
    tag: String,
    gzipped: Bytes,
    /// Plain content, for the few clients that do not take it compressed.
    plain: OnceLock<Bytes>,
}

/// Whether this path belongs to the page.
pub(super) fn is_of_page(path: &str) -> bool {
    path == "/" || path.starts_with("/page/")
}

/// Routes of the page.
pub(super) fn routes() -> Router<AppState> {
    Router::new().route("/", get(async |headers: HeaderMap| answer(INDEX, &headers))).route(
        "/page/{*file}",
        get(async |Path(file): Path<String>, headers: HeaderMap| match file.as_str() {
            INDEX => Err(StatusCode::NOT_FOUND.into_response()),
            file => answer(file, &headers).map_err(IntoResponse::into_response),
        }),
    )
}

fn answer(name: &str, headers: &HeaderMap) -> Result<Response, Problem> {
    let page = PAGE.as_ref().map_err(|error| {
        tracing::error!(%error, "the page cannot be compressed");
        Problem::new(Kind::Internal, "the page cannot be sent; the service's log says more")
    })?;
    let file = page.files.get(name).ok_or_else(|| Problem::from_status(StatusCode::NOT_FOUND))?;
    let mut response = if download::has(headers, &file.tag) {
        StatusCode::NOT_MODIFIED.into_response()
    } else {
        let content_type = (header::CONTENT_TYPE, file.content_type.clone());
        if takes_gzip(headers) {
            let encoding = (header::CONTENT_ENCODING, HeaderValue::from_static("gzip"));
            ([content_type, encoding], Body::from(file.gzipped.clone())).into_response()
        } else {
            ([content_type], Body::from(file.plain()?)).into_response()
        }
    };
    response.headers_mut().extend(file.headers());
    Ok(response)
}

impl Page {
    fn new() -> io::Result<Self> {
        let script = File {
            content_type: HeaderValue::from_static("text/javascript"),
            cache: FOREVER,
            tag: tag(rubmap_script::GZIPPED),
            gzipped: Bytes::from_static(rubmap_script::GZIPPED),
            plain: OnceLock::new(),
        };
        let name_of_script = format!("plotly-{}.js", &script.tag[1..17]);
        let mut files = BTreeMap::new();
        for name in Files::iter() {
            let Some(file) = Files::get(&name) else { continue };
            let content = match (name.as_ref(), std::str::from_utf8(&file.data)) {
                (INDEX, Ok(index)) => {
                    index.replace(PLACE_OF_SCRIPT, &format!("/page/{name_of_script}")).into_bytes()
                }
                _ => file.data.into_owned(),
            };
            files.insert(name.into_owned(), File::new(file.metadata.mimetype(), content)?);
        }
        files.insert(name_of_script, script);
        Ok(Self { files })
    }
}

impl File {
    fn new(media_type: &str, content: Vec<u8>) -> io::Result<Self> {
        let mut gzipped = GzEncoder::new(Vec::new(), Compression::best());
        gzipped.write_all(&content)?;
        let text = if media_type.starts_with("text/") { "; charset=utf-8" } else { "" };
        Ok(Self {
            content_type: HeaderValue::try_from(format!("{media_type}{text}")).map_err(io::Error::other)?,
            cache: CHECKED,
            tag: tag(&content),
            gzipped: gzipped.finish()?.into(),
            plain: Bytes::from(content).into(),
        })
    }

    fn plain(&self) -> io::Result<Bytes> {
        if let Some(plain) = self.plain.get() {
            return Ok(plain.clone());
        }
        let mut plain = Vec::new();
        GzDecoder::new(&self.gzipped[..]).read_to_end(&mut plain)?;
        Ok(self.plain.get_or_init(|| plain.into()).clone())
    }

    /// Headers of every answer, also of those without the content.
    fn headers(&self) -> impl Iterator<Item = (HeaderName, HeaderValue)> {
        let tag = HeaderValue::try_from(format!("W/{}", self.tag)).ok();
        let always = [
            (header::CACHE_CONTROL, self.cache.clone()),
            (header::VARY, HeaderValue::from_static("accept-encoding")),
            (header::CONTENT_SECURITY_POLICY, POLICY),
            (header::REFERRER_POLICY, HeaderValue::from_static("no-referrer")),
            (HeaderName::from_static("cross-origin-opener-policy"), HeaderValue::from_static("same-origin")),
        ];
        always.into_iter().chain(tag.map(|tag| (header::ETAG, tag)))
    }
}

fn tag(content: &[u8]) -> String {
    format!("\"{:x}\"", Sha256::digest(content))
}

/// Whether the client accepts content compressed by gzip (RFC 9110, 12.5.3).
fn takes_gzip(headers: &HeaderMap) -> bool {
    let values = headers.get_all(header::ACCEPT_ENCODING).iter().filter_map(|value| value.to_str().ok());
    values.flat_map(|value| value.split(',')).any(|coding| {
        let mut parts = coding.split(';').map(str::trim);
        let named = parts.next().is_some_and(|name| name.eq_ignore_ascii_case("gzip"));
        let weight = parts.find_map(|part| part.strip_prefix("q="));
        named && weight.is_none_or(|weight| weight.parse().is_ok_and(|weight: f64| weight > 0.0))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gzip_is_for_those_who_take_it() {
        let takes = |accepted: &'static str| {
            takes_gzip(&HeaderMap::from_iter([(header::ACCEPT_ENCODING, HeaderValue::from_static(accepted))]))
        };
        assert!(takes("gzip") && takes("br, GZIP;q=0.5") && takes("gzip, deflate, br, zstd"));
        assert!(!takes("") && !takes("br") && !takes("gzip;q=0") && !takes("xgzip"));
        assert!(!takes_gzip(&HeaderMap::new()));
    }
}
