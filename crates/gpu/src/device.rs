//! An opened device: one queue, the memory, and what every object holds on to.

use crate::features::FeatureStructs;
use crate::instance::{Instance, InstanceInner};
use crate::memory::{Budget, Memory, MemoryBlock, MemoryRequest, PooledMemory};
use crate::probe::Candidate;
use crate::{ApiVersion, DeviceFacts, DeviceKind, DeviceReport, Error, Feature, Limits, Result, select_device};
use ash::{ext, vk};
use std::collections::BTreeSet;
use std::ffi::CString;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// How to open a device.
#[derive(Debug, Clone, Default)]
pub struct DeviceOptions {
    /// Load the validation layer with its synchronization checks; see [`Device::validation_messages`].
    pub validation: bool,
    /// The device's index, or a part of its name in any case. Without it the best device is taken.
    pub selector: Option<String>,
    /// Bytes that buffers and images may use together; by default three quarters of the largest heap.
    pub memory_budget: Option<u64>,
}

/// An opened device. Cheap to clone; every object made from it keeps it alive.
#[derive(Clone)]
pub struct Device {
    pub(crate) inner: Arc<DeviceInner>,
}

pub(crate) struct DeviceInner {
    pub(crate) raw: ash::Device,
    pub(crate) feedback: Option<ext::transform_feedback::Device>,
    pub(crate) pipeline_cache: vk::PipelineCache,
    pub(crate) queue_family: u32,
    pub(crate) physical: vk::PhysicalDevice,
    pub(crate) facts: DeviceFacts,
    pub(crate) limits: Limits,
    debug: Option<ext::debug_utils::Device>,
    queue: Mutex<Queue>,
    memory: Mutex<MemoryState>,
    pub(crate) instance: Arc<InstanceInner>,
}

/// The one queue. Its lock is held from submission to completion: who has the lock knows that the GPU is idle.
pub(crate) struct Queue {
    pub(crate) raw: vk::Queue,
    pub(crate) health: Health,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Health {
    Good,
    /// Nothing can be submitted any more.
    Lost,
    /// As `Lost`, and the GPU may still be at work: nothing may be destroyed.
    Hung,
}

struct MemoryState {
    budget: Budget,
    source: Option<Box<dyn Memory>>,
}

impl Device {
    /// Opens the loader and a device in one go.
    ///
    /// # Errors
    /// As [`Instance::new`] and [`Device::new`].
    pub fn open(options: &DeviceOptions) -> Result<Self> {
        Self::new(&Instance::new(options.validation)?, options)
    }

    /// Opens a device of an instance; validation is as the instance has it.
    ///
    /// # Errors
    /// No device fits, or the driver fails.
    pub fn new(instance: &Instance, options: &DeviceOptions) -> Result<Self> {
        let mut candidates = instance.candidates()?;
        let numbered = candidates.iter().enumerate();
        let reports: Vec<_> = numbered.map(|(index, candidate)| DeviceReport::new(index, &candidate.facts)).collect();
        let candidate = candidates.swap_remove(select_device(&reports, options.selector.as_deref())?);
        Ok(Self { inner: Arc::new(open(instance, candidate, options)?) })
    }

    /// The driver's name for the device.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.inner.facts.name
    }

    /// The driver's name and version.
    #[must_use]
    pub fn driver(&self) -> &str {
        &self.inner.facts.driver
    }

    /// What sort of hardware it is.
    #[must_use]
    pub fn kind(&self) -> DeviceKind {
        self.inner.facts.kind
    }

    /// Whether the CPU does the work; such a device wants its patches one an instance.
    #[must_use]
    pub fn is_software(&self) -> bool {
        self.kind() == DeviceKind::Software
    }

    /// The newest Vulkan that the device offers; 1.3 is what is used.
    #[must_use]
    pub fn api_version(&self) -> ApiVersion {
        self.inner.facts.api_version
    }

    /// Whether an optional feature is there and enabled.
    #[must_use]
    pub fn has(&self, feature: Feature) -> bool {
        self.inner.facts.features.contains(&feature)
    }

    /// The limits that matter here.
    #[must_use]
    pub fn limits(&self) -> &Limits {
        &self.inner.limits
    }

    /// Everything the validation layer has said so far; always empty without validation.
    #[must_use]
    pub fn validation_messages(&self) -> Vec<String> {
        self.inner.instance.validation.as_ref().map(|validation| validation.messages.all()).unwrap_or_default()
    }

    /// Bytes in use by buffers and images.
    #[must_use]
    pub fn memory_used(&self) -> u64 {
        self.inner.memory().budget.used
    }

    /// Bytes that buffers and images may use together.
    #[must_use]
    pub fn memory_budget(&self) -> u64 {
        self.inner.memory().budget.limit
    }
}

fn open(instance: &Instance, candidate: Candidate, options: &DeviceOptions) -> Result<DeviceInner> {
    let vulkan = &instance.inner.raw;
    let Candidate { physical, facts, limits, queue_family } = candidate;
    let raw = create_device(vulkan, physical, queue_family, &facts.features)?;
    // From here on, `Drop` takes care of the device whatever fails.
    let mut device = DeviceInner {
        // SAFETY: the device was made with one queue of this family.
        queue: Mutex::new(Queue { raw: unsafe { raw.get_device_queue(queue_family, 0) }, health: Health::Good }),
        feedback: facts
            .features
            .contains(&Feature::TransformFeedback)
            .then(|| ext::transform_feedback::Device::new(vulkan, &raw)),
        debug: instance.inner.validation.is_some().then(|| ext::debug_utils::Device::new(vulkan, &raw)),
        pipeline_cache: vk::PipelineCache::null(),
        memory: Mutex::new(MemoryState {
            budget: options
                .memory_budget
                .map_or(Budget::of_heap(limits.largest_heap), |limit| Budget { limit, used: 0 }),
            source: None,
        }),
        instance: Arc::clone(&instance.inner),
        queue_family,
        physical,
        facts,
        limits,
        raw,
    };
    device.memory().source = Some(Box::new(PooledMemory::new(vulkan, &device.raw, physical)?));
    // SAFETY: the device lives.
    device.pipeline_cache = unsafe { device.raw.create_pipeline_cache(&vk::PipelineCacheCreateInfo::default(), None) }
        .map_err(Error::vulkan("vkCreatePipelineCache", &device.facts.name))?;
    Ok(device)
}

fn create_device(
    instance: &ash::Instance,
    physical: vk::PhysicalDevice,
    queue_family: u32,
    features: &BTreeSet<Feature>,
) -> Result<ash::Device> {
    let queues = [vk::DeviceQueueCreateInfo::default().queue_family_index(queue_family).queue_priorities(&[1.0])];
    let mut structs = FeatureStructs::enabling(features);
    let mut all = vk::PhysicalDeviceFeatures2::default().features(structs.core);
    let mut extensions = Vec::new();
    let mut info = vk::DeviceCreateInfo::default().queue_create_infos(&queues);
    if features.contains(&Feature::TransformFeedback) {
        extensions.push(ext::transform_feedback::NAME.as_ptr());
        info = info.push_next(&mut structs.feedback);
    }
    info = info
        .enabled_extension_names(&extensions)
        .push_next(&mut structs.vulkan12)
        .push_next(&mut structs.vulkan13)
        .push_next(&mut all);
    // SAFETY: `info` and what it points to outlive the call; every feature and extension was found on this device,
    // whose version is at least 1.3.
    unsafe { instance.create_device(physical, &info, None) }.map_err(Error::vulkan("vkCreateDevice", "the device"))
}

impl DeviceInner {
    /// Waits until the GPU is idle and keeps it so until the guard goes.
    pub(crate) fn idle_queue(&self) -> MutexGuard<'_, Queue> {
        self.queue.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Destroys an object when the GPU has done with it; after a hang, leaves it to the end of the process.
    pub(crate) fn destroy(&self, object: impl FnOnce(&ash::Device)) {
        let queue = self.idle_queue();
        if queue.health != Health::Hung {
            object(&self.raw);
        }
    }

    fn memory(&self) -> MutexGuard<'_, MemoryState> {
        self.memory.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(crate) fn allocate(&self, request: &MemoryRequest<'_>) -> Result<MemoryBlock> {
        let mut memory = self.memory();
        let asked = request.requirements.size;
        memory.budget.take(request.name, asked)?;
        let block = match memory.source.as_mut() {
            Some(source) => source.allocate(request),
            None => Err("the device has no memory source".to_owned()),
        };
        block.map_err(|reason| {
            memory.budget.give_back(asked);
            Error::NoMemory { name: request.name.to_owned(), asked, reason }
        })
    }

    /// Takes back a block that was asked for with `asked` bytes.
    pub(crate) fn free(&self, block: MemoryBlock, asked: u64) {
        let mut memory = self.memory();
        memory.budget.give_back(asked);
        if let Some(source) = memory.source.as_mut() {
            source.free(block);
        }
    }

    /// Names an object for debuggers and validation messages.
    pub(crate) fn name_object(&self, handle: impl vk::Handle, name: &str) {
        let Some(debug) = &self.debug else { return };
        let name = c_string(name);
        let info = vk::DebugUtilsObjectNameInfoEXT::default().object_handle(handle).object_name(&name);
        // SAFETY: the object is of this device and not in use by another thread: it was just made.
        // A name that could not be set is no reason to fail.
        let _ = unsafe { debug.set_debug_utils_object_name(&info) };
    }

    pub(crate) fn begin_label(&self, commands: vk::CommandBuffer, name: &str) {
        if let Some(debug) = &self.debug {
            let name = c_string(name);
            // SAFETY: the command buffer is of this device and being recorded.
            unsafe {
                debug.cmd_begin_debug_utils_label(commands, &vk::DebugUtilsLabelEXT::default().label_name(&name));
            }
        }
    }

    pub(crate) fn end_label(&self, commands: vk::CommandBuffer) {
        if let Some(debug) = &self.debug {
            // SAFETY: as in `begin_label`, which came before.
            unsafe { debug.cmd_end_debug_utils_label(commands) };
        }
    }

    /// Checks that an object's optional feature is there.
    pub(crate) fn need(&self, feature: Feature, needed_by: &str) -> Result<()> {
        match self.facts.features.contains(&feature) {
            true => Ok(()),
            false => Err(Error::MissingFeature { needed_by: needed_by.to_owned(), feature: feature.name() }),
        }
    }
}

/// A name as C wants it, without the zero bytes that C cannot hold.
fn c_string(name: &str) -> CString {
    CString::new(name.replace('\0', "")).unwrap_or_default()
}

impl Drop for DeviceInner {
    fn drop(&mut self) {
        let source = self.memory().source.take();
        if self.idle_queue().health == Health::Hung {
            // The GPU may still be writing: the device, its memory and its instance stay until the process ends.
            std::mem::forget(source);
            std::mem::forget(Arc::clone(&self.instance));
            return;
        }
        drop(source);
        // SAFETY: every object holds this device, so none is left; the queue is idle and the memory was freed.
        unsafe {
            self.raw.destroy_pipeline_cache(self.pipeline_cache, None);
            self.raw.destroy_device(None);
        }
    }
}
