//! Seeded generators of hard cases: 36 families, each hard for one reason.
//!
//! A family draws inputs that come near one weakness of f32 formulas (cancellation, a decision on a
//! boundary, a scale far from 1) over ranges as they occur in scenes and somewhat beyond, and the
//! oracle answers them. The same family, seed and number give the same case on every machine:
//! random numbers come from integers, and nothing rounds otherwise than IEEE 754 says.

mod cylinder;
mod draw;
mod mesh;
mod mixed;
mod plane;
mod sphere;
mod triangle;

use crate::cases::{HardCase, Primitive, Ray};
use crate::oracle::{ExactAnswer, answer};

use draw::Draw;

/// One kind of hard cases.
#[derive(Clone, Copy, Debug)]
pub struct Family {
    /// Its name in the case format.
    pub name: &'static str,
    /// What is hard in it.
    pub about: &'static str,
    /// Draws the inputs; the index rotates what must come evenly.
    draw: fn(&mut Draw, usize) -> Setup,
    wanted: Wanted,
}

/// Inputs without an answer.
struct Setup {
    primitive: Primitive,
    ray: Ray,
    note: String,
}

/// What the answer must be for the case to belong to its family.
#[derive(Clone, Copy, Debug)]
enum Wanted {
    Any,
    Hit,
    Miss,
}

impl Family {
    /// The family of this name.
    #[must_use]
    pub fn named(name: &str) -> Option<&'static Self> {
        FAMILIES.iter().find(|family| family.name == name)
    }

    const fn new(
        name: &'static str,
        about: &'static str,
        draw: fn(&mut Draw, usize) -> Setup,
    ) -> Self {
        Self { name, about, draw, wanted: Wanted::Any }
    }

    const fn wanting(self, wanted: Wanted) -> Self {
        Self { wanted, ..self }
    }

    fn accepts(&self, answer: &ExactAnswer) -> bool {
        match self.wanted {
            Wanted::Any => true,
            Wanted::Hit => answer.expect.is_hit(),
            Wanted::Miss => !answer.expect.is_hit(),
        }
    }

    /// The case number `index`.
    fn case(&self, seed: u64, index: usize) -> HardCase {
        let mut draw = Draw::new(seed, self.name, index);
        let mut attempt = || {
            let setup = (self.draw)(&mut draw, index);
            let answer = answer(&setup.primitive, &setup.ray);
            (setup, answer)
        };
        let mut case = attempt();
        // What a family wants comes in half of the attempts or more.
        for _ in 0..100 {
            if self.accepts(&case.1) {
                break;
            }
            case = attempt();
        }
        let (setup, answer) = case;
        let separator = if answer.reason.is_empty() { "" } else { "; " };
        HardCase {
            family: self.name.to_owned(),
            id: format!("{}-s{seed}-{index:04}", self.name),
            primitive: setup.primitive,
            ray: setup.ray,
            expect: Some(answer.expect),
            decidable: answer.decidable,
            cond: answer.cond,
            margin: answer.margin,
            note: format!("{}{separator}{}", setup.note, answer.reason),
        }
    }
}

/// `count` cases of a family with their exact answers; the first of them do not depend on `count`.
#[must_use]
pub fn generate(family: &Family, seed: u64, count: usize) -> Vec<HardCase> {
    (0..count).map(|index| family.case(seed, index)).collect()
}

/// All families, by primitive.
pub const FAMILIES: [Family; 36] = [
    Family::new("plane_basic", "nothing is hard: the control", plane::basic),
    Family::new(
        "plane_parallel",
        "rays almost parallel to the plane, 1e-7 to 0.1 rad",
        plane::parallel,
    ),
    Family::new("plane_far", "planes 1e2 to 1e7 away", plane::far),
    Family::new("sphere_basic", "nothing is hard: the control", sphere::basic),
    Family::new("sphere_graze", "closest approach within 1e-8 to 0.1 of the radius", sphere::graze),
    Family::new("sphere_far", "origins 1e2 to 1e7 radii away", sphere::far),
    Family::new(
        "sphere_ground",
        "radius 1e5 to 1e7 as the ground, eyes 0.01 to 100 above it",
        sphere::ground,
    ),
    Family::new("sphere_inside", "origins inside", sphere::inside).wanting(Wanted::Hit),
    Family::new("sphere_behind", "the sphere lies behind the origin", sphere::behind)
        .wanting(Wanted::Miss),
    Family::new("sphere_surface_exact", "origins exactly on the surface", sphere::surface_exact),
    Family::new(
        "sphere_surface_round",
        "origins on the surface but for rounding",
        sphere::surface_round,
    ),
    Family::new("dir_scale", "directions 1e-30 to 1e34 long", mixed::direction_scale),
    Family::new("scale_scene", "everything scaled by 1e-4 to 2e6", mixed::scale),
    Family::new("offset_scene", "everything moved by 1e5 to 1e6", mixed::offset),
    Family::new("tri_basic", "nothing is hard: the control", triangle::basic),
    Family::new("tri_needle", "two vertices 1e-6 to 0.01 apart", triangle::needle),
    Family::new("tri_sliver", "a vertex 1e-6 to 0.01 from the edge opposite", triangle::sliver),
    Family::new(
        "tri_tiny_far",
        "triangles 1e2 to 3e5 times as far away as large",
        triangle::tiny_far,
    ),
    Family::new(
        "tri_edge_on",
        "rays 1e-6 to 0.03 rad from the triangle's plane",
        triangle::edge_on,
    ),
    Family::new("tri_edge", "rays 1e-7 to 0.01 inside or outside an edge", triangle::edge),
    Family::new("tri_degenerate", "triangles without area", triangle::degenerate)
        .wanting(Wanted::Miss),
    Family::new(
        "flat_surface_exact",
        "origins exactly on a plane or triangle",
        mixed::flat_surface_exact,
    )
    .wanting(Wanted::Miss),
    Family::new("mesh_edge", "rays at the edge that two triangles share", mesh::edge)
        .wanting(Wanted::Hit),
    Family::new("mesh_vertex", "rays at the vertex that a fan shares", mesh::vertex)
        .wanting(Wanted::Hit),
    Family::new("mesh_closed", "from inside an octahedron at its edges and vertices", mesh::closed)
        .wanting(Wanted::Hit),
    Family::new("cyl_basic", "nothing is hard: the control", cylinder::basic),
    Family::new("cyl_parallel", "rays 0 to 0.1 rad from the axis", cylinder::parallel),
    Family::new("cyl_graze", "closest approach within 1e-8 to 0.1 of the radius", cylinder::graze),
    Family::new("cyl_rim", "rays 1e-7 to 0.1 of the height from a rim", cylinder::rim),
    Family::new("cyl_far_wall", "the near wall is missed, the far wall hit", cylinder::far_wall)
        .wanting(Wanted::Hit),
    Family::new("cyl_inside", "origins inside", cylinder::inside),
    Family::new("cyl_huge", "radius 1e3 to 1e6, height 0.1 to 10", cylinder::huge),
    Family::new("cyl_far", "origins 1e2 to 1e7 radii away", cylinder::far),
    Family::new("cyl_surface_exact", "origins exactly on the wall", cylinder::surface_exact),
    Family::new(
        "cyl_surface_round",
        "origins on the wall but for rounding",
        cylinder::surface_round,
    ),
    Family::new("invalid_input", "NaN, infinite and zero input", mixed::invalid)
        .wanting(Wanted::Miss),
];
