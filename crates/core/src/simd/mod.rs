//! Number types: one number, or a packet of several that are computed side by side.

pub(crate) mod lane;
mod packet;
pub(crate) mod vector;
