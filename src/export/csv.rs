//! Comma-separated values as in RFC 4180: a line of names, lines of numbers, nothing else.

use std::borrow::Cow;
use std::io::{self, Write};

use super::array::{Array, Values};

/// Writes arrays of one length as columns.
///
/// # Errors
/// Errors of writing.
pub fn write(columns: &[Array], out: &mut dyn Write) -> io::Result<()> {
    names(columns, out)?;
    end_line(out)?;
    let length = columns.first().map_or(0, |column| column.values.len());
    for row in 0..length {
        cells(columns, row, out)?;
        end_line(out)?;
    }
    Ok(())
}

/// Writes the names of columns, without the end of the line.
pub(super) fn names(columns: &[Array], out: &mut dyn Write) -> io::Result<()> {
    for (index, column) in columns.iter().enumerate() {
        let comma = if index == 0 { "" } else { "," };
        write!(out, "{comma}{}", quoted(&column.name))?;
    }
    Ok(())
}

/// Writes row `row` of columns, without the end of the line.
pub(super) fn cells(columns: &[Array], row: usize, out: &mut dyn Write) -> io::Result<()> {
    for (index, column) in columns.iter().enumerate() {
        if index > 0 {
            out.write_all(b",")?;
        }
        match &column.values {
            Values::Real(values) => real(values[row], out)?,
            Values::Whole(values) => {
                out.write_all(values[row].map_or(String::new(), |value| value.to_string()).as_bytes())?
            }
            Values::Flag(values) => write!(out, "{}", values[row])?,
            Values::Text(values) => out.write_all(quoted(&values[row]).as_bytes())?,
        }
    }
    Ok(())
}

/// Writes a number that is read back to the bit; nothing for NaN.
pub(super) fn real(value: f64, out: &mut dyn Write) -> io::Result<()> {
    if value.is_nan() { Ok(()) } else { write!(out, "{value:?}") }
}

pub(super) fn end_line(out: &mut dyn Write) -> io::Result<()> {
    out.write_all(b"\r\n")
}

/// Text as a field, behind an apostrophe where it begins with a character by which spreadsheets know formulas, so that a name
/// from elsewhere is shown and never run.
fn quoted(text: &str) -> Cow<'_, str> {
    if text.starts_with(['=', '+', '-', '@', '\t', '\r']) {
        Cow::Owned(format!("\"'{}\"", text.replace('"', "\"\"")))
    } else if text.contains([',', '"', '\r', '\n']) {
        Cow::Owned(format!("\"{}\"", text.replace('"', "\"\"")))
    } else {
        Cow::Borrowed(text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_those_of_rfc_4180() {
        let columns = [
            Array::reals("length_in, \"", [0.1, f64::NAN, 1e-12]),
            Array::some_whole("order", [Some(3), None, Some(0)]),
            Array::texts("message", ["a,b", "", "two\nlines"]),
            Array::flags("resolved", [true, false, true]),
        ];
        let mut text = Vec::new();
        write(&columns, &mut text).unwrap();
        let expected = "\"length_in, \"\"\",order,message,resolved\r\n0.1,3,\"a,b\",true\r\n,,,false\r\n\
            1e-12,0,\"two\nlines\",true\r\n";
        assert_eq!(String::from_utf8(text).unwrap(), expected);
    }

    /// Checks the rule of OWASP's page on CSV injection; numbers are numbers, negative ones too.
    #[test]
    fn text_that_looks_like_a_formula_is_not_run() {
        let columns = [
            Array::texts("=name", ["=1+1", "+1", "-1", "@a", "\tx", "\rx", "a=1", "=\"x\""]),
            Array::reals("value", [-1.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]),
        ];
        let mut text = Vec::new();
        write(&columns, &mut text).unwrap();
        let expected = "\"'=name\",value\r\n\"'=1+1\",-1.0\r\n\"'+1\",1.0\r\n\"'-1\",2.0\r\n\"'@a\",3.0\r\n\"'\tx\",4.0\r\n\
            \"'\rx\",5.0\r\na=1,6.0\r\n\"'=\"\"x\"\"\",7.0\r\n";
        assert_eq!(String::from_utf8(text).unwrap(), expected);
    }
}
