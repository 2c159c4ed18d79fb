//! Which way to compute with eight numbers at once this processor has, and the work that is done in it.

use super::lanes::{Lanes, Portable};

/// A way to compute with eight numbers at once.
#[derive(Clone, Copy, Debug)]
pub(super) enum Level {
    /// What every processor of the target has.
    Baseline,
    /// AVX2.
    #[cfg(target_arch = "x86_64")]
    Avx2(pulp::x86::V3),
}

/// Work to be done with eight numbers at once.
pub(super) trait InLanes {
    /// What it finds.
    type Output;
    /// Does it.
    fn run<L: Lanes>(self, lanes: L) -> Self::Output;
}

impl Level {
    /// The best that this processor has.
    pub(super) fn of_this_processor() -> Self {
        #[cfg(target_arch = "x86_64")]
        if let Some(avx2) = pulp::x86::V3::try_new() {
            return Self::Avx2(avx2);
        }
        Self::Baseline
    }

    /// Does some work.
    #[inline]
    pub(super) fn run<W: InLanes>(self, work: W) -> W::Output {
        match self {
            Self::Baseline => work.run(Portable),
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(avx2) => avx2.vectorize(InAvx2 { avx2, work }),
        }
    }
}

/// Work that is compiled for AVX2.
#[cfg(target_arch = "x86_64")]
struct InAvx2<W> {
    avx2: pulp::x86::V3,
    work: W,
}

#[cfg(target_arch = "x86_64")]
impl<W: InLanes> pulp::NullaryFnOnce for InAvx2<W> {
    type Output = W::Output;

    #[inline(always)]
    fn call(self) -> W::Output {
        self.work.run(self.avx2)
    }
}
