//! The faults that a check can find in a strategy, with the pixel, the tile and the thread.

use crate::recorder::Computation;
use rayweave_contract::Rgb;
use serde::ser::SerializeStruct;
use serde::{Serialize, Serializer};
use std::fmt;
use std::time::Duration;

/// A fault of a strategy, and the rendering in which it shows.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finding {
    /// The strategy's name.
    pub strategy: &'static str,
    /// The number of computing threads asked for.
    pub threads: usize,
    /// The rendering in which the fault shows; `None` if it is not about one.
    #[serde(rename = "picture")]
    pub render: Option<CheckedRender>,
    /// The fault.
    #[serde(flatten)]
    pub fault: Fault,
}

/// One rendering of a check.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct CheckedRender {
    /// The name of the work.
    pub scene: String,
    /// The width of the image in pixels.
    pub width: u32,
    /// The height of the image in pixels.
    pub height: u32,
    /// The side of a tile, in pixels.
    pub tile: u32,
    /// The repetition: 1, or 2 if the same renderer renders the image again.
    pub repetition: usize,
}

/// A fault of a strategy. Pixels are counted over the whole image; the first one is the first in
/// reading order.
#[derive(Clone, Debug, PartialEq)]
pub enum Fault {
    /// The image is not the reference's.
    Different(PixelDifference),
    /// Pixels were written, but not computed exactly once.
    NotOnce {
        /// The number of such pixels.
        pixels: usize,
        /// The column of the first.
        x: u32,
        /// The row of the first.
        y: u32,
        /// Every computation of the first; empty when it was written without being computed.
        computations: Vec<Computation>,
    },
    /// More threads computed than were asked for.
    TooManyThreads {
        /// The expected number: that asked for, or 1 for a strategy that starts no threads.
        expected: usize,
        /// The number of threads that computed.
        found: usize,
    },
    /// Fewer threads computed at the same time than were asked for.
    TooFewThreads {
        /// The number asked for.
        expected: usize,
        /// The largest number of threads that were inside the work at the same time.
        found: usize,
        /// The time that these waited for another one.
        waited: Duration,
    },
    /// The strategy returned an error or panicked, with this message.
    Failed(String),
}

/// The pixels in which an image differs from the reference.
#[derive(Clone, Debug)]
pub struct PixelDifference {
    /// The number of differing pixels.
    pub pixels: usize,
    /// The column of the first.
    pub x: u32,
    /// The row of the first.
    pub y: u32,
    /// The reference's colour there.
    pub expected: Rgb,
    /// The colour found there; `None` if the pixel was not written.
    pub found: Option<Rgb>,
    /// The last computation of the pixel; `None` if there was none.
    pub computation: Option<Computation>,
}

/// Compares the bits of colours, so that a NaN equals itself.
impl PartialEq for PixelDifference {
    fn eq(&self, other: &Self) -> bool {
        let bits = |color: Rgb| color.map(f32::to_bits);
        (self.pixels, self.x, self.y) == (other.pixels, other.x, other.y)
            && bits(self.expected) == bits(other.expected)
            && self.found.map(bits) == other.found.map(bits)
            && self.computation == other.computation
    }
}

/// Serializes the kind of fault and its message.
impl Serialize for Fault {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let kind = match self {
            Self::Different(_) => "different",
            Self::NotOnce { .. } => "not-once",
            Self::TooManyThreads { .. } | Self::TooFewThreads { .. } => "threads",
            Self::Failed(_) => "failed",
        };
        let mut fault = serializer.serialize_struct("Fault", 2)?;
        fault.serialize_field("kind", kind)?;
        fault.serialize_field("message", &self.to_string())?;
        fault.end()
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let plural = if self.threads == 1 { "" } else { "s" };
        write!(f, "{}, {} thread{plural}", self.strategy, self.threads)?;
        if let Some(render) = &self.render {
            write!(f, ", {render}")?;
        }
        write!(f, ": {}", self.fault)
    }
}

impl fmt::Display for CheckedRender {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}x{}, tiles of {}", self.scene, self.width, self.height, self.tile)?;
        if self.repetition > 1 { write!(f, ", rendered again") } else { Ok(()) }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Different(difference) => difference.fmt(f),
            Self::NotOnce { pixels, x, y, computations } => {
                write!(f, "pixels not computed exactly once: {pixels}, first ({x}, {y}), ")?;
                match computations.as_slice() {
                    [] => write!(f, "never computed"),
                    several => {
                        write!(f, "computed {} times", several.len())?;
                        several.iter().try_for_each(|computation| write!(f, ", {computation}"))
                    }
                }
            }
            Self::TooManyThreads { expected, found } => {
                write!(f, "computing threads: expected {expected}, found {found}")
            }
            Self::TooFewThreads { expected, found, waited } => {
                let threads = match found {
                    0 => "no thread was".to_owned(),
                    1 => "only one thread was".to_owned(),
                    _ => format!("only {found} threads were"),
                };
                write!(
                    f,
                    "computing threads: expected {expected}, found {found}: {threads} inside the \
                     work at any time within {} s (a lock held while computing?)",
                    waited.as_secs_f64()
                )
            }
            Self::Failed(message) => f.write_str(message),
        }
    }
}

impl fmt::Display for PixelDifference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { pixels, x, y, expected, found, computation } = self;
        write!(
            f,
            "differing pixels: {pixels}, first ({x}, {y}), expected {}, found ",
            Color(*expected)
        )?;
        match found {
            Some(color) => write!(f, "{}", Color(*color))?,
            None => write!(f, "never written")?,
        }
        match computation {
            Some(computation) => write!(f, ", computed in {computation}"),
            None => write!(f, ", never computed"),
        }
    }
}

/// A colour whose text differs if its bits differ.
struct Color(Rgb);

impl fmt::Display for Color {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let channel = |value: f32| match value.is_nan() {
            true => format!("NaN({:#x})", value.to_bits()),
            false => format!("{value:?}"),
        };
        write!(f, "[{}]", self.0.map(channel).join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recorder::ComputingThread;
    use rayweave_contract::Rect;

    fn computation() -> Computation {
        let tile = Rect { x: 8, y: 16, width: 8, height: 4 };
        Computation {
            tile,
            thread: ComputingThread { index: 1, name: Some("tile-queue 0".to_owned()) },
        }
    }

    #[test]
    fn a_difference_says_everything() {
        let render = CheckedRender {
            scene: "room".to_owned(),
            width: 97,
            height: 61,
            tile: 8,
            repetition: 2,
        };
        let difference = PixelDifference {
            pixels: 32,
            x: 9,
            y: 17,
            expected: [0.1, 1.0, -0.0],
            found: Some([0.1f32.next_up(), f32::from_bits(0x7fc0_0001), 0.0]),
            computation: Some(computation()),
        };
        let mut finding = Finding {
            strategy: "tile-queue",
            threads: 2,
            render: Some(render),
            fault: Fault::Different(difference.clone()),
        };
        assert_eq!(
            finding.to_string(),
            "tile-queue, 2 threads, room 97x61, tiles of 8, rendered again: differing pixels: 32, \
             first (9, 17), expected [0.1, 1.0, -0.0], found [0.10000001, NaN(0x7fc00001), 0.0], \
             computed in tile 8x4 at (8, 16) by thread 1 (\"tile-queue 0\")"
        );
        finding.fault =
            Fault::Different(PixelDifference { found: None, computation: None, ..difference });
        assert!(finding.to_string().ends_with("found never written, never computed"));
    }

    #[test]
    fn the_other_faults() {
        let finding =
            |fault| Finding { strategy: "one", threads: 1, render: None, fault }.to_string();
        assert_eq!(
            finding(Fault::TooManyThreads { expected: 1, found: 2 }),
            "one, 1 thread: computing threads: expected 1, found 2"
        );
        for (found, threads) in
            [(0, "no thread was"), (1, "only one thread was"), (2, "only 2 threads were")]
        {
            let waited = Duration::from_secs(1);
            assert_eq!(
                Fault::TooFewThreads { expected: 3, found, waited }.to_string(),
                format!(
                    "computing threads: expected 3, found {found}: {threads} inside the work at \
                     any time within 1 s (a lock held while computing?)"
                )
            );
        }
        let once = |computations| Fault::NotOnce { pixels: 3, x: 0, y: 1, computations };
        let text = finding(once(vec![computation(), computation()]));
        assert!(text.contains("once: 3, first (0, 1), computed 2 times, tile 8x4 at"), "{text}");
        assert!(finding(once(Vec::new())).ends_with("first (0, 1), never computed"));
    }
}
