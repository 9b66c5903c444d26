//! The colour that a ray brings back: hit, shade, reflect, repeat.
//!
//! This is the recursion of Whitted (An Improved Illumination Model for Shaded Display, 1980),
//! written as a loop, because a mirror sends on just one ray.

use crate::accel::behind_culling::cull_behind;
use crate::accel::cones::ConeSet;
use crate::accel::hit::Hit;
use crate::accel::occluders::Occluders;
use crate::accel::plane_culling::hiding_planes;
use crate::accel::primitives::Primitives;
use crate::execution::Acceleration;
use crate::formulas::{Family, LightPath};
use crate::material::{Finish, Light, Material, power};
use crate::ray::Ray;
use crate::scene::{Plane, Scene};
use crate::shapes::SurfacePoint;
use crate::shapes::side::Side;
use crate::simd::lane::{Lane, Mask, Scalar};
use crate::simd::vector::Vector;
use glam::DVec3;
use std::marker::PhantomData;

/// A scene in the precision and with the formulas of an image, ready for rays.
#[derive(Debug)]
pub(crate) struct World<S, F> {
    pub(crate) primitives: Primitives<S>,
    materials: Vec<Material<S>>,
    pub(crate) lights: Vec<Light<S>>,
    /// The direction cones of the primitives, seen from the eye. Without them a ray from the eye
    /// may hit any primitive.
    pub(crate) eye: Option<ConeSet<S>>,
    /// The same, seen from the eye's mirror image behind each plane that reflects, by the plane's
    /// number: for the second segment of a ray from the eye.
    mirrored_eyes: Vec<Option<ConeSet<S>>>,
    background: Vector<S>,
    /// The largest number of bounces: 0 if nothing reflects.
    pub(crate) max_reflections: u32,
    /// Computes path hashes, for adaptive sampling.
    hashes_paths: bool,
    formulas: PhantomData<F>,
}

/// The result of tracing a ray.
pub(crate) struct Traced<L: Lane> {
    pub(crate) color: Vector<L>,
    /// A number that is equal for rays that hit the same primitives in the same order, each lit by
    /// the same lights. 0 unless path hashes are computed.
    pub(crate) path_hash: L::Index,
}

/// A point to be lit: its position and normal, and its material.
struct Surface<L: Lane> {
    at: SurfacePoint<L>,
    finish: Finish<L>,
}

impl<S: Scalar, F: Family> World<S, F> {
    /// Prepares `scene` for rays that all start at `eye`, the camera's position, and go forward;
    /// without an `eye`, for any rays.
    pub(crate) fn new(scene: &Scene, eye: Option<DVec3>, acceleration: Acceleration) -> Self {
        // Skipping primitives relies on the formulas' error bounds.
        let acceleration = if F::ERROR_BOUNDED { acceleration } else { Acceleration::None };
        let scene = match (eye, acceleration) {
            (Some(_), Acceleration::Auto) => &cull_behind(scene, S::ROUNDOFF),
            _ => scene,
        };
        let mut primitives = Primitives::new(scene, acceleration);
        let use_cones = acceleration == Acceleration::Auto && primitives.leaves().is_none();
        if use_cones && eye.is_some() {
            primitives.bound_triangles(scene);
        }
        let cones_from = |point: DVec3| use_cones.then(|| ConeSet::new(scene, point));
        // Without error bounds a ray may slip through a plane, so planes hide nothing from it.
        let culling_eye = eye.filter(|_| F::ERROR_BOUNDED);
        let mirrors = scene.materials.iter().any(|material| material.reflection > 0.0);
        let shining = scene.lights.iter().filter(|light| light.color * light.power != DVec3::ZERO);
        let lights = shining.filter_map(|light| {
            let at = light.position;
            let mut planes = hiding_planes(scene, at, culling_eye, S::ROUNDOFF)?;
            if F::ERROR_BOUNDED {
                planes.retain(|&(_, side)| side != Side::Unknown);
            }
            let occluders = Occluders::new(scene, at, planes, cones_from(at));
            let in_flat_surface = F::ERROR_BOUNDED && occluders.is_in_flat_surface(scene, at);
            Some(Light::new(light, in_flat_surface, occluders))
        });
        let mirrored_eye = |plane: &Plane| {
            let mirror = scene.materials[plane.material].reflection > 0.0;
            eye.filter(|_| use_cones && mirror).map(|eye| ConeSet::mirrored(scene, eye, plane))
        };
        Self {
            mirrored_eyes: scene.planes.iter().map(mirrored_eye).collect(),
            lights: lights.collect(),
            eye: eye.and_then(cones_from),
            primitives,
            materials: scene.materials.iter().map(Material::new).collect(),
            background: Vector::rounded(scene.render.background),
            max_reflections: if mirrors { scene.render.max_reflections } else { 0 },
            hashes_paths: scene.render.adaptive,
            formulas: PhantomData,
        }
    }

    /// Returns the colour at the end of a ray of unit direction, in the lanes of `active`.
    /// `from_eye` says that all rays start at the eye.
    ///
    /// Instead of computing `(1 - k) surface + k mirrored` from the last bounce back to the first,
    /// each surface is added with the share that the mirrors before it left over.
    #[inline(always)]
    pub(crate) fn trace<L: Lane<Scalar = S>>(
        &self,
        mut ray: Ray<L>,
        mut active: L::Mask,
        from_eye: bool,
    ) -> Traced<L> {
        let (zero, one) = (L::literal(0.0), L::literal(1.0));
        let mut cones = self.eye.as_ref().filter(|_| from_eye).map(|eye| (eye, zero));
        let mut color = Vector::zero();
        let mut share = one;
        let mut path_hash = L::splat_index(0);
        for bounce in 0..=self.max_reflections {
            let hit = self.primitives.closest_hit::<L, F>(&ray, active, cones.take());
            let missed = active & !hit.exists();
            color = Vector::select(missed, color + Vector::splat(self.background) * share, color);
            active = active & hit.exists();
            if !active.any() {
                break;
            }
            let surface = self.surface(&hit, &ray, active);
            let kept = one - surface.finish.reflection;
            // A perfect mirror shows no light of its own, so it needs no shadow rays.
            let shown = active & zero.lt(kept);
            if self.hashes_paths {
                let longer =
                    L::hash_combine(L::hash_combine(path_hash, L::splat_index(1)), hit.primitive);
                path_hash = L::select_index(active, longer, path_hash);
            }
            let lit = self.shade(&surface, &ray, shown, &mut path_hash);
            color = Vector::select(shown, color + lit * (share * kept), color);
            active = active & zero.lt(surface.finish.reflection);
            if bounce == self.max_reflections || !active.any() {
                break;
            }
            if from_eye && bounce == 0 {
                cones = self.mirrored_eye::<L>(&hit, active).map(|eye| (eye, hit.t));
            }
            share = share * surface.finish.reflection;
            ray = mirrored(&ray, &surface.at);
        }
        Traced { color, path_hash }
    }

    /// Returns the cones of the eye's mirror image, if all rays of `active` hit the same plane.
    #[inline(always)]
    fn mirrored_eye<L: Lane<Scalar = S>>(
        &self,
        hit: &Hit<L>,
        active: L::Mask,
    ) -> Option<&ConeSet<S>> {
        let number = L::first_index(active, hit.primitive)?;
        let others = active & !L::index_equals(hit.primitive, number);
        self.mirrored_eyes.get(number as usize).filter(|_| !others.any())?.as_ref()
    }

    /// Returns the surfaces that the rays of `active`, at least one, hit. Each distinct primitive
    /// is looked up once, for all lanes that hit it.
    #[inline(always)]
    fn surface<L: Lane<Scalar = S>>(
        &self,
        hit: &Hit<L>,
        ray: &Ray<L>,
        active: L::Mask,
    ) -> Surface<L> {
        let mut surface: Option<Surface<L>> = None;
        let mut todo = active;
        loop {
            let number = L::first_index(todo, hit.primitive).unwrap_or(0);
            let here = L::index_equals(hit.primitive, number);
            let at = self.primitives.surface::<L, F>(number, ray, hit.t);
            let found = Surface {
                at,
                finish: Finish::splat(&self.materials[self.primitives.material(number)]),
            };
            let all = match surface {
                Some(others) => Surface::select(here, found, others),
                None => found,
            };
            todo = todo & !here;
            if !todo.any() {
                return all;
            }
            surface = Some(all);
        }
    }

    /// Returns Phong's sum over the lights that a point sees.
    #[inline(always)]
    fn shade<L: Lane<Scalar = S>>(
        &self,
        surface: &Surface<L>,
        ray: &Ray<L>,
        active: L::Mask,
        path_hash: &mut L::Index,
    ) -> Vector<L> {
        let (zero, two) = (L::literal(0.0), L::literal(2.0));
        let Surface { at, finish } = surface;
        let start = at.start();
        let facing = at.normal.dot(ray.direction);
        let mut color = finish.color * finish.ambient;
        // Lights are numbered from 2, because 1 stands for a hit in a path hash.
        for (number, light) in (2..).zip(&self.lights) {
            // The direction to the light starts where shadow rays start, which is certainly on the
            // viewer's side. A light in the surface itself is then below it by all roundings but
            // those of the light's own coordinates, and no rounding makes it shine.
            let toward = Vector::splat(light.position) - start;
            let distance = toward.dot(toward).sqrt();
            let inverse_distance = L::literal(1.0) / distance;
            let to_light = toward * inverse_distance;
            let cosine = at.normal.dot(to_light);
            // Without such a light, this is one branch.
            let highest_below = match light.uncertain {
                Some(uncertain) => at.normal.abs().dot(Vector::splat(uncertain)) * inverse_distance,
                None => zero,
            };
            let above = active & highest_below.lt(cosine);
            if !above.any() {
                continue;
            }
            let path = LightPath { start, toward, to_light, distance };
            let lit = above & !self.primitives.occluded::<L, F>(above, &path, &light.occluders);
            if !lit.any() {
                continue;
            }
            if self.hashes_paths {
                *path_hash = L::select_index(
                    lit,
                    L::hash_combine(*path_hash, L::splat_index(number)),
                    *path_hash,
                );
            }
            // m . -d with m = 2 (n . l) n - l.
            let mirror_cosine = to_light.dot(ray.direction) - two * cosine * facing;
            // In the other lanes the base is 0, and so is its power.
            let shining = lit & zero.lt(mirror_cosine);
            let highlight = power(mirror_cosine.max(zero), finish.shininess, shining);
            let answer = finish.color * (finish.diffuse * cosine)
                + Vector::new(highlight, highlight, highlight) * finish.specular;
            color =
                Vector::select(lit, color + Vector::splat(light.intensity).scale(answer), color);
        }
        color
    }
}

impl<L: Lane> Surface<L> {
    #[inline(always)]
    fn select(mask: L::Mask, yes: Self, no: Self) -> Self {
        Self {
            at: SurfacePoint::select(mask, yes.at, no.at),
            finish: Finish::select(mask, yes.finish, no.finish),
        }
    }
}

/// Returns the ray that a mirror sends on. Its direction is made unit again, so that errors do not
/// accumulate from bounce to bounce.
#[inline(always)]
fn mirrored<L: Lane>(ray: &Ray<L>, at: &SurfacePoint<L>) -> Ray<L> {
    let along = at.normal.dot(ray.direction);
    let direction = ray.direction - at.normal * (along + along);
    Ray { origin: at.start(), direction: direction.unit() }
}
