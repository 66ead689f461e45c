//! A definition as JSON.

use serde_json::{Map, Value, json};

use super::{Axis, Sweep};

impl Sweep {
    /// The definition as [`Sweep::from_json`] takes it, every default written out.
    #[must_use]
    pub fn to_json(&self) -> Value {
        let blocks: Vec<Value> = self
            .blocks
            .iter()
            .map(|block| {
                let mut parts = Map::new();
                if !block.grid.is_empty() {
                    parts.insert("grid".to_owned(), axes(&block.grid));
                }
                if !block.zip.is_empty() {
                    parts.insert("zip".to_owned(), axes(&block.zip));
                }
                if !block.list.is_empty() {
                    parts.insert("list".to_owned(), Value::from_iter(block.list.iter().map(written)));
                }
                Value::Object(parts)
            })
            .collect();
        let mut definition = json!({
            "name": self.name,
            "model": self.model.name(),
            "base": written(&self.base),
            "replicates": self.replicates,
            "where": self.filters,
            "priority": self.priority,
        });
        // The definition without blocks is one block without parts: its base.
        if blocks.iter().any(|block| block != &json!({})) {
            definition["blocks"] = Value::from(blocks);
        }
        definition
    }
}

fn axes(axes: &[Axis]) -> Value {
    axes.iter().map(|axis| (axis.key.clone(), axis.to_json())).collect()
}

/// Keys as a definition writes them: absent values as `"auto"`.
fn written(keys: &Map<String, Value>) -> Value {
    keys.iter()
        .map(|(name, value)| {
            (name.clone(), if value.is_null() { Value::from("auto") } else { value.clone() })
        })
        .collect()
}
