//! The reader from outside: one module an aspect, each test named after what it claims.
mod colors;
mod common;
mod edits;
mod errors;
mod json;
mod json_cameras;
mod json_instances;
mod load;
mod robust;
mod syntax;
mod tags;
