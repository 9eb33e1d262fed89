//! What the header of a dump says: how many vertices there are, and where in each of them a property lies.

/// Bytes of a header at most; that of a dump has a few hundred.
pub(crate) const MAX_HEADER_BYTES: u64 = 1 << 16;

/// The floats of a vertex, in the order of [`crate::DumpVertex`]'s fields.
pub(crate) const FLOATS: [&str; 16] =
    ["x", "y", "z", "nx", "ny", "nz", "u", "v", "s", "t", "sx", "sy", "sz", "r", "g", "b"];
/// So many of them all dumps have.
const REQUIRED_FLOATS: usize = 8;
/// What the triangles are, by either name that PLY files use.
const INDEX_LISTS: [&str; 2] = ["list uchar int vertex_indices", "list uchar int vertex_index"];

/// Where the properties of a vertex lie, in bytes from its beginning.
#[derive(Debug, PartialEq)]
pub(crate) struct Layout {
    /// Those of [`FLOATS`].
    pub floats: [Option<usize>; FLOATS.len()],
    /// `face`
    pub face: usize,
    /// `level`
    pub level: usize,
    /// `kind`
    pub kind: usize,
    /// Bytes of a vertex.
    pub stride: usize,
}

/// A header that describes a dump.
#[derive(Debug, PartialEq)]
pub(crate) struct Header {
    /// Vertices announced, three a triangle.
    pub vertex_count: u64,
    pub layout: Layout,
}

/// What is there, and what a dump has there.
pub(crate) type Fault = (String, String);

pub(crate) fn fault(found: impl Into<String>, expected: impl Into<String>) -> Fault {
    (found.into(), expected.into())
}

/// Reads the lines between `ply` and `end_header`, both left out. Properties may come in any order, and with others that
/// are passed over.
pub(crate) fn parse(lines: &[String]) -> Result<Header, Fault> {
    let mut lines =
        lines.iter().map(String::as_str).filter(|line| !line.starts_with("comment") && !line.starts_with("obj_info"));
    let format = lines.next().unwrap_or_default();
    if format != "format binary_little_endian 1.0" {
        return Err(fault(format!("{format:?}"), "format binary_little_endian 1.0"));
    }
    let vertex_count = element_count(lines.next(), "vertex")?;
    let mut properties = Vec::new();
    let mut next = lines.next();
    while let Some(property) = next.and_then(|line| line.strip_prefix("property ")) {
        properties.push(property);
        next = lines.next();
    }
    let triangle_count = element_count(next, "face")?;
    if vertex_count != triangle_count.saturating_mul(3) {
        let found = format!("{vertex_count} vertices and {triangle_count} triangles");
        return Err(fault(found, "three vertices a triangle"));
    }
    let list = lines.next().unwrap_or_default();
    if !list.strip_prefix("property ").is_some_and(|list| INDEX_LISTS.contains(&list)) {
        return Err(fault(format!("{list:?}"), format!("property {}", INDEX_LISTS[0])));
    }
    if let Some(more) = lines.next() {
        return Err(fault(format!("{more:?}"), "end_header"));
    }
    Ok(Header { vertex_count, layout: layout(&properties)? })
}

fn element_count(line: Option<&str>, name: &str) -> Result<u64, Fault> {
    let line = line.unwrap_or("end_header");
    let count = line.strip_prefix("element ").and_then(|line| line.strip_prefix(name)).map(str::trim);
    count
        .and_then(|count| count.parse().ok())
        .ok_or_else(|| fault(format!("{line:?}"), format!("element {name} and a count")))
}

fn layout(properties: &[&str]) -> Result<Layout, Fault> {
    let (mut floats, mut ints) = ([None; FLOATS.len()], [None; 3]);
    let mut stride = 0;
    for property in properties {
        let unknown = || fault(format!("property {property}"), "a scalar property");
        let (kind, name) = property.split_once(' ').ok_or_else(unknown)?;
        let size = scalar_bytes(kind).ok_or_else(unknown)?;
        let (place, expected) = match (FLOATS.iter().position(|&float| float == name), name) {
            (Some(index), _) => (Some(&mut floats[index]), "float"),
            (None, "face") => (Some(&mut ints[0]), "int"),
            (None, "level") => (Some(&mut ints[1]), "uchar"),
            (None, "kind") => (Some(&mut ints[2]), "uchar"),
            _ => (None, kind),
        };
        if canonical(kind) != canonical(expected) {
            return Err(fault(format!("property {property}"), format!("property {expected} {name}")));
        }
        if place.is_some_and(|place| place.replace(stride).is_some()) {
            return Err(fault(format!("property {name} twice"), "it once"));
        }
        stride += size;
    }
    let missing = |name: &str| fault(format!("vertices without {name}"), "x y z nx ny nz u v face level kind");
    if let Some(index) = floats[..REQUIRED_FLOATS].iter().position(Option::is_none) {
        return Err(missing(FLOATS[index]));
    }
    let [face, level, kind] = ints;
    Ok(Layout {
        floats,
        face: face.ok_or_else(|| missing("face"))?,
        level: level.ok_or_else(|| missing("level"))?,
        kind: kind.ok_or_else(|| missing("kind"))?,
        stride,
    })
}

/// The name that a type has in dumps, of the two that PLY has for each.
fn canonical(kind: &str) -> &str {
    match kind {
        "float32" => "float",
        "int32" => "int",
        "uint8" => "uchar",
        other => other,
    }
}

fn scalar_bytes(kind: &str) -> Option<usize> {
    match kind {
        "char" | "uchar" | "int8" | "uint8" => Some(1),
        "short" | "ushort" | "int16" | "uint16" => Some(2),
        "int" | "uint" | "float" | "int32" | "uint32" | "float32" => Some(4),
        "double" | "float64" => Some(8),
        _ => None,
    }
}
