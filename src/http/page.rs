//! Pages of lists.

use serde::Serialize;

use super::problem::Problem;

const DEFAULT_LIMIT: u32 = 50;
const LARGEST_LIMIT: u32 = 500;

/// Number of items on a page: as many as asked for, within the limits of a page.
pub(super) fn limit(asked: Option<u32>) -> Result<u32, Problem> {
    let limit = asked.unwrap_or(DEFAULT_LIMIT);
    if (1..=LARGEST_LIMIT).contains(&limit) {
        return Ok(limit);
    }
    Err(Problem::parameter("limit", format!("a page has 1 to {LARGEST_LIMIT} entries")))
}

/// Reads a cursor; refuses one that this service did not give.
pub(super) fn cursor<T>(given: Option<&str>, read: impl Fn(&str) -> Option<T>) -> Result<Option<T>, Problem> {
    let bad = || Problem::parameter("cursor", "not a cursor that this service gave");
    given.map(|cursor| read(cursor).ok_or_else(bad)).transpose()
}

/// Path of another page of a list.
pub(super) fn path(listing: &str, query: &impl Serialize) -> Result<String, Problem> {
    let query = serde_urlencoded::to_string(query).map_err(std::io::Error::other)?;
    Ok(format!("{listing}?{query}"))
}

/// Cuts a list of up to `limit` + 1 items to a page. Returns the last item if there is another page.
pub(super) fn cut<T>(items: &mut Vec<T>, limit: u32) -> Option<&T> {
    let more = items.len() > limit as usize;
    items.truncate(limit as usize);
    items.last().filter(|_| more)
}
