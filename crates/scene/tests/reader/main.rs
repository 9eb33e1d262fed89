//! The reader from outside: one module an aspect, each test named after what it claims.
mod common;
mod edits;
mod errors;
mod load;
mod robust;
mod syntax;
mod tags;
