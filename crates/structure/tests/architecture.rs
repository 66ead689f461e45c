//! `docs/architecture.md` lists every module of every package with the first line of its documentation.

use std::fmt::Write;
use std::path::Path;

use structure::{files, read, root};

const BEGIN: &str = "<!-- modules: generated, run `TAMP_BLESS=1 cargo test -p structure` -->\n";
const END: &str = "<!-- end of modules -->";

/// Source folders, in the order of the document.
const PACKAGES: [&str; 8] = [
    "crates/record",
    "crates/scene",
    "sim-core",
    "crates/analysis",
    "crates/protocol",
    "server",
    "worker",
    "crates/tamp",
];

/// The first sentence of a file's documentation.
fn summary(path: &Path) -> String {
    let text = read(path);
    let lines = text.lines().skip_while(|line| !line.starts_with("//!"));
    let paragraph: Vec<&str> = lines
        .map_while(|line| line.strip_prefix("//!"))
        .map(str::trim)
        .take_while(|line| !line.is_empty())
        .collect();
    let joined = paragraph.join(" ");
    // A full stop ends a sentence when a capital follows: "eqs. (30)" goes on.
    let ends = joined.match_indices(". ").map(|(place, _)| place);
    let end = ends
        .filter(|place| joined[place + 2..].starts_with(char::is_uppercase))
        .min()
        .map_or(joined.len(), |place| place + 1);
    joined[..end].trim_end_matches('.').replace('|', "\\|")
}

/// The list: packages, and their modules of the first level.
fn modules() -> String {
    let mut list = String::new();
    for package in PACKAGES {
        let source = format!("{package}/src");
        let root_file = ["lib.rs", "main.rs"]
            .map(|name| Path::new(&source).join(name))
            .into_iter()
            .find(|path| root().join(path).exists())
            .expect("a package has a root");
        let _ = write!(list, "\n### `{package}`\n\n{}.\n\n", summary(&root_file));
        for path in files(&source, "rs") {
            let inside = path.strip_prefix(&source).expect("found below the source folder");
            let name = inside.to_string_lossy();
            let is_first_level = inside.components().count() == 1;
            if is_first_level && !["lib.rs", "main.rs"].contains(&name.as_ref()) {
                let _ = writeln!(list, "- `{}`: {}", name.trim_end_matches(".rs"), summary(&path));
            }
        }
    }
    list
}

#[test]
fn the_module_list_matches_the_tree() {
    let page = read("docs/architecture.md");
    let (before, rest) = page.split_once(BEGIN).expect("the page has a list of modules");
    let (list, after) = rest.split_once(END).expect("the list of modules ends");
    let generated = modules();
    if std::env::var_os("TAMP_BLESS").is_some() {
        let renewed = format!("{before}{BEGIN}{generated}\n{END}{after}");
        std::fs::write(root().join("docs/architecture.md"), renewed).expect("the page can be written");
        return;
    }
    assert!(
        list.trim() == generated.trim(),
        "docs/architecture.md is stale: run `TAMP_BLESS=1 cargo test -p structure`"
    );
}

#[test]
fn every_module_says_what_it_is() {
    for package in PACKAGES {
        for path in
            files(&format!("{package}/src"), "rs").into_iter().filter(|path| !path.ends_with("tests.rs"))
        {
            assert!(!summary(&path).is_empty(), "{} begins without `//!`", path.display());
        }
    }
}

#[test]
fn every_link_between_documents_leads_somewhere() {
    let mut pages = files("docs", "md");
    pages.extend(["README.md", "CONTRIBUTING.md", "CHANGELOG.md"].map(Into::into));
    for page in pages {
        let folder = page.parent().unwrap_or_else(|| Path::new(""));
        let text = read(&page);
        for target in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            let is_elsewhere = target.contains("://") || target.starts_with('#') || target.contains(' ');
            let file = target.split('#').next().unwrap_or_default();
            assert!(
                is_elsewhere || root().join(folder).join(file).exists(),
                "{}: {target} leads nowhere",
                page.display()
            );
        }
    }
}
