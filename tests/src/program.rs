//! Running `planish` and judging how it ended.

use std::ffi::OsStr;
use std::path::Path;
use std::process::{Command, ExitStatus};

use serde_json::Value;

use crate::repository;

/// What every error begins with.
const ERROR_PREFIX: &str = "planish: error: ";

/// Exit status of a command that failed.
pub const FAILED: i32 = 1;
/// Exit status of a command line that makes no sense.
pub const WRONG_USAGE: i32 = 2;

/// Where tables are kept for another run. Those of tests are built, unless they ask for a folder.
const TABLE_CACHE: &str = "PLANISH_TABLE_CACHE";

/// A command line of `planish`.
pub struct Planish {
    command: Command,
    line: String,
}

impl Planish {
    /// One of planish's commands.
    pub fn new(command: &str) -> Self {
        let mut planish = Command::new(repository::planish());
        planish.env(TABLE_CACHE, "none");
        Self { command: planish, line: "planish".to_owned() }.flags(command)
    }

    /// `planish dump MESH -o OUT`, under validation.
    pub fn dump(mesh: &Path, out: &Path) -> Self {
        Self::new("dump").path(mesh).flags("-o").path(out).flags("--validation")
    }

    /// `planish render MESH -o OUT`, under validation.
    pub fn render(mesh: &Path, out: &Path) -> Self {
        Self::new("render").path(mesh).flags("-o").path(out).flags("--validation")
    }

    /// `planish info MESH --json`.
    pub fn info(mesh: &Path) -> Self {
        Self::new("info").path(mesh).flags("--json")
    }

    /// Adds words, separated by blanks.
    #[must_use]
    pub fn flags(mut self, words: &str) -> Self {
        self.command.args(words.split_whitespace());
        self.line = format!("{} {words}", self.line);
        self
    }

    /// Adds a path, whatever is in it.
    #[must_use]
    pub fn path(mut self, path: &Path) -> Self {
        self.command.arg(path);
        self.line = format!("{} {}", self.line, path.display());
        self
    }

    /// Sets an environment variable.
    #[must_use]
    pub fn env(mut self, name: &str, value: impl AsRef<OsStr>) -> Self {
        self.line = format!("{name}={} {}", value.as_ref().display(), self.line);
        self.command.env(name, value);
        self
    }

    /// Keeps tables where it would for a user.
    #[must_use]
    pub fn keeping_tables(mut self) -> Self {
        self.command.env_remove(TABLE_CACHE);
        self
    }

    /// Runs it to its end.
    pub fn run(mut self) -> Outcome {
        let output = self.command.output().unwrap_or_else(|error| panic!("{}: {error}", self.line));
        Outcome {
            line: self.line,
            status: output.status,
            stdout: String::from_utf8_lossy(&output.stdout).into_owned(),
            stderr: String::from_utf8_lossy(&output.stderr).into_owned(),
        }
    }
}

/// How a command ended.
#[derive(Debug)]
pub struct Outcome {
    /// The command line, to tell it.
    pub line: String,
    /// Exit status.
    pub status: ExitStatus,
    /// Standard output.
    pub stdout: String,
    /// Standard error.
    pub stderr: String,
}

impl Outcome {
    /// Unless it succeeded without a word on standard error: why not.
    pub fn silent_success(self) -> Result<Self, String> {
        if self.status.success() && self.stderr.is_empty() { Ok(self) } else { Err(self.told("expected success")) }
    }

    /// Unless it ended with this status and one line on standard error that tells an error: why not. Returns what the
    /// line says.
    pub fn one_error(&self, status: i32) -> Result<&str, String> {
        let expected = || self.told(&format!("expected exit status {status} and one line \"{ERROR_PREFIX}..\""));
        let one_line = self.stderr.strip_suffix('\n').filter(|line| !line.contains('\n'));
        let message = one_line.and_then(|line| line.strip_prefix(ERROR_PREFIX)).ok_or_else(expected)?;
        if self.status.code() != Some(status) || message.contains("panicked") || !self.stdout.is_empty() {
            return Err(expected());
        }
        Ok(message)
    }

    /// Unless it either succeeded or failed with one line: why not. For input of which both may be said.
    pub fn success_or_one_error(&self) -> Result<(), String> {
        if self.status.success() { Ok(()) } else { self.one_error(FAILED).map(drop) }
    }

    /// Standard output as JSON.
    pub fn json(&self) -> Result<Value, String> {
        serde_json::from_str(&self.stdout).map_err(|error| self.told(&format!("expected JSON ({error})")))
    }

    /// What was run, what was expected and what came out.
    pub fn told(&self, expected: &str) -> String {
        format!("{}\n  {expected}; {}, standard error: {}", self.line, self.status, self.stderr.trim_end())
    }
}
