//! The disc engine against closed forms, an oracle and itself.

#![expect(clippy::unwrap_used, reason = "a test may panic")]
#![expect(clippy::needless_range_loop, reason = "components of small vectors are addressed by axis")]

mod drag;
mod elastic;
mod lattice;
mod pair;
mod run;
mod same_bits;
mod support;
