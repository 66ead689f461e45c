//! Key tables as Markdown: `docs/keys.md` is this text, and a test fails when they differ.

use std::fmt::Write;

use super::{Absent, Domain, Key};
use crate::Model;

/// The whole of `docs/keys.md`: keys and derived quantities of every model.
#[must_use]
pub fn document() -> String {
    let mut page = String::from(
        "# Keys of a scene\n\n\
         Generated from the key tables in `crates/scene`; to renew it run `TAMP_BLESS=1 cargo test -p scene`.\n\n\
         A scene is a JSON object with `model` and any of the model's keys, in SI units; an absent key takes its \
         default. Unknown keys are errors. Whole numbers are at most 2^53 - 1.\n",
    );
    for model in Model::ALL {
        let keys = model.keys();
        if keys.is_empty() {
            continue;
        }
        let _ = write!(page, "\n## Model `{}`\n\n{}\n\n", model.name(), model.summary());
        table(&mut page, keys);
        nested(&mut page, keys);
        let _ = write!(
            page,
            "\n### Quantities of `{}`\n\nFor `where` in a sweep (beside every numeric key) and as columns of results.\n\n\
             | quantity | unit | meaning | source |\n|---|---|---|---|\n",
            model.name()
        );
        for quantity in model.quantities() {
            let _ = writeln!(
                page,
                "| `{}` | {} | {} | {} |",
                quantity.name, quantity.unit, quantity.meaning, quantity.source
            );
        }
    }
    page
}

fn table(page: &mut String, keys: &[Key]) {
    page.push_str("| key | unit | admitted | default | meaning | source |\n|---|---|---|---|---|---|\n");
    for key in keys {
        let default = match key.absent {
            Absent::Required => "required".to_owned(),
            Absent::Default(text) => format!("`{text}`"),
            Absent::SameAs(other) => format!("as `{other}`"),
        };
        let _ = writeln!(
            page,
            "| `{}` | {} | {} | {default} | {} | {} |",
            key.name,
            key.unit,
            key.domain.describe().replace('|', "\\|"),
            key.meaning.replace('|', "\\|"),
            key.source.replace('|', "\\|"),
        );
    }
}

/// Words and nested records of the keys, each explained below the main table.
fn nested(page: &mut String, keys: &[Key]) {
    for key in keys {
        nested_domain(page, key.name, &key.domain);
    }
}

fn nested_domain(page: &mut String, name: &str, domain: &Domain) {
    match domain {
        Domain::Word(words) => {
            let _ = write!(page, "\n`{name}` is one of:\n\n");
            for word in *words {
                let _ = writeln!(page, "- `\"{}\"`: {}", word.name, word.meaning);
            }
        }
        Domain::Tagged { tag, variants } => {
            let _ = write!(page, "\n`{name}` is one of these records, told apart by `{tag}`:\n");
            for variant in *variants {
                let _ = write!(page, "\n- `\"{}\"`: {}\n", variant.name, variant.meaning);
                if !variant.keys.is_empty() {
                    page.push('\n');
                    table(page, variant.keys);
                }
            }
            for variant in *variants {
                nested(page, variant.keys);
            }
        }
        Domain::Record(keys) => {
            let _ = write!(page, "\nThe keys of `{name}`:\n\n");
            table(page, keys);
            nested(page, keys);
        }
        Domain::Auto(inner) => nested_domain(page, name, inner),
        Domain::List { of, .. } => nested_domain(page, name, of),
        Domain::Real(..) | Domain::Integer(..) | Domain::OneOf(_) | Domain::Bool => {}
    }
}
