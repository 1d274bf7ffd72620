//! Drawings that were made already and are stored in memory, so that a page with ten of them does not have them drawn at every visit.

use std::collections::{HashMap, VecDeque};
use std::sync::{Mutex, MutexGuard, PoisonError};

use axum::body::Bytes;

/// Bytes of all stored drawings. One drawing has some hundred thousand.
const MOST: usize = 32 << 20;

/// Drawings of results that do not change any more, by their entity tags. The oldest make room for new ones.
#[derive(Debug, Default)]
pub struct Renderings(Mutex<Kept>);

#[derive(Debug, Default)]
struct Kept {
    by_tag: HashMap<String, Bytes>,
    /// Entity tags of the drawings, oldest first.
    order: VecDeque<String>,
    bytes: usize,
}

impl Renderings {
    /// Drawing with this tag, if it is still stored.
    pub(super) fn get(&self, tag: &str) -> Option<Bytes> {
        self.lock().by_tag.get(tag).cloned()
    }

    /// Stores a drawing, unless it would take the place of most others.
    pub(super) fn keep(&self, tag: &str, drawing: Bytes) {
        if drawing.len() > MOST / 4 {
            return;
        }
        let mut kept = self.lock();
        let added = drawing.len();
        if kept.by_tag.insert(tag.to_owned(), drawing).is_some() {
            // Drawn twice at the same time; both are the same.
            return;
        }
        kept.order.push_back(tag.to_owned());
        kept.bytes += added;
        while kept.bytes > MOST
            && let Some(oldest) = kept.order.pop_front()
        {
            kept.bytes -= kept.by_tag.remove(&oldest).map_or(0, |drawing| drawing.len());
        }
    }

    fn lock(&self) -> MutexGuard<'_, Kept> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_oldest_make_room() {
        let renderings = Renderings::default();
        let drawing = |size: usize| Bytes::from(vec![0; size]);
        for index in 0..5 {
            renderings.keep(&index.to_string(), drawing(MOST / 4));
            renderings.keep(&index.to_string(), drawing(MOST / 4));
        }
        assert!(renderings.get("0").is_none());
        assert!((1..5).all(|index| renderings.get(&index.to_string()).is_some()));
        assert_eq!(renderings.lock().bytes, MOST);
        renderings.keep("large", drawing(MOST / 4 + 1));
        assert!(renderings.get("large").is_none() && renderings.get("1").is_some());
    }
}
