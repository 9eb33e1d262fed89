//! The Vulkan instance: the loader, validation, and the list of devices.

use crate::features::has_extension;
use crate::messages::Messages;
use crate::probe::{Candidate, version_of};
use crate::{DeviceReport, Error, NEEDED_VERSION, Result};
use ash::{ext, vk};
use std::ffi::CStr;
use std::sync::Arc;

const VALIDATION_LAYER: &CStr = c"VK_LAYER_KHRONOS_validation";

/// The connection to the Vulkan loader. Cheap to clone; everything made from it keeps it alive.
#[derive(Clone)]
pub struct Instance {
    pub(crate) inner: Arc<InstanceInner>,
}

pub(crate) struct InstanceInner {
    pub(crate) raw: ash::Instance,
    pub(crate) validation: Option<Validation>,
    /// Holds the loader's library open.
    _entry: ash::Entry,
}

pub(crate) struct Validation {
    debug: ext::debug_utils::Instance,
    messenger: vk::DebugUtilsMessengerEXT,
    pub(crate) messages: Box<Messages>,
}

impl Instance {
    /// Opens the Vulkan loader, with the validation layer and its synchronization checks if asked for.
    ///
    /// # Errors
    /// No loader, no driver, a loader older than 1.3, or no validation layer though asked for.
    pub fn new(validation: bool) -> Result<Self> {
        // SAFETY: a loader found by the system's rules is a Vulkan loader; it is closed with the last instance.
        let entry = unsafe { ash::Entry::load() }.map_err(|error| Error::NoLoader { reason: error.to_string() })?;
        // SAFETY: `entry` is loaded.
        let found = unsafe { entry.try_enumerate_instance_version() }
            .map_err(Error::vulkan("vkEnumerateInstanceVersion", "the loader"))?
            .map_or(vk::API_VERSION_1_0, |version| version);
        if version_of(found) < NEEDED_VERSION {
            return Err(Error::OldLoader { found: version_of(found) });
        }
        let raw = create_instance(&entry, validation)?;
        let mut inner = InstanceInner { raw, validation: None, _entry: entry };
        if validation {
            let debug = ext::debug_utils::Instance::new(&inner._entry, &inner.raw);
            let messages = Box::<Messages>::default();
            // SAFETY: the box keeps the messages in place until `Drop` has destroyed the messenger.
            let messenger = unsafe { debug.create_debug_utils_messenger(&messages.messenger(), None) }
                .map_err(Error::vulkan("vkCreateDebugUtilsMessengerEXT", "the instance"))?;
            inner.validation = Some(Validation { debug, messenger, messages });
        }
        Ok(Self { inner: Arc::new(inner) })
    }

    /// Every Vulkan device with every reason why it is refused.
    ///
    /// # Errors
    /// When Vulkan cannot list them, or `PLANISH_HIDE_FEATURE` is malformed.
    pub fn devices(&self) -> Result<Vec<DeviceReport>> {
        let candidates = self.candidates()?;
        let numbered = candidates.iter().enumerate();
        Ok(numbered.map(|(index, candidate)| DeviceReport::new(index, &candidate.facts)).collect())
    }

    pub(crate) fn candidates(&self) -> Result<Vec<Candidate>> {
        // SAFETY: the instance lives.
        let all = unsafe { self.inner.raw.enumerate_physical_devices() }
            .map_err(Error::vulkan("vkEnumeratePhysicalDevices", "the instance"))?;
        all.into_iter().map(|physical| Candidate::new(&self.inner.raw, physical)).collect()
    }
}

fn create_instance(entry: &ash::Entry, validation: bool) -> Result<ash::Instance> {
    let application = vk::ApplicationInfo::default().application_name(c"planish").api_version(vk::API_VERSION_1_3);
    let mut layers = Vec::new();
    let mut extensions = Vec::new();
    let checks = [vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];
    let mut checking = vk::ValidationFeaturesEXT::default().enabled_validation_features(&checks);
    if validation {
        extensions = validation_extensions(entry)?;
        layers.push(VALIDATION_LAYER.as_ptr());
    }
    let mut info = vk::InstanceCreateInfo::default()
        .application_info(&application)
        .enabled_layer_names(&layers)
        .enabled_extension_names(&extensions);
    if validation {
        info = info.push_next(&mut checking);
    }
    // SAFETY: `info` and what it points to outlive the call; the layer and the extensions are there.
    unsafe { entry.create_instance(&info, None) }.map_err(|result| match result {
        vk::Result::ERROR_INCOMPATIBLE_DRIVER => Error::NoDriver,
        result => Error::vulkan("vkCreateInstance", "the loader")(result),
    })
}

/// The extensions that validation needs, after a look whether its layer is installed.
fn validation_extensions(entry: &ash::Entry) -> Result<Vec<*const std::ffi::c_char>> {
    // SAFETY: `entry` is loaded.
    let layers = unsafe { entry.enumerate_instance_layer_properties() }
        .map_err(Error::vulkan("vkEnumerateInstanceLayerProperties", "the loader"))?;
    if !layers.iter().any(|layer| layer.layer_name_as_c_str() == Ok(VALIDATION_LAYER)) {
        return Err(Error::NoValidationLayer);
    }
    // SAFETY: `entry` is loaded and the layer is there.
    let offered = unsafe { entry.enumerate_instance_extension_properties(Some(VALIDATION_LAYER)) }
        .map_err(Error::vulkan("vkEnumerateInstanceExtensionProperties", "the validation layer"))?;
    let mut extensions = vec![ext::debug_utils::NAME.as_ptr()];
    if has_extension(&offered, ext::validation_features::NAME) {
        extensions.push(ext::validation_features::NAME.as_ptr());
    }
    Ok(extensions)
}

impl Drop for InstanceInner {
    fn drop(&mut self) {
        // SAFETY: every device holds this instance, so none is left; the messenger goes before the instance.
        unsafe {
            if let Some(validation) = &self.validation {
                validation.debug.destroy_debug_utils_messenger(validation.messenger, None);
            }
            self.raw.destroy_instance(None);
        }
    }
}
