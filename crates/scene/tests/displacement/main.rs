//! Displacement maps from outside: one module an aspect, each test named after what it claims.
mod common;
mod faces;
mod files;
mod refusals;
mod scene_files;
mod udim;
mod uv;
