//! How far a job is: a bar on a terminal, a line now and then elsewhere.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use super::client::{Client, Job};

/// Time between two looks at a job.
const INTERVAL: Duration = Duration::from_millis(150);

/// Time between two plain lines.
const LINE_INTERVAL: Duration = Duration::from_secs(5);

/// Follows a job to its end; an error if it did not end well.
pub(in crate::cli) async fn follow(client: &Client, job: &Job, name: &str) -> anyhow::Result<Job> {
    let mut display = if std::io::stderr().is_terminal() { bar(name) } else { Display::plain(name) };
    loop {
        let job = client.job(&job.id).await?;
        display.show(&job);
        if job.status.is_final() {
            display.finish();
            return job.successful();
        }
        tokio::time::sleep(INTERVAL).await;
    }
}

enum Display {
    Bar(ProgressBar),
    Lines { name: String, begin: Instant, last: Option<Instant> },
}

fn bar(name: &str) -> Display {
    let bar = ProgressBar::new(100).with_prefix(format!("{name:<14}"));
    // The template is a constant; should it ever be wrong, the library's own bar does as well.
    let style = ProgressStyle::with_template("{prefix} [{bar:36}] {percent:>3} %  {elapsed}  {wide_msg}")
        .unwrap_or_else(|_| ProgressStyle::default_bar())
        .progress_chars("=> ");
    bar.set_style(style);
    bar.enable_steady_tick(INTERVAL);
    Display::Bar(bar)
}

impl Display {
    fn plain(name: &str) -> Self {
        Self::Lines { name: name.to_owned(), begin: Instant::now(), last: None }
    }

    fn show(&mut self, job: &Job) {
        match self {
            Self::Bar(bar) => {
                bar.set_position(job.progress);
                bar.set_message(words(job));
            }
            Self::Lines { name, begin, last } => {
                if job.status.is_final() || last.is_none_or(|last| last.elapsed() >= LINE_INTERVAL) {
                    let seconds = begin.elapsed().as_secs();
                    eprintln!("{name:<14} {:>3} %  {seconds:>3} s  {}", job.progress, words(job));
                    *last = Some(Instant::now());
                }
            }
        }
    }

    fn finish(self) {
        if let Self::Bar(bar) = self {
            bar.abandon();
        }
    }
}

/// Counts as soon as there is something to count; before that, what is being prepared.
fn words(job: &Job) -> String {
    if job.speeds.finished == 0 && !job.phase.is_empty() {
        return job.phase.clone();
    }
    format!("{} of {} speeds", job.speeds.finished, job.speeds.total)
}
