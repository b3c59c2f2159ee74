//! Two things at once.

use std::sync::Mutex;

/// What `a` and `b` give; `a` runs in a thread of its own meanwhile, if the system has one to give.
pub fn both<A: Send, B>(a: impl FnOnce() -> A + Send, b: impl FnOnce() -> B) -> (A, B) {
    let a = Mutex::new(Some(a));
    let run = || {
        let a = a.lock().expect("nothing panics while it is held").take();
        a.map(|a| a())
    };
    std::thread::scope(|scope| {
        let thread = std::thread::Builder::new().spawn_scoped(scope, run);
        let b = b();
        let a = match thread {
            Ok(thread) => thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)),
            Err(_) => run(),
        };
        (a.expect("it ran once"), b)
    })
}
