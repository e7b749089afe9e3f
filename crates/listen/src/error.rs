//! Why it is not possible to listen, in sentences for welders.

use std::io;
use std::path::PathBuf;

/// Why a source cannot be listened to.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ListenError {
    /// The file of a source cannot be used.
    #[error("{path}: {reason}", path = path.display())]
    Source {
        /// The file.
        path: PathBuf,
        /// What is wrong and what would be right.
        reason: String,
    },
    /// The broker or server does not answer, or refuses.
    #[error("{url} cannot be listened to: {reason}")]
    Refused {
        /// Its address.
        url: String,
        /// What is wrong and what to do.
        reason: String,
    },
    /// A log cannot be written.
    #[error("{path}: {reason}", path = path.display())]
    Log {
        /// The log.
        path: PathBuf,
        /// What is wrong and what to do.
        reason: String,
    },
    /// The operating system gives no timer or socket.
    #[error("no connection can be opened on this machine: {0}")]
    System(io::Error),
    /// A thread ended unexpectedly.
    #[error("listening ended unexpectedly. Please report this as a fault of Beadwright.")]
    Ended,
}
