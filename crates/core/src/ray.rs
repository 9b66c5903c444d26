//! Rays, and how the rays of a packet are grouped by their direction.

use crate::simd::lane::{Lane, Mask, Scalar};
use crate::simd::vector::Vector;

/// The half line `origin + t direction` for `t > 0`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ray<L> {
    pub(crate) origin: Vector<L>,
    /// The direction, of any length; `t` is measured in it.
    pub(crate) direction: Vector<L>,
}

impl<L: Lane> Ray<L> {
    /// Returns the point at `t`.
    #[inline(always)]
    pub(crate) fn at(&self, t: L) -> Vector<L> {
        self.origin + self.direction * t
    }
}

/// Returns the `t` that stands for "no hit".
#[inline(always)]
pub(crate) fn miss<L: Lane>() -> L {
    L::literal(f64::INFINITY)
}

/// Returns, for each of x, y and z, the rays whose direction is longest along it. Every ray belongs
/// to exactly one axis.
#[inline(always)]
fn longest_axis<L: Lane>(direction: [L; 3]) -> [L::Mask; 3] {
    let [x, y, z] = direction.map(L::abs);
    let is_x = y.lt(x) & z.lt(x);
    let is_y = !is_x & z.lt(y);
    [is_x, is_y, !is_x & !is_y]
}

/// The axes in cyclic order, x, y and z being 0, 1 and 2. The last one is that along which the
/// direction is longest.
pub(crate) type AxisOrder = [usize; 3];

/// The orders that end with x, y and z.
const ORDERS: [AxisOrder; 3] = [[1, 2, 0], [2, 0, 1], [0, 1, 2]];

/// The class of a direction: its dominant axis and its octant.
///
/// All rays of one class pass the sides of a box in the same order, and project triangles along the
/// same axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct DirectionClass {
    pub(crate) order: AxisOrder,
    /// True for each of x, y and z along which the direction is below 0.
    pub(crate) backward: [bool; 3],
}

impl DirectionClass {
    #[inline(always)]
    fn of<S: Scalar>(direction: [S; 3]) -> Self {
        let [x, y, z] = ORDERS;
        let order = match longest_axis(direction) {
            [true, ..] => x,
            [_, true, _] => y,
            _ => z,
        };
        Self { order, backward: direction.map(|d| d.lt(S::literal(0.0))) }
    }
}

impl<L: Lane> Ray<L> {
    /// Calls `group` for each dominant axis with the rays of `wanted` that have it.
    #[inline(always)]
    pub(crate) fn by_axis(&self, wanted: L::Mask, mut group: impl FnMut(AxisOrder, L::Mask)) {
        for (order, along) in ORDERS.into_iter().zip(longest_axis(self.direction.to_array())) {
            let alike = wanted & along;
            if alike.any() {
                group(order, alike);
            }
        }
    }

    /// Calls `group` for each direction class with the rays of `wanted` that have it. The rays of a
    /// packet of neighbours mostly have one class.
    #[inline(always)]
    pub(crate) fn by_direction_class(
        &self,
        wanted: L::Mask,
        mut group: impl FnMut(DirectionClass, L::Mask),
    ) {
        let direction = self.direction.to_array();
        let backward = direction.map(|d| d.lt(L::literal(0.0)));
        let along = longest_axis(direction);
        let mut todo = wanted;
        while let Some(first) = L::first(todo, direction) {
            let class = DirectionClass::of(first);
            let mut alike = todo & along[class.order[2]];
            for (one, all) in class.backward.into_iter().zip(backward) {
                alike = alike & if one { all } else { !all };
            }
            group(class, alike);
            todo = todo & !alike;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches a ray that is in no group or in two, whatever its components are, or in a group
    /// other than that of its longest component.
    #[test]
    fn every_ray_has_one_axis() {
        let numbers = [
            0.0,
            -0.0,
            1.0,
            -1.0,
            0.5,
            1e-40,
            f32::MAX,
            f32::INFINITY,
            f32::NEG_INFINITY,
            f32::NAN,
        ];
        for (x, y, z) in (numbers.iter().flat_map(|x| numbers.map(|y| (*x, y))))
            .flat_map(|(x, y)| numbers.map(|z| (x, y, z)))
        {
            let direction = Vector::new(x, y, z);
            let ray = Ray { origin: Vector::zero(), direction };
            let mut groups = vec![];
            ray.by_axis(true, |order, _| groups.push(order));
            assert_eq!(groups.len(), 1, "{direction:?}: {groups:?}");
            assert_eq!(groups[0], DirectionClass::of(direction.to_array()).order, "{direction:?}");
            let [a, b, longest] = groups[0].map(|axis| direction.to_array()[axis].abs());
            assert!(
                [a, b, longest].iter().any(|c| c.is_nan()) || longest >= f32::max(a, b),
                "{direction:?}"
            );
        }
    }
}
