//! Frames: every kernel against its CPU twin, what culling leaves out, lists that overflow, the same frame twice, odd cameras
//! and densities, how much is computed, and that closed surfaces have no cracks. On the real device, with the validation layer and its synchronization checks on.

mod culling;
mod darkroom;
mod deform;
mod fuzz;
mod gregory;
mod gregory_culling;
mod gregory_lists;
mod grids;
mod holes;
mod in_use;
mod inside;
mod kernels;
mod lab;
mod overflow;
mod placement;
mod random;
mod reflectance;
mod repeat;
mod rivals;
mod seen;
mod shading;
mod shadows;
mod twin;
mod watertight;
mod world;
