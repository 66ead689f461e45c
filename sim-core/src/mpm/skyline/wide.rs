//! The routines of [`plain`](super::plain) with four lanes of AVX2: the same operations, the same bits.

use super::{NotPositive, Profile, plain};

#[target_feature(enable = "avx2")]
pub(super) fn factorise(values: &mut [f64], profile: &Profile) -> Result<(), NotPositive> {
    plain::factorise(values, profile)
}

#[target_feature(enable = "avx2")]
pub(super) fn solve(values: &[f64], profile: &Profile, b: &mut [f64]) {
    plain::solve(values, profile, b);
}

#[target_feature(enable = "avx2")]
pub(super) fn compliance(values: &[f64], profile: &Profile, out: &mut Vec<f64>) {
    plain::compliance(values, profile, out);
}
