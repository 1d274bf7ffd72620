//! Tests of connections to a PostgreSQL server.

use crate::store::StoreError;
use crate::store::dialect::Dialect;
use crate::store::testing::stores;

#[tokio::test]
async fn connections_that_are_lost_are_replaced_and_what_hangs_is_cut_off() {
    for store in stores().await.iter().filter(|store| store.dialect == Dialect::Postgres) {
        let settings =
            "select current_setting('lock_timeout'), current_setting('idle_in_transaction_session_timeout')";
        let found: (String, String) = sqlx::query_as(settings).fetch_one(&store.readers).await.unwrap();
        assert_eq!(found, ("5s".to_owned(), "30s".to_owned()));

        let waits = store.readers.acquire().await.unwrap();
        let mut writes = store.write().await.unwrap();
        let others = "select pg_terminate_backend(pid, 1000) from pg_stat_activity
             where datname = current_database() and pid <> pg_backend_pid()";
        sqlx::query(others).fetch_all(&store.readers).await.unwrap();
        let lost = sqlx::query("select 1").execute(&mut *writes).await.unwrap_err();
        assert!(StoreError::from(lost).may_pass());
        drop((waits, writes));
        store.probe().await.unwrap();

        // A permanent refusal stays one.
        let twice = "insert into readiness (id, mark) values (1, '')";
        let refused = sqlx::query(twice).execute(&store.writer).await.unwrap_err();
        assert!(!StoreError::from(refused).may_pass());
    }
}
