//! Progress for whoever watches: bars on a terminal, lines elsewhere; always on the error stream, so that the output stream has nothing but results.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{MultiProgress, ProgressBar, ProgressStyle};

use super::size::size;

/// Characters of a name before a bar.
const PREFIX: usize = 14;

/// Time between two frames of a bar.
const TICK: Duration = Duration::from_millis(150);

/// Time between two plain lines.
const LINE_INTERVAL: Duration = Duration::from_secs(5);

/// Terminal on which progress is reported.
#[derive(Debug, Default)]
pub(super) struct Terminal {
    bars: MultiProgress,
}

/// Progress of one activity.
#[derive(Debug)]
pub(super) enum Bar {
    /// Bar drawn on a terminal.
    Drawn(ProgressBar),
    /// Plain lines, where there is no terminal.
    Lines {
        /// Name of the activity.
        name: String,
        /// Time at which the activity began.
        begin: Instant,
        /// Time at which the last line was written.
        last: Option<Instant>,
    },
}

impl Terminal {
    /// Writes a line, above the bars.
    pub(super) fn say(&self, line: &str) {
        self.bars.suspend(|| eprintln!("{line}"));
    }

    /// Begins a bar from 0 to 100 for an activity that takes its time: the first line comes at once.
    pub(super) fn bar(&self, name: &str) -> Bar {
        self.begin(name, None)
    }

    /// Begins a bar from 0 to 100 for an activity that is mostly done in a moment: then there is no line.
    pub(super) fn short_bar(&self, name: &str) -> Bar {
        self.begin(name, Some(Instant::now()))
    }

    fn begin(&self, name: &str, last: Option<Instant>) -> Bar {
        let name = format!("{name:<PREFIX$}");
        if !std::io::stderr().is_terminal() {
            return Bar::Lines { name, begin: Instant::now(), last };
        }
        // The words behind the bar need their room.
        let name = if name.chars().count() > PREFIX {
            name.chars().take(PREFIX - 1).chain(['…']).collect()
        } else {
            name
        };
        let bar = self.bars.add(ProgressBar::new(100).with_prefix(name));
        // The template is a constant; should it ever be wrong, the library's own bar does as well.
        let style = ProgressStyle::with_template("{prefix} [{bar:36}] {percent:>3} %  {elapsed}  {wide_msg}")
            .unwrap_or_else(|_| ProgressStyle::default_bar())
            .progress_chars("=> ");
        bar.set_style(style);
        bar.enable_steady_tick(TICK);
        Bar::Drawn(bar)
    }
}

impl Bar {
    /// Shows progress in percent and in words; the `last` report is always shown.
    pub(super) fn show(&mut self, percent: u64, words: &str, last: bool) {
        match self {
            Self::Drawn(bar) => {
                bar.set_position(percent);
                bar.set_message(words.to_owned());
            }
            Self::Lines { name, begin, last: written } => {
                if last || written.is_none_or(|written| written.elapsed() >= LINE_INTERVAL) {
                    eprintln!("{name} {percent:>3} %  {:>3} s  {words}", begin.elapsed().as_secs());
                    *written = Some(Instant::now());
                }
            }
        }
    }

    /// Shows how many bytes have been moved, of how many if that is known.
    pub(super) fn show_bytes(&mut self, moved: u64, total: Option<u64>) {
        let percent = total.map_or(0, |total| (100 * moved).checked_div(total).unwrap_or(100));
        let of = total.map(|total| format!(" of {}", size(total))).unwrap_or_default();
        self.show(percent, &format!("{}{of}", size(moved)), false);
    }
}

impl Drop for Bar {
    /// Leaves on the terminal what was drawn last.
    fn drop(&mut self) {
        if let Self::Drawn(bar) = self {
            bar.abandon();
        }
    }
}
