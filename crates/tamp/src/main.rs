//! The command line of Tamp.

fn main() {}
