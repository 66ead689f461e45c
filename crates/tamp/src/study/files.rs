//! Writes the results of a study beside its database.

use std::path::{Path, PathBuf};

use protocol::api::SweepView;
use protocol::client::{Client, ClientError};

use super::report::{self, Found};
use crate::failure::Failure;

/// What is kept: file name and where the coordinator serves it. Results come first and must be there; an analysis
/// that the data do not allow is left out.
const FILES: [(&str, &str, bool); 9] = [
    ("results.csv", "/results?format=csv", true),
    ("collapse.json", "/collapse", false),
    ("collapse.svg", "/collapse.svg", false),
    ("fit.json", "/fit", false),
    ("fit.svg", "/fit.svg", false),
    ("exponents.json", "/exponents", false),
    ("forces.json", "/forces", false),
    ("forces.svg", "/forces.svg", false),
    ("bonds.json", "/bonds", false),
];

/// Writes every file; answers the folder.
pub async fn write(
    client: &Client,
    data_dir: &Path,
    view: &SweepView,
    found: &Found,
) -> Result<PathBuf, Failure> {
    let folder = data_dir.join(folder_name(&view.name));
    std::fs::create_dir_all(&folder).map_err(|error| Failure::file(&folder, &error))?;
    put(&folder.join("table.txt"), report::text(found).as_bytes())?;
    let rows = serde_json::to_vec_pretty(&found.rows)
        .map_err(|error| Failure::Work(format!("cannot be written as JSON: {error}")))?;
    put(&folder.join("results.json"), &rows)?;
    for (name, route, must_be_there) in FILES {
        match client.get_bytes(&format!("/v1/sweeps/{}{route}", view.id)).await {
            Ok(bytes) => put(&folder.join(name), &bytes)?,
            Err(ClientError::FixInput(_)) if !must_be_there => {}
            Err(error) => return Err(error.into()),
        }
    }
    Ok(folder)
}

fn put(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    worker::write_durably(path, bytes).map_err(|error| Failure::file(path, &error))
}

/// The name of the sweep as a folder: letters, digits, dots and dashes only.
fn folder_name(name: &str) -> String {
    let safe: String = name
        .chars()
        .map(|c| if c.is_ascii_alphanumeric() || matches!(c, '.' | '-' | '_') { c } else { '-' })
        .collect();
    match safe.trim_matches('.') {
        "" => "sweep".to_owned(),
        rest => rest.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folder_names_stay_inside_the_data_directory() {
        let made = ["tiny", "../../etc", "a b/c", "..", ""].map(folder_name);
        assert_eq!(made, ["tiny", "-..-etc", "a-b-c", "sweep", "sweep"]);
    }
}
