//! Numbers and names as mesh files write them.

use crate::error::MeshProblem;

/// Most characters of a text that an error repeats.
const LONGEST: usize = 60;

/// Quotes `text` or, where it is long, its beginning with an ellipsis.
pub fn quoted(text: &str) -> String {
    match text.char_indices().nth(LONGEST) {
        None => text.to_owned(),
        Some((end, _)) => format!("{}…", &text[..end]),
    }
}

/// Largest number of a node or element: so large that no program writes more, so small that sums of them have no overflow.
pub(crate) const LARGEST: u64 = 1_000_000_000_000_000;

/// Parses an integer from 0 to 10^15.
pub(crate) fn integer(word: &str, expected: &'static str) -> Result<u64, MeshProblem> {
    let number = word.trim().parse().ok().filter(|&number| number <= LARGEST);
    number.ok_or_else(|| MeshProblem::NotA { text: quoted(word.trim()), expected })
}

/// Parses a finite real number, as [`number`] reads it.
pub(crate) fn real(word: &str, expected: &'static str) -> Result<f64, MeshProblem> {
    number(word).ok_or_else(|| MeshProblem::NotA { text: quoted(word.trim()), expected })
}

/// Finite real number, in Fortran's and Nastran's spellings too: `1.5D+3`, `1.5+3`.
pub fn number(word: &str) -> Option<f64> {
    let word = word.trim();
    let fortran = || {
        let word = word.replace(['d', 'D'], "e");
        if word.contains(['e', 'E']) {
            return word.parse().ok();
        }
        let sign = word.get(1..)?.find(['+', '-'])? + 1;
        format!("{}e{}", &word[..sign], &word[sign..]).parse().ok()
    };
    let number: Option<f64> = word.parse().ok().or_else(fortran);
    number.filter(|x| x.is_finite())
}

#[cfg(test)]
mod tests {
    use super::real;

    #[test]
    fn numbers_in_every_spelling() {
        for text in ["1500", "1.5e3", "1.5E+03", "1.5D3", "1.5d+03", "1.5+3", "15000-1", " 1500. "] {
            assert_eq!(real(text, "a number").ok(), Some(1500.0), "{text}");
        }
        assert_eq!(real("-1.5-3", "a number").ok(), Some(-1.5e-3));
        for text in ["", "-", "x", "1.5+", "1e999", "nan", "é+1"] {
            assert!(real(text, "a number").is_err(), "{text}");
        }
    }
}
