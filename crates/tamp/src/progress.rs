//! Progress on stderr: a bar on a terminal, a line now and then elsewhere.

use std::io::IsTerminal as _;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Time between two lines when stderr is no terminal.
const BETWEEN_LINES: Duration = Duration::from_secs(10);
/// Parts the bar is divided into.
const PARTS: u64 = 1000;

/// Shows how far something is.
pub struct Progress {
    label: String,
    begun: Instant,
    shown: Shown,
}

enum Shown {
    Bar(ProgressBar),
    Lines { last: Option<Instant> },
    Nothing,
}

impl Progress {
    /// Progress of what `label` says; `quiet` shows nothing.
    pub fn new(label: &str, quiet: bool) -> Self {
        let shown = if quiet {
            Shown::Nothing
        } else if std::io::stderr().is_terminal() {
            let bar = ProgressBar::with_draw_target(Some(PARTS), ProgressDrawTarget::stderr());
            let style = ProgressStyle::with_template("{prefix} [{bar:30}] {percent:>3} %  {msg}");
            bar.set_style(style.expect("the template is right").progress_chars("=> "));
            bar.set_prefix(label.to_owned());
            Shown::Bar(bar)
        } else {
            Shown::Lines { last: None }
        };
        Self { label: label.to_owned(), begun: Instant::now(), shown }
    }

    /// Shows a share of the work done, 0 … 1, and a few words.
    pub fn show(&mut self, fraction: f64, words: &str) {
        let share = if fraction.is_finite() { fraction.clamp(0.0, 1.0) } else { 0.0 };
        match &mut self.shown {
            Shown::Bar(bar) => {
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    clippy::cast_precision_loss,
                    reason = "a share of 1000"
                )]
                bar.set_position((share * PARTS as f64) as u64);
                bar.set_message(words.to_owned());
            }
            Shown::Lines { last } => {
                if last.is_none_or(|last| last.elapsed() >= BETWEEN_LINES) {
                    *last = Some(Instant::now());
                    eprintln!("{}: {:.0} %, {words}", self.label, 100.0 * share);
                }
            }
            Shown::Nothing => {}
        }
    }

    /// Ends with a last line.
    pub fn end(self, words: &str) {
        match self.shown {
            Shown::Bar(bar) => {
                bar.finish_and_clear();
                eprintln!("{}: {words}", self.label);
            }
            Shown::Lines { .. } => eprintln!("{}: {words}", self.label),
            Shown::Nothing => {}
        }
    }

    /// Estimated time to the end, from the share done since the start.
    pub fn remaining(&self, fraction: f64) -> Option<Duration> {
        let spent = self.begun.elapsed().as_secs_f64();
        let is_telling = fraction > 0.01 && fraction <= 1.0 && spent > 1.0;
        is_telling.then(|| Duration::from_secs_f64(spent * (1.0 - fraction) / fraction))
    }
}

/// A time a person can read: `45 s`, `12 min`, `3.5 h`.
pub fn span(seconds: f64) -> String {
    match seconds {
        s if s < 90.0 => format!("{s:.0} s"),
        s if s < 5400.0 => format!("{:.0} min", s / 60.0),
        s if s < 172_800.0 => format!("{:.1} h", s / 3600.0),
        s => format!("{:.1} d", s / 86_400.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spans_are_told_in_a_fitting_unit() {
        let told = [4.2, 89.0, 600.0, 9000.0, 400_000.0].map(span);
        assert_eq!(told, ["4 s", "89 s", "10 min", "2.5 h", "4.6 d"]);
    }
}
