//! Texts in the small HTML that Plotly reads, which no user's text may become.

use crate::heading;

/// Escapes a text, so that it is shown as it is.
pub(super) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// Breaks a text into lines of about so many characters.
pub(super) fn broken(text: &str, columns: usize) -> String {
    let lines: Vec<String> = heading::broken(text, columns).iter().map(|line| escaped(line)).collect();
    lines.join("<br>")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_stay_text() {
        assert_eq!(escaped("<a href=\"x\">a & b</a>"), "&lt;a href=\"x\"&gt;a &amp; b&lt;/a&gt;");
        assert_eq!(broken("one <b> three", 7), "one &lt;b&gt;<br>three");
    }
}
