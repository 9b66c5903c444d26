//! Lesson 5, `channel-rows`: threads send finished rows to the one thread that owns the image.
//!
//! In OpenMP: no counterpart. Its threads share the image; these share a counter and send their
//! rows.
//!
//! * **New**: no thread writes to the image but its owner, so there is nothing to lock. And the
//!   rows are no longer dealt out beforehand: an atomic counter says which row is next. A thread
//!   adds one to it and computes the row of that number.
//! * **What it decides**: nothing beforehand. A free thread takes the next row, computes it into
//!   memory of its own and sends that. The caller's thread copies it.
//! * **What it costs**: an allocation, a message and a copy for every row, starting the threads,
//!   and one thread more, which only copies. Rows that wait to be copied take memory.
//! * **When it is right**: when results cannot be written in place, because their size is not known
//!   beforehand or they go to a file or a window that one thread owns.

use rayweave_contract::*;
use rayweave_thread_team as thread_team;
use std::iter;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;

/// Finished rows by a channel.
pub static STRATEGY: Strategy = Strategy {
    name: "channel-rows",
    summary: "the next row to a free thread, sent to the image's owner",
    threads: Threads::PerRender,
    policy: Policy::new(Granularity::Row, Scheduling::Dynamic { chunk: 1 }, Output::Channel),
    unavailable: None,
    prepare: &|plan| renderer(move |work, image| render(plan, work, image)),
};

fn render(plan: Plan, work: &dyn Work, image: &mut Image) -> Result<(), RenderError> {
    let (width, height) = (image.width() as usize, image.height() as usize);
    let next = AtomicUsize::new(0);
    let (sender, finished) = mpsc::channel();
    // Each thread owns a sender, so the channel ends with the last of them.
    let senders = iter::repeat_n(sender, plan.threads.get());
    let compute = |team: &thread_team::Team, sender: mpsc::Sender<(usize, Vec<Rgb>)>| {
        loop {
            let y = next.fetch_add(1, Ordering::Relaxed);
            if y >= height {
                return Ok(());
            }
            let mut row = vec![[0.0; 3]; width];
            team.render_tile(work, &mut Tile::row(0, y as u32, &mut row))?;
            // The caller's thread receives until the last sender is gone.
            let _ = sender.send((y, row));
        }
    };
    thread_team::run_with(senders, compute, || {
        for (y, row) in finished {
            image.pixels_mut()[y * width..][..width].copy_from_slice(&row);
        }
    })
}
