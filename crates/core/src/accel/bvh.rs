//! The bounding volume hierarchy over the bounded primitives: a ray tries few of many.
//!
//! Skipping a box never changes the result. A hit may lie a few roundings of the coordinates off
//! the primitive (see the error bounds beside the shapes), and where a ray grazes a triangle its
//! `t` is noise anywhere along the triangle. So a box is skipped for two reasons only. Either the
//! ray's whole line misses the box, enlarged by more than those roundings. Or the box lies behind
//! the ray or beyond the closest hit so far, measured along the dominant axis of the ray: along
//! this axis the `t` of every primitive is within its box.

use crate::random::random_points;
use crate::ray::{DirectionClass, Ray};
use crate::shapes::MARGIN;
use crate::shapes::aabb::Aabb;
use crate::shapes::shape_list::Leaf;
use crate::simd::lane::{Lane, Mask, Scalar};
use crate::simd::vector::Vector;
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb as BuilderAabb;
use obvhs::bvh2::{Bvh2, builder::build_bvh2};

/// A hierarchy of boxes, each node with two children.
#[derive(Debug)]
pub(crate) struct Bvh<S> {
    /// The nodes, the root first.
    nodes: Vec<Node<S>>,
    leaves: Vec<Leaf>,
    /// The largest magnitude of any coordinate.
    reach: S,
}

/// A box, and its leaf or children.
#[derive(Clone, Copy, Debug)]
struct Node<S> {
    bounds: Aabb<S>,
    /// The index of the leaf; or of the first of the two children, which lie next to each other.
    first: u32,
    content: Content,
}

/// The kind of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Content {
    Leaf,
    /// Two children. The first one is lower along this axis.
    Children {
        axis: u8,
    },
}

/// The depth of the deepest hierarchy that is used. The depth is usually two more than the
/// logarithm of the size.
const MAX_DEPTH: usize = 128;

/// The largest coordinate: the builder multiplies three of them in `f32`.
const LARGEST: f64 = 1e12;

/// Up to this many primitives, the builder tries to reinsert all nodes at a better place; of more
/// primitives a smaller share. It takes 2 to 5 us a primitive, and saves up to a tenth of a
/// rendering's time.
const ALL_TRIED: f32 = 4096.0;

/// The random enlargements of boxes for the builder, as shares of a box's diagonal. The builder
/// merges two boxes if each is the other's best partner. Among equal boxes, boxes within each other
/// or evenly spaced ones all partners are as good, and it would merge one pair a pass: the time
/// would grow with the square of their number. If the first enlargement gives too deep a hierarchy,
/// as for thousands of boxes within each other, the second one is tried.
const ENLARGEMENTS: [f32; 2] = [1.0 / 65536.0, 1.0 / 32.0];

/// Returns the builder's parameters for this many primitives. A packet tries a primitive in about
/// the time of two boxes, so leaves are small.
fn build_parameters(primitives: usize) -> BvhBuildParams {
    let medium = BvhBuildParams::medium_build();
    BvhBuildParams {
        reinsertion_batch_ratio: (ALL_TRIED / primitives as f32)
            .clamp(medium.reinsertion_batch_ratio, 1.0),
        max_prims_per_leaf: 4,
        collapse_traversal_cost: 2.0,
        ..medium
    }
}

impl<S: Scalar> Bvh<S> {
    /// Builds the hierarchy over primitives in these boxes. `leaf` is called with the indices of
    /// primitives that are tried together.
    ///
    /// Returns `None` if there is no primitive, or if the hierarchy would be too deep.
    pub(crate) fn build(bounds: &[Aabb<S>], mut leaf: impl FnMut(&[u32]) -> Leaf) -> Option<Self> {
        let whole = bounds.iter().copied().reduce(Aabb::join)?;
        if !whole.reach().lt(S::literal(LARGEST)) {
            return None;
        }
        let order = shuffled(bounds.len());
        let bvh = ENLARGEMENTS.iter().find_map(|&share| {
            let boxes = enlarged(order.iter().map(|&i| &bounds[i as usize]), share);
            let bvh = build_bvh2(&boxes, build_parameters(boxes.len()), &mut Default::default());
            (depth(&bvh) <= MAX_DEPTH).then_some(bvh)
        })?;
        let mut built = Self {
            nodes: Vec::with_capacity(bvh.nodes.len()),
            leaves: Vec::new(),
            reach: whole.reach(),
        };
        built.nodes.push(Node { bounds: whole, first: 0, content: Content::Leaf });
        // Children lie next to each other, after their parent.
        let mut pending = vec![(0, 0)];
        while let Some((source, target)) = pending.pop() {
            let node = &bvh.nodes[source];
            let (first, content) = if node.is_leaf() {
                let members =
                    node.first_index as usize..(node.first_index + node.prim_count) as usize;
                let members = bvh.primitive_indices[members].iter();
                let members: Vec<u32> = members.map(|&i| order[i as usize]).collect();
                let boxes = members.iter().map(|&member| bounds[member as usize]);
                if let Some(joined) = boxes.reduce(Aabb::join) {
                    built.nodes[target].bounds = joined;
                }
                built.leaves.push(leaf(&members));
                (built.leaves.len() - 1, Content::Leaf)
            } else {
                let (left, right) = (node.first_index as usize, node.first_index as usize + 1);
                let apart = bvh.nodes[right].aabb.center() - bvh.nodes[left].aabb.center();
                let axis = apart.abs().max_position();
                let lower_first = if apart[axis] >= 0.0 { [left, right] } else { [right, left] };
                let first = built.nodes.len();
                for (i, child) in lower_first.into_iter().enumerate() {
                    built.nodes.push(built.nodes[0]);
                    pending.push((child, first + i));
                }
                (first, Content::Children { axis: axis as u8 })
            };
            built.nodes[target].first = first as u32;
            built.nodes[target].content = content;
        }
        // Joins the boxes in this precision, from the leaves up.
        for i in (0..built.nodes.len()).rev() {
            if built.nodes[i].content != Content::Leaf {
                let first = built.nodes[i].first as usize;
                built.nodes[i].bounds =
                    built.nodes[first].bounds.join(built.nodes[first + 1].bounds);
            }
        }
        Some(built)
    }

    /// Returns the number of leaves.
    pub(crate) fn leaves(&self) -> usize {
        self.leaves.len()
    }

    /// Calls `found` with every leaf that a ray of `wanted` may hit before `limit`, and with these
    /// rays, from near to far. All rays have this class. `found` returns the rays that are still
    /// searching, and their limits.
    #[inline(always)]
    pub(crate) fn traverse<L: Lane<Scalar = S>>(
        &self,
        ray: &Ray<L>,
        class: DirectionClass,
        mut wanted: L::Mask,
        mut limit: L,
        mut found: impl FnMut(&Leaf, L::Mask) -> (L::Mask, L),
    ) {
        let slabs = Slabs::new(ray, class, self.reach);
        // The far children that are still to be visited.
        let mut stack = [0_u32; MAX_DEPTH];
        let mut height = 0;
        let mut node = &self.nodes[0];
        let mut reached = wanted;
        loop {
            match node.content {
                Content::Leaf => {
                    (wanted, limit) = found(&self.leaves[node.first as usize], reached);
                    if !wanted.any() {
                        return;
                    }
                }
                Content::Children { axis } => {
                    // Tests both children at once, so that neither test waits for the other.
                    let far = u32::from(!class.backward[axis as usize]);
                    let (near, far) = (node.first + 1 - far, node.first + far);
                    let children = [&self.nodes[near as usize], &self.nodes[far as usize]];
                    let reach = |child: &Node<S>| wanted & slabs.reach(&child.bounds, limit);
                    let reaching = [reach(children[0]), reach(children[1])];
                    match [reaching[0].any(), reaching[1].any()] {
                        [true, behind] => {
                            (node, reached) = (children[0], reaching[0]);
                            if behind {
                                stack[height] = far;
                                height += 1;
                            }
                            continue;
                        }
                        [false, true] => {
                            (node, reached) = (children[1], reaching[1]);
                            continue;
                        }
                        [false, false] => {}
                    }
                }
            }
            // A hit that was found meanwhile may lie before the box.
            loop {
                if height == 0 {
                    return;
                }
                height -= 1;
                node = &self.nodes[stack[height] as usize];
                reached = wanted & slabs.reach(&node.bounds, limit);
                if reached.any() {
                    break;
                }
            }
        }
    }
}

/// The part of the slab test that is the same for all boxes, for rays of one class. Axes are in the
/// class's order: the dominant one is last.
struct Slabs<L> {
    /// For each axis, the sides of a box that the rays pass first and last, as an index for
    /// `Aabb::side`.
    sides: [[usize; 2]; 3],
    /// The origin relative to these sides, moved away by the margin: this is done once for the ray
    /// instead of for every box.
    origin: [[L; 2]; 3],
    inverse: [L; 3],
}

impl<L: Lane> Slabs<L> {
    #[inline(always)]
    fn new(ray: &Ray<L>, class: DirectionClass, reach: L::Scalar) -> Self {
        let (origin, direction) = (ray.origin.to_array(), ray.direction.to_array());
        let farthest = origin[0].abs().max(origin[1].abs()).max(origin[2].abs());
        let margin = (farthest + L::splat(reach)) * L::literal(MARGIN * L::Scalar::ROUNDOFF);
        // A component near 0 is replaced by one that moves the ray by less than the margin, so that
        // no infinity is multiplied by a zero.
        let least =
            direction[class.order[2]].abs() * L::literal(L::Scalar::ROUNDOFF * L::Scalar::ROUNDOFF);
        Self {
            sides: class.order.map(|axis| {
                let (low, high) = (axis, 3 + axis);
                if class.backward[axis] { [high, low] } else { [low, high] }
            }),
            origin: class.order.map(|axis| {
                let (above, below) = (origin[axis] + margin, origin[axis] - margin);
                if class.backward[axis] { [below, above] } else { [above, below] }
            }),
            inverse: class.order.map(|axis| {
                let d = direction[axis];
                let turned = if class.backward[axis] { -least } else { least };
                L::literal(1.0) / L::select(d.abs().lt(least), turned, d)
            }),
        }
    }

    /// Returns the rays that may hit something in the box before `limit`.
    #[inline(always)]
    fn reach(&self, bounds: &Aabb<L::Scalar>, limit: L) -> L::Mask {
        // The `t` at which the ray passes a side.
        let at = |axis: usize, side: usize| {
            let side_at = L::splat(bounds.side(self.sides[axis][side]));
            (side_at - self.origin[axis][side]) * self.inverse[axis]
        };
        // Written out, because a `map` over an array is not always inlined.
        let (x, y, z) = ((at(0, 0), at(0, 1)), (at(1, 0), at(1, 1)), (at(2, 0), at(2, 1)));
        let crossed = x.0.max(y.0).max(z.0).le(x.1.min(y.1).min(z.1));
        crossed & L::literal(0.0).le(z.1) & z.0.le(limit)
    }
}

/// Returns the numbers below `count` in a random order, the same in every run. The builder keeps
/// the order of boxes with equal centres, and sorted sizes among nested boxes are as bad as ties.
fn shuffled(count: usize) -> Vec<u32> {
    let mut order: Vec<u32> = (0..count as u32).collect();
    let mut point = random_points();
    for last in (1..count).rev() {
        order.swap(last, (point().x * (last + 1) as f64) as usize);
    }
    order
}

/// Returns boxes in the builder's numbers, each enlarged by up to `share` of its diagonal on every
/// side, or by a rounding if that is more. They only guide the hierarchy's shape.
fn enlarged<'a, S: Scalar>(
    bounds: impl Iterator<Item = &'a Aabb<S>>,
    share: f32,
) -> Vec<BuilderAabb> {
    let mut point = random_points();
    let enlarge = |bounds: &'a Aabb<S>| {
        let corner = |v: Vector<S>| v.widened().as_vec3a();
        let (low, high) = (corner(bounds.low()), corner(bounds.high()));
        let rounding = low.abs().max(high.abs()).max_element() * f32::EPSILON;
        let most = ((high - low).length() * share).max(2.0 * rounding);
        BuilderAabb::new(low - point().as_vec3a() * most, high + point().as_vec3a() * most)
    };
    bounds.map(enlarge).collect()
}

/// Returns the depth of the deepest leaf. The root has depth 1.
fn depth(bvh: &Bvh2) -> usize {
    let mut deepest = 0;
    let mut pending = vec![(0, 1)];
    while let Some((node, depth)) = pending.pop() {
        deepest = deepest.max(depth);
        let node = &bvh.nodes[node];
        if !node.is_leaf() {
            let first = node.first_index as usize;
            pending.extend([(first, depth + 1), (first + 1, depth + 1)]);
        }
    }
    deepest
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches boxes of which the builder merges one pair a pass: the hierarchy would be too deep,
    /// or take minutes.
    #[test]
    fn boxes_in_one_place_or_a_row_are_a_hierarchy() {
        let cube = |x: f64, half: f64| {
            let corner =
                |side: f64| Vector::new((x + side) as f32, (side - 5.0) as f32, side as f32);
            Aabb::new(corner(-half), corner(half))
        };
        // The place and half the side of each cube, and what they grow by from one to the next.
        for (name, (x, step), (half, growth)) in [
            ("equal", (1.0, 0.0), (0.5, 0.0)),
            ("within each other", (1.0, 0.0), (0.5, 1e-5)),
            ("in a row", (0.0, 1.0), (0.25, 0.0)),
            ("smaller than a rounding", (1e6, 0.0), (1e-6, 0.0)),
        ] {
            let bounds: Vec<_> = (0..40_000)
                .map(|i| cube(x + f64::from(i) * step, half + f64::from(i) * growth))
                .collect();
            let mut members = Vec::new();
            let bvh = Bvh::build(&bounds, |leaf| {
                members.extend_from_slice(leaf);
                Leaf::default()
            });
            assert!(bvh.is_some_and(|bvh| bvh.leaves() >= 10_000), "{name}");
            members.sort_unstable();
            assert!(members.iter().copied().eq(0..40_000), "{name}: every primitive once");
        }
    }
}
