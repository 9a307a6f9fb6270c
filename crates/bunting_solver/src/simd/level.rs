//! The instruction set of the kernels: the best one that the machine has.

use core::cell::Cell;

use fearless_simd::Level;

std::thread_local! {
    /// Instruction set that replaces the best one for this thread's kernels; tests set it.
    static CHOSEN: Cell<Option<Level>> = const { Cell::new(None) };
}

/// The instruction set for this thread's kernels.
pub(crate) fn level() -> Level {
    CHOSEN.get().unwrap_or_else(Level::new)
}

/// Whether an instruction set has a fused multiply-add, which rounds a sum with a product once. Where it has none, the
/// product is rounded, too: once in software takes fifty times as long.
#[inline(always)]
pub(crate) fn fuses(level: Level) -> bool {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    {
        matches!(level, Level::Avx2(_) | Level::Avx512(_))
    }
    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
    {
        let _ = level;
        cfg!(target_arch = "aarch64")
    }
}

/// Whether this thread's kernels have a fused multiply-add: those that have agree to the bit, and so do those that have
/// not.
#[doc(hidden)]
#[must_use]
pub fn has_fused_products() -> bool {
    fuses(level())
}

/// Whether this thread's kernels use AVX-512.
pub(crate) fn has_avx512() -> bool {
    #[cfg(target_arch = "x86_64")]
    {
        matches!(level(), Level::Avx512(_))
    }
    #[cfg(not(target_arch = "x86_64"))]
    {
        false
    }
}

/// Evaluates an expression with the token of this thread's instruction set, compiled for that set.
///
/// Code for SSE2 also runs on SSE4.2 machines: each further set adds about a fifth to this crate's compile time.
macro_rules! dispatch {
    ($token:pat => $work:expr) => {{
        #[cfg(target_arch = "x86_64")]
        {
            use fearless_simd::{Level, Simd};
            macro_rules! compiled_for {
                ($set:expr) => {{
                    let set = $set;
                    set.vectorize(
                        #[inline(always)]
                        || {
                            let $token = set;
                            $work
                        },
                    )
                }};
            }
            match $crate::simd::level::level() {
                Level::Avx512(set) => compiled_for!(set),
                Level::Avx2(set) => compiled_for!(set),
                set => compiled_for!(set.as_sse2().expect("SSE2 is part of x86-64")),
            }
        }
        #[cfg(not(target_arch = "x86_64"))]
        fearless_simd::dispatch!($crate::simd::level::level(), $token => $work)
    }};
}
pub(crate) use dispatch;

/// Name of the instruction set of this machine's kernels, for reports.
#[must_use]
pub fn instruction_set() -> &'static str {
    match level() {
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        Level::Avx512(_) => "AVX-512",
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        Level::Avx2(_) => "AVX2",
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        Level::Sse2(_) | Level::Sse4_2(_) => "SSE2",
        #[cfg(target_arch = "aarch64")]
        Level::Neon(_) => "NEON",
        #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
        Level::WasmSimd128(_) => "SIMD128",
        _ => "scalar",
    }
}

/// Calls `work` on this thread with each instruction set that the machine has, the best first, and returns
/// the results in that order. For tests of independence from the instruction set.
#[doc(hidden)]
pub fn with_every_instruction_set<T>(mut work: impl FnMut() -> T) -> Vec<T> {
    let results = levels().into_iter().map(|level| {
        CHOSEN.set(Some(level));
        work()
    });
    let results = results.collect();
    CHOSEN.set(None);
    results
}

/// The instruction sets of this machine, the best first.
fn levels() -> Vec<Level> {
    let best = Level::new();
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    {
        use fearless_simd::Simd;
        let all = [
            best.as_avx512().map(Simd::level),
            best.as_avx2().map(Simd::level),
            best.as_sse2().map(Simd::level),
        ];
        all.into_iter().flatten().collect()
    }
    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
    {
        vec![best]
    }
}
