//! All primitives of a scene, and the two questions a ray asks of them: what is nearest, and is
//! anything in between.

use crate::formulas::Family;
use crate::lane::{Lane, Mask, Scalar};
use crate::ray::{Ray, miss};
use crate::scene::Scene;
use crate::shapes::SurfacePoint;
use crate::shapes::cylinder::Cylinder;
use crate::shapes::plane::Plane;
use crate::shapes::sphere::Sphere;
use crate::shapes::triangle::Triangle;
use crate::vector::Vector;
use std::ops::ControlFlow;

/// The primitives by kind, in file order. A primitive's number counts through the kinds in this
/// order: it decides between equal distances.
#[derive(Debug)]
pub(crate) struct Primitives<S> {
    planes: Vec<Plane<S>>,
    spheres: Vec<Sphere<S>>,
    triangles: Vec<Triangle<S>>,
    cylinders: Vec<Cylinder<S>>,
    /// The material of each primitive, by its number.
    materials: Vec<usize>,
}

/// The nearest hit of a ray.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hit<L: Lane> {
    /// Infinite where nothing is hit.
    pub(crate) t: L,
    /// The number of the primitive, where something is.
    pub(crate) primitive: L::Index,
}

impl<L: Lane> Hit<L> {
    #[inline(always)]
    pub(crate) fn exists(&self) -> L::Mask {
        self.t.lt(miss())
    }
}

impl<S: Scalar> Primitives<S> {
    pub(crate) fn new(scene: &Scene) -> Self {
        let materials = (scene.planes.iter().map(|p| p.material))
            .chain(scene.spheres.iter().map(|s| s.material))
            .chain(scene.triangles.iter().map(|t| t.material))
            .chain(scene.cylinders.iter().map(|c| c.material))
            .collect();
        Self {
            planes: scene.planes.iter().map(Plane::new).collect(),
            spheres: scene.spheres.iter().map(Sphere::new).collect(),
            triangles: scene.triangles.iter().map(Triangle::new).collect(),
            cylinders: scene.cylinders.iter().map(Cylinder::new).collect(),
            materials,
        }
    }

    /// The smallest `t`; of equal ones that of the lowest number, since only a smaller `t` replaces
    /// what was found before.
    #[inline(always)]
    pub(crate) fn nearest<L: Lane<Scalar = S>, F: Family>(&self, ray: &Ray<L>) -> Hit<L> {
        let mut nearest = Hit { t: miss(), primitive: L::splat_index(0) };
        let _ = self.visit::<L, F>(ray, |number, t: L| {
            let nearer = t.lt(nearest.t);
            nearest.t = L::select(nearer, t, nearest.t);
            nearest.primitive = L::select_index(nearer, L::splat_index(number), nearest.primitive);
            ControlFlow::Continue(())
        });
        nearest
    }

    /// The lanes of `wanted` whose ray meets something before `limit`.
    #[inline(always)]
    pub(crate) fn blocked<L: Lane<Scalar = S>, F: Family>(
        &self,
        ray: &Ray<L>,
        limit: L,
        wanted: L::Mask,
    ) -> L::Mask {
        let mut free = wanted;
        let _ = self.visit::<L, F>(ray, |_, t: L| {
            free = free & !t.lt(limit);
            if free.any() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        });
        wanted & !free
    }

    /// Shows the number and the `t` of every primitive, in order, until `found` has seen enough.
    #[inline(always)]
    fn visit<L: Lane<Scalar = S>, F: Family>(
        &self,
        ray: &Ray<L>,
        mut found: impl FnMut(u32, L) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        // A kind that is not there costs a comparison, not what its rays would need.
        let mut first = 0;
        if !self.planes.is_empty() {
            F::planes(&self.planes, ray, &mut |i, t| found(first + i as u32, t))?;
            first += self.planes.len() as u32;
        }
        if !self.spheres.is_empty() {
            F::spheres(&self.spheres, ray, &mut |i, t| found(first + i as u32, t))?;
            first += self.spheres.len() as u32;
        }
        if !self.triangles.is_empty() {
            F::triangles(&self.triangles, ray, &mut |i, t| found(first + i as u32, t))?;
            first += self.triangles.len() as u32;
        }
        if !self.cylinders.is_empty() {
            F::cylinders(&self.cylinders, ray, &mut |i, t| found(first + i as u32, t))?;
        }
        ControlFlow::Continue(())
    }

    /// The index of a primitive's material.
    #[inline(always)]
    pub(crate) fn material(&self, number: u32) -> usize {
        self.materials[number as usize]
    }

    /// The point of primitive `number` that the ray hits at `t`, the normal turned against the ray:
    /// surfaces have two sides.
    #[inline(always)]
    pub(crate) fn surface<L: Lane<Scalar = S>, F: Family>(
        &self,
        number: u32,
        ray: &Ray<L>,
        t: L,
    ) -> SurfacePoint<L> {
        let near = ray.at(t);
        let mut at = F::settle(near, self.surface_near(number, near));
        let behind = L::literal(0.0).lt(at.normal.dot(ray.direction));
        at.normal = Vector::select(behind, -at.normal, at.normal);
        at
    }

    /// The point of primitive `number` next to `near`, and its normal there.
    #[inline(always)]
    fn surface_near<L: Lane<Scalar = S>>(&self, number: u32, near: Vector<L>) -> SurfacePoint<L> {
        let mut index = number as usize;
        if let Some(plane) = self.planes.get(index) {
            return plane.surface(near);
        }
        index -= self.planes.len();
        if let Some(sphere) = self.spheres.get(index) {
            return sphere.surface(near);
        }
        index -= self.spheres.len();
        if let Some(triangle) = self.triangles.get(index) {
            return triangle.surface(near);
        }
        index -= self.triangles.len();
        self.cylinders[index].surface(near)
    }
}
