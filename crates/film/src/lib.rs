//! Frame buffers to EXR, PNG and PLY files.
