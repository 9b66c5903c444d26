//! A tree of boxes around the bounded primitives: a ray meets few of many.
//!
//! Whether a box is entered never changes what is found. A hit may lie a few roundings of the
//! coordinates off the primitive (see the error bounds beside the shapes), and where a ray grazes a
//! triangle its `t` is noise anywhere along it. So a box is skipped for two reasons only: the ray's
//! whole line misses the box made larger by more than those roundings, or, along the axis in which
//! the ray is longest, the box lies behind the ray or beyond what was found before; in this axis
//! the `t` of every primitive is within its box.

use crate::ray::{DirectionClass, Ray};
use crate::shapes::MARGIN;
use crate::shapes::aabb::Aabb;
use crate::shapes::shape_list::Leaf;
use crate::simd::lane::{Lane, Mask, Scalar};
use crate::simd::vector::Vector;
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb as BuilderAabb;
use obvhs::bvh2::{Bvh2, builder::build_bvh2};

#[derive(Debug)]
pub(crate) struct Bvh<S> {
    /// The root first.
    nodes: Vec<Node<S>>,
    leaves: Vec<Leaf>,
    /// The largest magnitude of any coordinate.
    reach: S,
}

#[derive(Clone, Copy, Debug)]
struct Node<S> {
    bounds: Aabb<S>,
    /// The number of its leaf; or of the first of its two children, which lie next to each other.
    first: u32,
    content: Content,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Content {
    Leaf,
    /// Two children, the first of which is lower along this axis.
    Children {
        axis: u8,
    },
}

/// The deepest tree that is used. Trees have some two levels more than the logarithm of their size.
const MAX_DEPTH: usize = 128;

/// Coordinates up to here: the builder multiplies three of them, in `f32`.
const LARGEST: f64 = 1e12;

/// Up to so many primitives the builder first tries all nodes for a better place in the tree; of
/// more a smaller share, down to its own. It takes 2 to 5 us a primitive. A fractal of 937 spheres
/// then takes 0.91 [0.84, 0.97] of the time, a cloud of 1,000 about as much, a mesh of 2,000
/// triangles no less.
const ALL_TRIED: f32 = 4096.0;

/// How a tree over so many primitives is built. A packet tries a primitive in about the time of two
/// boxes, so leaves are small.
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
    /// Over primitives in these boxes; `leaf` takes the numbers of those that are tried together.
    /// None if there is no primitive, or the tree would be too deep.
    pub(crate) fn build(bounds: &[Aabb<S>], mut leaf: impl FnMut(&[u32]) -> Leaf) -> Option<Self> {
        let whole = bounds.iter().copied().reduce(Aabb::join)?;
        if !whole.reach().lt(S::literal(LARGEST)) {
            return None;
        }
        let boxes: Vec<BuilderAabb> = bounds.iter().map(rounded).collect();
        let bvh = build_bvh2(&boxes, build_parameters(boxes.len()), &mut Default::default());
        if depth(&bvh) > MAX_DEPTH {
            return None;
        }
        let mut built = Self {
            nodes: Vec::with_capacity(bvh.nodes.len()),
            leaves: Vec::new(),
            reach: whole.reach(),
        };
        built.nodes.push(Node { bounds: whole, first: 0, content: Content::Leaf });
        // Each pair of children lies next to each other, its parent before it.
        let mut pending = vec![(0, 0)];
        while let Some((source, target)) = pending.pop() {
            let node = &bvh.nodes[source];
            let (first, content) = if node.is_leaf() {
                let members =
                    node.first_index as usize..(node.first_index + node.prim_count) as usize;
                let members = &bvh.primitive_indices[members];
                let boxes = members.iter().map(|&member| bounds[member as usize]);
                if let Some(joined) = boxes.reduce(Aabb::join) {
                    built.nodes[target].bounds = joined;
                }
                built.leaves.push(leaf(members));
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
        // The boxes in this precision, from the leaves up.
        for i in (0..built.nodes.len()).rev() {
            if built.nodes[i].content != Content::Leaf {
                let first = built.nodes[i].first as usize;
                built.nodes[i].bounds =
                    built.nodes[first].bounds.join(built.nodes[first + 1].bounds);
            }
        }
        Some(built)
    }

    pub(crate) fn leaves(&self) -> usize {
        self.leaves.len()
    }

    /// Shows `found` every leaf that a ray of `wanted`, all with this class, may hit before
    /// `limit`, with the rays that may, from near to far. `found` returns the rays that still want
    /// to know, and their limits.
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
        // Far children that are still to be looked at.
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
                    // Both at once: neither waits for what becomes of the other.
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
            // What was found meanwhile may lie before the box.
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

/// What all boxes ask of rays with one class. Axes are in the class's order: the one along
/// which the rays are longest is last.
struct Slabs<L> {
    /// For each axis, the place in a box of the side that the rays pass first, and of the other
    /// one.
    sides: [[usize; 2]; 3],
    /// The origin as seen from each of these sides, moved away by the margin: instead of every box,
    /// once.
    origin: [[L; 2]; 3],
    inverse: [L; 3],
}

impl<L: Lane> Slabs<L> {
    #[inline(always)]
    fn new(ray: &Ray<L>, class: DirectionClass, reach: L::Scalar) -> Self {
        let (origin, direction) = (ray.origin.to_array(), ray.direction.to_array());
        let farthest = origin[0].abs().max(origin[1].abs()).max(origin[2].abs());
        let margin = (farthest + L::splat(reach)) * L::literal(MARGIN * L::Scalar::ROUNDOFF);
        // A direction across the axis is turned, by less than the margin tells: no infinity meets a
        // zero.
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

    /// The rays that may hit something in the box before `limit`.
    #[inline(always)]
    fn reach(&self, bounds: &Aabb<L::Scalar>, limit: L) -> L::Mask {
        // Where the ray passes a side.
        let at = |axis: usize, side: usize| {
            let side_at = L::splat(bounds.side(self.sides[axis][side]));
            (side_at - self.origin[axis][side]) * self.inverse[axis]
        };
        // Written out: a `map` over an array is not always inlined.
        let (x, y, z) = ((at(0, 0), at(0, 1)), (at(1, 0), at(1, 1)), (at(2, 0), at(2, 1)));
        let crossed = x.0.max(y.0).max(z.0).le(x.1.min(y.1).min(z.1));
        crossed & L::literal(0.0).le(z.1) & z.0.le(limit)
    }
}

/// The box in the builder's numbers. It only guides the tree's shape, so a rounding does not
/// matter.
fn rounded<S: Scalar>(bounds: &Aabb<S>) -> BuilderAabb {
    let corner = |v: Vector<S>| v.widened().as_vec3a();
    BuilderAabb::new(corner(bounds.low()), corner(bounds.high()))
}

/// Of the deepest leaf, where the root has 1.
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
