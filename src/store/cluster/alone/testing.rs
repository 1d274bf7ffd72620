//! Test server of a program that has none.

/// Address of a new database: there is no server.
pub(in crate::store) async fn database() -> Option<String> {
    None
}
