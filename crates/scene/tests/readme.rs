//! Every sweep that the README shows is one.

use std::path::Path;

use scene::Sweep;

#[test]
fn sweeps_of_the_readme_expand() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../README.md");
    let readme = std::fs::read_to_string(path).unwrap();
    let fenced = readme.split("```json\n").skip(1).filter_map(|rest| rest.split("```").next());
    let heredocs = readme.split("<<'SWEEP'\n").skip(1).filter_map(|rest| rest.split("\nSWEEP\n").next());
    let texts: Vec<&str> = fenced.chain(heredocs).collect();
    assert_eq!(texts.len(), 2);
    for text in texts {
        let sweep = Sweep::from_text(text).unwrap_or_else(|problems| panic!("{text}: {problems}"));
        assert!(sweep.survey().unwrap().points >= 12);
    }
}
