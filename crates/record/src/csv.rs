//! A table as CSV text.

use std::fmt::Write as _;

use crate::Table;

/// RFC 4180 text: a header of column names, then one line per row, each number in its shortest form that reads back
/// to the same bits. Units are not in the text: they stand in the table.
#[must_use]
pub fn csv(table: &Table) -> String {
    let columns = table.columns();
    let names: Vec<&str> = columns.iter().map(|column| column.name.as_str()).collect();
    let mut text = names.join(",");
    text.push('\n');
    for row in 0..table.rows() {
        for (index, column) in columns.iter().enumerate() {
            let separator = if index == 0 { "" } else { "," };
            // `{:?}` goes over to an exponent for small and large numbers
            write!(text, "{separator}{:?}", column.values[row].get())
                .expect("writing to a string cannot fail");
        }
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_back_to_the_same_bits() {
        let values = [0.1 + 0.2, 1e-300, -0.0, 3.0];
        let mut table = Table::new();
        table.push("a", "1", &values).unwrap().push("b", "d", &[1.0, 2.0, 3.0, 4.0]).unwrap();
        let text = csv(&table);
        let mut lines = text.lines();
        assert_eq!(lines.next(), Some("a,b"));
        let read: Vec<u64> =
            lines.map(|line| line.split(',').next().unwrap().parse::<f64>().unwrap().to_bits()).collect();
        assert_eq!(read, values.map(f64::to_bits));
    }
}
