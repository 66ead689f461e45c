//! The whole coordinator in process: router, use cases, store on a temporary disk; the clock is moved by hand.

#![expect(clippy::unwrap_used, reason = "helpers of tests, outside of test functions")]

#[path = "service/bad_input.rs"]
mod bad_input;
#[path = "service/description.rs"]
mod description;
#[path = "service/discs.rs"]
mod discs;
#[path = "service/leases.rs"]
mod leases;
#[path = "service/model.rs"]
mod model;
#[path = "service/plastic.rs"]
mod plastic;
#[path = "service/sharing.rs"]
mod sharing;
#[path = "service/support.rs"]
mod support;
#[path = "service/sweeps.rs"]
mod sweeps;
