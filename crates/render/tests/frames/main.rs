//! Frames: every kernel against its CPU twin, what culling leaves out, lists that overflow, the same frame twice, odd cameras
//! and densities, and how much is computed. On the real device, with the validation layer and its synchronization checks on.

mod culling;
mod fuzz;
mod in_use;
mod kernels;
mod lab;
mod overflow;
mod repeat;
mod seen;
mod twin;
mod world;
