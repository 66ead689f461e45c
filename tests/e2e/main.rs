//! End to end: real processes, real HTTP, a real database; every test waits on conditions and has a folder and
//! ports of its own.

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
