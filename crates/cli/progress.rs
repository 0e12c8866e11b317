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

/// Does work under a bar of `steps` steps; a signal ends the work.
pub(crate) fn shown<T>(
    label: &str,
    steps: u64,
    interrupt: &Interrupt,
    work: impl FnOnce(&mut Interruptible<'_>) -> T,
) -> T {
    let mut progress = Interruptible { bar: bar(label, steps), interrupt };
    let done = work(&mut progress);
    progress.bar.finish_and_clear();
    done
}

/// Makes `count` things on all threads, under a bar; `None` for those that had not begun when a signal came.
pub(crate) fn in_parallel<T: Send>(
    label: &str,
    count: usize,
    interrupt: &Interrupt,
    each: impl Fn(usize) -> T + Sync,
) -> Vec<Option<T>> {
    let bar = bar(label, count as u64);
    let one = |i: usize| {
        let made = (!interrupt.asked()).then(|| each(i));
        bar.inc(u64::from(made.is_some()));
        made
    };
    let made = harness::analysis::in_parallel(count, one);
    bar.finish_and_clear();
    made
}

/// A bar whose work Ctrl-C ends.
pub(crate) struct Interruptible<'a> {
    bar: ProgressBar,
    interrupt: &'a Interrupt,
}

impl Progress for Interruptible<'_> {
    fn advance(&mut self, steps: u64) {
        self.bar.inc(steps);
    }

    fn stops(&self) -> bool {
        self.interrupt.asked()
    }
}
