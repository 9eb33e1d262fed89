//! Vectors of three doubles.

/// A point or a vector.
pub type Vector = [f64; 3];

pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub fn subtract(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|c| a[c] - b[c])
}

pub fn length(a: Vector) -> f64 {
    dot(a, a).sqrt()
}
