use crate::called;
use crate::interrupt::Interrupt;
use harness::Progress;
use indicatif::{ProgressBar, ProgressStyle};

/// A bar on the terminal's standard error, on a terminal only.
pub(crate) fn bar(label: &str, steps: u64) -> ProgressBar {
    let bar = ProgressBar::new(steps);
    // The template is a constant; should it ever not parse, the default style serves.
    if let Ok(style) = ProgressStyle::with_template("{msg:<28} {wide_bar} {percent:>3} %  {per_sec}  {eta} left") {
        bar.set_style(style);
    }
    bar.set_message(label.to_owned());
    called::watch(&bar);
    bar
}

/// A bar whose work Ctrl-C ends.
pub(crate) struct Interruptible<'a> {
    pub(crate) bar: ProgressBar,
    pub(crate) interrupt: &'a Interrupt,
}

impl Progress for Interruptible<'_> {
    fn advance(&mut self, steps: u64) {
        self.bar.inc(steps);
    }

    fn stops(&self) -> bool {
        self.interrupt.asked()
    }
}
