//! `channel-rows`: N threads compute rows and send them to the one thread that owns the image.
//!
//! * **What it decides**: that threads share only the next row's number and a channel. A thread
//!   takes the next row, computes it into memory of its own, and sends that; the caller's thread
//!   copies.
//! * **What it costs**: an allocation, a message and a copy for every row, the samples that a row
//!   shares with its neighbours, starting the threads within every rendering, and a thread more
//!   than N that only copies. Rows that are not copied yet take memory: at the worst as much as
//!   the image.
//! * **When it is right**: when results must not be written in place, because their size is not
//!   known beforehand, or they go to a file or a window that one thread owns.

use rayweave_contract::{
    Granularity, Image, Output, Plan, Policy, Renderer, Rgb, Scheduling, Strategy, StrategyError,
    Threads, Tile, Work,
};
use rayweave_thread_team as thread_team;
use std::iter;
use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::mpsc;

const NAME: &str = "channel-rows";

/// Threads that send finished rows to the one that owns the image.
#[derive(Debug)]
pub struct ChannelRows;

impl Strategy for ChannelRows {
    fn name(&self) -> &'static str {
        NAME
    }

    fn summary(&self) -> &'static str {
        "threads take the next row and send it to the caller's thread, which copies it"
    }

    fn threads(&self) -> Threads {
        Threads::PerRender
    }

    fn policy(&self) -> Policy {
        Policy {
            granularity: Granularity::Row,
            scheduling: Scheduling::Dynamic { chunk: 1 },
            output: Output::Channel,
        }
    }

    fn prepare(&self, plan: Plan) -> Result<Box<dyn Renderer>, StrategyError> {
        Ok(Box::new(Channel { threads: plan.threads }))
    }
}

struct Channel {
    threads: NonZeroUsize,
}

impl Renderer for Channel {
    fn render(&mut self, work: &dyn Work, image: &mut Image) -> Result<(), StrategyError> {
        let (width, height) = (image.width() as usize, image.height());
        let next = AtomicU32::new(0);
        let (sender, finished) = mpsc::channel::<(u32, Vec<Rgb>)>();
        // Each thread owns a sender, so the channel ends with the last of them.
        let senders = iter::repeat_n(sender, self.threads.get());
        let compute = |team: &thread_team::Team, sender: mpsc::Sender<_>| {
            loop {
                let y = next.fetch_add(1, Ordering::Relaxed);
                if y >= height {
                    return Ok(());
                }
                let mut row = vec![[0.0; 3]; width];
                team.render_tile(work, &mut Tile::row(0, y, &mut row))?;
                // The caller's thread receives until the last sender is gone.
                let _ = sender.send((y, row));
            }
        };
        thread_team::run_with(NAME, senders, compute, || {
            for (y, row) in finished {
                let begin = y as usize * width;
                image.pixels_mut()[begin..begin + width].copy_from_slice(&row);
            }
        })
    }
}
