//! The USD reader from outside: one module an aspect, each test named after what it claims.
#![cfg(feature = "usd")]
mod common;
mod composition;
mod look;
mod mesh;
mod moving;
mod place;
mod robust;
