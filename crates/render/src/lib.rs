//! Subdivision surfaces on the GPU: upload, subdivide, limit, draw.
