//! The contract by which work and strategy know nothing of each other.

mod image;
mod policy;
mod strategy;
mod tile;
mod work;

pub use image::{Digest, Image, ImageError, MAX_PIXELS, NotADigest, Rgb};
pub use policy::{Dealing, Delivery, Piece, Rule};
pub use strategy::{
    Plan, Renderer, Strategy, StrategyError, ThreadsStart, panic_message, render_tile,
};
pub use tile::{Area, Tile};
pub use work::Work;
