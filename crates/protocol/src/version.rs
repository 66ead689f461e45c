//! The protocol between worker and coordinator.

/// Version of the worker protocol; the coordinator answers 426 to a worker outside its accepted range.
pub const PROTOCOL_VERSION: u32 = 1;
