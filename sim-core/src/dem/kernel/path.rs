//! Which compiled copy of the hot loops runs.

/// Which compiled copy of the hot loops runs; all give the same bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Path {
    /// One contact at a time.
    Plain,
    /// One contact at a time, fused multiply-add in hardware.
    #[cfg(target_arch = "x86_64")]
    PlainFma,
    /// A register full of contacts at a time.
    #[cfg(target_arch = "x86_64")]
    Avx2,
    /// The same with the registers of AVX-512.
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

impl Path {
    /// The fastest path of this machine, or its plain one.
    #[must_use]
    pub fn choose(choice: crate::KernelChoice) -> Self {
        #[cfg(target_arch = "x86_64")]
        {
            let fma = std::arch::is_x86_feature_detected!("fma");
            let vectors = fma && choice != crate::KernelChoice::Scalar;
            if vectors && choice != crate::KernelChoice::Avx2 && has_avx512() {
                return Self::Avx512;
            }
            if vectors && std::arch::is_x86_feature_detected!("avx2") {
                return Self::Avx2;
            }
            if fma {
                return Self::PlainFma;
            }
        }
        let _ = choice;
        Self::Plain
    }

    /// Part of the kernel name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Plain => "scalar",
            #[cfg(target_arch = "x86_64")]
            Self::PlainFma => "scalar",
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => "avx2",
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => "avx512",
        }
    }
}

/// Whether the machine has the parts of AVX-512 that the kernel uses.
#[cfg(target_arch = "x86_64")]
fn has_avx512() -> bool {
    std::arch::is_x86_feature_detected!("avx512f")
        && std::arch::is_x86_feature_detected!("avx512vl")
        && std::arch::is_x86_feature_detected!("avx512dq")
        && std::arch::is_x86_feature_detected!("avx512bw")
}
