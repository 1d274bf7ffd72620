//! Bytes of an array, raw or from base64, taken piece by piece.

use base64::Engine;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};

/// Base64 as programs write it, some without the padding at the end.
const ENGINE: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new()
        .with_decode_padding_mode(DecodePaddingMode::Indifferent)
        .with_decode_allow_trailing_bits(true),
);
/// Most groups of four characters that are decoded at once.
const GROUPS: usize = 1024;

/// Source of bytes.
pub(super) enum Source<'a> {
    /// Bytes as they are.
    Raw(&'a [u8]),
    /// Base64 text that is left, and bytes decoded from before it that are not yet taken.
    Base64 {
        /// Text.
        text: &'a [u8],
        /// Bytes.
        left: Vec<u8>,
    },
}

impl<'a> Source<'a> {
    /// Source of base64 text.
    pub(super) fn base64(text: &'a [u8]) -> Self {
        Self::Base64 { text, left: Vec::new() }
    }

    /// Next bytes, exactly so many; none if there are fewer, or if the text is not base64. Nothing is reserved that is not there.
    pub(super) fn take(&mut self, count: usize) -> Option<Vec<u8>> {
        match self {
            Self::Raw(bytes) => {
                let (taken, rest) = bytes.split_at_checked(count)?;
                *bytes = rest;
                Some(taken.to_vec())
            }
            Self::Base64 { text, left } => {
                let mut found = std::mem::take(left);
                while found.len() < count {
                    let groups = (count - found.len()).div_ceil(3).min(GROUPS);
                    let characters = group(text, 4 * groups);
                    if characters.is_empty() {
                        return None;
                    }
                    ENGINE.decode_vec(characters, &mut found).ok()?;
                }
                *left = found.split_off(count);
                Some(found)
            }
        }
    }
}

/// Next characters without blanks, at most so many. They end behind padding, as each of several texts in a row ends with its own.
fn group(text: &mut &[u8], most: usize) -> Vec<u8> {
    let mut found = Vec::with_capacity(most);
    while found.len() < most
        && !(found.len() % 4 == 0 && found.last() == Some(&b'='))
        && let Some((&character, rest)) = text.split_first()
    {
        *text = rest;
        if !character.is_ascii_whitespace() {
            found.push(character);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::Source;

    #[test]
    fn texts_in_a_row_are_one_source() {
        let mut source = Source::base64(b" AQ==\n AgME BQ==");
        assert_eq!(source.take(2), Some(vec![1, 2]));
        assert_eq!(source.take(3), Some(vec![3, 4, 5]));
        assert_eq!(source.take(1), None);
        assert_eq!(Source::base64(b"AQ").take(1), Some(vec![1]));
        assert_eq!(Source::base64(b"AQID****").take(4), None);
        assert_eq!(Source::Raw(&[1, 2]).take(3), None);
    }
}
