//! Loops in the widest vector registers of the processor.

/// Runs inlined code in the widest vectors of the processor: x86-64-v3 if available. Rounding does not change: products
/// and sums are fused only where the code requires it.
///
/// This is a macro because a function called from two places may not be inlined into either.
macro_rules! wide {
    ($loops:expr) => {{
        #[cfg(target_arch = "x86_64")]
        if let pulp::x86::Arch::V3(v3) = pulp::x86::Arch::new() {
            v3.vectorize(|| $loops)
        } else {
            $loops
        }
        #[cfg(not(target_arch = "x86_64"))]
        $loops
    }};
}
pub(crate) use wide;
