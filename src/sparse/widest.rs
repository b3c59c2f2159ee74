//! Loops compiled for several widths of vector registers, the widest that the processor has chosen at run time.

/// A loop over much data. `run` should be `#[inline(always)]`, so that each width gets a copy of its own.
pub trait Kernel {
    type Output;
    fn run(self) -> Self::Output;
}

/// Runs it with the widest vector registers that this processor has. Additions and products are those of the plain loop
/// in the same order, so the digits are the same on all.
pub fn on_widest<T: Kernel>(kernel: T) -> T::Output {
    #[cfg(target_arch = "x86_64")]
    {
        #[target_feature(enable = "avx512f")]
        fn avx512<T: Kernel>(kernel: T) -> T::Output {
            kernel.run()
        }
        #[target_feature(enable = "avx2")]
        fn avx2<T: Kernel>(kernel: T) -> T::Output {
            kernel.run()
        }
        if is_x86_feature_detected!("avx512f") {
            // SAFETY: the processor has just said that it can.
            return unsafe { avx512(kernel) };
        }
        if is_x86_feature_detected!("avx2") {
            // SAFETY: likewise.
            return unsafe { avx2(kernel) };
        }
    }
    kernel.run()
}
