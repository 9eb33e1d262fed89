//! The displacement map that a mesh asks for. It is read once its mesh is known, by whoever draws it.
use std::path::Path;

use super::Fault;
use super::text::{DisplacementText, KindText, LayoutText};
use crate::displacement::{DisplacementKind, DisplacementLayout, DisplacementRequest};
use crate::obj::quoted;

/// The map that an element of the scene file at `scene` describes.
pub fn request(scene: &Path, text: &DisplacementText) -> Result<DisplacementRequest, Fault> {
    // A control character would break the line of a message that names the file.
    if text.file.is_empty() || text.file.contains(char::is_control) {
        return Err(Fault::new("displacement.file", quoted(text.file.as_bytes()), "the path of an image"));
    }
    let mut request = DisplacementRequest::new(scene.with_file_name(&text.file));
    // JSON has no numbers that are not finite.
    request.scale = text.scale.unwrap_or(request.scale);
    request.midpoint = text.midpoint.unwrap_or(request.midpoint);
    request.kind = match text.kind {
        None | Some(KindText::Scalar) => DisplacementKind::Scalar,
        Some(KindText::Vector) => DisplacementKind::Vector,
    };
    request.layout = match text.layout {
        None | Some(LayoutText::Uv) => DisplacementLayout::Uv,
        Some(LayoutText::Faces) => DisplacementLayout::Faces,
    };
    Ok(request)
}
