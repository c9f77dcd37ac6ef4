//! What is said to people: lines on standard error, progress bars.

use npr_harness::error::{HarnessError, PathRole};
use npr_harness::executor::{CpuReason, Executor};
use std::fmt;
use std::io::{self, IsTerminal, Write};

/// Names in files may hold anything; no line break of theirs, and nothing that commands a terminal, is printed.
pub fn one_line(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}

/// Writes a line to standard error, where somebody reads it.
pub fn tell(text: &str) {
    // There is no other place to say that this one is closed or full.
    let _ = writeln!(io::stderr().lock(), "{text}");
}

/// Writes to standard output. A reader that has had enough, such as `head`, is no error: the work goes on.
pub fn say(text: fmt::Arguments<'_>) -> Result<(), HarnessError> {
    match io::stdout().lock().write_fmt(text) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(HarnessError::Unusable { role: PathRole::Output, path: "-".into(), source: error })
        }
        _ => Ok(()),
    }
}

/// A bar on a terminal, nothing elsewhere.
pub fn progress_bar(what: &str) -> indicatif::ProgressBar {
    if !io::stderr().is_terminal() {
        return indicatif::ProgressBar::hidden();
    }
    let bar = indicatif::ProgressBar::new(1000);
    if let Ok(style) = indicatif::ProgressStyle::with_template("{msg:24} {bar:40} {percent:>3}% {eta}") {
        bar.set_style(style);
    }
    bar.set_message(what.to_owned());
    bar
}

pub fn spinner(what: &str) -> indicatif::ProgressBar {
    if !io::stderr().is_terminal() {
        return indicatif::ProgressBar::hidden();
    }
    let bar = indicatif::ProgressBar::new_spinner();
    bar.set_message(what.to_owned());
    bar.enable_steady_tick(std::time::Duration::from_millis(200));
    bar
}

/// Says why the CPU renders, where a device was wanted and is not there or cannot.
pub fn announce(executor: &Executor) {
    if let Executor::Cpu { why: Some(why @ CpuReason::Unable(_)) } = executor {
        tell(&format!("npr: rendering on the CPU: {}", one_line(&why.to_string())));
    }
}
