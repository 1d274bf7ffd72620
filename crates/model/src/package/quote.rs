//! Quotation of the user's own text in errors, shortened.

/// Most characters of a name or value that an error repeats.
const LONGEST: usize = 60;

/// Number of characters kept from the beginning of a long message, which says what is wrong; its end, which says what is expected, is kept
/// too.
const BEGINNING: usize = 80;
const END: usize = 300;

/// Quotes `text` or, where it is long, its beginning with an ellipsis.
pub(crate) fn quoted(text: &str) -> String {
    match text.char_indices().nth(LONGEST) {
        None => text.to_owned(),
        Some((end, _)) => format!("{}…", &text[..end]),
    }
}

/// Shortens the message of a JSON reader, which repeats a wrong value in full, by leaving out the middle of a long one.
pub(crate) fn bounded_message(message: &str) -> String {
    if message.chars().nth(BEGINNING + END).is_none() {
        return message.to_owned();
    }
    let beginning: String = message.chars().take(BEGINNING).collect();
    let end = message.char_indices().rev().nth(END - 1).map_or(0, |(start, _)| start);
    format!("{beginning}…{}", &message[end..])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_texts_stay_and_long_ones_end_in_an_ellipsis() {
        let longest = "é".repeat(LONGEST);
        assert_eq!(quoted(&longest), longest);
        assert_eq!(quoted(&format!("{longest}x")), format!("{longest}…"));
    }

    #[test]
    fn a_message_keeps_both_ends() {
        let message =
            format!("unknown variant `{}`, expected `cartesian` or `cylindrical`", "é".repeat(1 << 20));
        let bounded = bounded_message(&message);
        assert!(
            bounded.starts_with("unknown variant `é")
                && bounded.ends_with("`, expected `cartesian` or `cylindrical`")
        );
        assert_eq!(bounded.chars().count(), BEGINNING + 1 + END);
        assert_eq!(bounded_message("expected value"), "expected value");
    }
}
