//! The source tree as tests see it: where it is, its files, its packages and the edges between them.
//!
//! A package of its own with next to no dependencies, so that these tests run in seconds.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

/// Root of the workspace.
#[must_use]
pub fn root() -> PathBuf {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    package.ancestors().nth(2).expect("the package lies in crates/structure").to_path_buf()
}

/// Every file below `folder` (relative to the root) that ends in `.extension`, as paths relative to the root, sorted.
#[must_use]
pub fn files(folder: &str, extension: &str) -> Vec<PathBuf> {
    fn walk(folder: &Path, extension: &str, found: &mut Vec<PathBuf>) {
        let Ok(entries) = std::fs::read_dir(folder) else { return };
        for entry in entries.filter_map(Result::ok) {
            let path = entry.path();
            if path.is_dir() {
                if path.file_name().is_some_and(|name| name != "target") {
                    walk(&path, extension, found);
                }
            } else if path.extension().is_some_and(|found| found == extension) {
                found.push(path);
            }
        }
    }
    let mut found = Vec::new();
    walk(&root().join(folder), extension, &mut found);
    let mut relative: Vec<PathBuf> = found
        .into_iter()
        .map(|path| path.strip_prefix(root()).expect("found below the root").to_path_buf())
        .collect();
    relative.sort();
    relative
}

/// The text of a file of the workspace.
///
/// # Panics
/// When there is no such file.
#[must_use]
pub fn read(path: impl AsRef<Path>) -> String {
    let full = root().join(path.as_ref());
    std::fs::read_to_string(&full).unwrap_or_else(|error| panic!("{}: {error}", full.display()))
}

/// The code of a Rust file: unit tests at its end and comments are left out.
#[must_use]
pub fn code(path: &Path) -> String {
    let text = read(path);
    let until_tests = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
    until_tests
        .lines()
        .map(|line| match line.trim_start() {
            comment if comment.starts_with("//") => "",
            _ => line,
        })
        .collect::<Vec<_>>()
        .join("\n")
}

/// The packages of the workspace with their direct dependencies by name, development dependencies left out.
///
/// # Panics
/// When `cargo metadata` fails.
#[must_use]
pub fn direct_dependencies() -> BTreeMap<String, BTreeSet<String>> {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--no-deps", "--format-version", "1", "--offline"])
        .current_dir(root())
        .output()
        .expect("cargo runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let metadata: Value = serde_json::from_slice(&output.stdout).expect("cargo metadata is JSON");
    let packages = metadata["packages"].as_array().expect("packages");
    packages
        .iter()
        .map(|package| {
            let dependencies = package["dependencies"].as_array().expect("dependencies");
            let normal = dependencies.iter().filter(|edge| edge["kind"] != "dev");
            (text(&package["name"]), normal.map(|edge| text(&edge["name"])).collect())
        })
        .collect()
}

/// What the lock file says each package needs, by name (all platforms; versions of one name are joined).
#[must_use]
pub fn locked_dependencies() -> BTreeMap<String, BTreeSet<String>> {
    let mut needs: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for package in read("Cargo.lock").split("[[package]]").skip(1) {
        let quoted = |line: &str| line.split('"').nth(1).unwrap_or_default().to_owned();
        let name = package.lines().find(|line| line.starts_with("name = ")).map(quoted).unwrap_or_default();
        let listed = package.lines().filter(|line| line.starts_with(" \""));
        let of_package = listed.map(|line| quoted(line).split(' ').next().unwrap_or_default().to_owned());
        needs.entry(name).or_default().extend(of_package);
    }
    needs
}

/// Every package that `package` needs, directly or through others, at run or build time.
#[must_use]
pub fn all_dependencies(package: &str) -> BTreeSet<String> {
    let direct = direct_dependencies();
    let locked = locked_dependencies();
    let mut found = BTreeSet::new();
    let mut open = vec![package.to_owned()];
    while let Some(name) = open.pop() {
        // For packages of the workspace the lock file would add their development dependencies.
        let needs = direct.get(&name).or_else(|| locked.get(&name));
        for needed in needs.into_iter().flatten() {
            if found.insert(needed.clone()) {
                open.push(needed.clone());
            }
        }
    }
    found
}

fn text(value: &Value) -> String {
    value.as_str().expect("a text").to_owned()
}
