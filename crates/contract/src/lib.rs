//! The contract that separates work from strategies.
//!
//! * [`Work`] is a pure function that fills any [`Tile`] of an [`Image`]; the tracer is one.
//! * A [`Strategy`] decides which thread computes which tile, and states its [`Policy`]. Prepared
//!   for a [`Plan`], it is a [`Renderer`].
//! * Whatever observes a rendering is a `Work` around a `Work`.
//!
//! This crate starts no thread, opens no file and reads no clock.
//!
//! ```
//! use rayweave_contract::{Image, Renderer, Tile, Work, render_tile};
//!
//! /// A gradient: the work.
//! struct Gradient;
//!
//! impl Work for Gradient {
//!     fn render(&self, tile: &mut Tile<'_>) {
//!         let left = tile.rect().x;
//!         for (y, row) in tile.rows() {
//!             for (x, color) in (left..).zip(row) {
//!                 *color = [x as f32, y as f32, 0.0];
//!             }
//!         }
//!     }
//! }
//!
//! // One tile after the other: the simplest renderer.
//! let mut one_by_one = Renderer::new("one-by-one", |work, image| {
//!     let mut tiles = image.tiles(std::num::NonZeroU32::new(2).unwrap());
//!     tiles.iter_mut().try_for_each(|tile| render_tile(work, tile))
//! });
//!
//! let mut image = Image::new(3, 2)?;
//! one_by_one.render(&Gradient, &mut image)?;
//! assert_eq!(image.pixels()[5], [2.0, 1.0, 0.0]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod image;
mod policy;
mod strategy;
mod tile;
mod work;

pub use image::{Digest, Image, ImageError, MAX_PIXELS, ParseDigestError};
pub use policy::{Granularity, Output, Policy, Scheduling, Threads};
pub use strategy::{
    Plan, Prepare, RenderError, RenderFn, Renderer, Strategy, StrategyError, panic_message,
    render_tile, renderer,
};
pub use tile::{Rect, Rgb, Tile};
pub use work::Work;
