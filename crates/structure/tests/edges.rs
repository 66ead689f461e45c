//! Who may depend on whom, and what belongs where (docs/architecture.md).

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use structure::{all_dependencies, code, direct_dependencies, files};

/// Packages of the workspace that a package may name directly.
const MAY_USE: &[(&str, &[&str])] = &[
    ("record", &[]),
    ("scene", &[]),
    ("structure", &[]),
    ("sim-core", &["record", "scene"]),
    ("analysis", &["record"]),
    ("protocol", &["record", "scene"]),
    ("server", &["analysis", "protocol", "record", "scene"]),
    ("worker", &["protocol", "record", "scene", "sim-core"]),
    ("tamp", &["analysis", "protocol", "record", "scene", "server", "sim-core", "worker"]),
    ("tamp-tests", &["analysis", "protocol", "record", "scene", "server", "sim-core", "tamp", "worker"]),
];

/// Packages that a package must never need, however indirectly.
const NEVER_NEEDS: &[(&str, &[&str])] = &[
    ("record", &["tokio", "sqlx", "axum", "reqwest", "rand"]),
    ("scene", &["tokio", "sqlx", "axum", "reqwest", "rand", "nalgebra"]),
    ("sim-core", &["tokio", "sqlx", "axum", "hyper", "reqwest", "protocol", "tracing"]),
    ("analysis", &["tokio", "sqlx", "axum", "hyper", "reqwest", "scene", "sim-core", "protocol"]),
    ("protocol", &["sqlx", "axum", "sim-core", "server", "worker"]),
    ("server", &["sim-core", "worker", "openssl", "native-tls"]),
    ("worker", &["server", "sqlx", "axum", "openssl", "native-tls"]),
];

#[test]
fn packages_use_only_what_the_design_allows() {
    let direct = direct_dependencies();
    let workspace: BTreeSet<&String> = direct.keys().collect();
    let ruled: BTreeSet<String> = MAY_USE.iter().map(|(package, _)| (*package).to_owned()).collect();
    assert_eq!(workspace, ruled.iter().collect(), "every package of the workspace has a rule here");
    for (package, allowed) in MAY_USE {
        for used in direct[*package].iter().filter(|used| workspace.contains(used)) {
            assert!(allowed.contains(&used.as_str()), "{package} must not depend on {used}");
        }
    }
}

#[test]
fn packages_never_need_what_the_design_forbids() {
    for (package, forbidden) in NEVER_NEEDS {
        let needed = all_dependencies(package);
        assert!(needed.len() > 3, "{package}: the dependencies were not found");
        for name in *forbidden {
            assert!(!needed.contains(*name), "{package} must not need {name}, not even indirectly");
        }
    }
}

/// Lines of code below `folder` that hold one of `words`, except in files for which `exempt` holds.
fn lines_with(folder: &str, words: &[&str], exempt: impl Fn(&Path) -> bool) -> Vec<String> {
    let searched: Vec<PathBuf> = files(folder, "rs").into_iter().filter(|path| !exempt(path)).collect();
    let mut found = Vec::new();
    for path in searched {
        for (number, line) in code(&path).lines().enumerate() {
            let folded = line.to_lowercase();
            if let Some(word) = words.iter().find(|word| line.contains(**word) || folded.contains(**word)) {
                found.push(format!("{}:{}: {word}", path.display(), number + 1));
            }
        }
    }
    found
}

fn is_in(path: &Path, module: &str) -> bool {
    path.starts_with(module) || path == Path::new(&format!("{module}.rs"))
}

#[test]
fn sql_is_spoken_only_in_the_store() {
    let words = ["sqlx::", "insert into ", "delete from ", "create table ", "on conflict", "pragma "];
    // This package names the words it looks for.
    let store = |path: &Path| is_in(path, "server/src/store") || path.starts_with("crates/structure");
    for folder in ["server/src", "worker/src", "sim-core/src", "crates"] {
        assert_eq!(lines_with(folder, &words, store), Vec::<String>::new());
    }
}

#[test]
fn status_codes_are_known_only_at_the_edge() {
    let edge = |path: &Path| is_in(path, "server/src/api");
    assert_eq!(lines_with("server/src", &["StatusCode", "IntoResponse"], edge), Vec::<String>::new());
}

#[test]
fn the_physics_knows_no_clock_and_no_fixed_machine() {
    let words = [
        "SystemTime",
        "Instant::",
        "thread_rng",
        "StdRng",
        "SmallRng",
        "HashMap",
        "HashSet",
        "std::net",
        "std::fs",
    ];
    assert_eq!(lines_with("sim-core/src", &words, |_| false), Vec::<String>::new());
}

#[test]
fn simulations_take_transcendental_functions_from_libm() {
    // std's come from the platform and may differ in the last bit between machines.
    let words = [
        ".exp()",
        ".ln()",
        ".log10()",
        ".sin()",
        ".cos()",
        ".tan()",
        ".sin_cos()",
        ".acos()",
        ".asin()",
        ".atan()",
        ".atan2(",
        ".powf(",
        ".cbrt()",
        ".hypot(",
        ".tanh()",
    ];
    let elsewhere = |_: &Path| false;
    assert_eq!(lines_with("sim-core/src", &words, elsewhere), Vec::<String>::new());
    assert_eq!(lines_with("crates/scene/src", &words, elsewhere), Vec::<String>::new());
}

#[test]
fn code_left_out_of_a_search_is_really_left_out() {
    let this = code(Path::new("crates/structure/src/lib.rs"));
    assert!(!this.contains("Root of the workspace"), "comments are left out");
    assert!(this.contains("pub fn root()"));
}
