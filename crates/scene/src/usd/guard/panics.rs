//! Panics of the crate, and the stack that it runs on.
use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::sync::Once;
use std::thread;

/// Room for what recurses as deep as the guard lets a layer nest, whoever calls: 400 times 600 KiB. It is reserved, not used.
const STACK_BYTES: usize = 256 << 20;

thread_local! {
    static IS_GUARDED: Cell<bool> = const { Cell::new(false) };
}

/// Runs what may recurse and panic on malformed files on a thread of its own; none if it did panic.
pub fn apart<T: Send>(read: impl FnOnce() -> T + Send) -> Option<T> {
    thread::scope(|scope| {
        let builder = thread::Builder::new().name("usd".into()).stack_size(STACK_BYTES);
        let thread = builder.spawn_scoped(scope, || silent(read)).ok()?;
        thread.join().ok().flatten()
    })
}

/// Runs what may panic; none if it did. Nothing is printed then: other threads' panics are told as ever.
pub fn silent<T>(read: impl FnOnce() -> T) -> Option<T> {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let before = take_hook();
        set_hook(Box::new(move |panic| {
            if !IS_GUARDED.get() {
                before(panic);
            }
        }));
    });
    let outer = IS_GUARDED.replace(true);
    // Nothing of what was being read outlives this call.
    let result = catch_unwind(AssertUnwindSafe(read)).ok();
    IS_GUARDED.set(outer);
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_caught_and_the_next_call_runs() {
        assert_eq!(apart(|| -> u32 { panic!("malformed") }), None);
        assert_eq!(apart(|| 3), Some(3));
    }
}
