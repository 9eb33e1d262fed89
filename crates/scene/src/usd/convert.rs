//! Values as the file holds them to numbers of ours. Every precision that a schema allows is read: half, float and double.
use glam::{DAffine3, DMat3, DQuat, DVec2, DVec3};
use openusd::sdf::Value;

/// A list of vectors of three; floats keep their bits.
pub fn vec3s(value: Value) -> Option<Vec<[f32; 3]>> {
    Some(match value {
        Value::Vec3fVec(list) => list.into_iter().map(|v| [v.x, v.y, v.z]).collect(),
        Value::Vec3dVec(list) => list.into_iter().map(|v| [v.x as f32, v.y as f32, v.z as f32]).collect(),
        Value::Vec3hVec(list) => list.into_iter().map(|v| [v.x.to_f32(), v.y.to_f32(), v.z.to_f32()]).collect(),
        _ => return None,
    })
}

/// A list of vectors of two; floats keep their bits.
pub fn vec2s(value: Value) -> Option<Vec<[f32; 2]>> {
    Some(match value {
        Value::Vec2fVec(list) => list.into_iter().map(|v| [v.x, v.y]).collect(),
        Value::Vec2dVec(list) => list.into_iter().map(|v| [v.x as f32, v.y as f32]).collect(),
        Value::Vec2hVec(list) => list.into_iter().map(|v| [v.x.to_f32(), v.y.to_f32()]).collect(),
        _ => return None,
    })
}

/// A list of integers.
pub fn integers(value: Value) -> Option<Vec<i64>> {
    Some(match value {
        Value::IntVec(list) => list.into_iter().map(i64::from).collect(),
        Value::UintVec(list) => list.into_iter().map(i64::from).collect(),
        Value::Int64Vec(list) => list,
        _ => return None,
    })
}

/// A list of numbers.
pub fn numbers(value: Value) -> Option<Vec<f64>> {
    Some(match value {
        Value::FloatVec(list) => list.into_iter().map(f64::from).collect(),
        Value::DoubleVec(list) => list,
        Value::HalfVec(list) => list.into_iter().map(|v| v.to_f64()).collect(),
        _ => return None,
    })
}

/// A number.
pub fn number(value: Value) -> Option<f64> {
    Some(match value {
        Value::Float(v) => f64::from(v),
        Value::Double(v) => v,
        Value::Half(v) => v.to_f64(),
        Value::Int(v) => f64::from(v),
        Value::Uint(v) => f64::from(v),
        Value::Int64(v) => v as f64,
        Value::Uint64(v) => v as f64,
        _ => return None,
    })
}

/// A vector of three.
pub fn vec3(value: Value) -> Option<DVec3> {
    Some(match value {
        Value::Vec3f(v) => DVec3::new(v.x.into(), v.y.into(), v.z.into()),
        Value::Vec3d(v) => DVec3::new(v.x, v.y, v.z),
        Value::Vec3h(v) => DVec3::new(v.x.to_f64(), v.y.to_f64(), v.z.to_f64()),
        _ => return None,
    })
}

/// A rotation.
pub fn quat(value: Value) -> Option<DQuat> {
    Some(match value {
        Value::Quatf(q) => DQuat::from_xyzw(q.x.into(), q.y.into(), q.z.into(), q.w.into()),
        Value::Quatd(q) => DQuat::from_xyzw(q.x, q.y, q.z, q.w),
        Value::Quath(q) => DQuat::from_xyzw(q.x.to_f64(), q.y.to_f64(), q.z.to_f64(), q.w.to_f64()),
        _ => return None,
    })
}

/// A list of rotations.
pub fn quats(value: Value) -> Option<Vec<DQuat>> {
    match value {
        Value::QuatfVec(list) => list.into_iter().map(|q| quat(Value::Quatf(q))).collect(),
        Value::QuatdVec(list) => list.into_iter().map(|q| quat(Value::Quatd(q))).collect(),
        Value::QuathVec(list) => list.into_iter().map(|q| quat(Value::Quath(q))).collect(),
        _ => None,
    }
}

/// An affine map; none of a matrix that projects.
pub fn affine(value: Value) -> Option<DAffine3> {
    match value {
        Value::Matrix4d(matrix) => affine_of(&matrix.0),
        _ => None,
    }
}

/// A list of affine maps.
pub fn affines(value: Value) -> Option<Vec<DAffine3>> {
    match value {
        Value::Matrix4dVec(list) => list.iter().map(|matrix| affine_of(&matrix.0)).collect(),
        _ => None,
    }
}

/// USD multiplies rows by matrices: its rows are our columns.
fn affine_of(m: &[f64; 16]) -> Option<DAffine3> {
    let row = |r: usize| DVec3::new(m[4 * r], m[4 * r + 1], m[4 * r + 2]);
    let is_affine = [m[3], m[7], m[11], m[15]] == [0.0, 0.0, 0.0, 1.0] && m.iter().all(|entry| entry.is_finite());
    is_affine.then(|| DAffine3 { matrix3: DMat3::from_cols(row(0), row(1), row(2)), translation: row(3) })
}

/// A token or a string.
pub fn token(value: Value) -> Option<String> {
    value.as_str().map(str::to_owned)
}

/// A list of tokens.
pub fn tokens(value: Value) -> Option<Vec<String>> {
    match value {
        Value::TokenVec(list) => Some(list.iter().map(|token| token.as_str().to_owned()).collect()),
        _ => None,
    }
}

/// Yes or no.
pub fn boolean(value: Value) -> Option<bool> {
    match value {
        Value::Bool(v) => Some(v),
        _ => None,
    }
}

/// A vector of two.
pub fn vec2(value: Value) -> Option<DVec2> {
    match value {
        Value::Vec2f(v) => Some(DVec2::new(v.x.into(), v.y.into())),
        Value::Vec2d(v) => Some(DVec2::new(v.x, v.y)),
        _ => None,
    }
}

/// A vector of four.
pub fn vec4(value: Value) -> Option<[f32; 4]> {
    match value {
        Value::Vec4f(v) => Some([v.x, v.y, v.z, v.w]),
        _ => None,
    }
}
