//! The curl tour of the README, executed line by line against a coordinator with a worker.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::lab::{Lab, PROGRAM};

/// Marks a block of the README that is part of the tour.
const MARK: &str = "<!-- tour -->";
/// The address the README uses.
const README_ADDRESS: &str = "http://127.0.0.1:8300";

/// The fenced `sh` blocks right after a mark, in order.
fn blocks(readme: &str) -> Vec<String> {
    readme
        .split(MARK)
        .skip(1)
        .filter_map(|rest| {
            let block = rest.trim_start().strip_prefix("```sh\n")?;
            Some(block[..block.find("```")?].to_owned())
        })
        .collect()
}

fn find(program: &str) -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    std::env::split_paths(&path).map(|folder| folder.join(program)).find(|file| file.is_file())
}

#[test]
fn every_line_of_the_tour_works() {
    let readme = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../README.md")).unwrap();
    let blocks = blocks(&readme);
    assert_eq!(blocks.len(), readme.matches(MARK).count(), "every mark is followed by a block of sh");
    assert!(!blocks.is_empty(), "the README has a tour");
    let (Some(curl), Some(bash)) = (find("curl"), find("bash")) else {
        let reason = format!("{} blocks of the tour need curl and bash, which are not here", blocks.len());
        assert!(std::env::var_os("TAMP_NO_SKIPS").is_none(), "{reason}");
        eprintln!("skipped: {reason}");
        return;
    };
    let lab = Lab::new();
    let _worker = lab.worker("worker");
    let bin = lab.path("bin");
    std::fs::create_dir(&bin).unwrap();
    // an answer that is an error is a failure of the tour
    script(&bin.join("curl"), &format!("exec {} --fail-with-body \"$@\"", curl.display()));
    script(&bin.join("tamp"), &format!("exec {PROGRAM} \"$@\""));
    let folder = lab.path("tour");
    std::fs::create_dir_all(folder.join("examples")).unwrap();

    let text = blocks.concat().replace(README_ADDRESS, lab.address());
    let tour = format!("set -euo pipefail\ntrap 'echo \"failed: $BASH_COMMAND\" >&2' ERR\n{text}");
    let search = format!("{}:{}", bin.display(), std::env::var("PATH").unwrap_or_default());
    let output = Command::new(bash)
        .args(["-c", &tour])
        .current_dir(&folder)
        .env("PATH", search)
        .output()
        .expect("bash starts");
    assert!(
        output.status.success(),
        "{}\n--- output\n{}",
        String::from_utf8_lossy(&output.stderr),
        String::from_utf8_lossy(&output.stdout)
    );
}

fn script(path: &Path, line: &str) {
    use std::os::unix::fs::PermissionsExt as _;
    std::fs::write(path, format!("#!/bin/sh\n{line}\n")).unwrap();
    std::fs::set_permissions(path, std::fs::Permissions::from_mode(0o755)).unwrap();
}

#[test]
fn only_marked_blocks_of_sh_are_part_of_the_tour() {
    let text =
        "a\n```sh\nnot this\n```\n<!-- tour -->\n```sh\ncurl 1\n```\n<!-- tour -->\n\n```sh\ncurl 2\n```\n";
    assert_eq!(blocks(text), ["curl 1\n", "curl 2\n"]);
}
