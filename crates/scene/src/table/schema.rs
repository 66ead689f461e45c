//! Key tables as JSON Schema (draft 2020-12), for the API description and for editors.

use serde_json::{Map, Value, json};

use super::{Absent, Bound, Domain, Key, LARGEST_INTEGER};

/// The schema of an object with these keys and, first, the constants given.
pub(crate) fn object_schema(constants: &[(&str, &str)], keys: &[Key]) -> Value {
    let mut properties = Map::new();
    let mut required: Vec<&str> = Vec::new();
    for (name, word) in constants {
        properties.insert((*name).to_owned(), json!({ "const": word }));
        required.push(name);
    }
    for key in keys {
        properties.insert(key.name.to_owned(), key_schema(key));
        if key.absent == Absent::Required {
            required.push(key.name);
        }
    }
    json!({
        "type": "object",
        "properties": properties,
        "required": required,
        "additionalProperties": false,
    })
}

fn key_schema(key: &Key) -> Value {
    let mut schema = domain_schema(&key.domain);
    let Value::Object(fields) = &mut schema else { unreachable!("a schema is an object") };
    let unit = if key.unit == "-" { String::new() } else { format!(" [{}]", key.unit) };
    let default = match key.absent {
        Absent::SameAs(other) => format!("; default: as {other}"),
        _ => String::new(),
    };
    fields.insert("description".to_owned(), format!("{}{unit}{default}", key.meaning).into());
    if let Absent::Default(text) = key.absent {
        fields.insert("default".to_owned(), serde_json::from_str(text).expect("a default is JSON"));
    }
    schema
}

fn domain_schema(domain: &Domain) -> Value {
    match domain {
        Domain::Real(low, high) => {
            let mut schema = json!({ "type": "number" });
            match low {
                Bound::Including(end) => schema["minimum"] = json!(end),
                Bound::Excluding(end) => schema["exclusiveMinimum"] = json!(end),
                Bound::Open => {}
            }
            match high {
                Bound::Including(end) => schema["maximum"] = json!(end),
                Bound::Excluding(end) => schema["exclusiveMaximum"] = json!(end),
                Bound::Open => {}
            }
            schema
        }
        Domain::Integer(low, high) => {
            json!({ "type": "integer", "minimum": low, "maximum": (*high).min(LARGEST_INTEGER) })
        }
        Domain::OneOf(numbers) => json!({ "enum": numbers }),
        Domain::Bool => json!({ "type": "boolean" }),
        Domain::Word(words) => {
            json!({ "enum": words.iter().map(|word| word.name).collect::<Vec<_>>() })
        }
        Domain::Auto(inner) => json!({ "anyOf": [{ "enum": ["auto", null] }, domain_schema(inner)] }),
        Domain::Tagged { tag, variants } => {
            let names: Vec<&str> = variants.iter().map(|variant| variant.name).collect();
            let records = variants.iter().map(|variant| object_schema(&[(tag, variant.name)], variant.keys));
            json!({ "anyOf": std::iter::once(json!({ "enum": names })).chain(records).collect::<Vec<_>>() })
        }
        Domain::Record(keys) => object_schema(&[], keys),
        Domain::List { of, min, max } => {
            json!({ "type": "array", "items": domain_schema(of), "minItems": min, "maxItems": max })
        }
    }
}
