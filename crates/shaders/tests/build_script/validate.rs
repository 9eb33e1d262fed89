use std::fs;
use std::io::ErrorKind;
use std::process::Command;

use tempfile::TempDir;

use crate::fixtures;

/// Runs Khronos' validator on a module; panics with its message, or when it is not installed.
fn assert_valid(name: &str, words: &[u32]) {
    let folder = TempDir::new().expect("a temporary folder");
    let file = folder.path().join(format!("{name}.spv"));
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    fs::write(&file, bytes).expect("a file");
    let run =
        Command::new("spirv-val").args(["--target-env", "vulkan1.3", "--scalar-block-layout"]).arg(&file).output();
    match run {
        Ok(output) => assert!(output.status.success(), "{name}: {}", String::from_utf8_lossy(&output.stderr)),
        Err(error) if error.kind() == ErrorKind::NotFound => {
            panic!("spirv-val is not installed; this test needs it (Debian: apt install spirv-tools)")
        }
        Err(error) => panic!("spirv-val could not be run: {error}"),
    }
}

#[test]
fn every_shipped_module_is_valid_for_vulkan_1_3() {
    for module in planish_shaders::MODULES {
        assert_valid(module.name, module.spirv);
    }
}

#[test]
fn every_fixture_is_valid_for_vulkan_1_3() {
    for module in fixtures() {
        assert_valid(&module.name, &module.words);
    }
}

#[test]
#[should_panic(expected = "broken: ")]
fn the_validator_rejects_a_broken_module() {
    let mut words = fixtures().remove(0).words;
    words.pop();
    assert_valid("broken", &words);
}
