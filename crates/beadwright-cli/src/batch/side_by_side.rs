//! Runs on all processors, as many at a time as there are threads, with the results in the order of the runs.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

/// The results of all items, in their order. Every thread has a pool of its own and takes the next item when it is done
/// with one: in a common pool, a plan that waits would begin others, and the memory of all of them would add up.
pub(super) fn map<T: Sync, R: Send>(
    items: &[T],
    threads: Option<u16>,
    each: impl Fn(&T) -> R + Sync,
) -> anyhow::Result<Vec<R>> {
    let threads = match threads {
        Some(threads) => threads.into(),
        None => thread::available_parallelism()?.get(),
    };
    let workers = threads.min(items.len()).max(1);
    let pools = (0..workers).map(|_| rayon::ThreadPoolBuilder::new().num_threads(threads / workers).build());
    let pools: Vec<rayon::ThreadPool> = pools.collect::<Result<_, _>>()?;
    let next = AtomicUsize::new(0);
    let work = || {
        let mut done = Vec::new();
        while let Some((i, item)) = take(items, &next) {
            done.push((i, each(item)));
        }
        done
    };
    let mut done: Vec<(usize, R)> = thread::scope(|scope| {
        let working: Vec<_> = pools.iter().map(|pool| scope.spawn(|| pool.install(work))).collect();
        // A panic continues here.
        working.into_iter().flat_map(|worker| worker.join().unwrap_or_else(|e| std::panic::resume_unwind(e))).collect()
    });
    done.sort_by_key(|(i, _)| *i);
    Ok(done.into_iter().map(|(_, result)| result).collect())
}

/// The next item that nobody has taken.
fn take<'a, T>(items: &'a [T], next: &AtomicUsize) -> Option<(usize, &'a T)> {
    let i = next.fetch_add(1, Ordering::Relaxed);
    items.get(i).map(|item| (i, item))
}
