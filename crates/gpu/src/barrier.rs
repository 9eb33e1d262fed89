//! Which barrier a pass needs, derived from what kinds of passes came before it.

use ash::vk::{AccessFlags2 as Access, PipelineStageFlags2 as Stages};

/// What a pass does, as far as its barriers are concerned.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum PassKind {
    /// Copies and fills.
    Transfer,
    /// Compute shaders, dispatched directly or indirectly.
    Compute,
    /// Drawing into images.
    Draw,
    /// Drawing into transform feedback buffers.
    TransformFeedback,
    /// The CPU, after the submission: what the GPU wrote can be read.
    Host,
}

impl PassKind {
    const ALL: [Self; 5] = [Self::Transfer, Self::Compute, Self::Draw, Self::TransformFeedback, Self::Host];

    /// The stages in which such a pass touches memory.
    fn stages(self) -> Stages {
        let shaders =
            Stages::VERTEX_SHADER | Stages::TESSELLATION_CONTROL_SHADER | Stages::TESSELLATION_EVALUATION_SHADER;
        match self {
            Self::Transfer => Stages::ALL_TRANSFER,
            Self::Compute => Stages::DRAW_INDIRECT | Stages::COMPUTE_SHADER,
            Self::Draw => {
                Stages::DRAW_INDIRECT
                    | shaders
                    | Stages::FRAGMENT_SHADER
                    | Stages::EARLY_FRAGMENT_TESTS
                    | Stages::LATE_FRAGMENT_TESTS
                    | Stages::COLOR_ATTACHMENT_OUTPUT
            }
            Self::TransformFeedback => Stages::DRAW_INDIRECT | shaders | Stages::TRANSFORM_FEEDBACK_EXT,
            Self::Host => Stages::HOST,
        }
    }

    fn reads(self) -> Access {
        match self {
            Self::Transfer => Access::TRANSFER_READ,
            Self::Compute => Access::INDIRECT_COMMAND_READ | Access::SHADER_STORAGE_READ,
            Self::Draw => {
                Access::INDIRECT_COMMAND_READ
                    | Access::SHADER_STORAGE_READ
                    | Access::COLOR_ATTACHMENT_READ
                    | Access::DEPTH_STENCIL_ATTACHMENT_READ
            }
            Self::TransformFeedback => {
                Access::INDIRECT_COMMAND_READ
                    | Access::SHADER_STORAGE_READ
                    | Access::TRANSFORM_FEEDBACK_COUNTER_READ_EXT
            }
            Self::Host => Access::HOST_READ,
        }
    }

    fn writes(self) -> Access {
        match self {
            Self::Transfer => Access::TRANSFER_WRITE,
            Self::Compute => Access::SHADER_STORAGE_WRITE,
            Self::Draw => {
                Access::SHADER_STORAGE_WRITE | Access::COLOR_ATTACHMENT_WRITE | Access::DEPTH_STENCIL_ATTACHMENT_WRITE
            }
            Self::TransformFeedback => {
                Access::SHADER_STORAGE_WRITE
                    | Access::TRANSFORM_FEEDBACK_WRITE_EXT
                    | Access::TRANSFORM_FEEDBACK_COUNTER_WRITE_EXT
            }
            // Submitting makes the CPU's writes visible without a barrier.
            Self::Host => Access::NONE,
        }
    }
}

/// A set of kinds of passes: bit `1 << kind`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
struct PassSet(u8);

impl PassSet {
    fn insert(&mut self, kind: PassKind) {
        self.0 |= 1 << kind as u8;
    }

    fn iter(self) -> impl Iterator<Item = PassKind> {
        PassKind::ALL.into_iter().filter(move |&kind| self.0 & (1 << kind as u8) != 0)
    }
}

/// The masks of one global memory barrier.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Barrier {
    pub(crate) from_stages: Stages,
    pub(crate) from_access: Access,
    pub(crate) to_stages: Stages,
    pub(crate) to_access: Access,
}

/// Waits for every pass of `before` and makes its writes visible to a pass of kind `next`.
fn barrier(before: PassSet, next: PassKind) -> Barrier {
    Barrier {
        from_stages: before.iter().fold(Stages::NONE, |stages, kind| stages | kind.stages()),
        from_access: before.iter().fold(Access::NONE, |access, kind| access | kind.writes()),
        to_stages: next.stages(),
        to_access: next.reads() | next.writes(),
    }
}

/// Remembers, for every kind of pass, what was recorded since a barrier last led to that kind.
/// A pass therefore waits for exactly those passes that nothing has made it wait for yet.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct PassOrder {
    /// By the kind that would have to wait.
    unordered: [PassSet; PassKind::ALL.len()],
    last: Option<PassKind>,
}

impl PassOrder {
    /// Opens a pass that may depend on everything before it.
    pub(crate) fn open(&mut self, kind: PassKind) -> Option<Barrier> {
        let before = std::mem::take(&mut self.unordered[kind as usize]);
        for set in &mut self.unordered {
            set.insert(kind);
        }
        self.last = Some(kind);
        (before != PassSet::default()).then(|| barrier(before, kind))
    }

    /// Opens a pass that does not depend on the one before if that is of the same kind: it joins it, since what
    /// that one waited for has been waited for.
    pub(crate) fn join(&mut self, kind: PassKind) -> Option<Barrier> {
        if self.last == Some(kind) { None } else { self.open(kind) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use PassKind::{Compute, Draw, Host, Transfer, TransformFeedback};

    /// The barrier before the last of a row of passes.
    fn last_barrier(passes: &[PassKind]) -> Option<Barrier> {
        let mut order = PassOrder::default();
        passes.iter().map(|&kind| order.open(kind)).last().flatten()
    }

    #[test]
    fn the_first_pass_needs_no_barrier() {
        for kind in PassKind::ALL {
            assert_eq!(last_barrier(&[kind]), None);
        }
    }

    #[test]
    fn each_pair_of_passes_has_the_barrier_of_the_table() {
        let compute_to_draw = last_barrier(&[Compute, Draw]).unwrap();
        assert_eq!(compute_to_draw.from_stages, Stages::DRAW_INDIRECT | Stages::COMPUTE_SHADER);
        assert_eq!(compute_to_draw.from_access, Access::SHADER_STORAGE_WRITE);
        assert!(compute_to_draw.to_stages.contains(Stages::DRAW_INDIRECT | Stages::TESSELLATION_CONTROL_SHADER));
        assert!(compute_to_draw.to_access.contains(Access::INDIRECT_COMMAND_READ | Access::SHADER_STORAGE_READ));

        let table = [
            (Transfer, Compute, Access::TRANSFER_WRITE, Access::SHADER_STORAGE_READ),
            (Compute, Compute, Access::SHADER_STORAGE_WRITE, Access::INDIRECT_COMMAND_READ),
            (Compute, Host, Access::SHADER_STORAGE_WRITE, Access::HOST_READ),
            (Draw, Transfer, Access::COLOR_ATTACHMENT_WRITE, Access::TRANSFER_READ),
            (Draw, Draw, Access::DEPTH_STENCIL_ATTACHMENT_WRITE, Access::DEPTH_STENCIL_ATTACHMENT_READ),
            (Draw, Compute, Access::SHADER_STORAGE_WRITE, Access::SHADER_STORAGE_WRITE),
            (TransformFeedback, Transfer, Access::TRANSFORM_FEEDBACK_COUNTER_WRITE_EXT, Access::TRANSFER_READ),
            (TransformFeedback, Host, Access::TRANSFORM_FEEDBACK_WRITE_EXT, Access::HOST_READ),
            (
                TransformFeedback,
                TransformFeedback,
                Access::TRANSFORM_FEEDBACK_COUNTER_WRITE_EXT,
                Access::TRANSFORM_FEEDBACK_COUNTER_READ_EXT,
            ),
        ];
        for (before, next, from_access, to_access) in table {
            let barrier = last_barrier(&[before, next]).unwrap();
            assert!(barrier.from_access.contains(from_access), "{before:?} -> {next:?}: {barrier:?}");
            assert!(barrier.to_access.contains(to_access), "{before:?} -> {next:?}: {barrier:?}");
            assert_eq!((barrier.from_stages, barrier.to_stages), (before.stages(), next.stages()));
        }
    }

    #[test]
    fn only_writes_are_waited_for_and_reads_only_delay_writes() {
        for before in PassKind::ALL {
            for next in PassKind::ALL {
                let barrier = last_barrier(&[before, next]).unwrap();
                assert!(!barrier.from_access.intersects(Access::TRANSFER_READ | Access::SHADER_STORAGE_READ));
                assert!(!barrier.from_access.intersects(Access::INDIRECT_COMMAND_READ | Access::HOST_READ));
            }
        }
    }

    #[test]
    fn a_pass_waits_for_all_kinds_since_its_last_barrier() {
        let waits = last_barrier(&[Transfer, Compute, Draw]).unwrap();
        assert_eq!(waits.from_stages, Transfer.stages() | Compute.stages());
        assert_eq!(waits.from_access, Access::TRANSFER_WRITE | Access::SHADER_STORAGE_WRITE);
        // The second compute pass already waited for the transfer.
        assert_eq!(last_barrier(&[Transfer, Compute, Compute]).unwrap().from_stages, Compute.stages());
        // The copy before the first of two draws is not waited for twice.
        assert_eq!(
            last_barrier(&[Transfer, Draw, Compute, Draw]).unwrap().from_stages,
            Draw.stages() | Compute.stages()
        );
    }

    #[test]
    fn joining_adds_a_barrier_only_after_another_kind() {
        let mut order = PassOrder::default();
        assert_eq!(order.join(Compute), None);
        assert_eq!(order.join(Compute), None);
        assert!(order.open(Transfer).is_some());
        assert!(order.join(Compute).is_some());
        assert_eq!(order.join(Compute), None);
        assert!(order.open(Compute).is_some());
    }
}
