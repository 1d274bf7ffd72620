//! Curve of a shroud from a table of r and z.

use std::path::Path;

use anyhow::{Context, bail};

/// Reads a curve from a file.
///
/// # Errors
/// A file that cannot be read, and the first line that is not two numbers.
pub(super) fn read(path: &Path) -> anyhow::Result<Vec<[f64; 2]>> {
    let name = || path.display().to_string();
    let text = std::fs::read_to_string(path).with_context(|| format!("cannot read {}", name()))?;
    curve(&text).with_context(name)
}

/// Points of a table with two columns; blank lines, lines after `#` and a first line of names are no points.
fn curve(text: &str) -> anyhow::Result<Vec<[f64; 2]>> {
    let mut points = Vec::new();
    let mut first = true;
    let lines = text.trim_start_matches('\u{feff}').lines().zip(1..);
    for (line, number) in lines.filter(|(line, _)| !line.trim().is_empty() && !line.starts_with('#')) {
        let words = line.split(|c: char| c == ',' || c == ';' || c.is_whitespace());
        let words: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
        let numbers: Result<Vec<f64>, _> = words.iter().map(|word| word.parse::<f64>()).collect();
        match numbers.as_deref() {
            Ok(&[r, z]) => points.push([r, z]),
            Err(_) if first => {}
            _ => bail!("line {number} is not two numbers, r and z"),
        }
        first = false;
    }
    Ok(points)
}

#[cfg(test)]
mod tests {
    use super::curve;

    #[test]
    fn tables_with_and_without_names() {
        let expected = [[20.0, 0.5], [35.5, -4.0]];
        for text in [
            "20,0.5\n35.5,-4\n",
            "\u{feff}r [mm]; z [mm]\r\n\r\n20;0.5\r\n35.5 ; -4",
            "# shroud\nr z\n2e1 0.5\n35.5\t-4.0",
        ] {
            assert_eq!(curve(text).unwrap(), expected, "{text}");
        }
        let wrong = |text: &str| curve(text).unwrap_err().to_string();
        assert_eq!(wrong("r,z\n1,2\n3,4,5\n"), "line 3 is not two numbers, r and z");
        assert_eq!(wrong("1,2\nr,z\n"), "line 2 is not two numbers, r and z");
    }
}
