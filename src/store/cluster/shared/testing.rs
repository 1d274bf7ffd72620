//! PostgreSQL server for the tests of one process.

use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::LazyLock;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};

use sqlx::{AnyConnection, AssertSqlSafe, Connection, Executor};

/// Longest time until the server takes connections.
const START: Duration = Duration::from_secs(60);

/// Script that makes a server in a folder, from its binaries and that folder, and runs it for as long as somebody holds the other end of
/// its input: tests end without notice. Its default collation sorts texts as people do; texts of the store must not be sorted so.
const SCRIPT: &str = r#"
"$1/initdb" -D "$2/data" -U rubmap -A trust -E UTF8 --locale=C.UTF-8 --locale-provider=icu --icu-locale=en --no-sync || exit
"$1/postgres" -D "$2/data" -k "$2" -c listen_addresses= -c fsync=off -c max_connections=200 &
cat > /dev/null
kill -INT $!
wait $!
rm -rf "$2"
"#;

/// Server that listens at a socket in its folder.
struct Server {
    folder: PathBuf,
    /// Input of the script: closing it stops the server.
    _input: ChildStdin,
}

static SERVER: LazyLock<Option<Server>> = LazyLock::new(|| {
    let started = start();
    if let Err(reason) = &started {
        eprintln!("skipped on PostgreSQL: {reason}");
    }
    started.ok()
});

/// Address of a new database, if there is a server.
pub(in crate::store) async fn database() -> Option<String> {
    static DATABASES: AtomicU32 = AtomicU32::new(0);
    let server = SERVER.as_ref()?;
    let address = |name: &str| format!("postgres:///{name}?user=rubmap&host={}", server.folder.display());
    let name = format!("test_{}", DATABASES.fetch_add(1, Ordering::Relaxed));
    sqlx::any::install_default_drivers();
    let mut connection = AnyConnection::connect(&address("postgres")).await.unwrap();
    connection.execute(AssertSqlSafe(format!("create database {name}"))).await.unwrap();
    connection.close().await.unwrap();
    Some(address(&name))
}

fn start() -> Result<Server, String> {
    let binaries = binaries().ok_or("it is not installed")?;
    let folder =
        tempfile::Builder::new().prefix("rubmap-postgres-").tempdir().map_err(|error| error.to_string())?;
    let mut command = as_its_user(folder.path())?;
    let log = std::fs::File::create(folder.path().join("log")).map_err(|error| error.to_string())?;
    let errors = log.try_clone().map_err(|error| error.to_string())?;
    let mut script = command
        .args(["sh", "-c", SCRIPT, "sh"])
        .args([&binaries, folder.path()])
        .stdin(Stdio::piped())
        .stdout(log)
        .stderr(errors)
        // A signal from the terminal to the tests must not stop the server before it has cleaned up.
        .process_group(0)
        .spawn()
        .map_err(|error| error.to_string())?;
    wait_for(&mut script, folder.path())?;
    let input = script.stdin.take().ok_or("it has no input")?;
    Ok(Server { folder: folder.keep(), _input: input })
}

/// Folder of the PostgreSQL binaries.
fn binaries() -> Option<PathBuf> {
    let mut folders: Vec<PathBuf> = std::env::split_paths(&std::env::var_os("PATH")?).collect();
    if let Ok(versions) = std::fs::read_dir("/usr/lib/postgresql") {
        folders.extend(versions.filter_map(|version| Some(version.ok()?.path().join("bin"))));
    }
    folders.into_iter().find(|folder| folder.join("initdb").exists() && folder.join("postgres").exists())
}

/// Command prefix that runs a command as a user who may run the server, as root may not; that user then owns `folder`.
fn as_its_user(folder: &Path) -> Result<Command, String> {
    const USER: &str = "postgres";
    if !rustix::process::getuid().is_root() {
        return Ok(Command::new("env"));
    }
    let owned = Command::new("chown").arg(USER).arg(folder).status().map_err(|error| error.to_string())?;
    if !owned.success() {
        return Err(format!("root cannot run it, and there is no user {USER}"));
    }
    let mut command = Command::new("runuser");
    command.args(["-u", USER, "--"]);
    Ok(command)
}

/// Waits until the server in `folder` takes connections.
fn wait_for(script: &mut Child, folder: &Path) -> Result<(), String> {
    let begin = Instant::now();
    loop {
        let log = std::fs::read_to_string(folder.join("log")).unwrap_or_default();
        if log.contains("ready to accept connections") {
            return Ok(());
        }
        let has_ended = script.try_wait().map_err(|error| error.to_string())?.is_some();
        if has_ended || begin.elapsed() > START {
            return Err(format!("it does not start: {log}"));
        }
        std::thread::sleep(Duration::from_millis(50));
    }
}
