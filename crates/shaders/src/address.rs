//! Typed device addresses, the host's side of `buffer_reference`.

use std::fmt;
use std::hash::{Hash, Hasher};
use std::marker::PhantomData;

/// The address of a `T`, or of the first of many, in memory of the device. 64 bits, as in the shader.
///
/// `T` is only a label: the type says neither that the address is valid nor how many elements lie there.
#[derive(bytemuck::Pod, bytemuck::Zeroable)]
#[zeroable(bound = "")]
#[repr(transparent)]
pub struct DeviceAddress<T> {
    raw: u64,
    target: PhantomData<T>,
}

impl<T> DeviceAddress<T> {
    /// The address as Vulkan returns it for a buffer, in bytes.
    pub const fn new(raw: u64) -> Self {
        Self { raw, target: PhantomData }
    }

    /// The address that points nowhere, 0.
    pub const fn null() -> Self {
        Self::new(0)
    }

    /// The address in bytes.
    pub const fn raw(self) -> u64 {
        self.raw
    }

    /// Whether the address is 0.
    pub const fn is_null(self) -> bool {
        self.raw == 0
    }

    /// The address `elements` elements of `size_of::<T>()` bytes further on.
    ///
    /// # Panics
    /// When the address leaves 64 bits, in builds with overflow checks.
    pub const fn offset(self, elements: u64) -> Self {
        Self::new(self.raw + elements * size_of::<T>() as u64)
    }
}

// By hand: derives would ask the same of `T`, of which there is no value here.
impl<T> Clone for DeviceAddress<T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for DeviceAddress<T> {}

impl<T> Default for DeviceAddress<T> {
    fn default() -> Self {
        Self::null()
    }
}

impl<T> PartialEq for DeviceAddress<T> {
    fn eq(&self, other: &Self) -> bool {
        self.raw == other.raw
    }
}

impl<T> Eq for DeviceAddress<T> {}

impl<T> Hash for DeviceAddress<T> {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.raw.hash(state);
    }
}

impl<T> fmt::Debug for DeviceAddress<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:#x}", self.raw)
    }
}
