//! `tamp`: see the library.

use std::process::ExitCode;

fn main() -> ExitCode {
    tamp::main()
}
