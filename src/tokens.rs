//! Access to the service: bearer tokens, of which a file holds hashes, owners and scopes.
//!
//! A line of the file is `<SHA-256 of the token, hexadecimal> <scope> <owner>`; `#` begins a comment. Tokens are 32 random
//! bytes, so that a plain hash is as good as a slow one, and to find a token by its hash tells nobody anything about it.

use std::collections::HashMap;
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant, SystemTime};

use base64::Engine;
use base64::prelude::BASE64_URL_SAFE_NO_PAD;
use clap::ValueEnum;
use sha2::{Digest, Sha256};

/// Prefix of all tokens, so that people and scanners know one when they see it.
const PREFIX: &str = "rubmap_";

/// Length of the longest name of an owner.
const LONGEST_OWNER: usize = 64;

/// Time after which a change of the file is noticed.
const BETWEEN_LOOKS: Duration = Duration::from_secs(1);

/// Scope of a token: what its holder may do.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Scope {
    /// Read what belongs to the owner.
    Read,
    /// Read, upload, compute, cancel and delete what belongs to the owner.
    Write,
    /// Everything, whoever owns it.
    Admin,
}

/// Sender of a request.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Principal {
    /// Owner of what the request makes; empty where the service knows no owners.
    pub owner: String,
    /// Scope of the sender's token.
    pub scope: Scope,
}

impl Principal {
    /// Sender of any request to a service without tokens.
    pub fn anybody() -> Self {
        Self { owner: String::new(), scope: Scope::Admin }
    }

    /// Whether the sender may see what belongs to `owner`.
    pub fn sees(&self, owner: &str) -> bool {
        self.scope == Scope::Admin || self.owner == owner
    }

    /// Owner whose things alone the sender may see; `None` if they see all.
    pub fn only(&self) -> Option<&str> {
        (self.scope != Scope::Admin).then_some(&self.owner)
    }
}

/// Error of a file of tokens.
#[derive(Debug, thiserror::Error)]
pub enum TokensError {
    /// File that cannot be read or written.
    #[error("the file of tokens {}: {source}", path.display())]
    File {
        /// Path of the file.
        path: PathBuf,
        /// Cause, as the system reports it.
        source: std::io::Error,
    },
    /// Line that is not what it should be.
    #[error(
        "the file of tokens {}, line {line}: expected a SHA-256 in hexadecimal, a scope (read, write or admin) and an owner; \
         `rubmap token new` writes such lines",
        path.display()
    )]
    Line {
        /// Path of the file.
        path: PathBuf,
        /// Number of the line, from 1.
        line: usize,
    },
    /// Owner whose name is not allowed.
    #[error("the owner {0:?}: a name has 1 to 64 letters, digits, dots, dashes, underscores and @")]
    Owner(String),
    /// Failure of the system to give random numbers.
    #[error("no random numbers for a token: {0}")]
    Random(getrandom::Error),
}

/// Tokens of a file, read again when it changes.
#[derive(Debug, Clone)]
pub struct Tokens {
    path: PathBuf,
    state: Arc<Mutex<State>>,
}

#[derive(Debug)]
struct State {
    looked: Instant,
    changed: SystemTime,
    known: HashMap<[u8; 32], Principal>,
}

impl Tokens {
    /// Reads the tokens of the file at `path`.
    pub fn read(path: &Path) -> Result<Self, TokensError> {
        let (changed, known) = load(path)?;
        let state = State { looked: Instant::now(), changed, known };
        Ok(Self { path: path.to_owned(), state: Arc::new(Mutex::new(state)) })
    }

    /// Sender to whom `token` belongs, if it is one.
    pub fn principal(&self, token: &str) -> Option<Principal> {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        if state.looked.elapsed() > BETWEEN_LOOKS {
            state.looked = Instant::now();
            if modified(&self.path).ok() != Some(state.changed) {
                match load(&self.path) {
                    Ok((changed, known)) => {
                        tracing::info!(tokens = known.len(), "read the file of tokens again");
                        (state.changed, state.known) = (changed, known);
                    }
                    Err(TokensError::File { source, .. }) if source.kind() == ErrorKind::NotFound => {
                        tracing::error!("the file of tokens is gone: nobody has access");
                        state.known.clear();
                        // The file may come back as it was, with the time that it had.
                        state.changed = SystemTime::UNIX_EPOCH;
                    }
                    // The file may be half-written.
                    Err(error) => tracing::error!(%error, "the tokens stay those that were read before"),
                }
            }
        }
        state.known.get(&hash(token)).cloned()
    }
}

/// Makes a token for `owner`, appends its hash to the file at `path`, and returns it: nobody can read it again.
pub fn new_token(path: &Path, owner: &str, scope: Scope) -> Result<String, TokensError> {
    if !is_owner(owner) {
        return Err(TokensError::Owner(owner.to_owned()));
    }
    let mut random = [0; 32];
    getrandom::fill(&mut random).map_err(TokensError::Random)?;
    let token = format!("{PREFIX}{}", BASE64_URL_SAFE_NO_PAD.encode(random));
    let word = scope.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned());
    let line = format!("{} {word} {owner}\n", hexadecimal(&hash(&token)));
    append(path, &line).map_err(|source| TokensError::File { path: path.to_owned(), source })?;
    Ok(token)
}

fn append(path: &Path, line: &str) -> std::io::Result<()> {
    let mut options = std::fs::File::options();
    options.append(true).create(true);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
    // The last line of a file written by hand may have no end.
    let ended = std::fs::read(path).map_or(true, |text| text.last().is_none_or(|last| *last == b'\n'));
    let mut file = options.open(path)?;
    file.write_all(if ended { b"" } else { b"\n" })?;
    file.write_all(line.as_bytes())?;
    file.sync_all()
}

fn load(path: &Path) -> Result<(SystemTime, HashMap<[u8; 32], Principal>), TokensError> {
    let failed = |source| TokensError::File { path: path.to_owned(), source };
    // Taken before the text: what is written in between is read again.
    let changed = modified(path).map_err(failed)?;
    let text = std::fs::read_to_string(path).map_err(failed)?;
    let mut known = HashMap::new();
    for (index, line) in text.lines().enumerate() {
        let line = line.split('#').next().unwrap_or_default().trim();
        if line.is_empty() {
            continue;
        }
        let (hash, principal) =
            read_line(line).ok_or(TokensError::Line { path: path.to_owned(), line: index + 1 })?;
        known.insert(hash, principal);
    }
    Ok((changed, known))
}

fn read_line(line: &str) -> Option<([u8; 32], Principal)> {
    let mut words = line.split_whitespace();
    let (hash, scope, owner) = (words.next()?, words.next()?, words.next()?);
    let scope = Scope::from_str(scope, false).ok()?;
    if words.next().is_some() || !is_owner(owner) || hash.len() != 64 || !hash.is_ascii() {
        return None;
    }
    let mut bytes = [0; 32];
    for (byte, digits) in bytes.iter_mut().zip(hash.as_bytes().chunks(2)) {
        *byte = u8::from_str_radix(std::str::from_utf8(digits).ok()?, 16).ok()?;
    }
    Some((bytes, Principal { owner: owner.to_owned(), scope }))
}

fn is_owner(name: &str) -> bool {
    let allowed = |c: char| c.is_ascii_alphanumeric() || ".-_@".contains(c);
    (1..=LONGEST_OWNER).contains(&name.len()) && name.chars().all(allowed)
}

fn modified(path: &Path) -> std::io::Result<SystemTime> {
    path.metadata()?.modified()
}

fn hash(token: &str) -> [u8; 32] {
    Sha256::digest(token).into()
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_token_is_known_by_its_hash_alone() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("tokens");
        let alice = new_token(&path, "alice", Scope::Write).unwrap();
        let admin = new_token(&path, "ops@plant-1", Scope::Admin).unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(!text.contains(&alice) && !text.contains(alice.trim_start_matches(PREFIX)), "{text}");
        let tokens = Tokens::read(&path).unwrap();
        let of = |token: &str| tokens.principal(token);
        assert_eq!(of(&alice), Some(Principal { owner: "alice".to_owned(), scope: Scope::Write }));
        assert!(of(&admin).unwrap().sees("alice") && !of(&alice).unwrap().sees("ops@plant-1"));
        for wrong in ["", PREFIX, "rubmap_x", &alice[1..], &format!("{alice} ")] {
            assert_eq!(of(wrong), None, "{wrong:?}");
        }
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            assert_eq!(path.metadata().unwrap().permissions().mode() & 0o777, 0o600);
        }
    }

    #[test]
    fn a_token_taken_out_of_the_file_is_none_any_more() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("tokens");
        let token = new_token(&path, "alice", Scope::Read).unwrap();
        let tokens = Tokens::read(&path).unwrap();
        assert!(tokens.principal(&token).is_some());
        let look_again = || {
            let mut state = tokens.state.lock().unwrap();
            state.looked = Instant::now() - 2 * BETWEEN_LOOKS;
            state.changed = SystemTime::UNIX_EPOCH;
        };
        std::fs::write(&path, "half a li").unwrap();
        look_again();
        assert!(tokens.principal(&token).is_some(), "a file that does not read changes nothing");
        std::fs::write(&path, "# nobody\n").unwrap();
        look_again();
        assert!(tokens.principal(&token).is_none());
        std::fs::write(&path, "# no end").unwrap();
        let token = new_token(&path, "alice", Scope::Read).unwrap();
        look_again();
        assert!(tokens.principal(&token).is_some());
        std::fs::remove_file(&path).unwrap();
        look_again();
        assert!(tokens.principal(&token).is_none(), "without the file nobody has access");
    }

    #[test]
    fn a_file_that_was_away_and_comes_back_as_it_was_is_read_again() {
        let folder = tempfile::tempdir().unwrap();
        let [path, away] = ["tokens", "away"].map(|name| folder.path().join(name));
        let token = new_token(&path, "alice", Scope::Read).unwrap();
        let tokens = Tokens::read(&path).unwrap();
        let look_again = || tokens.state.lock().unwrap().looked = Instant::now() - 2 * BETWEEN_LOOKS;
        std::fs::rename(&path, &away).unwrap();
        look_again();
        assert!(tokens.principal(&token).is_none());
        std::fs::rename(&away, &path).unwrap();
        look_again();
        assert!(tokens.principal(&token).is_some());
    }

    #[test]
    fn a_bad_line_is_refused_with_its_number() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("tokens");
        let hash = "0".repeat(64);
        for bad in [
            "alice".to_owned(),
            format!("{hash} user alice"),
            format!("{hash} read"),
            format!("{hash} read a b"),
            format!("{hash} read a/b"),
            format!("{} read alice", "0".repeat(63)),
            format!("{} read alice", "g".repeat(64)),
            format!("{} read alice", "é".repeat(32)),
        ] {
            std::fs::write(&path, format!("# tokens\n\n{bad}\n")).unwrap();
            assert!(matches!(Tokens::read(&path), Err(TokensError::Line { line: 3, .. })), "{bad}");
        }
        assert!(matches!(new_token(&path, "a b", Scope::Read), Err(TokensError::Owner(_))));
        assert!(matches!(Tokens::read(&folder.path().join("none")), Err(TokensError::File { .. })));
    }
}
