//! Files to scenes: meshes and cameras.
