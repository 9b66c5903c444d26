//! Measures each sample of a comparison in a process of its own: this program, started as `sample`
//! with a job.
//!
//! Thus no waiting pool, spinning team or warm allocator of one strategy affects another.

use crate::interrupt::Interrupt;
use crate::options::SceneOptions;
use rayweave_measure::compare::{Entry, Executor};
use rayweave_measure::measurement::Sample;
use serde::{Deserialize, Serialize};
use std::env;
use std::ffi::OsString;
use std::fs;
use std::io::{BufRead, BufReader};
use std::num::{NonZeroU32, NonZeroUsize};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::{Duration, Instant};

/// A process counts as stuck after this many times the time of the slowest process before it.
const PATIENCE: u32 = 100;

/// The shortest time after which a process counts as stuck, and the longest without CPU time.
const LEAST_PATIENCE: Duration = Duration::from_secs(60);

/// A request for one rendering: the argument of `sample`, as JSON.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Job {
    /// The process that waits for the answer.
    pub parent: u32,
    /// The scene file with any name that the system allows; `None` is the lab report's scene.
    pub scene: Option<OsString>,
    /// The options of the scene.
    pub options: SceneOptions,
    /// The side of a tile in pixels.
    pub tile: NonZeroU32,
    /// The strategy's name.
    pub strategy: String,
    /// The number of computing threads.
    pub threads: NonZeroUsize,
    /// True to render once and count the rays, instead of twice with all times.
    pub count_rays: bool,
}

/// The answer that `sample` prints as JSON: a sample, or the reason why there is none.
pub type Answer = Result<Sample, String>;

/// The executor that starts a process for each rendering of one scene.
pub struct SubprocessExecutor {
    program: PathBuf,
    /// The part of the job that is the same for all strategies, threads and purposes.
    job: Job,
    begin: Instant,
    /// The longest time that a process took to answer.
    slowest: Option<Duration>,
    interrupt: Interrupt,
}

impl SubprocessExecutor {
    /// Returns an executor of jobs like `job`.
    pub fn new(job: Job, interrupt: &Interrupt) -> Result<Self, String> {
        let program = own_program()?;
        let (begin, interrupt) = (Instant::now(), interrupt.clone());
        Ok(Self { program, job, begin, slowest: None, interrupt })
    }

    fn ask(&mut self, entry: &Entry<'_>, count_rays: bool) -> Answer {
        let begin = Instant::now();
        let strategy = entry.strategy.name.to_owned();
        let job = Job { strategy, threads: entry.threads, count_rays, ..self.job.clone() };
        let job = serde_json::to_string(&job).map_err(|e| e.to_string())?;
        let whole = self.slowest.map(|slowest| (slowest * PATIENCE).max(LEAST_PATIENCE));
        let patience = Patience { whole, idle: LEAST_PATIENCE };
        let mut command = Command::new(&self.program);
        let text = output(command.args(["sample", &job]), patience, &self.interrupt)?;
        let answer: Answer = serde_json::from_str(&text)
            .map_err(|e| format!("the answer of its process is not valid: {e}"))?;
        if answer.is_ok() {
            self.slowest = self.slowest.max(Some(begin.elapsed()));
        }
        answer
    }
}

impl Executor for SubprocessExecutor {
    fn render(&mut self, entry: &Entry<'_>) -> Answer {
        self.ask(entry, false)
    }

    fn warm_up(&mut self, entry: &Entry<'_>) -> Answer {
        self.ask(entry, true)
    }

    fn elapsed(&self) -> Duration {
        self.begin.elapsed()
    }

    fn is_interrupted(&self) -> bool {
        self.interrupt.happened()
    }
}

/// Returns the path by which this program is started again. On Linux it leads to the running
/// program even after its file was replaced or removed, by a build for example.
fn own_program() -> Result<PathBuf, String> {
    let running = Path::new("/proc/self/exe");
    if cfg!(target_os = "linux") && running.exists() {
        return Ok(running.to_owned());
    }
    env::current_exe().map_err(|e| format!("cannot find this program's own file: {e}"))
}

/// A child process that is killed when dropped.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        // An error means that it has ended by itself.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// The time between two looks at a process. A look takes some microseconds beside the measured
/// threads.
const LOOK: Duration = Duration::from_millis(100);

/// The limits of waiting for a process. Time in which this program was stopped too does not count.
#[derive(Clone, Copy)]
struct Patience {
    /// The longest time without an answer.
    whole: Option<Duration>,
    /// The longest time in which it uses no CPU time: it is stopped, or in a deadlock.
    idle: Duration,
}

/// Returns the first line of a process's standard output, or the reason why there is none. The
/// process is killed when patience ends, or when the run is interrupted.
fn output(
    command: &mut Command,
    patience: Patience,
    interrupt: &Interrupt,
) -> Result<String, String> {
    let child = command.stdin(Stdio::null()).stdout(Stdio::piped()).spawn();
    let mut child = Running(child.map_err(|e| format!("its process cannot be started: {e}"))?);
    let stdout = child.0.stdout.take();
    let (sender, receiver) = mpsc::channel();
    let read = move || {
        let mut text = String::new();
        let read = stdout.map_or(Ok(0), |stdout| BufReader::new(stdout).read_line(&mut text));
        // Nobody receives once patience has ended.
        let _ = sender.send(read.map(|_| text));
    };
    // The reader sleeps until the process writes or ends.
    let reader = thread::Builder::new().spawn(read);
    reader.map_err(|e| format!("the output of its process cannot be read: {e}"))?;
    let mut wait = Wait::new(child.0.id(), patience);
    loop {
        match receiver.recv_timeout(LOOK) {
            Ok(Ok(line)) if !line.is_empty() => return Ok(line),
            Ok(Err(error)) => return Err(format!("its answer cannot be read: {error}")),
            Err(RecvTimeoutError::Timeout) => wait.look(interrupt)?,
            // It has closed its output without an answer.
            Ok(Ok(_)) | Err(RecvTimeoutError::Disconnected) => break,
        }
    }
    loop {
        match child.0.try_wait() {
            Ok(Some(status)) => {
                return Err(format!("its process ended without an answer: {status}"));
            }
            Ok(None) => thread::sleep(LOOK),
            Err(error) => return Err(format!("its process is lost: {error}")),
        }
        wait.look(interrupt)?;
    }
}

/// The time that a process has been waited for.
struct Wait {
    process: u32,
    patience: Patience,
    last_look: Instant,
    whole: Duration,
    idle: Duration,
    cpu_time: Option<u64>,
}

impl Wait {
    fn new(process: u32, patience: Patience) -> Self {
        let (whole, idle) = (Duration::ZERO, Duration::ZERO);
        Self { process, patience, last_look: Instant::now(), whole, idle, cpu_time: None }
    }

    /// Returns the reason to wait no longer as an error.
    fn look(&mut self, interrupt: &Interrupt) -> Result<(), String> {
        // A longer time means that this program was stopped as well.
        let passed = self.last_look.elapsed().min(2 * LOOK);
        self.last_look = Instant::now();
        self.whole += passed;
        self.idle += passed;
        let cpu_time = cpu_time(self.process);
        if cpu_time != self.cpu_time {
            (self.cpu_time, self.idle) = (cpu_time, Duration::ZERO);
        }
        if interrupt.happened() {
            Err("interrupted".to_owned())
        } else if let Some(whole) = self.patience.whole.filter(|&whole| self.whole >= whole) {
            let seconds = whole.as_secs();
            Err(format!("no answer after {seconds} s, perhaps a deadlock: its process was killed"))
        } else if cpu_time.is_some() && self.idle >= self.patience.idle {
            Err(format!(
                "its process did not run for {} s (stopped, or a deadlock?): it was killed",
                self.patience.idle.as_secs()
            ))
        } else {
            Ok(())
        }
    }
}

/// Returns the CPU time of a process in clock ticks, on Linux.
fn cpu_time(process: u32) -> Option<u64> {
    let stat = fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
    // The name before the last parenthesis may contain anything.
    let (_, fields) = stat.rsplit_once(')')?;
    let mut fields = fields.split_whitespace().skip(11).map(|field| field.parse::<u64>().ok());
    Some(fields.next()?? + fields.next()??)
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    const SHORT: Patience =
        Patience { whole: Some(Duration::from_secs(1)), idle: Duration::from_secs(60) };

    fn shell(script: &str, patience: Patience) -> Result<String, String> {
        output(Command::new("sh").args(["-c", script]), patience, &Interrupt::never())
    }

    /// Catches an answer that is lost because something else keeps the pipe, or that is awaited
    /// although the process is gone, or has closed its output.
    #[test]
    fn a_process_answers_or_ends_or_is_given_up() {
        let long = Patience { whole: Some(LEAST_PATIENCE), idle: LEAST_PATIENCE };
        let killed = "its process ended without an answer: signal: 9 (SIGKILL)";
        let late = "no answer after 1 s, perhaps a deadlock: its process was killed";
        for (script, patience, expected) in [
            ("echo words", long, Ok("words\n")),
            ("echo words; echo more", long, Ok("words\n")),
            ("sleep 3 2>&1 & echo words", long, Ok("words\n")),
            ("echo words; exec sleep 1000", long, Ok("words\n")),
            ("exit 3", long, Err("its process ended without an answer: exit status: 3")),
            ("kill -9 $$", long, Err(killed)),
            ("exec >&-; exec sleep 1000", SHORT, Err(late)),
            (
                "printf '\\377\\n'",
                long,
                Err("its answer cannot be read: stream did not contain valid UTF-8"),
            ),
        ] {
            let expected = expected.map(str::to_owned).map_err(str::to_owned);
            assert_eq!(shell(script, patience), expected, "{script}");
        }
        let missing = output(&mut Command::new("/no/such/program"), long, &Interrupt::never());
        let missing = missing.expect_err("missing");
        assert!(missing.starts_with("its process cannot be started: "), "{missing}");
    }

    /// Catches a process that keeps running after the program stops waiting for it.
    #[test]
    fn a_stuck_process_is_ended() {
        let folder = tempfile::TempDir::new().expect("a temporary folder");
        let file = folder.path().join("pid");
        let script = format!("echo $$ > {}; exec sleep 1000", file.display());
        shell(&script, SHORT).expect_err("stuck");
        let pid = fs::read_to_string(&file).expect("its number").trim().to_owned();
        let alive = Command::new("sh").args(["-c", &format!("kill -0 {pid} 2>/dev/null")]).status();
        assert!(!alive.expect("a shell").success(), "{pid} is alive");
    }

    /// Catches a first process, for which there is no other limit, that is waited for without end.
    #[cfg(target_os = "linux")]
    #[test]
    fn a_stopped_process_is_given_up() {
        let patience = Patience { whole: None, idle: Duration::from_secs(1) };
        let stopped = shell("kill -STOP $$; echo words", patience).expect_err("stopped");
        let expected = "its process did not run for 1 s (stopped, or a deadlock?): it was killed";
        assert_eq!(stopped, expected);
    }
}
