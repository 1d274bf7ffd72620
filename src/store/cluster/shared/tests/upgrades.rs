//! Tests of the upgrade of tables on a PostgreSQL server.

use sqlx::{AnyConnection, AssertSqlSafe, Connection, Executor};

use crate::store::cluster::testing::database;
use crate::store::jobs::JobId;
use crate::store::postgres::migrate;
use crate::store::{ACCOUNTS, Store, StoreError};

/// Lines of [`ACCOUNTS`] for the owner to run, for one account.
fn grants(account: &str) -> String {
    let lines: Vec<&str> = ACCOUNTS.lines().filter(|line| line.starts_with("  ")).collect();
    assert_eq!(lines.len(), 4);
    lines.join("\n").replace("SERVICE", account)
}

#[tokio::test]
async fn a_service_needs_no_right_to_change_tables_that_are_up_to_date() {
    let Some(owner) = database().await else { return };
    let mut connection = AnyConnection::connect(&owner).await.unwrap();
    let account = format!("service_{}", uuid::Uuid::now_v7().simple());
    connection.execute(AssertSqlSafe(format!("create role {account} login"))).await.unwrap();
    let service = owner.replace("user=rubmap", &format!("user={account}"));
    assert_ne!(service, owner);
    let folder = tempfile::tempdir().unwrap();
    let open = async || Store::connect(folder.path(), &service).await;

    // Without tables, nothing may be read.
    assert!(matches!(open().await, Err(StoreError::NotUpToDate(_))));
    let upgrades = migrate(&owner).await.unwrap();
    assert!(upgrades.len() == 2 && upgrades.iter().all(|upgrade| upgrade.steps > 0), "{upgrades:?}");
    assert!(matches!(open().await, Err(StoreError::NotUpToDate(_))));

    connection.execute(AssertSqlSafe(grants(&account))).await.unwrap();
    let upgrades = migrate(&owner).await.unwrap();
    assert!(upgrades.iter().all(|upgrade| upgrade.steps == 0), "{upgrades:?}");
    let store = open().await.unwrap();
    store.probe().await.unwrap();
    let queue = store.shared_queue().unwrap();
    queue.push_preparation(JobId::new(), None).await.unwrap();
    queue.tidy().await.unwrap();
    assert!(queue.claim("anything").await.unwrap().is_some());

    // A migration is missing, which the account may not run; the owner runs it.
    connection
        .execute("delete from _sqlx_migrations where version = (select max(version) from _sqlx_migrations)")
        .await
        .unwrap();
    assert!(matches!(open().await, Err(StoreError::NotUpToDate(_))));
}

#[tokio::test]
async fn tables_of_a_later_program_are_left_alone() {
    let Some(url) = database().await else { return };
    let known = migrate(&url).await.unwrap();
    let mut connection = AnyConnection::connect(&url).await.unwrap();
    for (history, part) in [("_sqlx_migrations", &known[0]), ("apalis._sqlx_migrations", &known[1])] {
        let later = format!(
            "insert into {history} (version, description, success, checksum, execution_time)
             values (99999999999999, 'later', true, '', 0)"
        );
        connection.execute(AssertSqlSafe(later)).await.unwrap();
        let refused = migrate(&url).await.unwrap_err();
        let StoreError::NewerTables { part: whose, found, known } = refused else { panic!("{refused}") };
        assert_eq!((whose, found, known), (part.part, 99_999_999_999_999, part.version));
        connection
            .execute(AssertSqlSafe(format!("delete from {history} where version = {found}")))
            .await
            .unwrap();
    }
}
