//! Standard output and standard error.
//!
//! Nothing here panics when the other end has gone away: a closed standard output ends the command without a word, as a
//! pager that was left does, and a closed standard error is not written to.

use std::fmt::{Arguments, Display};
use std::io::{ErrorKind, IsTerminal, Write, stderr, stdout};

use anyhow::Context;

use crate::args::ConsoleArguments;

/// What a command tells besides its results: warnings, explanations and progress, all on standard error.
#[derive(Clone, Copy, Debug)]
pub struct Console {
    quiet: bool,
    verbose: bool,
    shows_progress: bool,
}

impl Console {
    /// As the flags say; progress goes to a terminal only.
    pub fn new(arguments: &ConsoleArguments) -> Self {
        let shows_progress = !arguments.quiet && stderr().is_terminal();
        Self { quiet: arguments.quiet, verbose: arguments.verbose, shows_progress }
    }

    /// Says what is odd, unless `-q`.
    pub fn warn(&self, warning: impl Display) {
        if !self.quiet {
            self.end_progress();
            print(format_args!("planish: warning: {}\n", one_line(&warning.to_string())));
        }
    }

    /// Says what is being done and why, with `-v`.
    pub fn explain(&self, explanation: impl Display) {
        if self.verbose {
            self.end_progress();
            print(format_args!("planish: {explanation}\n"));
        }
    }

    /// Replaces the line of progress.
    pub fn progress(&self, state: Arguments<'_>) {
        if self.shows_progress {
            print(format_args!("\r\x1b[K{state}"));
        }
    }

    /// Removes the line of progress.
    pub fn end_progress(&self) {
        self.progress(format_args!(""));
    }
}

fn print(text: Arguments<'_>) {
    // There is nobody left to tell that standard error cannot be written to.
    let _ = stderr().lock().write_fmt(text);
}

/// An error with its causes, those left out that it tells itself.
pub fn error_text(error: &anyhow::Error) -> String {
    let mut text = String::new();
    for cause in error.chain().map(ToString::to_string) {
        if text.is_empty() {
            text = cause;
        } else if !text.contains(&cause) {
            text = format!("{text}: {cause}");
        }
    }
    text
}

/// Prints why a command failed: one line.
pub fn print_error(message: &str) {
    print(format_args!("planish: error: {}\n", one_line(message)));
}

/// Prints a result to standard output.
pub fn print_output(text: &str) -> anyhow::Result<()> {
    let mut stdout = stdout().lock();
    stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()).context("cannot write to standard output")
}

/// What a command line asks for that makes no sense for the scene it names.
#[derive(Debug)]
pub struct WrongUsage(pub String);

impl Display for WrongUsage {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(formatter, "{} (planish --help explains)", self.0)
    }
}

impl std::error::Error for WrongUsage {}

/// Whether a command failed only because the reader of its output has gone away.
pub fn is_closed_output(error: &anyhow::Error) -> bool {
    error.downcast_ref::<std::io::Error>().is_some_and(|error| error.kind() == ErrorKind::BrokenPipe)
}

/// A message as one line.
fn one_line(message: &str) -> String {
    message.lines().map(str::trim).filter(|line| !line.is_empty()).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_of_several_lines_becomes_one() {
        assert_eq!(one_line("no device:\n  lavapipe\n\n"), "no device: lavapipe");
    }

    #[test]
    fn a_cause_is_told_once() {
        let error = |text: &'static str| anyhow::anyhow!("disk full").context(text);
        assert_eq!(error_text(&error("cannot write a.exr")), "cannot write a.exr: disk full");
        assert_eq!(error_text(&error("a.exr: disk full, expected room")), "a.exr: disk full, expected room");
    }

    #[test]
    fn only_a_closed_pipe_is_forgiven() {
        let failed = |kind| anyhow::Error::from(std::io::Error::from(kind)).context("standard output");
        assert!(is_closed_output(&failed(ErrorKind::BrokenPipe)));
        assert!(!is_closed_output(&failed(ErrorKind::StorageFull)));
    }
}
