//! Many independent checks on all cores.

use std::num::NonZeroUsize;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

/// Checks every case, in order of their beginning, and panics with everything that any of them found wrong.
pub fn check_all<Case: Sync>(cases: &[Case], check: impl Fn(&Case) -> Result<(), String> + Sync) {
    let next = AtomicUsize::new(0);
    let failures = Mutex::new(Vec::new());
    let worker = || {
        while let Some(case) = cases.get(next.fetch_add(1, Ordering::Relaxed)) {
            if let Err(failure) = check(case) {
                failures.lock().expect("no other worker has panicked").push(failure);
            }
        }
    };
    let thread_count = thread::available_parallelism().map_or(1, NonZeroUsize::get).min(cases.len());
    thread::scope(|scope| {
        for _ in 0..thread_count {
            scope.spawn(worker);
        }
    });
    let failures = failures.into_inner().expect("no worker has panicked");
    assert!(failures.is_empty(), "{} of {} cases failed:\n{}", failures.len(), cases.len(), failures.join("\n"));
}
