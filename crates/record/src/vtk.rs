//! A packing as a legacy VTK file: particles as points, contacts as lines between them; deformable bodies with their
//! material points and outlines.

mod bodies;

use std::fmt::Write as _;

use crate::{Column, Packing, Table};

/// The packing has no particles that could be drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the packing cannot be drawn: {0}")]
pub struct NoPicture(pub &'static str);

/// Legacy VTK (version 3.0, ASCII, POLYDATA): points with a vertex each from the columns `x`, `y` (and `z`) of the
/// table `particles`, lines from `i` and `j` of the table `contacts`; every other column becomes point or cell data
/// of its name. Contacts that do not join two particles (walls) have no line and are left out.
///
/// Where the packing has tables `points` and `outlines` of deformable bodies, these are drawn instead: a vertex per
/// material point with its columns (von Mises stress, plastic strain, …) as point data, a closed line per outline with
/// the columns of the particle as cell data. Lengths are those of the tables.
///
/// # Errors
/// [`NoPicture`] when there are no particles with positions.
pub fn vtk(packing: &Packing, title: &str) -> Result<String, NoPicture> {
    let particles = packing.0.get("particles").ok_or(NoPicture("it has no table of particles"))?;
    let (Some(x), Some(y)) = (particles.column("x"), particles.column("y")) else {
        return Err(NoPicture("its particles have no positions x, y"));
    };
    // the title is one line
    let title: Vec<&str> = title.split_whitespace().collect();
    let mut text = format!("# vtk DataFile Version 3.0\ntamp {}\nASCII\nDATASET POLYDATA\n", title.join(" "));
    if let Some(bodies) = bodies::Bodies::of(packing, particles) {
        bodies.write(&mut text);
        return Ok(text);
    }
    let z = particles.column("z").unwrap_or_else(|| vec![0.0; x.len()]);
    let contacts = packing.0.get("contacts");
    let pairs = contacts.map(|table| pairs(table, x.len())).unwrap_or_default();

    let n = x.len();
    line(&mut text, format_args!("POINTS {n} double"));
    for ((x, y), z) in x.iter().zip(&y).zip(&z) {
        line(&mut text, format_args!("{x:?} {y:?} {z:?}"));
    }
    line(&mut text, format_args!("VERTICES {n} {}", 2 * n));
    for point in 0..n {
        line(&mut text, format_args!("1 {point}"));
    }
    if !pairs.is_empty() {
        line(&mut text, format_args!("LINES {} {}", pairs.len(), 3 * pairs.len()));
        for (_, i, j) in &pairs {
            line(&mut text, format_args!("2 {i} {j}"));
        }
    }
    line(&mut text, format_args!("POINT_DATA {n}"));
    for column in columns(particles, &["x", "y", "z"]) {
        let values = column.values.iter().map(|value| value.get());
        scalars(&mut text, &column.name, values);
    }
    if let Some(contacts) = contacts.filter(|_| !pairs.is_empty()) {
        // cell data covers the vertices first, then the lines; vertices get zeros
        line(&mut text, format_args!("CELL_DATA {}", n + pairs.len()));
        for column in columns(contacts, &["i", "j"]) {
            let of_lines = pairs.iter().map(|(row, _, _)| column.values[*row].get());
            scalars(&mut text, &column.name, std::iter::repeat_n(0.0, n).chain(of_lines));
        }
    }
    Ok(text)
}

/// Rows of the contact table that join two particles: row, first, second.
fn pairs(contacts: &Table, particles: usize) -> Vec<(usize, usize, usize)> {
    let (Some(i), Some(j)) = (contacts.column("i"), contacts.column("j")) else { return Vec::new() };
    let index = |value: f64| {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked just below")]
        let whole = value as usize;
        #[expect(clippy::cast_precision_loss, reason = "particle numbers stay far below 2^53")]
        let exact = whole as f64 == value;
        (exact && whole < particles).then_some(whole)
    };
    i.iter().zip(&j).enumerate().filter_map(|(row, (&i, &j))| Some((row, index(i)?, index(j)?))).collect()
}

fn columns<'a>(table: &'a Table, not: &'a [&str]) -> impl Iterator<Item = &'a Column> {
    table.columns().iter().filter(move |column| !not.contains(&column.name.as_str()))
}

fn scalars(text: &mut String, name: &str, values: impl Iterator<Item = f64>) {
    // a name in VTK is one word
    let word: Vec<&str> = name.split_whitespace().collect();
    line(text, format_args!("SCALARS {} double 1\nLOOKUP_TABLE default", word.join("_")));
    for value in values {
        line(text, format_args!("{value:?}"));
    }
}

fn line(text: &mut String, content: std::fmt::Arguments<'_>) {
    writeln!(text, "{content}").expect("writing to a string cannot fail");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_lines_and_their_data() {
        let mut particles = Table::new();
        particles.push("x", "d", &[0.0, 1.0]).unwrap().push("y", "d", &[0.5, 0.5]).unwrap();
        particles.push("contacts", "1", &[1.0, 2.0]).unwrap();
        let mut contacts = Table::new();
        // the second contact is with a wall
        contacts.push("i", "1", &[0.0, 1.0]).unwrap().push("j", "1", &[1.0, -1.0]).unwrap();
        contacts.push("f n", "kn d", &[2e-9, 1.0]).unwrap();
        let packing =
            Packing([("particles".to_owned(), particles), ("contacts".to_owned(), contacts)].into());
        let expected = "# vtk DataFile Version 3.0\ntamp a b\nASCII\nDATASET POLYDATA\n\
            POINTS 2 double\n0.0 0.5 0.0\n1.0 0.5 0.0\nVERTICES 2 4\n1 0\n1 1\nLINES 1 3\n2 0 1\n\
            POINT_DATA 2\nSCALARS contacts double 1\nLOOKUP_TABLE default\n1.0\n2.0\n\
            CELL_DATA 3\nSCALARS f_n double 1\nLOOKUP_TABLE default\n0.0\n0.0\n2e-9\n";
        assert_eq!(vtk(&packing, "a\nb").unwrap(), expected);
    }

    #[test]
    fn deformable_bodies_show_points_and_outlines() {
        let table = |columns: &[(&str, &[f64])]| {
            let mut table = Table::new();
            for (name, values) in columns {
                table.push(name, "1", values).unwrap();
            }
            table
        };
        let particles = table(&[("x", &[0.5, 2.5]), ("y", &[0.5, 0.5]), ("f_p", &[0.25, 0.75])]);
        let points = table(&[
            ("disc", &[0.0, 1.0]),
            ("x", &[0.5, 2.5]),
            ("y", &[0.5, 0.5]),
            ("von_mises", &[0.01, 0.02]),
        ]);
        let outlines = table(&[
            ("disc", &[0.0, 0.0, 0.0, 1.0, 1.0, 1.0]),
            ("x", &[0.0, 1.0, 0.5, 2.0, 3.0, 2.5]),
            ("y", &[0.0, 0.0, 1.0, 0.0, 0.0, 1.0]),
        ]);
        let tables = [("particles", particles), ("points", points), ("outlines", outlines)];
        let packing = Packing(tables.map(|(name, table)| (name.to_owned(), table)).into());
        let expected = "# vtk DataFile Version 3.0\ntamp two\nASCII\nDATASET POLYDATA\nPOINTS 8 double\n\
            0.5 0.5 0.0\n2.5 0.5 0.0\n0.0 0.0 0.0\n1.0 0.0 0.0\n0.5 1.0 0.0\n2.0 0.0 0.0\n3.0 0.0 0.0\n2.5 1.0 0.0\n\
            VERTICES 2 4\n1 0\n1 1\nLINES 2 10\n4 2 3 4 2\n4 5 6 7 5\nPOINT_DATA 8\n\
            SCALARS outline double 1\nLOOKUP_TABLE default\n0.0\n0.0\n1.0\n1.0\n1.0\n1.0\n1.0\n1.0\n\
            SCALARS disc double 1\nLOOKUP_TABLE default\n0.0\n1.0\n0.0\n0.0\n0.0\n1.0\n1.0\n1.0\n\
            SCALARS von_mises double 1\nLOOKUP_TABLE default\n0.01\n0.02\n0.0\n0.0\n0.0\n0.0\n0.0\n0.0\n\
            CELL_DATA 4\nSCALARS f_p double 1\nLOOKUP_TABLE default\n0.0\n0.0\n0.25\n0.75\n";
        assert_eq!(vtk(&packing, "two").unwrap(), expected);
    }

    #[test]
    fn what_cannot_be_drawn_is_refused() {
        assert!(vtk(&Packing::default(), "empty").is_err());
    }
}
