//! How much memory may be used: a run that would need more is stopped with a sentence before the machine begins to swap.

use crate::progress;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use sysinfo::{MemoryRefreshKind, ProcessRefreshKind, ProcessesToUpdate, RefreshKind, System};

static LIMIT: OnceLock<u64> = OnceLock::new();
static EXCEEDED: AtomicBool = AtomicBool::new(false);

/// Maximum fraction of the machine's memory that is used by default.
const PART: f64 = 0.75;
/// Beyond this multiple of the limit, or this long after it was reached, the run is killed without further waiting.
const PATIENCE: (f64, Duration) = (1.15, Duration::from_secs(3));
/// Time between two checks.
const PAUSE: Duration = Duration::from_millis(20);

/// Most bytes that may be used.
pub(crate) fn limit() -> u64 {
    *LIMIT.get_or_init(|| {
        let memory = RefreshKind::nothing().with_memory(MemoryRefreshKind::nothing().with_ram());
        let system = System::new_with_specifics(memory);
        let total = system.cgroup_limits().map_or(system.total_memory(), |limits| limits.total_memory);
        // Where the system does not say, nothing is limited.
        if total == 0 { u64::MAX } else { (total as f64 * PART) as u64 }
    })
}

/// Watches this process from now on; `most` is what it may use, GB.
pub(crate) fn watch(most: Option<f64>) {
    if let Some(most) = most {
        _ = LIMIT.set((most * 1e9) as u64);
    }
    #[cfg(unix)]
    space::guard();
    let limit = limit();
    let watching = move || {
        let Ok(own) = sysinfo::get_current_pid() else { return };
        let (mut system, mut waited) = (System::new(), Duration::ZERO);
        loop {
            std::thread::sleep(PAUSE);
            let wanted = ProcessRefreshKind::nothing().with_memory();
            system.refresh_processes_specifics(ProcessesToUpdate::Some(&[own]), false, wanted);
            let used = system.process(own).map_or(0, sysinfo::Process::memory);
            if used > limit || waited > Duration::ZERO {
                EXCEEDED.store(true, Ordering::Relaxed);
                progress::cancel();
                waited += PAUSE;
            }
            if used as f64 > PATIENCE.0 * limit as f64 || waited > PATIENCE.1 {
                eprintln!("error: {}", sentence());
                std::process::exit(1);
            }
        }
    };
    if std::thread::Builder::new().spawn(watching).is_err() {
        eprintln!("error: {}", sentence());
        std::process::exit(1);
    }
}

/// The sentence for a run that was stopped because of its memory, or that was refused some when it asked.
pub(crate) fn exceeded(error: &anyhow::Error) -> Option<String> {
    let kind =
        |cause: &(dyn std::error::Error + 'static)| cause.downcast_ref::<std::io::Error>().map(std::io::Error::kind);
    let refused = error.chain().any(|cause| kind(cause) == Some(std::io::ErrorKind::OutOfMemory));
    #[cfg(unix)]
    if let Some(limit) = space::limit().filter(|_| refused) {
        return Some(too_much(limit, space::ULIMIT));
    }
    (refused || EXCEEDED.load(Ordering::Relaxed)).then(sentence)
}

fn sentence() -> String {
    too_much(limit(), "--max-memory GB")
}

fn too_much(limit: u64, remedy: &str) -> String {
    let digits = if limit < 100_000_000 { 2 } else { 1 };
    format!(
        "more than {:.digits$} GB of memory would be needed, and nothing was written. Use a coarser model or --grid, or allow \
         more with {remedy}.",
        limit as f64 / 1e9
    )
}

/// The limit of the shell (`ulimit -v`): if an allocation fails, Rust aborts, and the sentence is printed on the way
/// out.
#[cfg(unix)]
mod space {
    use rustix::process::{Resource, getrlimit};
    use signal_hook::consts::SIGABRT;
    use signal_hook::low_level;

    pub(super) const ULIMIT: &str = "ulimit -v KB";

    /// The limit of the shell, bytes.
    pub(super) fn limit() -> Option<u64> {
        getrlimit(Resource::As).current
    }

    pub(super) fn guard() {
        let Some(limit) = limit() else { return };
        let line = format!("error: {}\n", super::too_much(limit, ULIMIT));
        let say = move || {
            _ = rustix::io::write(rustix::stdio::stderr(), line.as_bytes());
            low_level::exit(1);
        };
        // Safety: the handler only writes bytes that already exist, and ends the process.
        #[expect(unsafe_code, reason = "no safe function says something when memory is out")]
        let registered = unsafe { low_level::register(SIGABRT, say) };
        _ = registered;
    }
}
