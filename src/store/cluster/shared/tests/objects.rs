//! Tests of objects in a shared folder and in a bucket.

#[path = "../../../../../tests/cluster/s3.rs"]
mod s3;

use std::io::ErrorKind;
use std::path::Path;

use object_store::aws::AmazonS3Builder;
use tempfile::TempDir;

use self::s3::S3;
use crate::store::StoreError;
use crate::store::cluster::address::Address;
use crate::store::cluster::remote::{Remote, connect_bucket};
use crate::store::objects::Objects;
use crate::store::reserve::Reserve;

const KEY: &str = "AKIAOFTHETESTS";
const SECRET: &str = "the-secret-of-the-tests";

fn bucket(name: &str) -> Address {
    Address::Bucket { bucket: name.to_owned(), prefix: "a/b".to_owned() }
}

/// Opens the object store at `address` for the data folder `data`, without the environment, which all tests share.
async fn open(s3: &S3, address: &Address, data: &Path) -> std::io::Result<Objects> {
    let Address::Bucket { bucket, prefix } = address else { panic!("{address} is no bucket") };
    let settings = AmazonS3Builder::new()
        .with_endpoint(s3.endpoint())
        .with_allow_http(true)
        .with_access_key_id(KEY)
        .with_secret_access_key(SECRET);
    let store = connect_bucket(settings, bucket, prefix).map_err(|failure| failure.of(address, None))?;
    Ok(Objects::over(Remote::over(address, store).await?, data, Reserve::of(data)))
}

/// Object stores in a folder, and in a bucket where moto is installed, each with two data folders.
async fn pairs(s3: Option<&S3>, folder: &Path) -> Vec<[(TempDir, Objects); 2]> {
    let data = || tempfile::tempdir().unwrap();
    let shared = async || {
        let data = data();
        let address = Address::Folder(folder.to_owned());
        let objects = Objects::open(&address, data.path(), Reserve::of(data.path())).await.unwrap();
        (data, objects)
    };
    let mut pairs = vec![[shared().await, shared().await]];
    if let Some(s3) = s3 {
        let of_bucket = async || {
            let data = data();
            let objects = open(s3, &bucket(S3::BUCKET), data.path()).await.unwrap();
            (data, objects)
        };
        pairs.push([of_bucket().await, of_bucket().await]);
    }
    pairs
}

fn write(data: &TempDir, name: &str, content: &[u8]) {
    let path = data.path().join(name);
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    std::fs::write(path, content).unwrap();
}

/// Bytes in which no two parts are alike.
fn noise(bytes: usize) -> Vec<u8> {
    (0..bytes as u64).map(|k| (k.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 56) as u8).collect()
}

#[tokio::test]
async fn what_one_publishes_another_fetches_until_it_is_removed() {
    let folder = tempfile::tempdir().unwrap();
    let s3 = S3::new();
    for [(here, ours), (there, theirs)] in pairs(s3.as_ref(), folder.path()).await {
        // Lengths of nothing, one part, and several parts with a rest.
        for (name, content) in [
            ("models/a.zip", Vec::new()),
            ("bases/m-1/x", noise(1000)),
            ("bases/m-2/x", noise((20 << 20) + 7)),
        ] {
            write(&here, name, &content);
            let (from, to) = (here.path().join(name), there.path().join(name));
            assert!(!theirs.have(&to).await.unwrap());
            assert!(!theirs.fetch(&to, |_| Ok(())).await.unwrap() && !to.exists());
            assert_eq!((theirs.size(&to).await.unwrap(), theirs.sha256(&to).await.unwrap()), (None, None));
            ours.publish(&from).await.unwrap();
            assert!(theirs.have(&to).await.unwrap());
            assert_eq!(theirs.size(&to).await.unwrap(), Some(content.len() as u64));
            let refused = theirs.fetch(&to, |_| Err(ErrorKind::InvalidData.into())).await.unwrap_err();
            assert_eq!(refused.kind(), ErrorKind::InvalidData);
            assert!(!to.exists(), "what is not accepted gets no name");
            assert!(theirs.fetch(&to, |_| Ok(())).await.unwrap());
            assert!(std::fs::read(&to).unwrap() == content, "{name}");
            assert_eq!(theirs.sha256(&to).await.unwrap(), ours.sha256(&from).await.unwrap());
        }
        // Another file takes its place.
        write(&here, "models/a.zip", b"another");
        ours.publish(&here.path().join("models/a.zip")).await.unwrap();
        assert!(theirs.fetch(&there.path().join("models/a.zip"), |_| Ok(())).await.unwrap());
        assert_eq!(std::fs::read(there.path().join("models/a.zip")).unwrap(), b"another");

        ours.remove_folders(&here.path().join("bases"), |name| name == "m-1").await.unwrap();
        assert!(!theirs.have(&there.path().join("bases/m-1/x")).await.unwrap());
        assert!(theirs.have(&there.path().join("bases/m-2/x")).await.unwrap());
        for _ in 0..2 {
            ours.remove(&here.path().join("models/a.zip")).await.unwrap();
        }
        assert!(!theirs.have(&there.path().join("models/a.zip")).await.unwrap());
        let outside = ours.have(Path::new("/elsewhere")).await.unwrap_err();
        assert_eq!(outside.kind(), ErrorKind::InvalidInput);
    }
}

#[tokio::test]
async fn what_is_wrong_is_said_without_secrets() {
    let data = tempfile::tempdir().unwrap();
    let nowhere = Address::Folder(data.path().join("nowhere"));
    let refused = Objects::open(&nowhere, data.path(), Reserve::of(data.path())).await.unwrap_err();
    assert!(refused.to_string().contains("there is no such folder"), "{refused}");
    for (allowed, expected) in [(false, true), (true, false)] {
        let plain = AmazonS3Builder::new().with_endpoint("http://s3.example").with_allow_http(allowed);
        let refused =
            connect_bucket(plain, "wheels", "").err().map(|failure| failure.of(&nowhere, None).to_string());
        assert_eq!(refused.is_some_and(|said| said.contains("AWS_ALLOW_HTTP=true")), expected);
    }
    if let Some(s3) = S3::new() {
        let refused = open(&s3, &bucket("wheel"), data.path()).await.unwrap_err();
        let said = "object store s3://wheel/a/b: there is no such bucket: make it, or correct its name";
        assert_eq!(refused.to_string(), said);
        assert!(!StoreError::may_pass_of(&refused));
    }
    if let Some(s3) = S3::strict() {
        let refused = open(&s3, &bucket(S3::BUCKET), data.path()).await.unwrap_err();
        let said = refused.to_string();
        assert!(said.starts_with("object store s3://wheels/a/b: it refuses access"), "{said}");
        assert!(!said.contains(KEY) && !said.contains(SECRET), "{said}");
        assert!(!StoreError::may_pass_of(&refused));
    }
}

#[tokio::test]
async fn a_store_that_is_away_is_waited_for_by_whoever_asks() {
    let Some(mut s3) = S3::new() else { return };
    let data = tempfile::tempdir().unwrap();
    let objects = open(&s3, &bucket(S3::BUCKET), data.path()).await.unwrap();
    let content = noise(20 << 20);
    write(&data, "bases/m/x", &content);
    let path = data.path().join("bases/m/x");

    // The store goes away while parts are being uploaded.
    s3.freeze();
    let crash = async {
        tokio::time::sleep(std::time::Duration::from_millis(500)).await;
        s3.crash();
    };
    let (sent, ()) = tokio::join!(objects.publish(&path), crash);
    let lost = sent.unwrap_err();
    assert!(StoreError::may_pass_of(&lost), "{lost}");
    let said = format!("{lost} {lost:?}");
    assert!(!said.contains(KEY) && !said.contains(SECRET), "{said}");
    for lost in [objects.have(&path).await.unwrap_err(), objects.fetch(&path, |_| Ok(())).await.unwrap_err()]
    {
        assert!(StoreError::may_pass_of(&lost), "{lost}");
    }
    assert_eq!(std::fs::read(&path).unwrap().len(), content.len());

    s3.start();
    assert!(!objects.have(&path).await.unwrap(), "never a part of a file");
    objects.publish(&path).await.unwrap();
    std::fs::remove_file(&path).unwrap();
    assert!(objects.fetch(&path, |_| Ok(())).await.unwrap());
    assert!(std::fs::read(&path).unwrap() == content);
}
