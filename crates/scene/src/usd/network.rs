//! Networks of shaders (UsdShade): what an input is connected to.
use glam::{DAffine2, DVec2};
use openusd::sdf::{Path, Value};
use openusd::usd;

use super::attributes::Attributes;
use super::guard::Stage;
use super::textures::Textures;
use super::{convert, layers};
use crate::gltf::fault::Fault;
use crate::{TextureRef, Wrap};

/// Connections that one input may follow: networks may go in circles.
const MAX_STEPS: usize = 32;
/// Texture coordinates of readers that name none.
const UV_NAME: &str = "st";

/// Where an input's value comes from.
pub enum Source {
    /// An attribute's own value.
    Value(usd::Attribute),
    /// A shader's output.
    Output(usd::Prim, String),
}

/// Follows an attribute's connections, through the interfaces of materials and node graphs.
pub fn source(stage: &Stage, prim: &usd::Prim, name: &str) -> Result<Source, Fault> {
    let mut attribute = prim.attribute(name);
    for _ in 0..MAX_STEPS {
        let connections = attribute.connections().map_err(|error| failed(attribute.path(), &error))?;
        let Some(target) = connections.first() else { return Ok(Source::Value(attribute)) };
        let path = target.as_str().to_owned();
        let (owner, name) = path.rsplit_once('.').unwrap_or((&path, ""));
        let owner = stage.prim(owner)?;
        let kind = owner.type_name().map_err(|error| failed(target, &error))?;
        if kind.is_some_and(|kind| kind.as_str() == "Shader") && name.starts_with("outputs:") {
            return Ok(Source::Output(owner, name.trim_start_matches("outputs:").to_owned()));
        }
        attribute = owner.attribute(name);
    }
    Err(Fault::new(prim.path().as_str(), format!("connections of {name} without an end"), "a source"))
}

fn failed(path: &Path, error: &dyn std::fmt::Display) -> Fault {
    Fault::new(path.as_str(), error.to_string(), "a connection that can be read")
}

/// The shader's identifier; empty without one.
pub fn identifier(shader: &usd::Prim) -> Result<String, Fault> {
    Ok(Attributes::new(shader, 1.0).get("info:id", "a token", convert::token)?.unwrap_or_default())
}

/// An input's own value; none if it has none, or a shader's output.
pub fn value<T>(
    stage: &Stage,
    prim: &usd::Prim,
    name: &str,
    convert: fn(Value) -> Option<T>,
) -> Result<Option<T>, Fault> {
    let Source::Value(attribute) = source(stage, prim, &format!("inputs:{name}"))? else { return Ok(None) };
    let value = attribute.get_at::<Value>(usd::TimeCode::EARLIEST);
    Ok(value.map_err(|error| failed(attribute.path(), &error))?.and_then(convert))
}

/// Where the asset of an input is; none if it has none.
fn asset(stage: &Stage, prim: &usd::Prim, name: &str) -> Result<Option<String>, Fault> {
    let Source::Value(attribute) = source(stage, prim, &format!("inputs:{name}"))? else { return Ok(None) };
    let value = attribute.get_at::<Value>(usd::TimeCode::EARLIEST);
    let value = value.map_err(|error| failed(attribute.path(), &error))?;
    Ok(value.and_then(|value| layers::asset(&attribute, value)).filter(|asset| !asset.is_empty()))
}

/// The texture that an input is connected to, with the name of its texture coordinates; none if it is to another shader.
/// `is_color`: texels are sRGB unless the file says otherwise.
pub fn texture(
    stage: &Stage,
    (shader, output): (&usd::Prim, &str),
    is_color: bool,
    textures: &mut Textures,
) -> Result<Option<(TextureRef, String)>, Fault> {
    if identifier(shader)? != "UsdUVTexture" {
        return Ok(None);
    }
    let Some(asset) = asset(stage, shader, "file")? else { return Ok(None) };
    let token = |name| value(stage, shader, name, convert::token);
    let wrap = [wrap(token("wrapS")?.as_deref()), wrap(token("wrapT")?.as_deref())];
    let is_srgb = match token("sourceColorSpace")?.as_deref() {
        Some("sRGB") => true,
        Some("raw") => false,
        _ => is_color,
    };
    let factors = |name, fallback| value(stage, shader, name, convert::vec4).map(|v| v.unwrap_or(fallback));
    let (scale, bias) = (factors("scale", [1.0; 4])?, factors("bias", [0.0; 4])?);
    let (map, uv_name) = coordinates(stage, shader)?;
    let (x, y, t) = (map.matrix2.x_axis, map.matrix2.y_axis, map.translation);
    // USD's t runs upwards.
    let transform = [[x.x, y.x, t.x], [-x.y, -y.y, 1.0 - t.y]].map(|row| row.map(|entry| entry as f32));
    let channel = ["r", "g", "b", "a"].iter().position(|&channel| channel == output).unwrap_or(0) as u32;
    let texture = textures.texture(&asset, wrap);
    Ok(Some((TextureRef { texture, channel, is_srgb, transform, scale, bias }, uv_name)))
}

/// What lies beyond an image's edges. What its metadata says is not read: as the specification has it without, nothing.
fn wrap(token: Option<&str>) -> Wrap {
    match token {
        Some("repeat") => Wrap::Repeat,
        Some("mirror") => Wrap::Mirror,
        Some("clamp") => Wrap::Clamp,
        _ => Wrap::Black,
    }
}

/// The map from texture coordinates to those of a texture, and their name.
fn coordinates(stage: &Stage, texture: &usd::Prim) -> Result<(DAffine2, String), Fault> {
    let mut map = DAffine2::IDENTITY;
    let mut next = (texture.clone(), "inputs:st");
    for _ in 0..MAX_STEPS {
        let Source::Output(shader, _) = source(stage, &next.0, next.1)? else { break };
        match identifier(&shader)?.as_str() {
            "UsdTransform2d" => {
                let degrees = value(stage, &shader, "rotation", convert::number)?.unwrap_or(0.0);
                let scale = value(stage, &shader, "scale", convert::vec2)?.unwrap_or(DVec2::ONE);
                let translation = value(stage, &shader, "translation", convert::vec2)?.unwrap_or(DVec2::ZERO);
                let turn = DAffine2::from_angle_translation(degrees.to_radians(), translation);
                map = map * turn * DAffine2::from_scale(scale);
                next = (shader, "inputs:in");
            }
            id if id.starts_with("UsdPrimvarReader_float2") => {
                let name = value(stage, &shader, "varname", convert::token)?;
                return Ok((map, name.filter(|name| !name.is_empty()).unwrap_or_else(|| UV_NAME.to_owned())));
            }
            _ => break,
        }
    }
    Ok((map, UV_NAME.to_owned()))
}
