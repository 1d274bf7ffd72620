//! Address of the database that several processes share.

use std::convert::Infallible;
use std::fmt;
use std::str::FromStr;

/// The address of a PostgreSQL database; it may have a password in it, which nothing shows.
#[derive(Clone, PartialEq, Eq)]
pub struct DatabaseUrl(String);

impl DatabaseUrl {
    /// Full address, including the password.
    pub fn expose(&self) -> &str {
        &self.0
    }
}

impl fmt::Debug for DatabaseUrl {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("postgres://…")
    }
}

/// Takes any text: the address in a refusal would be shown.
impl FromStr for DatabaseUrl {
    type Err = Infallible;

    fn from_str(url: &str) -> Result<Self, Infallible> {
        Ok(Self(url.to_owned()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_password_is_not_shown() {
        let url: DatabaseUrl = "postgres://me:secret@db/rubmap".parse().unwrap();
        assert_eq!(
            (format!("{url:?}").as_str(), url.expose()),
            ("postgres://…", "postgres://me:secret@db/rubmap")
        );
    }
}
