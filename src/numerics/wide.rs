//! Loops in vectors as wide as the processor has.

/// Runs what is inlined into it in the widest vectors of the processor: those of x86-64-v3, where it has them. Nothing is rounded otherwise than without:
/// products are fused with sums only where the code says so.
///
/// A macro, since a function called from two places need not be inlined into either.
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
