//! The `tamp` program, so that the end-to-end tests always start the one that was built with them.

use std::process::ExitCode;

fn main() -> ExitCode {
    tamp::main()
}
