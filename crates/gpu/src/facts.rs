//! Which device can be used, and which is taken: pure functions over plain facts.

use crate::{Error, Feature, Result};
use std::collections::BTreeSet;
use std::fmt;

/// The oldest Vulkan that is used.
pub const NEEDED_VERSION: ApiVersion = ApiVersion { major: 1, minor: 3, patch: 0 };

/// A version of the Vulkan API.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct ApiVersion {
    /// 1 so far.
    pub major: u32,
    /// The 3 of 1.3.
    pub minor: u32,
    /// The header's revision.
    pub patch: u32,
}

impl fmt::Display for ApiVersion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}.{}", self.major, self.minor, self.patch)
    }
}

/// What sort of hardware a device is, in the order in which devices are preferred.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum DeviceKind {
    /// A GPU with memory of its own.
    Discrete,
    /// A GPU that shares the CPU's memory.
    Integrated,
    /// A GPU lent by a virtual machine's host.
    Virtual,
    /// None of the others.
    Other,
    /// The CPU, such as Mesa's lavapipe.
    Software,
}

impl fmt::Display for DeviceKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Discrete => "discrete",
            Self::Integrated => "integrated",
            Self::Virtual => "virtual",
            Self::Other => "other",
            Self::Software => "software",
        })
    }
}

/// All that decides whether a device can be used.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DeviceFacts {
    /// The driver's name for the device.
    pub name: String,
    /// The driver's name and version.
    pub driver: String,
    /// What sort of hardware it is.
    pub kind: DeviceKind,
    /// The newest Vulkan that it offers.
    pub api_version: ApiVersion,
    /// Every feature of [`Feature::ALL`] that it has.
    pub features: BTreeSet<Feature>,
    /// Whether some queue takes both graphics and compute work.
    pub has_graphics_compute_queue: bool,
}

impl DeviceFacts {
    /// Every reason why this device cannot be used; none when it can.
    #[must_use]
    pub fn refusals(&self) -> Vec<String> {
        let mut refusals = Vec::new();
        let is_new_enough = self.api_version >= NEEDED_VERSION;
        if !is_new_enough {
            refusals.push(format!("Vulkan 1.3 expected, {} found", self.api_version));
        }
        // An older device was not asked about newer features: it would be blamed for them wrongly.
        refusals.extend(
            Feature::ALL
                .into_iter()
                .filter(|feature| feature.is_required() && (is_new_enough || feature.is_vulkan_1_0()))
                .filter(|feature| !self.features.contains(feature))
                .map(|feature| format!("{} is not supported", feature.name())),
        );
        if !self.has_graphics_compute_queue {
            refusals.push("no queue takes both graphics and compute".to_owned());
        }
        refusals
    }

    /// Takes features away, given the comma-separated names of `PLANISH_HIDE_FEATURE`.
    ///
    /// # Errors
    /// [`Error::UnknownFeature`] for a name that is not in [`Feature::ALL`].
    pub fn hide(&mut self, names: &str) -> Result<()> {
        for name in names.split(',').map(str::trim).filter(|name| !name.is_empty()) {
            let feature = Feature::from_name(name).ok_or_else(|| Error::UnknownFeature {
                name: name.to_owned(),
                known: Feature::ALL.map(Feature::name).join(", "),
            })?;
            self.features.remove(&feature);
        }
        Ok(())
    }
}

/// One device and why it cannot be used, if so.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DeviceReport {
    /// The device's place in Vulkan's list; a selector can name it.
    pub index: usize,
    /// The driver's name for the device.
    pub name: String,
    /// The driver's name and version.
    pub driver: String,
    /// What sort of hardware it is.
    pub kind: DeviceKind,
    /// The newest Vulkan that it offers.
    pub api_version: ApiVersion,
    /// Every reason why it cannot be used; none when it can.
    pub refusals: Vec<String>,
}

impl DeviceReport {
    /// What is reported of the device at `index` with these facts.
    #[must_use]
    pub fn new(index: usize, facts: &DeviceFacts) -> Self {
        Self {
            index,
            name: facts.name.clone(),
            driver: facts.driver.clone(),
            kind: facts.kind,
            api_version: facts.api_version,
            refusals: facts.refusals(),
        }
    }
}

impl fmt::Display for DeviceReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "[{}] {} ({}", self.index, self.name, self.kind)?;
        match self.refusals.is_empty() {
            true => f.write_str(")"),
            false => write!(f, "; refused: {})", self.refusals.join(", ")),
        }
    }
}

/// The index of the device to take. A selector is an index or any part of a name, in any case; a number that is no
/// device's index is part of a name.
/// Among several that fit: discrete before integrated, virtual, other and software, then the first.
///
/// # Errors
/// [`Error::NoSuchDevice`] with a selector, [`Error::NoSuitableDevice`] without, both listing each device's refusals.
pub fn select_device(reports: &[DeviceReport], selector: Option<&str>) -> Result<usize> {
    let index = selector.and_then(|selector| selector.parse::<usize>().ok()).filter(|&index| index < reports.len());
    let is_asked_for = |report: &&DeviceReport| match (index, selector) {
        (Some(index), _) => report.index == index,
        (None, Some(part)) => report.name.to_lowercase().contains(&part.to_lowercase()),
        (None, None) => true,
    };
    reports
        .iter()
        .filter(|report| report.refusals.is_empty())
        .filter(is_asked_for)
        .min_by_key(|report| (report.kind, report.index))
        .map(|report| report.index)
        .ok_or_else(|| {
            let devices: Vec<_> = reports.iter().map(ToString::to_string).collect();
            let devices = devices.join("; ");
            match selector.map(str::to_owned) {
                Some(selector) => Error::NoSuchDevice { selector, devices },
                None => Error::NoSuitableDevice { devices },
            }
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn facts(name: &str, kind: DeviceKind) -> DeviceFacts {
        DeviceFacts {
            name: name.to_owned(),
            driver: "test 1.0".to_owned(),
            kind,
            api_version: NEEDED_VERSION,
            features: Feature::ALL.into_iter().filter(|feature| feature.is_required()).collect(),
            has_graphics_compute_queue: true,
        }
    }

    fn reports(devices: &[DeviceFacts]) -> Vec<DeviceReport> {
        let numbered = devices.iter().enumerate();
        numbered.map(|(index, facts)| DeviceReport::new(index, facts)).collect()
    }

    #[test]
    fn a_device_with_all_required_features_is_accepted() {
        assert_eq!(facts("gpu", DeviceKind::Discrete).refusals(), Vec::<String>::new());
    }

    #[test]
    fn every_required_feature_is_missed_by_name() {
        for feature in Feature::ALL.into_iter().filter(|feature| feature.is_required()) {
            let mut device = facts("gpu", DeviceKind::Discrete);
            device.features.remove(&feature);
            assert_eq!(device.refusals(), [format!("{} is not supported", feature.name())]);
        }
    }

    #[test]
    fn a_device_without_tessellation_shaders_is_refused_by_that_name() {
        let mut device = facts("gpu", DeviceKind::Discrete);
        device.hide(" tessellationShader,").unwrap();
        assert_eq!(device.refusals(), ["tessellationShader is not supported"]);
    }

    #[test]
    fn an_old_device_is_refused_for_its_version_and_not_for_features_it_was_not_asked_about() {
        let mut device = facts("gpu", DeviceKind::Discrete);
        device.features.clear();
        device.has_graphics_compute_queue = false;
        device.api_version = ApiVersion { major: 1, minor: 2, patch: 131 };
        assert_eq!(
            device.refusals(),
            [
                "Vulkan 1.3 expected, 1.2.131 found",
                "tessellationShader is not supported",
                "no queue takes both graphics and compute"
            ]
        );
    }

    #[test]
    fn hiding_an_unknown_feature_lists_the_known_ones() {
        let error = facts("gpu", DeviceKind::Discrete).hide("tesselation").unwrap_err().to_string();
        assert!(error.contains("\"tesselation\"") && error.contains("tessellationShader"), "{error}");
    }

    #[test]
    fn discrete_comes_before_integrated_before_software() {
        use DeviceKind::{Discrete, Integrated, Software};
        let all = [facts("s", Software), facts("i", Integrated), facts("d", Discrete), facts("d2", Discrete)];
        assert_eq!(select_device(&reports(&all), None).unwrap(), 2);
        assert_eq!(select_device(&reports(&all[..2]), None).unwrap(), 1);
        assert_eq!(select_device(&reports(&all[..1]), None).unwrap(), 0);
    }

    #[test]
    fn a_refused_device_is_passed_over() {
        let mut best = facts("best", DeviceKind::Discrete);
        best.features.clear();
        let list = reports(&[best, facts("llvmpipe", DeviceKind::Software)]);
        assert_eq!(select_device(&list, None).unwrap(), 1);
        let error = select_device(&list, Some("best")).unwrap_err().to_string();
        assert!(error.contains("[0] best") && error.contains("scalarBlockLayout"), "{error}");
    }

    #[test]
    fn a_selector_is_an_index_or_a_part_of_a_name_in_any_case() {
        let list =
            reports(&[facts("Big GPU", DeviceKind::Discrete), facts("llvmpipe (LLVM 15)", DeviceKind::Software)]);
        assert_eq!(select_device(&list, Some("1")).unwrap(), 1);
        assert_eq!(select_device(&list, Some("LLVMPIPE")).unwrap(), 1);
        assert_eq!(select_device(&list, Some("gpu")).unwrap(), 0);
        assert_eq!(select_device(&list, Some("15")).unwrap(), 1);
        assert!(matches!(select_device(&list, Some("7")), Err(Error::NoSuchDevice { .. })));
    }

    #[test]
    fn when_no_device_fits_every_device_is_listed_with_its_reasons() {
        let mut device = facts("gpu", DeviceKind::Discrete);
        device.hide("tessellationShader,maintenance4").unwrap();
        let error = select_device(&reports(&[device]), None).unwrap_err();
        assert_eq!(
            error.to_string(),
            "no device can be used: [0] gpu (discrete; refused: tessellationShader is not supported, maintenance4 is not supported)"
        );
        assert!(matches!(select_device(&[], None), Err(Error::NoSuitableDevice { .. })));
    }
}
