//! Occlusion: whether anything lies between a point and a light.

use crate::accel::occluders::Occluders;
use crate::accel::primitives::Primitives;
use crate::formulas::{Family, LightPath, RayPrecomputations};
use crate::ray::Ray;
use crate::shapes::cylinder;
use crate::shapes::shape_list::Leaf;
use crate::shapes::sphere;
use crate::shapes::triangle;
use crate::simd::lane::{Lane, Mask, Scalar};

/// The rays of a packet to one light. It is made where it is used: kept in memory meanwhile, it
/// would cost a per cent of a rendering without packets.
#[derive(Clone, Copy)]
struct Shadow<'a, L: Lane> {
    ray: &'a Ray<L>,
    /// The `t` of the light.
    limit: L,
    occluders: &'a Occluders<L::Scalar>,
}

impl<S: Scalar> Primitives<S> {
    /// Returns the lanes of `wanted` whose shadow ray meets something on its way. The ray goes
    /// along `path` to the light of these `occluders`.
    #[inline(always)]
    pub(crate) fn occluded<L: Lane<Scalar = S>, F: Family>(
        &self,
        wanted: L::Mask,
        path: &LightPath<L>,
        occluders: &Occluders<S>,
    ) -> L::Mask {
        let (ray, limit) = F::shadow_ray(path);
        let ray = &ray;
        let mut clear = wanted;
        for &(plane, side) in &occluders.planes {
            clear = clear & !F::plane_hides(&self.planes[plane as usize], ray, limit, side);
        }
        if !clear.any() {
            return wanted;
        }
        match (&self.bvh, &occluders.cones) {
            (Some(bvh), _) if F::ERROR_BOUNDED => ray.by_direction_class(clear, |class, wanted| {
                let precomputed = self.precompute(ray, Some(class.order));
                bvh.traverse(ray, class, wanted, limit, |leaf, reached| {
                    clear = clear
                        & !(reached
                            & !self.clear_of_leaf::<L, F>(
                                leaf,
                                &Shadow { ray, limit, occluders },
                                &precomputed,
                                reached,
                            ));
                    (wanted & clear, limit)
                });
            }),
            (_, Some(cones)) if F::ERROR_BOUNDED => {
                cones.candidates((-path.to_light, path.distance), clear, |i, inside| {
                    clear = clear
                        & !self.bounded_hides::<L, F>(i, &Shadow { ray, limit, occluders }, inside);
                    clear
                });
            }
            _ => self.by_axis::<L, F>(ray, clear, |leaf, precomputed, wanted| {
                let reached = wanted & clear;
                clear = clear
                    & !(reached
                        & !self.clear_of_leaf::<L, F>(
                            leaf,
                            &Shadow { ray, limit, occluders },
                            precomputed,
                            reached,
                        ));
            }),
        }
        if F::ERROR_BOUNDED && !occluders.near.is_empty() {
            clear = clear & !self.near_hides(ray, occluders);
        }
        wanted & !clear
    }

    /// Returns the rays from which a sphere or a cylinder near the light hides it.
    #[inline(never)]
    fn near_hides<L: Lane<Scalar = S>>(&self, ray: &Ray<L>, occluders: &Occluders<S>) -> L::Mask {
        let mut hidden = L::first_lanes(0);
        for near in &occluders.near {
            hidden = hidden
                | match self.spheres.get(near.number) {
                    Some(sphere) => sphere.hides_near(ray, &near.center),
                    None => {
                        let precomputed = cylinder::RayPrecomputation::new(ray);
                        let light = (occluders.light, &near.center);
                        let cylinder = self.cylinders.of_kind(near.number);
                        cylinder.hides_near(ray, &precomputed, light)
                    }
                };
        }
        hidden
    }

    /// Returns the rays of `wanted` from which the primitive at index `i` of all bounded ones hides
    /// the light, in file order. There is no BVH. It is not inlined, for the reason that
    /// `Primitives::sphere` is not.
    #[inline(never)]
    fn bounded_hides<L: Lane<Scalar = S>, F: Family>(
        &self,
        mut i: usize,
        shadow: &Shadow<'_, L>,
        wanted: L::Mask,
    ) -> L::Mask {
        if i < self.spheres.shapes.len() {
            return self.sphere_hides::<L, F>(i, shadow, wanted);
        }
        i -= self.spheres.shapes.len();
        if i < self.triangles.shapes.len() {
            return self.triangle_hides::<L, F>(i, shadow, wanted);
        }
        self.cylinder_hides::<L, F>(i - self.triangles.shapes.len(), shadow, wanted)
    }

    // The following return the rays of `wanted` from which the shape at index `i` of a kind hides
    // the light.

    #[inline(always)]
    fn sphere_hides<L: Lane<Scalar = S>, F: Family>(
        &self,
        i: usize,
        &Shadow { ray, limit, occluders }: &Shadow<'_, L>,
        wanted: L::Mask,
    ) -> L::Mask {
        let precomputed = sphere::RayPrecomputation::new(ray);
        let hidden = F::sphere_hides(&self.spheres.shapes[i], ray, &precomputed, wanted, limit);
        unless_near::<L, F>(self.spheres.first + i as u32, hidden, occluders)
    }

    #[inline(always)]
    fn triangle_hides<L: Lane<Scalar = S>, F: Family>(
        &self,
        i: usize,
        &Shadow { ray, limit, occluders }: &Shadow<'_, L>,
        wanted: L::Mask,
    ) -> L::Mask {
        let triangle = &self.triangles.shapes[i];
        let side = || occluders.side(self.triangles.first + i as u32, triangle);
        let mut clear = wanted;
        ray.by_axis(wanted, |order, wanted| {
            let precomputed = triangle::RayPrecomputation::new(ray, order);
            clear = clear & !F::triangle_hides(triangle, ray, &precomputed, wanted, limit, side);
        });
        wanted & !clear
    }

    #[inline(always)]
    fn cylinder_hides<L: Lane<Scalar = S>, F: Family>(
        &self,
        i: usize,
        &Shadow { ray, limit, occluders }: &Shadow<'_, L>,
        wanted: L::Mask,
    ) -> L::Mask {
        let precomputed = cylinder::RayPrecomputation::new(ray);
        let hidden = F::cylinder_hides(&self.cylinders.shapes[i], ray, &precomputed, wanted, limit);
        unless_near::<L, F>(self.cylinders.first + i as u32, hidden, occluders)
    }

    /// Returns the rays of `wanted` from which nothing in `leaf` hides the light.
    #[inline(never)]
    fn clear_of_leaf<L: Lane<Scalar = S>, F: Family>(
        &self,
        leaf: &Leaf,
        &Shadow { ray, limit, occluders }: &Shadow<'_, L>,
        precomputed: &RayPrecomputations<L>,
        wanted: L::Mask,
    ) -> L::Mask {
        let mut clear = wanted;
        for (number, sphere) in self.spheres.range(&leaf.spheres) {
            let hidden = F::sphere_hides(sphere, ray, &precomputed.sphere, clear, limit);
            clear = clear & !unless_near::<L, F>(number, hidden, occluders);
            if !clear.any() {
                return clear;
            }
        }
        for (number, triangle) in self.triangles.range(&leaf.triangles) {
            let side = || occluders.side(number, triangle);
            clear = clear
                & !F::triangle_hides(triangle, ray, &precomputed.triangle, clear, limit, side);
            if !clear.any() {
                return clear;
            }
        }
        for (number, cylinder) in self.cylinders.range(&leaf.cylinders) {
            let hidden = F::cylinder_hides(cylinder, ray, &precomputed.cylinder, clear, limit);
            clear = clear & !unless_near::<L, F>(number, hidden, occluders);
            if !clear.any() {
                return clear;
            }
        }
        clear
    }
}

/// Returns the hidden rays, unless the sphere or cylinder is near the light and so has been tried.
#[inline(always)]
fn unless_near<L: Lane, F: Family>(
    number: u32,
    hidden: L::Mask,
    occluders: &Occluders<L::Scalar>,
) -> L::Mask {
    if F::ERROR_BOUNDED && !occluders.near.is_empty() && occluders.is_near(number) {
        hidden & !hidden
    } else {
        hidden
    }
}
