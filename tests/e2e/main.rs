//! End to end: real processes, real HTTP, a real database; every test waits on conditions and has a folder and
//! ports of its own.

#![expect(clippy::unwrap_used, reason = "a test that cannot set up its lab has failed")]
#![expect(clippy::result_large_err, reason = "the last state seen is the message of a wait that ran out")]

mod cancel;
mod commands;
mod coordinator_away;
mod equal_scenes;
mod kill_worker;
mod lab;
mod scenes;
mod stale_result;
mod study;
mod submit_to_result;
mod tour;
mod wait;
