//! Distribution of work over threads.

use std::num::NonZero;

/// The least number of items per thread.
const LEAST: usize = 1 << 13;

/// The number of threads to use for a number of items.
pub fn count(items: usize) -> usize {
    if items < 2 * LEAST {
        return 1;
    }
    std::thread::available_parallelism().map_or(1, NonZero::get).min(items / LEAST)
}

/// Runs both functions concurrently, `b` on the calling thread.
pub fn join<A: Send, B: Send>(a: impl FnOnce() -> A + Send, b: impl FnOnce() -> B) -> (A, B) {
    std::thread::scope(|scope| {
        let a = scope.spawn(a);
        let b = b();
        (a.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)), b)
    })
}

/// Runs `work` for all items concurrently, each on a separate thread, the last on the calling thread. The results are
/// in the order of the items.
pub fn each<T: Send, R: Send>(items: impl IntoIterator<Item = T>, work: impl Fn(T) -> R + Sync) -> Vec<R> {
    let mut items: Vec<T> = items.into_iter().collect();
    let Some(last) = items.pop() else { return Vec::new() };
    std::thread::scope(|scope| {
        let work = &work;
        let others: Vec<_> = items.into_iter().map(|item| scope.spawn(move || work(item))).collect();
        let last = work(last);
        let join = |other: std::thread::ScopedJoinHandle<'_, R>| {
            other.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
        };
        let mut results: Vec<R> = others.into_iter().map(join).collect();
        results.push(last);
        results
    })
}
