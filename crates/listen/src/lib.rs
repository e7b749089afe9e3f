//! Listens to what a welding cell publishes, and writes it to logs that [`bead_record`] reads.
//!
//! A [`Source`] is a broker (MQTT) or a server (OPC UA) with what is wanted of it. [`listen`] writes a CSV log for each source, with the
//! times of the source, until it is stopped. It only reads: nothing is published, written or called. A connection that is lost is made
//! again, and the log says so with the events `interrupted` and `resumed`.
//!
//! | file | what it holds |
//! | --- | --- |
//! | `source` | a source, read from TOML |
//! | `payload` | cells and times from what was sent |
//! | `log` | the log, row by row: whole lines only |
//! | `watch` | when to end |
//! | `hearing` | what was heard of a source: its log, what was lost, who is silent |
//! | `mqtt`, `opcua` | the two protocols |

mod error;
mod hearing;
mod log;
mod mqtt;
mod opcua;
mod payload;
mod source;
mod watch;

pub use error::ListenError;
pub use hearing::Heard;
pub use source::Source;
pub use watch::Until;

use hearing::Hearing;
use log::Log;
use source::Address;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::thread;
use watch::Watch;

/// Listens to all sources at once, and writes `NAME.csv` for each of them to a folder. A log that is there already goes on.
///
/// `say` is given what happens while it listens, in sentences.
///
/// # Errors
/// [`ListenError`], if a source cannot be reached to begin with, refuses what is asked of it, or a log cannot be written. The other
/// sources then end too.
pub fn listen(
    sources: &[Source],
    folder: &Path,
    until: Until<'_>,
    say: &(dyn Fn(&str) + Sync),
) -> Result<Vec<Heard>, ListenError> {
    let watch = Watch::new(until, say);
    let listen = |source: &Source| {
        let whole = AssertUnwindSafe(|| Log::open(source, folder).and_then(|log| one(source, log, &watch)));
        // A source that panics ends the others too.
        let heard = catch_unwind(whole).unwrap_or(Err(ListenError::Ended));
        if heard.is_err() {
            watch.end();
        }
        heard
    };
    thread::scope(|scope| {
        let threads: Vec<_> = sources.iter().map(|source| scope.spawn(|| listen(source))).collect();
        threads.into_iter().map(|thread| thread.join().unwrap_or(Err(ListenError::Ended))).collect()
    })
}

/// Listens to one source.
fn one(source: &Source, log: Log, watch: &Watch<'_>) -> Result<Heard, ListenError> {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().map_err(ListenError::System)?;
    let hearing = Hearing::new(source, log, watch);
    runtime.block_on(async {
        match &source.address {
            Address::Mqtt { host, port } => mqtt::listen((host, *port), hearing).await,
            Address::OpcUa => opcua::listen(hearing).await,
        }
    })
}
