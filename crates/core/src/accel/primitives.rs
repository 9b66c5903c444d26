//! All primitives of a scene, and their closest hit.

use crate::accel::bounding_sphere::BoundingSphere;
use crate::accel::bvh::Bvh;
use crate::accel::coincident::Coincident;
use crate::accel::cones::ConeSet;
use crate::accel::hit::Hit;
use crate::execution::Acceleration;
use crate::formulas::{Family, RayPrecomputations};
use crate::ray::{AxisOrder, Ray, miss};
use crate::scene::Scene;
use crate::shapes::SurfacePoint;
use crate::shapes::aabb::Aabb;
use crate::shapes::cylinder::{self, Cylinder};
use crate::shapes::plane::Plane;
use crate::shapes::shape_list::{Leaf, ShapeList};
use crate::shapes::sphere::{self, Sphere};
use crate::shapes::triangle::{self, Triangle};
use crate::simd::lane::{Lane, Scalar};
use crate::simd::vector::Vector;

/// A BVH is built from this many bounded primitives on. At 63 mirrored spheres trying each is still
/// faster; at 1,000 the BVH wins clearly (METHODOLOGY.md).
const BVH_MIN_PRIMITIVES: usize = 64;

/// The primitives by kind. A primitive's number counts through planes, spheres, triangles and
/// cylinders, each in file order. It decides between equal distances.
#[derive(Debug)]
pub(crate) struct Primitives<S> {
    pub(super) planes: Vec<Plane<S>>,
    pub(super) spheres: ShapeList<Sphere<S>>,
    pub(super) triangles: ShapeList<Triangle<S>>,
    pub(super) cylinders: ShapeList<Cylinder<S>>,
    /// All triangles, and all spheres and cylinders.
    triangles_and_others: [Leaf; 2],
    /// The hierarchy over the bounded primitives, if there are enough of them.
    pub(super) bvh: Option<Bvh<S>>,
    /// The bounding sphere of each triangle; empty unless all rays have unit direction and there is
    /// no BVH.
    triangle_bounds: Vec<BoundingSphere<S>>,
    /// The material of each primitive, by number.
    materials: Vec<usize>,
}

impl<S: Scalar> Primitives<S> {
    /// Makes the primitives of `scene`, with a BVH if `acceleration` allows it and there are enough
    /// of them.
    pub(crate) fn new(scene: &Scene, acceleration: Acceleration) -> Self {
        let materials = (scene.planes.iter().map(|p| p.material))
            .chain(scene.spheres.iter().map(|s| s.material))
            .chain(scene.triangles.iter().map(|t| t.material))
            .chain(scene.cylinders.iter().map(|c| c.material))
            .collect();
        let spheres_from = scene.planes.len();
        let triangles_from = spheres_from + scene.spheres.len();
        let cylinders_from = triangles_from + scene.triangles.len();
        let mut primitives = Self {
            planes: scene.planes.iter().map(Plane::new).collect(),
            spheres: ShapeList::new(&scene.spheres, spheres_from, Sphere::new),
            triangles: ShapeList::new(&scene.triangles, triangles_from, Triangle::new),
            cylinders: ShapeList::new(&scene.cylinders, cylinders_from, Cylinder::new),
            triangles_and_others: [
                Leaf { triangles: 0..scene.triangles.len() as u32, ..Leaf::default() },
                Leaf {
                    spheres: 0..scene.spheres.len() as u32,
                    cylinders: 0..scene.cylinders.len() as u32,
                    ..Leaf::default()
                },
            ],
            bvh: None,
            triangle_bounds: vec![],
            materials,
        };
        primitives.unite(scene);
        if acceleration == Acceleration::Auto {
            primitives.build_bvh();
        }
        primitives
    }

    /// Decides between surfaces that lie in one plane.
    fn unite(&mut self, scene: &Scene) {
        let Coincident { covered_planes, covered_triangles, sharing } = Coincident::of(scene);
        covered_planes.into_iter().for_each(|i| self.planes[i].remove());
        covered_triangles.into_iter().for_each(|i| self.triangles.shapes[i].remove());
        for (i, first) in sharing {
            self.triangles.shapes[i].share_plane(&scene.triangles[first]);
        }
    }

    /// Returns the number of primitives.
    pub(crate) fn count(&self) -> usize {
        self.materials.len()
    }

    /// Returns the number of leaves of the BVH, if there is one.
    pub(crate) fn leaves(&self) -> Option<usize> {
        self.bvh.as_ref().map(Bvh::leaves)
    }

    /// Makes bounding spheres of the triangles. From then on, every ray whose closest hit is
    /// searched must have unit direction. Shadow rays do not use the spheres, because lights have
    /// cones then.
    pub(crate) fn bound_triangles(&mut self, scene: &Scene) {
        self.triangle_bounds = scene.triangles.iter().map(BoundingSphere::new).collect();
    }

    /// Builds a BVH over the bounded primitives, if there are enough of them.
    fn build_bvh(&mut self) {
        let Self { spheres, triangles, cylinders, .. } = self;
        let counts = [spheres.shapes.len(), triangles.shapes.len(), cylinders.shapes.len()];
        if counts.iter().sum::<usize>() < BVH_MIN_PRIMITIVES {
            return;
        }
        let bounds: Vec<Aabb<S>> = (spheres.shapes.iter().map(Sphere::bounds))
            .chain(triangles.shapes.iter().map(Triangle::bounds))
            .chain(cylinders.shapes.iter().map(Cylinder::bounds))
            .collect();
        // The shapes of a leaf get neighbouring positions.
        let mut order = [vec![], vec![], vec![]];
        self.bvh = Bvh::build(&bounds, |members| {
            let from = order.each_ref().map(|places| places.len() as u32);
            for &member in members {
                let mut place = member as usize;
                let mut kind = 0;
                while place >= counts[kind] {
                    place -= counts[kind];
                    kind += 1;
                }
                order[kind].push(place as u32);
            }
            let to = order.each_ref().map(|places| places.len() as u32);
            Leaf { spheres: from[0]..to[0], triangles: from[1]..to[1], cylinders: from[2]..to[2] }
        });
        if self.bvh.is_some() {
            self.spheres.arrange(&order[0]);
            self.triangles.arrange(&order[1]);
            self.cylinders.arrange(&order[2]);
        }
    }

    /// Computes the ray's part of the formulas for each kind that the scene has; for triangles,
    /// only if `order` names the ray's dominant axis.
    #[inline(always)]
    pub(super) fn precompute<L: Lane<Scalar = S>>(
        &self,
        ray: &Ray<L>,
        order: Option<AxisOrder>,
    ) -> RayPrecomputations<L> {
        RayPrecomputations {
            sphere: if self.spheres.shapes.is_empty() {
                sphere::RayPrecomputation::none()
            } else {
                sphere::RayPrecomputation::new(ray)
            },
            triangle: match order {
                Some(order) if !self.triangles.shapes.is_empty() => {
                    triangle::RayPrecomputation::new(ray, order)
                }
                _ => triangle::RayPrecomputation::none(),
            },
            cylinder: if self.cylinders.shapes.is_empty() {
                cylinder::RayPrecomputation::none()
            } else {
                cylinder::RayPrecomputation::new(ray)
            },
        }
    }

    /// Returns the closest hit of the rays of `wanted`. If hits have the same distance, it is that
    /// of the lowest number.
    ///
    /// If all rays come from one point, `from` holds the cones seen from it and the distance from
    /// it at which the rays start. The directions have unit length then.
    #[inline(always)]
    pub(crate) fn closest_hit<L: Lane<Scalar = S>, F: Family>(
        &self,
        ray: &Ray<L>,
        wanted: L::Mask,
        from: Option<(&ConeSet<S>, L)>,
    ) -> Hit<L> {
        let mut closest = Hit::none();
        for (number, plane) in (0..).zip(&self.planes) {
            closest.offer::<true>(number, F::plane(plane, ray));
        }
        match (&self.bvh, from) {
            (Some(bvh), _) if F::ERROR_BOUNDED => {
                ray.by_direction_class(wanted, |class, wanted| {
                    let precomputed = self.precompute(ray, Some(class.order));
                    bvh.traverse(ray, class, wanted, closest.t, |leaf, reached| {
                        self.closest_hit_in_leaf::<L, F>(
                            leaf,
                            ray,
                            &precomputed,
                            reached,
                            &mut closest,
                        );
                        (wanted, closest.t)
                    });
                });
            }
            (_, Some((cones, distance))) if F::ERROR_BOUNDED => {
                cones.candidates((ray.direction, distance), wanted, |i, inside| {
                    let number = self.spheres.first + i as u32;
                    closest.offer::<true>(number, self.bounded_primitive::<L, F>(i, ray, inside));
                    wanted
                });
            }
            _ => self.by_axis::<L, F>(ray, wanted, |leaf, precomputed, wanted| {
                self.closest_hit_in_leaf::<L, F>(leaf, ray, precomputed, wanted, &mut closest);
            }),
        }
        closest
    }

    /// Calls `leaf` with all bounded primitives: with the triangles once for each dominant axis, if
    /// the formulas need it.
    #[inline(always)]
    pub(super) fn by_axis<L: Lane<Scalar = S>, F: Family>(
        &self,
        ray: &Ray<L>,
        wanted: L::Mask,
        mut leaf: impl FnMut(&Leaf, &RayPrecomputations<L>, L::Mask),
    ) {
        let [triangles, others] = &self.triangles_and_others;
        let empty = Leaf::default();
        let for_others = self.precompute(ray, None);
        if *others != empty {
            leaf(others, &for_others, wanted);
        }
        if *triangles == empty {
            return;
        }
        if !F::ERROR_BOUNDED {
            return leaf(triangles, &for_others, wanted);
        }
        ray.by_axis(self.near_any_triangle(ray, wanted), |order, wanted| {
            leaf(
                triangles,
                &RayPrecomputations {
                    triangle: triangle::RayPrecomputation::new(ray, order),
                    ..for_others
                },
                wanted,
            );
        });
    }

    /// Returns the rays of `wanted` that come near any triangle, or all of them without bounding
    /// spheres.
    #[inline(always)]
    fn near_any_triangle<L: Lane<Scalar = S>>(&self, ray: &Ray<L>, wanted: L::Mask) -> L::Mask {
        let Some((first, others)) = self.triangle_bounds.split_first() else { return wanted };
        wanted & others.iter().fold(first.may_hit(ray), |near, around| near | around.may_hit(ray))
    }

    /// Returns the `t` at which rays of `wanted` hit the primitive at index `i` of all bounded
    /// ones, in file order. There is no BVH.
    #[inline(always)]
    fn bounded_primitive<L: Lane<Scalar = S>, F: Family>(
        &self,
        mut i: usize,
        ray: &Ray<L>,
        wanted: L::Mask,
    ) -> L {
        if i < self.spheres.shapes.len() {
            return self.sphere::<L, F>(i, ray, wanted);
        }
        i -= self.spheres.shapes.len();
        if i < self.triangles.shapes.len() {
            return self.triangle::<L, F>(i, ray, wanted);
        }
        self.cylinder::<L, F>(i - self.triangles.shapes.len(), ray, wanted)
    }

    // The following return the `t` at which rays of `wanted` hit the shape at index `i` of a kind.
    // Few rays come here, so they are not inlined: each copy is compiled for every number type and
    // family of formulas.

    #[inline(never)]
    fn sphere<L: Lane<Scalar = S>, F: Family>(&self, i: usize, ray: &Ray<L>, wanted: L::Mask) -> L {
        F::sphere(&self.spheres.shapes[i], ray, &sphere::RayPrecomputation::new(ray), wanted)
    }

    #[inline(never)]
    fn triangle<L: Lane<Scalar = S>, F: Family>(
        &self,
        i: usize,
        ray: &Ray<L>,
        wanted: L::Mask,
    ) -> L {
        let mut closest = miss();
        ray.by_axis(wanted, |order, wanted| {
            let precomputed = triangle::RayPrecomputation::new(ray, order);
            let t = F::triangle(&self.triangles.shapes[i], ray, &precomputed, wanted);
            closest = L::select(wanted, t, closest);
        });
        closest
    }

    #[inline(never)]
    fn cylinder<L: Lane<Scalar = S>, F: Family>(
        &self,
        i: usize,
        ray: &Ray<L>,
        wanted: L::Mask,
    ) -> L {
        F::cylinder(&self.cylinders.shapes[i], ray, &cylinder::RayPrecomputation::new(ray), wanted)
    }

    /// Tries every primitive of a leaf.
    #[inline(never)]
    fn closest_hit_in_leaf<L: Lane<Scalar = S>, F: Family>(
        &self,
        leaf: &Leaf,
        ray: &Ray<L>,
        precomputed: &RayPrecomputations<L>,
        wanted: L::Mask,
        closest: &mut Hit<L>,
    ) {
        for (number, sphere) in self.spheres.range(&leaf.spheres) {
            closest.offer::<false>(number, F::sphere(sphere, ray, &precomputed.sphere, wanted));
        }
        for (number, triangle) in self.triangles.range(&leaf.triangles) {
            closest
                .offer::<false>(number, F::triangle(triangle, ray, &precomputed.triangle, wanted));
        }
        for (number, cylinder) in self.cylinders.range(&leaf.cylinders) {
            closest
                .offer::<false>(number, F::cylinder(cylinder, ray, &precomputed.cylinder, wanted));
        }
    }

    /// Returns the index of a primitive's material.
    #[inline(always)]
    pub(crate) fn material(&self, number: u32) -> usize {
        self.materials[number as usize]
    }

    /// Returns the point at which the ray hits primitive `number`. The normal points against the
    /// ray, since surfaces have two sides.
    #[inline(always)]
    pub(crate) fn surface<L: Lane<Scalar = S>, F: Family>(
        &self,
        number: u32,
        ray: &Ray<L>,
        t: L,
    ) -> SurfacePoint<L> {
        let near = ray.at(t);
        let mut at = F::snap_to_surface(near, self.surface_near(number, near));
        let behind = L::literal(0.0).lt(at.normal.dot(ray.direction));
        at.normal = Vector::select(behind, -at.normal, at.normal);
        at
    }

    /// Returns the point of primitive `number` that is closest to `near`, and its normal there.
    #[inline(always)]
    fn surface_near<L: Lane<Scalar = S>>(&self, number: u32, near: Vector<L>) -> SurfacePoint<L> {
        if let Some(plane) = self.planes.get(number as usize) {
            plane.surface(near)
        } else if let Some(sphere) = self.spheres.get(number) {
            sphere.surface(near)
        } else if let Some(triangle) = self.triangles.get(number) {
            triangle.surface(near)
        } else {
            self.cylinders.of_kind(number).surface(near)
        }
    }
}
