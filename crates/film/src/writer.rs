//! Films that are written while the next is rendered.

use std::path::PathBuf;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use crate::{Error, Film, Result, WriteOptions, write_image_with};

/// Films that wait to be written, besides the one that is: each is as large as all of its pixels.
pub const QUEUE_LENGTH: usize = 2;

/// Where a film goes, and how.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Target {
    /// The file; its extension is its format.
    pub path: PathBuf,
    /// How it is made.
    pub options: WriteOptions,
}

/// What a writer did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WriterReport {
    /// Films taken.
    pub film_count: u64,
    /// Files that are whole.
    pub file_count: u64,
    /// Time that was spent on writing.
    pub busy: Duration,
    /// How much of it [`FilmWriter::write`] and [`FilmWriter::finish`] waited for.
    pub waited: Duration,
}

/// A thread that writes films in the order in which they come.
///
/// What could not be written is told by the next call. Films after it are written all the same: frames that are
/// rendered are not lost. A writer that is dropped first writes what it was given; errors are lost then.
#[derive(Debug)]
pub struct FilmWriter {
    /// None once no film can follow.
    queue: Option<SyncSender<Job>>,
    thread: Option<JoinHandle<()>>,
    shared: Arc<Mutex<Shared>>,
    waited: Duration,
}

#[derive(Debug)]
struct Job {
    film: Film,
    targets: Vec<Target>,
}

/// What the thread tells.
#[derive(Debug, Default)]
struct Shared {
    report: WriterReport,
    errors: Vec<Error>,
}

impl FilmWriter {
    /// Starts the thread.
    ///
    /// # Errors
    /// [`Error::WriterStopped`] where the system gives none.
    pub fn new() -> Result<Self> {
        let (queue, jobs) = sync_channel(QUEUE_LENGTH);
        let shared = Arc::new(Mutex::new(Shared::default()));
        let told = Arc::clone(&shared);
        let thread = std::thread::Builder::new().name("film writer".to_owned()).spawn(move || work(&jobs, &told));
        let thread = thread.map_err(|_| Error::WriterStopped)?;
        Ok(Self { queue: Some(queue), thread: Some(thread), shared, waited: Duration::ZERO })
    }

    /// Gives a film away, to be written to each of the targets; waits while the queue is full.
    ///
    /// # Errors
    /// The first of those of [`write_image_with`] for earlier films that was not told yet; this film is taken even so.
    /// [`Error::WriterStopped`].
    pub fn write(&mut self, film: Film, targets: Vec<Target>) -> Result<()> {
        let start = Instant::now();
        let queue = self.queue.as_ref().ok_or(Error::WriterStopped)?;
        let sent = queue.send(Job { film, targets });
        self.waited += start.elapsed();
        self.first_error()?;
        sent.map_err(|_| Error::WriterStopped)
    }

    /// All that could not be written and was not told yet, in order.
    pub fn take_errors(&mut self) -> Vec<Error> {
        std::mem::take(&mut lock(&self.shared).errors)
    }

    /// Waits until all films are written. Calling it again changes nothing; no film can follow.
    ///
    /// # Errors
    /// As [`FilmWriter::write`].
    pub fn finish(&mut self) -> Result<WriterReport> {
        let start = Instant::now();
        let joined = self.join();
        self.waited += start.elapsed();
        self.first_error()?;
        joined?;
        Ok(self.report())
    }

    /// What was done until now.
    pub fn report(&self) -> WriterReport {
        WriterReport { waited: self.waited, ..lock(&self.shared).report }
    }

    fn first_error(&self) -> Result<()> {
        let errors = &mut lock(&self.shared).errors;
        if errors.is_empty() { Ok(()) } else { Err(errors.remove(0)) }
    }

    fn join(&mut self) -> Result<()> {
        // The thread ends when no film can follow.
        self.queue = None;
        self.thread.take().map_or(Ok(()), |thread| thread.join().map_err(|_| Error::WriterStopped))
    }
}

impl Drop for FilmWriter {
    fn drop(&mut self) {
        // There is nobody to tell.
        let _ = self.join();
    }
}

fn work(jobs: &Receiver<Job>, shared: &Mutex<Shared>) {
    for Job { film, targets } in jobs {
        for Target { path, options } in targets {
            let start = Instant::now();
            let written = write_image_with(&film, &path, &options);
            let mut shared = lock(shared);
            shared.report.busy += start.elapsed();
            match written {
                Ok(()) => shared.report.file_count += 1,
                Err(error) => shared.errors.push(error),
            }
        }
        lock(shared).report.film_count += 1;
    }
}

/// Numbers and errors are whole whatever stopped the other thread.
fn lock(shared: &Mutex<Shared>) -> MutexGuard<'_, Shared> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}
