use planish_gpu::{Device, DeviceOptions, Error, HIDE_FEATURE_VARIABLE, Instance};
use std::process::Command;

#[test]
fn the_chosen_device_is_in_the_list_and_is_not_refused() {
    let instance = Instance::new(false).unwrap();
    let device = Device::new(&instance, &DeviceOptions::default()).unwrap();
    let reports = instance.devices().unwrap();
    let report = reports.iter().find(|report| report.name == device.name()).unwrap();
    assert!(report.refusals.is_empty());
    assert_eq!((&*report.driver, report.kind), (device.driver(), device.kind()));
    let by_index = DeviceOptions { selector: Some(report.index.to_string()), ..DeviceOptions::default() };
    assert_eq!(Device::new(&instance, &by_index).unwrap().name(), device.name());
}

#[test]
fn a_device_that_is_not_there_is_an_error_that_lists_those_that_are() {
    let selector = Some("no such GPU".to_owned());
    let error = Device::open(&DeviceOptions { selector, ..DeviceOptions::default() }).err().unwrap();
    assert!(error.to_string().starts_with("device \"no such GPU\" cannot be used: [0] "), "{error}");
}

/// Runs itself again with the variable set, as a process cannot safely change its own environment.
#[test]
fn a_device_without_tessellation_shaders_is_refused_by_that_name() {
    const NAME: &str = "refusal::a_device_without_tessellation_shaders_is_refused_by_that_name";
    if std::env::var(HIDE_FEATURE_VARIABLE).as_deref() != Ok("tessellationShader") {
        let this = std::env::current_exe().unwrap();
        let output = Command::new(this)
            .args(["--exact", NAME])
            .env(HIDE_FEATURE_VARIABLE, "tessellationShader")
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stdout));
        assert!(String::from_utf8_lossy(&output.stdout).contains("1 passed"));
        return;
    }
    for report in Instance::new(false).unwrap().devices().unwrap() {
        assert!(report.refusals.iter().any(|reason| reason == "tessellationShader is not supported"));
    }
    let error = Device::open(&DeviceOptions::default()).err().unwrap();
    assert!(matches!(error, Error::NoSuitableDevice { .. }), "{error}");
    assert!(error.to_string().contains("tessellationShader is not supported"), "{error}");
}
