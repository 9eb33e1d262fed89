//! Collects what the validation layer says.

use ash::vk;
use std::ffi::c_void;
use std::sync::{Mutex, PoisonError};

/// Warnings and errors of the validation layer, in order.
#[derive(Default)]
pub(crate) struct Messages(Mutex<Vec<String>>);

impl Messages {
    pub(crate) fn all(&self) -> Vec<String> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    fn push(&self, message: String) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push(message);
    }

    /// A messenger that writes here. `self` must stay where it is until the messenger is destroyed.
    pub(crate) fn messenger(&self) -> vk::DebugUtilsMessengerCreateInfoEXT<'static> {
        use vk::DebugUtilsMessageSeverityFlagsEXT as Severity;
        vk::DebugUtilsMessengerCreateInfoEXT::default()
            .message_severity(Severity::WARNING | Severity::ERROR)
            .message_type(vk::DebugUtilsMessageTypeFlagsEXT::VALIDATION)
            .pfn_user_callback(Some(collect))
            .user_data(std::ptr::from_ref(self).cast_mut().cast())
    }
}

/// Called by the driver's loader, on any thread.
unsafe extern "system" fn collect(
    _severity: vk::DebugUtilsMessageSeverityFlagsEXT,
    _kind: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    messages: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: `messages` is the `Messages` that `messenger` put there, shared and alive as long as the messenger.
    let messages = unsafe { &*messages.cast::<Messages>() };
    // SAFETY: Vulkan hands over one valid structure whose message, if any, is a C string.
    let text = unsafe { (*data).message_as_c_str() };
    messages.push(text.map(|text| text.to_string_lossy().into_owned()).unwrap_or_default());
    vk::FALSE
}
