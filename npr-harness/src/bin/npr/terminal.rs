//! Messages on the terminal: lines on standard error, progress bars.

use npr_harness::error::{HarnessError, PathRole};
use npr_harness::executor::{CpuReason, Executor};
use std::fmt;
use std::io::{self, IsTerminal, Write};

/// Removes line breaks and control characters, because names in files may contain anything.
pub fn one_line(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}

/// Writes a line to standard error.
pub fn tell(text: &str) {
    // An error here cannot be reported anywhere else.
    let _ = writeln!(io::stderr().lock(), "{text}");
}

/// Writes to standard output. A closed pipe, as with `head`, is not an error: the work continues.
pub fn say(text: fmt::Arguments<'_>) -> Result<(), HarnessError> {
    match io::stdout().lock().write_fmt(text) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(HarnessError::Unusable { role: PathRole::Output, path: "-".into(), source: error })
        }
        _ => Ok(()),
    }
}

/// A progress bar on a terminal; otherwise nothing.
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

/// Prints the reason why the CPU renders if a GPU was wanted but is missing or not capable.
pub fn announce(executor: &Executor) {
    if let Executor::Cpu { why: Some(why @ CpuReason::Unable(_)) } = executor {
        tell(&format!("npr: rendering on the CPU: {}", one_line(&why.to_string())));
    }
}
