//! A work and strategies for the tests of this crate.

use rayweave_contract::{
    Granularity, Image, Output, Plan, Policy, Renderer, Rgb, Scheduling, Strategy, StrategyError,
    Threads, Tile, Work,
};
use std::num::NonZeroU32;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The colour that [`Grey`] gives to every pixel.
pub(crate) const GREY: Rgb = [0.5; 3];

/// The side of the tiles that a [`FakeStrategy`] renders, whatever the plan says.
pub(crate) const SIDE: NonZeroU32 = NonZeroU32::new(2).expect("2 is not 0");

/// A work that only fills.
pub(crate) struct Grey;

impl Work for Grey {
    fn render(&self, tile: &mut Tile<'_>) {
        tile.rows().for_each(|(_, row)| row.fill(GREY));
    }
}

/// A renderer on the caller's thread that leaves out the first tiles, as many as given.
#[derive(Clone, Copy)]
pub(crate) struct Skip(pub(crate) usize);

impl Renderer for Skip {
    fn render(&mut self, work: &dyn Work, image: &mut Image) -> Result<(), StrategyError> {
        image.tiles(SIDE).iter_mut().skip(self.0).for_each(|tile| work.render(tile));
        Ok(())
    }
}

/// A strategy whose name, threads and renderers are those that the test gives.
pub(crate) struct FakeStrategy {
    name: &'static str,
    threads: Threads,
    /// Returns the renderer, by the number of earlier preparations.
    prepare: fn(usize) -> Result<Skip, StrategyError>,
    prepared: AtomicUsize,
}

impl FakeStrategy {
    pub(crate) const fn new(
        name: &'static str,
        threads: Threads,
        prepare: fn(usize) -> Result<Skip, StrategyError>,
    ) -> Self {
        Self { name, threads, prepare, prepared: AtomicUsize::new(0) }
    }

    /// Returns a strategy that renders every tile.
    pub(crate) const fn complete(name: &'static str, threads: Threads) -> Self {
        Self::new(name, threads, |_| Ok(Skip(0)))
    }

    /// Returns a strategy that must not be prepared, because the executor is a fake.
    pub(crate) const fn named(name: &'static str, threads: Threads) -> Self {
        Self::new(name, threads, |_| unreachable!("the executor is a fake"))
    }

    /// Returns the number of preparations.
    pub(crate) fn prepared(&self) -> usize {
        self.prepared.load(Ordering::Relaxed)
    }
}

impl Strategy for FakeStrategy {
    fn name(&self) -> &'static str {
        self.name
    }

    fn summary(&self) -> &'static str {
        "a fake"
    }

    fn threads(&self) -> Threads {
        self.threads
    }

    fn policy(&self) -> Policy {
        Policy {
            granularity: Granularity::Tile,
            scheduling: Scheduling::Dynamic { chunk: 1 },
            output: Output::InPlace,
        }
    }

    fn prepare(&self, _: Plan) -> Result<Box<dyn Renderer>, StrategyError> {
        Ok(Box::new((self.prepare)(self.prepared.fetch_add(1, Ordering::Relaxed))?))
    }
}
