//! Ctrl-C: the frame that is being made is given up, those that are made are written, and nothing is left half written. A second one
//! ends the process at once; files are renamed into place when they are whole, so even then none is cut.

use std::sync::atomic::{AtomicBool, Ordering};

use anyhow::{Context, Result};

static IS_REQUESTED: AtomicBool = AtomicBool::new(false);

/// Exit status of a process that was interrupted twice: 128 and the signal's number.
const INTERRUPTED: i32 = 130;

/// Listens from now on.
pub fn listen() -> Result<()> {
    let listening = ctrlc::set_handler(|| {
        if IS_REQUESTED.swap(true, Ordering::SeqCst) {
            std::process::exit(INTERRUPTED);
        }
    });
    listening.context("cannot listen for Ctrl-C")
}

/// Whether Ctrl-C was pressed.
pub fn is_requested() -> bool {
    IS_REQUESTED.load(Ordering::SeqCst)
}
