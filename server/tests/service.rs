//! The whole coordinator in process: router, use cases, store on a temporary disk; the clock is moved by hand.

#[path = "service/bad_input.rs"]
mod bad_input;
#[path = "service/description.rs"]
mod description;
#[path = "service/leases.rs"]
mod leases;
#[path = "service/model.rs"]
mod model;
#[path = "service/sharing.rs"]
mod sharing;
#[path = "service/support.rs"]
mod support;
#[path = "service/sweeps.rs"]
mod sweeps;
