//! The tracer, and the contract by which work and strategy know nothing of each other.

pub mod image;
pub mod scene;
pub mod strategy;
pub mod work;

pub use image::{Area, Digest, Image, Rgb, Tile};
pub use scene::Scene;
pub use strategy::{Plan, Renderer, Strategy, StrategyError, ThreadsStart};
pub use work::Work;
