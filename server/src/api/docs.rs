//! The description (`/openapi.yaml`), a page made from it (`/docs`) that needs no network, and the front page.

use std::fmt::Write as _;

use axum::Router;
use axum::http::header::CONTENT_TYPE;
use axum::response::Html;
use axum::routing::get;
use serde_json::Value;
use utoipa::openapi::OpenApi;

use crate::app::App;

const STYLE: &str = "body{font:16px/1.5 system-ui,sans-serif;max-width:60rem;margin:2rem auto;padding:0 1rem;\
color:#1c1c1c;background:#fdfdfc}code,pre{font:14px/1.45 ui-monospace,monospace}a{color:#0b5394}\
details{border-top:1px solid #ddd;padding:.5rem 0}summary{cursor:pointer}pre{background:#f3f2ef;padding:.7rem;\
overflow:auto}.m{display:inline-block;width:4rem;font-weight:600}table{border-collapse:collapse}\
td,th{text-align:left;padding:.15rem 1rem .15rem 0;vertical-align:top}";

pub(super) fn routes(api: &OpenApi) -> Router<App> {
    let yaml = api.to_yaml().expect("the description is plain data");
    let json = serde_json::to_value(api).expect("the description is plain data");
    let page = docs(&json);
    let front = front();
    Router::new()
        .route("/openapi.yaml", get(async move || ([(CONTENT_TYPE, "application/yaml")], yaml.clone())))
        .route("/openapi.json", get(async move || axum::Json(json.clone())))
        .route("/docs", get(async move || Html(page.clone())))
        .route("/", get(async move || Html(front.clone())))
}

fn front() -> String {
    let links = [
        ("/v1/sweeps", "sweeps"),
        ("/v1/workers", "workers"),
        ("/v1/events", "events, live"),
        ("/docs", "how to use the API"),
        ("/openapi.yaml", "API description (OpenAPI)"),
        ("/metrics", "metrics"),
        ("/readyz", "readiness"),
    ];
    let mut items = String::new();
    for (href, text) in links {
        let _ = write!(items, "<li><a href=\"{href}\">{text}</a></li>");
    }
    format!(
        "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>Tamp</title><style>{STYLE}</style>\
         <h1>Tamp</h1><p>Parameter sweeps of granular compaction. Version {}.</p><ul>{items}</ul></html>",
        env!("CARGO_PKG_VERSION")
    )
}

fn docs(api: &Value) -> String {
    let mut page = format!(
        "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>Tamp API</title><style>{STYLE}</style>\
         <h1>Tamp API</h1><p>{}</p><p><a href=\"/openapi.yaml\">openapi.yaml</a></p>",
        escaped(text(&api["info"], "description"))
    );
    for tag in api["tags"].as_array().into_iter().flatten() {
        let name = text(tag, "name");
        let _ = write!(page, "<h2>{}</h2><p>{}</p>", escaped(name), escaped(text(tag, "description")));
        for (path, methods) in api["paths"].as_object().into_iter().flatten() {
            for (method, operation) in methods.as_object().into_iter().flatten() {
                let tagged =
                    operation["tags"].as_array().is_some_and(|tags| tags.iter().any(|one| one == name));
                if tagged {
                    page.push_str(&described(method, path, operation));
                }
            }
        }
    }
    page.push_str("<h2>Documents</h2>");
    for (name, schema) in api["components"]["schemas"].as_object().into_iter().flatten() {
        let _ = write!(
            page,
            "<details id=\"{0}\"><summary><code>{0}</code> {1}</summary>{2}</details>",
            escaped(name),
            escaped(text(schema, "description")),
            fields(schema)
        );
    }
    page.push_str("</html>");
    page
}

fn described(method: &str, path: &str, operation: &Value) -> String {
    let mut out = format!(
        "<details><summary><span class=\"m\">{}</span><code>{}</code> {}</summary><p>{}</p>",
        method.to_uppercase(),
        escaped(path),
        escaped(text(operation, "summary")),
        escaped(text(operation, "description"))
    );
    let parameters = operation["parameters"].as_array().map_or(&[][..], Vec::as_slice);
    if !parameters.is_empty() {
        out.push_str("<table>");
        for parameter in parameters {
            let _ = write!(
                out,
                "<tr><td><code>{}</code></td><td>{}</td><td>{}</td></tr>",
                escaped(text(parameter, "name")),
                escaped(text(parameter, "in")),
                escaped(text(parameter, "description"))
            );
        }
        out.push_str("</table>");
    }
    for (media, content) in operation["requestBody"]["content"].as_object().into_iter().flatten() {
        let _ = write!(out, "<p>Body: {} {}</p>", escaped(media), kind(&content["schema"]));
    }
    out.push_str("<table>");
    for (status, response) in operation["responses"].as_object().into_iter().flatten() {
        for (media, content) in response["content"].as_object().into_iter().flatten() {
            let _ = write!(
                out,
                "<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>",
                escaped(status),
                escaped(media),
                kind(&content["schema"]),
                escaped(text(response, "description"))
            );
        }
    }
    out.push_str("</table></details>");
    out
}

fn fields(schema: &Value) -> String {
    if let Some(words) = schema["enum"].as_array() {
        let words: Vec<String> =
            words.iter().map(|word| format!("<code>{}</code>", escaped(&word.to_string()))).collect();
        return format!("<p>{}</p>", words.join(", "));
    }
    let mut out = String::from("<table>");
    for (name, field) in schema["properties"].as_object().into_iter().flatten() {
        let _ = write!(
            out,
            "<tr><td><code>{}</code></td><td>{}</td><td>{}</td></tr>",
            escaped(name),
            kind(field),
            escaped(text(field, "description"))
        );
    }
    out.push_str("</table>");
    out
}

/// The type of a field, with a link to its document.
fn kind(schema: &Value) -> String {
    if let Some(reference) = schema["$ref"].as_str() {
        let name = escaped(reference.rsplit('/').next().unwrap_or_default());
        return format!("<a href=\"#{name}\">{name}</a>");
    }
    for union in ["oneOf", "anyOf"] {
        if let Some(options) = schema[union].as_array() {
            return options.iter().map(kind).collect::<Vec<_>>().join(" or ");
        }
    }
    match &schema["type"] {
        Value::String(name) if name == "array" => format!("list of {}", kind(&schema["items"])),
        Value::String(name) => escaped(name),
        Value::Array(names) => {
            names.iter().filter_map(Value::as_str).map(escaped).collect::<Vec<_>>().join(" or ")
        }
        _ => String::new(),
    }
}

fn text<'a>(value: &'a Value, name: &str) -> &'a str {
    value[name].as_str().unwrap_or_default()
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
