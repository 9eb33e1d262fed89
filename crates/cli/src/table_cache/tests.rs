use super::*;
use crate::args::ConsoleArguments;

const KEY: &[u8] = b"a key";
const CONTENT: &[u8] = b"what it stands for";

fn console() -> Console {
    Console::new(&ConsoleArguments { quiet: true, verbose: false })
}

fn read(bytes: &[u8], key: &[u8]) -> Option<Vec<u8>> {
    decoded(&mut &bytes[..], bytes.len() as u64, key)
}

#[test]
fn what_is_stored_is_found_by_its_key_alone() {
    let (folder, console) = (tempfile::tempdir().unwrap(), console());
    let below = folder.path().join("a/b");
    let cache = TableCache::new(Some(&below), &console);
    assert_eq!(cache.load(KEY), None);
    cache.store(KEY, CONTENT);
    cache.store(b"another", b"");
    assert_eq!(cache.load(KEY).as_deref(), Some(CONTENT));
    assert_eq!(cache.load(b"another").as_deref(), Some(b"".as_slice()));
    assert_eq!(cache.load(b"a third"), None);
    let again = TableCache::new(Some(&below), &console);
    assert_eq!(again.load(KEY).as_deref(), Some(CONTENT));
    assert_eq!(TableCache::new(Some(Path::new(NONE)), &console).load(KEY), None);
}

#[test]
fn a_file_of_another_key_is_a_miss_and_is_replaced() {
    let (folder, console) = (tempfile::tempdir().unwrap(), console());
    let cache = TableCache::new(Some(folder.path()), &console);
    cache.store(b"b key", b"another content");
    fs::rename(path_of(folder.path(), b"b key"), path_of(folder.path(), KEY)).unwrap();
    assert_eq!(cache.load(KEY), None);
    cache.store(KEY, CONTENT);
    assert_eq!(cache.load(KEY).as_deref(), Some(CONTENT));
}

#[test]
fn a_file_with_any_bit_turned_or_any_byte_missing_or_too_many_is_a_miss() {
    let whole = encoded(KEY, CONTENT);
    assert_eq!(read(&whole, KEY).as_deref(), Some(CONTENT));
    for at in 0..whole.len() {
        assert_eq!(read(&whole[..at], KEY), None, "{at} bytes");
        for bit in 0..8 {
            let mut bytes = whole.clone();
            bytes[at] ^= 1 << bit;
            assert_eq!(read(&bytes, KEY), None, "bit {bit} of byte {at}");
        }
    }
    assert_eq!(read(&[whole.as_slice(), b"."].concat(), KEY), None);
    // Cut off while it is read.
    assert_eq!(decoded(&mut &whole[..whole.len() - 1], whole.len() as u64, KEY), None);
}

#[test]
fn a_file_that_claims_to_be_huge_is_a_miss() {
    let frame = (KEY.len() + HEAD_BYTES + CHECKSUM_BYTES) as u64;
    for content_bytes in [u64::MAX, u64::MAX - frame, 1 << 40] {
        let mut bytes = encoded(KEY, CONTENT);
        bytes[16..24].copy_from_slice(&content_bytes.to_le_bytes());
        assert_eq!(read(&bytes, KEY), None);
        // A sparse one, as long as it says.
        assert_eq!(decoded(&mut bytes.as_slice(), content_bytes.wrapping_add(frame), KEY), None);
    }
}

#[test]
fn what_is_no_file_is_a_miss() {
    let (folder, console) = (tempfile::tempdir().unwrap(), console());
    fs::create_dir(path_of(folder.path(), KEY)).unwrap();
    let cache = TableCache::new(Some(folder.path()), &console);
    assert_eq!(cache.load(KEY), None);
    cache.store(KEY, CONTENT);
    assert_eq!(cache.load(KEY), None);
}

#[test]
fn a_folder_that_cannot_be_made_is_tried_once() {
    let (folder, console) = (tempfile::tempdir().unwrap(), console());
    let file = folder.path().join("file");
    fs::write(&file, "").unwrap();
    let cache = TableCache::new(Some(&file.join("below")), &console);
    cache.store(KEY, CONTENT);
    assert!(cache.has_failed.get());
    fs::remove_file(&file).unwrap();
    cache.store(KEY, CONTENT);
    assert!(!file.exists());
    assert_eq!(cache.load(KEY), None);
}

#[test]
fn the_files_that_were_not_used_for_the_longest_make_room_and_no_others() {
    let (folder, console) = (tempfile::tempdir().unwrap(), console());
    let cache = TableCache::new(Some(folder.path()), &console);
    let keys: [&[u8]; 4] = [b"a", b"b", b"c", b"d"];
    let foreign = ["notes.table", "0123456789abcdef0123456789abcdef.txt"].map(|name| folder.path().join(name));
    foreign.iter().for_each(|path| fs::write(path, [7; 1000]).unwrap());
    let age = |path: &Path, days: u32| {
        File::open(path).unwrap().set_modified(SystemTime::now() - days * USE_PRECISION).unwrap();
    };
    for (key, days) in keys.into_iter().zip([2, 9, 7, 3]) {
        cache.store(key, CONTENT);
        age(&path_of(folder.path(), key), days);
    }
    foreign.iter().for_each(|path| age(path, 20));
    // The oldest is in use.
    assert!(cache.load(b"b").is_some());
    let left = || keys.map(|key| path_of(folder.path(), key).exists());
    let bytes = encoded(keys[0], CONTENT).len() as u64;
    make_room(folder.path(), 4 * bytes);
    assert_eq!(left(), [true; 4]);
    make_room(folder.path(), 2 * bytes + 1);
    assert_eq!(left(), [true, true, false, false]);
    assert!(foreign.iter().all(|path| path.exists()));
}

#[test]
fn the_default_folder_is_the_user_s_cache() {
    let folder = |cache_home: Option<&str>, home: Option<&str>| {
        default_folder(cache_home.map(OsString::from), home.map(OsString::from))
    };
    let expected = |path: &str| Some(PathBuf::from(path));
    assert_eq!(folder(Some("/c"), Some("/h")), expected("/c/planish/tables"));
    assert_eq!(folder(None, Some("/h")), expected("/h/.cache/planish/tables"));
    assert_eq!(folder(Some(""), Some("/h")), expected("/h/.cache/planish/tables"));
    assert_eq!(folder(Some("c"), None), None);
    assert_eq!(folder(None, Some("")), None);
}
