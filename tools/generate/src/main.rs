//! Writes the meshes of `scenes/` and larger ones of any size.
fn main() {}
