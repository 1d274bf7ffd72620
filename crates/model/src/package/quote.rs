//! Quotation of the user's own text in errors, shortened.

pub(crate) use rubmap_mesh::fields::quoted;

/// Number of characters kept from the beginning of a long message, which says what is wrong; its end, which says what is expected, is kept
/// too.
const BEGINNING: usize = 80;
const END: usize = 300;

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
