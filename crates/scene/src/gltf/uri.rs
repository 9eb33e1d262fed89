//! Where buffers and images are: in the URI itself, or in a file beside the scene's.
use std::path::{Path, PathBuf};

use base64::Engine as _;
use base64::engine::DecodePaddingMode;
use base64::engine::general_purpose::{GeneralPurpose, GeneralPurposeConfig};

use super::fault::Fault;

/// Where a URI leads.
#[derive(Debug, PartialEq)]
pub enum Target {
    /// The bytes that it spells out.
    Bytes(Vec<u8>),
    /// A file.
    File(PathBuf),
}

/// Some writers leave the padding out.
const LENIENT: GeneralPurpose = GeneralPurpose::new(
    &base64::alphabet::STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// Follows a URI of the scene file at `scene`. Files are those in the scene's folder and the folders in it: a scene from
/// elsewhere has no business in any other.
pub fn follow(scene: &Path, uri: &str, place: &str) -> Result<Target, Fault> {
    if let Some(data) = uri.strip_prefix("data:") {
        return embedded(data, place).map(Target::Bytes);
    }
    let refuse = |expected: &str| Err(Fault::new(place, format!("`{uri}`"), expected));
    let Some(name) = percent_decoded(uri) else {
        return refuse("a path in UTF-8 with whole %-codes");
    };
    if name.is_empty() || name.contains(|c: char| c.is_control() || c == '\\') {
        return refuse("a path without backslashes and control characters");
    }
    if name.contains(':') {
        return refuse("data: or the path of a file");
    }
    if name.starts_with('/') || name.split('/').any(|part| part == "..") {
        return refuse("a path within the scene's folder");
    }
    Ok(Target::File(scene.with_file_name(name)))
}

/// The bytes of a data URI, without its `data:`.
fn embedded(data: &str, place: &str) -> Result<Vec<u8>, Fault> {
    let Some((kind, text)) = data.split_once(',') else {
        return Err(Fault::new(place, "a data URI without a comma", "data:TYPE;base64,.."));
    };
    if !kind.ends_with(";base64") {
        return Err(Fault::new(place, format!("a data URI of `{kind}`"), "base64"));
    }
    LENIENT.decode(text).map_err(|error| Fault::new(place, format!("a data URI with {error}"), "base64"))
}

/// The text that %-codes stand for; none where they are cut or are no UTF-8.
fn percent_decoded(uri: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let Some((&first, after)) = rest.split_first() {
        rest = after;
        if first != b'%' {
            bytes.push(first);
            continue;
        }
        let digit = |at: usize| char::from(*after.get(at)?).to_digit(16);
        bytes.push((16 * digit(0)? + digit(1)?) as u8);
        rest = &after[2..];
    }
    String::from_utf8(bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(uri: &str) -> Result<Target, String> {
        follow(Path::new("folder/a.gltf"), uri, "p").map_err(|fault| fault.expected)
    }

    #[test]
    fn paths_are_seen_from_the_scenes_folder_and_decoded_once() {
        assert_eq!(of("sub/a%20b.bin"), Ok(Target::File("folder/sub/a b.bin".into())));
        assert_eq!(of("%25%32%46"), Ok(Target::File("folder/%2F".into())));
        assert_eq!(of("a..b"), Ok(Target::File("folder/a..b".into())));
    }

    #[test]
    fn paths_that_leave_the_folder_are_refused_however_they_are_written() {
        for uri in ["../a", "a/../../b", "/etc/passwd", "%2e%2e/a", "%2E%2E%2Fa", "%2Fetc", "..", "a/.."] {
            assert_eq!(of(uri), Err("a path within the scene's folder".to_owned()), "{uri}");
        }
        for uri in ["file:///etc/passwd", "C:/a", "http://a/b", "c%3A/a", "DATA:,"] {
            assert_eq!(of(uri), Err("data: or the path of a file".to_owned()), "{uri}");
        }
        for uri in ["..\\a", "\\\\server\\a", "a%00b", "a%0Ab", ""] {
            assert_eq!(of(uri), Err("a path without backslashes and control characters".to_owned()), "{uri:?}");
        }
        for uri in ["%", "%f", "%ff", "%g0", "a%"] {
            assert_eq!(of(uri), Err("a path in UTF-8 with whole %-codes".to_owned()), "{uri}");
        }
    }

    #[test]
    fn data_uris_are_base64_with_or_without_padding() {
        for text in ["aGk=", "aGk"] {
            assert_eq!(of(&format!("data:application/octet-stream;base64,{text}")), Ok(Target::Bytes(b"hi".to_vec())));
        }
        for uri in ["data:;base64,a", "data:;base64,a b=", "data:text/plain,hi", "data:", "data:;base64"] {
            assert!(of(uri).is_err(), "{uri}");
        }
    }
}
