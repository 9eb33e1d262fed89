//! The file as it is packed: JSON alone, or JSON and a block of bytes in a GLB (glTF 2.0, sections 2 and 4).
use std::collections::BTreeMap;

use ::gltf::json::Root;
use serde::de::IgnoredAny;

use super::fault::Fault;

/// What a GLB begins with.
const MAGIC: &[u8] = b"glTF";
/// Bytes of a GLB's header, and of a chunk's.
const HEADER: usize = 12;
const CHUNK_HEADER: usize = 8;
/// The byte order mark with which some editors begin UTF-8 files.
const BYTE_ORDER_MARK: &[u8] = b"\xEF\xBB\xBF";

/// The description, and the bytes that a GLB has beside it.
pub fn parse(bytes: &[u8]) -> Result<(Root, Option<&[u8]>), Fault> {
    let (json, blob) = if bytes.starts_with(MAGIC) { split(bytes)? } else { (bytes, None) };
    let json = json.strip_prefix(BYTE_ORDER_MARK).unwrap_or(json);
    let root: Root = serde_json::from_slice(json)
        .map_err(|error| if is_version_1(json) { of_version_1() } else { malformed(&error) })?;
    check_version(&root)?;
    Ok((root, blob))
}

/// The JSON chunk of a GLB, and its binary chunk if it has one. Chunks of other types are ignored, as the format asks.
fn split(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), Fault> {
    let refuse = |found: String, expected: &str| Err(Fault::new("GLB header", found, expected));
    let (Some(version), Some(length)) = (word(bytes, 4), word(bytes, 8)) else {
        return refuse(format!("{} bytes", bytes.len()), "a header of 12");
    };
    if version != 2 {
        return refuse(format!("version {version}"), "2");
    }
    let Some(mut rest) = bytes.get(HEADER..length) else {
        return refuse(format!("a length of {length}"), &format!("12 to {}, the file's size", bytes.len()));
    };
    let mut chunks: [Option<&[u8]>; 2] = [None; 2];
    let mut number = 0;
    while let (Some(length), Some(kind)) = (word(rest, 0), rest.get(4..CHUNK_HEADER)) {
        let Some(content) = rest.get(CHUNK_HEADER..CHUNK_HEADER.saturating_add(length)) else {
            let left = rest.len() - CHUNK_HEADER;
            return Err(Fault::new(
                format!("chunk {number}"),
                format!("a length of {length}"),
                format!("at most {left}"),
            ));
        };
        match kind {
            b"JSON" if number == 0 => chunks[0] = Some(content),
            b"BIN\0" if number == 1 => chunks[1] = Some(content),
            _ => {}
        }
        // Chunks begin at multiples of 4; their lengths should be ones, too.
        rest = rest.get(CHUNK_HEADER + length..).unwrap_or_default();
        number += 1;
    }
    match chunks {
        [Some(json), blob] => Ok((json, blob)),
        _ => Err(Fault::new("chunk 0", "no JSON", "a chunk of type JSON")),
    }
}

/// A little-endian word.
fn word(bytes: &[u8], at: usize) -> Option<usize> {
    let word = bytes.get(at..at.checked_add(4)?)?.try_into().ok()?;
    usize::try_from(u32::from_le_bytes(word)).ok()
}

fn check_version(root: &Root) -> Result<(), Fault> {
    let asset = &root.asset;
    if !asset.version.starts_with("2.") {
        return Err(Fault::new("asset.version", format!("`{}`", asset.version), "2.0"));
    }
    match asset.min_version.as_deref() {
        None | Some("2.0") => Ok(()),
        Some(version) => Err(Fault::new("asset.minVersion", format!("`{version}`"), "2.0")),
    }
}

/// Whether it is glTF 1.0, whose accessors are named and not numbered.
fn is_version_1(json: &[u8]) -> bool {
    #[derive(serde::Deserialize)]
    struct Named {
        #[expect(dead_code, reason = "that it can be read is what is asked")]
        accessors: BTreeMap<String, IgnoredAny>,
    }
    serde_json::from_slice::<Named>(json).is_ok()
}

fn of_version_1() -> Fault {
    Fault::new("asset.version", "glTF 1.0", "glTF 2.0")
}

/// serde_json's words in ours: place, found, expected.
fn malformed(error: &serde_json::Error) -> Fault {
    let place = format!("line {}, column {}", error.line(), error.column());
    let message = error.to_string();
    let message = message.rsplit_once(" at line ").map_or(message.as_str(), |(message, _)| message);
    let message =
        ["invalid type: ", "invalid value: "].iter().find_map(|kind| message.strip_prefix(kind)).unwrap_or(message);
    match message.split_once(", expected ") {
        Some((found, expected)) => Fault::new(place, found, crate::error::shown(expected)),
        None => Fault::new(place, message, "glTF 2.0"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn glb(chunks: &[(&[u8; 4], &[u8])]) -> Vec<u8> {
        let mut body = Vec::new();
        for (kind, content) in chunks {
            body.extend((content.len() as u32).to_le_bytes());
            body.extend_from_slice(*kind);
            body.extend_from_slice(content);
        }
        let header = [2, (HEADER + body.len()) as u32].map(u32::to_le_bytes).concat();
        [MAGIC, &header, &body].concat()
    }

    const JSON: &[u8] = br#"{"asset":{"version":"2.0"}} "#;

    #[test]
    fn chunks_of_unknown_types_are_passed_over() {
        let bytes = glb(&[(b"JSON", JSON), (b"BIN\0", b"data"), (b"MORE", b"....")]);
        assert_eq!(parse(&bytes).unwrap().1, Some(b"data".as_slice()));
        let bytes = glb(&[(b"MORE", JSON)]);
        assert_eq!(parse(&bytes).unwrap_err().place, "chunk 0");
    }

    #[test]
    fn lengths_beyond_the_file_are_refused() {
        for length in [0u32, 11, 1000, u32::MAX] {
            let mut bytes = glb(&[(b"JSON", JSON)]);
            bytes[8..12].copy_from_slice(&length.to_le_bytes());
            assert_eq!(parse(&bytes).unwrap_err().place, "GLB header", "{length}");
            let mut bytes = glb(&[(b"JSON", JSON)]);
            bytes[12..16].copy_from_slice(&length.max(1000).to_le_bytes());
            assert_eq!(parse(&bytes).unwrap_err().place, "chunk 0", "{length}");
        }
    }

    #[test]
    fn other_versions_are_refused() {
        let place = |json: &str| parse(json.as_bytes()).unwrap_err().place;
        assert_eq!(place(r#"{"asset":{"version":"1.0"}}"#), "asset.version");
        assert_eq!(place(r#"{"asset":{"version":"2.0","minVersion":"2.1"}}"#), "asset.minVersion");
        assert_eq!(place("{\"asset\":\n7}"), "line 2, column 1");
    }

    #[test]
    fn the_first_version_of_the_format_is_refused_by_its_name() {
        let fault = parse(br#"{ "accessors": { "a": { "count": 3 } }, "asset": { "version": "1.0" } }"#).unwrap_err();
        assert_eq!((fault.found.as_str(), fault.expected.as_str()), ("glTF 1.0", "glTF 2.0"));
    }
}
