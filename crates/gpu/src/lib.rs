//! A small Vulkan 1.3 backend on ash.
