//! What the bundles that fill a register have in common. Macros, because the instructions differ in name alone; no closures,
//! which are not always inlined into a caller with the features.

/// The operations of [`super::Lane`] that are one instruction each, for a bundle around a register.
macro_rules! one_instruction_each {
    (
        $add:ident, $sub:ident, $mul:ident, $div:ident, $mul_add:ident, $neg_mul_add:ident, $sqrt:ident, $max:ident, $min:ident,
        $load:ident, $store:ident
    ) => {
        #[inline(always)]
        fn add(self, other: Self) -> Self {
            // SAFETY: a bundle exists only where its instructions were detected; so for every method below.
            Self(unsafe { $add(self.0, other.0) })
        }
        #[inline(always)]
        fn sub(self, other: Self) -> Self {
            // SAFETY: see `add`.
            Self(unsafe { $sub(self.0, other.0) })
        }
        #[inline(always)]
        fn mul(self, other: Self) -> Self {
            // SAFETY: see `add`.
            Self(unsafe { $mul(self.0, other.0) })
        }
        #[inline(always)]
        fn div(self, other: Self) -> Self {
            // SAFETY: see `add`.
            Self(unsafe { $div(self.0, other.0) })
        }
        #[inline(always)]
        fn mul_add(self, factor: Self, addend: Self) -> Self {
            // SAFETY: see `add`.
            Self(unsafe { $mul_add(self.0, factor.0, addend.0) })
        }
        #[inline(always)]
        fn neg_mul_add(self, factor: Self, addend: Self) -> Self {
            // SAFETY: see `add`.
            Self(unsafe { $neg_mul_add(self.0, factor.0, addend.0) })
        }
        #[inline(always)]
        fn sqrt(self) -> Self {
            // SAFETY: see `add`.
            Self(unsafe { $sqrt(self.0) })
        }
        #[inline(always)]
        fn max(self, other: Self) -> Self {
            // SAFETY: see `add`.
            Self(unsafe { $max(self.0, other.0) })
        }
        #[inline(always)]
        fn min(self, other: Self) -> Self {
            // SAFETY: see `add`.
            Self(unsafe { $min(self.0, other.0) })
        }
        #[inline(always)]
        unsafe fn load(from: *const Self::Scalar) -> Self {
            // SAFETY: the caller vouches for `WIDTH` readable numbers.
            Self(unsafe { $load(from) })
        }
        #[inline(always)]
        unsafe fn store(self, to: *mut Self::Scalar) {
            // SAFETY: the caller vouches for `WIDTH` writable numbers.
            unsafe { $store(to, self.0) }
        }
    };
}

/// [`super::Widen`] for a bundle of doubles: it is wide already.
macro_rules! wide_already {
    ($bundle:ty) => {
        impl Widen for $bundle {
            type Wide = Self;

            #[inline(always)]
            fn narrow(wide: Self) -> Self {
                wide
            }
            #[inline(always)]
            fn widen(self) -> Self {
                self
            }
            #[inline(always)]
            fn gauge(square: Self, _: Self, _: Self) -> [Self; 2] {
                [square; 2]
            }
            #[inline(always)]
            fn meet([square, _]: [Self; 2], radius_a: Self, radius_b: Self) -> [Self; 2] {
                let reach = radius_a.add(radius_b);
                let (distance, inverse_square) = (square.sqrt(), Self::splat(1.0).div(square));
                [reach.sub(distance), distance.mul(inverse_square)]
            }
        }
    };
}

pub(super) use {one_instruction_each, wide_already};
