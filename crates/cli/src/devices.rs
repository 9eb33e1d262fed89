//! `planish devices`: which Vulkan devices there are, and whether each can run planish.

use std::fmt::Write;

use anyhow::Result;
use planish_gpu::{DeviceReport, Error, Instance};

use crate::console::print_output;

/// Runs the command.
pub fn run() -> Result<()> {
    let devices = match Instance::new(false) {
        Ok(instance) => instance.devices()?,
        // A loader without drivers: there are no devices, which is an answer.
        Err(Error::NoDriver) => Vec::new(),
        Err(error) => return Err(error.into()),
    };
    print_output(&describe(&devices))
}

fn describe(devices: &[DeviceReport]) -> String {
    if devices.is_empty() {
        return format!("no Vulkan devices: {}\n", Error::NoDriver);
    }
    let mut text = String::new();
    for device in devices {
        let DeviceReport { index, name, driver, kind, api_version, refusals } = device;
        // Writing to a string does not fail.
        let _ = write!(text, "{index}  {name}\n   driver  {driver}\n   type    {kind}\n   Vulkan  {api_version}\n");
        if refusals.is_empty() {
            text.push_str("   can run planish\n");
        }
        for refusal in refusals {
            let _ = writeln!(text, "   cannot run planish: {refusal}");
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use planish_gpu::{DeviceKind, NEEDED_VERSION};

    fn device(refusals: &[&str]) -> DeviceReport {
        DeviceReport {
            index: 1,
            name: "Device".to_owned(),
            driver: "driver 2".to_owned(),
            kind: DeviceKind::Integrated,
            api_version: NEEDED_VERSION,
            refusals: refusals.iter().map(|&refusal| refusal.to_owned()).collect(),
        }
    }

    #[test]
    fn every_reason_against_a_device_is_told() {
        let text = describe(&[device(&["no tessellation", "no queue"])]);
        assert!(
            text.contains("cannot run planish: no tessellation\n") && text.contains("cannot run planish: no queue\n")
        );
        assert!(!text.contains("can run planish\n"));
        assert!(describe(&[device(&[])]).contains("integrated\n   Vulkan  1.3.0\n   can run planish\n"));
    }

    #[test]
    fn no_device_is_said_so() {
        assert!(describe(&[]).starts_with("no Vulkan devices"));
    }
}
