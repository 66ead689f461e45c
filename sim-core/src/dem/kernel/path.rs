//! Which compiled copy of the hot loops runs.

/// Which compiled copy of the hot loops runs; all give the same bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Path {
    /// One contact at a time.
    Plain,
    /// One contact at a time, fused multiply-add in hardware.
    #[cfg(target_arch = "x86_64")]
    PlainFma,
    /// Four contacts at a time.
    #[cfg(target_arch = "x86_64")]
    Avx2,
}

impl Path {
    /// The fastest path of this machine, or its plain one.
    #[must_use]
    pub fn choose(choice: crate::KernelChoice) -> Self {
        #[cfg(target_arch = "x86_64")]
        {
            let fma = std::arch::is_x86_feature_detected!("fma");
            if choice == crate::KernelChoice::Auto && fma && std::arch::is_x86_feature_detected!("avx2") {
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
        }
    }
}
