//! Seeded generators of hard cases: 36 families, each hard for one reason.
//!
//! A family draws inputs near one weakness of f32 formulas: cancellation, a decision on a boundary,
//! or a scale far from 1. The inputs cover the ranges that occur in scenes and somewhat more. The
//! oracle answers them. The same family, seed and index give the same case on every machine,
//! because random numbers come from integers and all operations round as IEEE 754 specifies.

mod cylinder;
pub(crate) mod draw;
mod mesh;
mod mixed;
mod plane;
mod sphere;
mod triangle;

use crate::cases::{HardCase, Primitive, Ray};
use crate::oracle::{ExactAnswer, answer};

use draw::Draw;

/// A generator of hard cases of one kind.
#[derive(Clone, Copy, Debug)]
pub struct Family {
    /// The name in the case format.
    pub name: &'static str,
    /// The difficulty of its cases.
    pub about: &'static str,
    /// Draws the inputs. Variants that must be equally frequent rotate with the index.
    draw: Draws,
    /// The verdict that a case must have: hit (`true`) or miss (`false`), `None` for either.
    wanted: Option<bool>,
}

/// The inputs of a case, without the answer.
struct Setup {
    primitive: Primitive,
    ray: Ray,
    note: String,
}

impl Family {
    /// Returns the family with this name.
    #[must_use]
    pub fn named(name: &str) -> Option<&'static Self> {
        FAMILIES.iter().find(|family| family.name == name)
    }

    fn accepts(&self, answer: &ExactAnswer) -> bool {
        self.wanted.is_none_or(|hit| hit == answer.expect.is_hit())
    }

    /// Returns the case with this index.
    fn case(&self, seed: u64, index: usize) -> HardCase {
        let mut draw = Draw::new(seed, self.name, index);
        let mut attempt = || {
            let setup = (self.draw)(&mut draw, index);
            let answer = answer(&setup.primitive, &setup.ray);
            (setup, answer)
        };
        let mut case = attempt();
        // At least half of the attempts give an answer that the family accepts.
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

/// Returns `count` cases of a family with their exact answers. Each depends only on the family, the
/// seed and its index.
#[must_use]
pub fn generate(family: &Family, seed: u64, count: usize) -> Vec<HardCase> {
    (0..count).map(|index| family.case(seed, index)).collect()
}

type Draws = fn(&mut Draw, usize) -> Setup;

const fn any(name: &'static str, about: &'static str, draw: Draws) -> Family {
    Family { name, about, draw, wanted: None }
}

const fn hits(name: &'static str, about: &'static str, draw: Draws) -> Family {
    Family { name, about, draw, wanted: Some(true) }
}

const fn misses(name: &'static str, about: &'static str, draw: Draws) -> Family {
    Family { name, about, draw, wanted: Some(false) }
}

/// All families, ordered by primitive.
pub const FAMILIES: [Family; 36] = [
    any("plane_basic", "nothing is hard: the control", plane::basic),
    any("plane_parallel", "rays almost parallel to the plane, 1e-7 to 0.1 rad", plane::parallel),
    any("plane_far", "planes 1e2 to 1e7 away", plane::far),
    any("sphere_basic", "nothing is hard: the control", sphere::basic),
    any("sphere_graze", "closest approach within 1e-8 to 0.1 of the radius", sphere::graze),
    any("sphere_far", "origins 1e2 to 1e7 radii away", sphere::far),
    any(
        "sphere_ground",
        "radius 1e5 to 1e7 as the ground, eyes 0.01 to 100 above it",
        sphere::ground,
    ),
    hits("sphere_inside", "origins inside", sphere::inside),
    misses("sphere_behind", "the sphere lies behind the origin", sphere::behind),
    any("sphere_surface_exact", "origins exactly on the surface", sphere::surface_exact),
    any("sphere_surface_round", "origins on the surface but for rounding", sphere::surface_round),
    any("dir_scale", "directions 1e-30 to 1e34 long", mixed::direction_scale),
    any("scale_scene", "everything scaled by 1e-4 to 2e6", mixed::scale),
    any("offset_scene", "everything moved by 1e5 to 1e6", mixed::offset),
    any("tri_basic", "nothing is hard: the control", triangle::basic),
    any("tri_needle", "two vertices 1e-6 to 0.01 apart", triangle::needle),
    any("tri_sliver", "a vertex 1e-6 to 0.01 from the edge opposite", triangle::sliver),
    any("tri_tiny_far", "triangles 1e2 to 3e5 times as far away as large", triangle::tiny_far),
    any("tri_edge_on", "rays 1e-6 to 0.03 rad from the triangle's plane", triangle::edge_on),
    any("tri_edge", "rays 1e-7 to 0.01 inside or outside an edge", triangle::edge),
    misses("tri_degenerate", "triangles without area", triangle::degenerate),
    misses(
        "flat_surface_exact",
        "origins exactly on a plane or triangle",
        mixed::flat_surface_exact,
    ),
    hits("mesh_edge", "rays at the edge that two triangles share", mesh::edge),
    hits("mesh_vertex", "rays at the vertex that a fan shares", mesh::vertex),
    hits("mesh_closed", "from inside an octahedron at its edges and vertices", mesh::closed),
    any("cyl_basic", "nothing is hard: the control", cylinder::basic),
    any("cyl_parallel", "rays 0 to 0.1 rad from the axis", cylinder::parallel),
    any("cyl_graze", "closest approach within 1e-8 to 0.1 of the radius", cylinder::graze),
    any("cyl_rim", "rays 1e-7 to 0.1 of the height from a rim", cylinder::rim),
    hits("cyl_far_wall", "the near wall is missed, the far wall hit", cylinder::far_wall),
    any("cyl_inside", "origins inside", cylinder::inside),
    any("cyl_huge", "radius 1e3 to 1e6, height 0.1 to 10", cylinder::huge),
    any("cyl_far", "origins 1e2 to 1e7 radii away", cylinder::far),
    any("cyl_surface_exact", "origins exactly on the wall", cylinder::surface_exact),
    any("cyl_surface_round", "origins on the wall but for rounding", cylinder::surface_round),
    misses("invalid_input", "NaN, infinite and zero input", mixed::invalid),
];
