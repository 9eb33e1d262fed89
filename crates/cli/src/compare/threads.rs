//! Work on all cores.

use std::num::NonZeroUsize;
use std::panic::resume_unwind;
use std::thread::{available_parallelism, scope};

/// What `work` makes of each item, in the items' order.
pub fn map_on_all_cores<Item: Sync, Made: Send>(items: &[Item], work: impl Fn(&Item) -> Made + Sync) -> Vec<Made> {
    let thread_count = available_parallelism().map_or(1, NonZeroUsize::get);
    let part_length = items.len().div_ceil(thread_count).max(1);
    let work = &work;
    scope(|scope| {
        let parts =
            items.chunks(part_length).map(|part| scope.spawn(move || part.iter().map(work).collect::<Vec<_>>()));
        let parts: Vec<_> = parts.collect();
        parts.into_iter().flat_map(|part| part.join().unwrap_or_else(|panic| resume_unwind(panic))).collect()
    })
}
