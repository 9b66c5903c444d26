//! Coincident surfaces: planes and triangles that lie in one plane, however they are written.
//!
//! Where they overlap, the first listed is seen: their `t` is equal. Rounded, it would be so by
//! luck. So the plane through each surface is compared exactly, by the numbers as they are written.
//! What lies wholly in an earlier surface is never hit. Triangles that overlap get their `t` from
//! one of them.
//!
//! A plane is an equation `n . p = d` up to a factor, whose numbers are polynomials of those in the
//! scene. They are computed modulo the prime `2^61 - 1`, which rounds nothing: numbers of `f64` are
//! integers times powers of two. Equal planes have equal remainders. Planes that differ have equal
//! ones by chance only, in one of 2^61 cases (Schwartz, Fast Probabilistic Algorithms for
//! Verification of Polynomial Identities, 1980), and are then told apart by their distance.

use crate::scene::{Plane, Scene, Triangle, normal};
use glam::{DVec2, DVec3};
use std::collections::HashSet;
use std::ops::{Add, Mul, Sub};

/// The surfaces that share their plane with others.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Coincident {
    /// The indices of planes that an earlier one covers, and of triangles that an earlier plane or
    /// triangle covers.
    pub(crate) covered_planes: Vec<usize>,
    pub(crate) covered_triangles: Vec<usize>,
    /// The indices of triangles that overlap others in their plane, each with that of the triangle
    /// whose corners give all of them their plane.
    pub(crate) sharing: Vec<(usize, usize)>,
}

/// The largest number of pairs, for each triangle in a plane, that are tested for an overlap. If
/// there are more, all of them count as overlapping.
const PAIRS: usize = 256;

impl Coincident {
    /// Finds the surfaces of `scene` that lie in one plane.
    pub(crate) fn of(scene: &Scene) -> Self {
        let quotients: Vec<Quotient> = (scene.planes.iter().map(of_plane))
            .chain(scene.triangles.iter().map(of_triangle))
            .collect();
        let mut by_plane = repeated(&fingerprints(&quotients));
        by_plane.sort_unstable();
        let mut found = Self::default();
        for group in by_plane.chunk_by(|a, b| a.0 == b.0).filter(|group| group.len() > 1) {
            found.add(scene, &group.iter().map(|&(_, i)| i).collect::<Vec<_>>());
        }
        found.sharing.sort_unstable();
        found
    }

    /// Adds the surfaces of one plane. Their indices, which count through planes and triangles,
    /// ascend.
    fn add(&mut self, scene: &Scene, group: &[usize]) {
        let triangle = |i: usize| &scene.triangles[i - scene.planes.len()];
        if let Some(&first) = group.first().filter(|&&first| first < scene.planes.len()) {
            let plane = &scene.planes[first];
            let within = |v: DVec3| nearly_in(v, plane.normal, plane.point);
            for &i in &group[1..] {
                if i >= scene.planes.len() {
                    if triangle(i).vertices.into_iter().all(within) {
                        self.covered_triangles.push(i - scene.planes.len());
                    }
                } else if within(scene.planes[i].point) {
                    self.covered_planes.push(i);
                }
            }
            return;
        }
        let [a, b, c] = triangle(group[0]).vertices;
        let normal = normal([a, b, c]);
        let mut seen = HashSet::new();
        let mut distinct = Vec::new();
        for i in group.iter().copied() {
            let corners = triangle(i).vertices;
            if !corners.iter().all(|&v| nearly_in(v, normal, a)) {
                continue;
            }
            let mut corners = corners.map(|v| v.to_array().map(|x| (x + 0.0).to_bits()));
            corners.sort_unstable();
            let i = i - scene.planes.len();
            if seen.insert(corners) { distinct.push(i) } else { self.covered_triangles.push(i) }
        }
        let overlapping = overlapping(&scene.triangles, normal, &distinct);
        // The largest one knows its plane best.
        let area = |&i: &usize| {
            let [a, b, c] = scene.triangles[i].vertices;
            (b - a).cross(c - a).length()
        };
        if let Some(&largest) = overlapping.iter().max_by(|a, b| area(a).total_cmp(&area(b))) {
            self.sharing.extend(overlapping.iter().map(|&i| (i, largest)));
        }
    }
}

/// Returns whether a point is in a plane up to rounding: far less strict than the fingerprint, so
/// that this decides nothing but chance.
fn nearly_in(point: DVec3, normal: DVec3, of: DVec3) -> bool {
    let size = normal.abs().dot(point.abs() + of.abs());
    normal.dot(point - of).abs() <= 1e-9 * size
}

/// Returns which of these triangles overlap others in more than an edge, all with this normal.
fn overlapping(triangles: &[Triangle], normal: DVec3, members: &[usize]) -> Vec<usize> {
    // Along the axis of the longest component, the triangles keep their shape.
    let drop = normal.abs().max_position();
    let flat = |v: DVec3| DVec2::new(v[(drop + 1) % 3], v[(drop + 2) % 3]);
    let mut flat: Vec<(usize, [DVec2; 3])> =
        members.iter().map(|&i| (i, triangles[i].vertices.map(flat))).collect();
    let lowest = |corners: &[DVec2; 3]| corners[0].x.min(corners[1].x).min(corners[2].x);
    let highest = |corners: &[DVec2; 3]| corners[0].x.max(corners[1].x).max(corners[2].x);
    flat.sort_by(|a, b| lowest(&a.1).total_cmp(&lowest(&b.1)));
    let mut overlaps = vec![false; flat.len()];
    let mut pairs = 0;
    for i in 0..flat.len() {
        let end = highest(&flat[i].1);
        for j in (i + 1..flat.len()).take_while(|&j| lowest(&flat[j].1) < end) {
            pairs += 1;
            if pairs > PAIRS * flat.len() {
                return members.to_vec();
            }
            let (a, b) = (&flat[i].1, &flat[j].1);
            let known = overlaps[i] && overlaps[j];
            if !(known || apart(a, b) || apart(b, a)) {
                (overlaps[i], overlaps[j]) = (true, true);
            }
        }
    }
    flat.iter().zip(overlaps).filter(|(_, overlaps)| *overlaps).map(|(&(i, _), _)| i).collect()
}

/// Returns whether an edge of the triangle `a` has all of `b` on its outer side, or on itself.
fn apart(a: &[DVec2; 3], b: &[DVec2; 3]) -> bool {
    let area = |from: DVec2, to: DVec2, point: DVec2| (to - from).perp_dot(point - from);
    (0..3).any(|i| {
        let (from, to, inner) = (a[i], a[(i + 1) % 3], a[(i + 2) % 3]);
        let side = area(from, to, inner);
        b.iter().all(|&point| area(from, to, point) * side <= 0.0)
    })
}

/// The dividend and the divisor of a number that is the same for all multiples of an equation.
type Quotient = [Residue; 2];

fn of_plane(plane: &Plane) -> Quotient {
    quotient(residues(plane.normal), residues(plane.point))
}

fn of_triangle(triangle: &Triangle) -> Quotient {
    let [a, b, c] = triangle.vertices.map(residues);
    let edge = |to: [Residue; 3]| [to[0] - a[0], to[1] - a[1], to[2] - a[2]];
    let ([px, py, pz], [qx, qy, qz]) = (edge(b), edge(c));
    quotient([py * qz - pz * qy, pz * qx - px * qz, px * qy - py * qx], a)
}

/// Returns `f . n + d` and `g . n` for the plane `n . p = d`, with arbitrary `f` and `g`.
fn quotient(normal: [Residue; 3], point: [Residue; 3]) -> Quotient {
    let f = [0x05a1_37e9_4c2b_d861, 0x1b83_96f0_d247_5e1d, 0x0e6d_c15b_39a8_72f3].map(Residue);
    let g = [0x11c9_5d02_e8b7_346f, 0x07f4_a86b_1d93_c25b, 0x1a20_f37e_659c_b8d1].map(Residue);
    let dot = |a: [Residue; 3], b: [Residue; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let from = [f[0] + point[0], f[1] + point[1], f[2] + point[2]];
    let divisor = dot(g, normal);
    [dot(from, normal), if divisor == Residue(0) { Residue(1) } else { divisor }]
}

/// Returns the quotients, with one division for all: each inverse is a quotient of two products.
fn fingerprints(quotients: &[Quotient]) -> Vec<u64> {
    let mut product = Residue(1);
    let mut prints = Vec::with_capacity(quotients.len());
    for [_, divisor] in quotients {
        prints.push(product.0);
        product = product * *divisor;
    }
    let mut inverse = product.inverse();
    for (print, &[dividend, divisor]) in prints.iter_mut().zip(quotients).rev() {
        *print = (dividend * (inverse * Residue(*print))).0;
        inverse = inverse * divisor;
    }
    prints
}

/// Returns the fingerprints that may occur more than once, with their indices: those that share one
/// of many bits with another.
fn repeated(prints: &[u64]) -> Vec<(u64, usize)> {
    let words = prints.len().next_power_of_two();
    let place = |print: u64| (print as usize % words, 1_u8 << (print >> 58));
    let (mut once, mut again) = (vec![0_u8; words], vec![0_u8; words]);
    for (word, bit) in prints.iter().map(|&print| place(print)) {
        again[word] |= once[word] & bit;
        once[word] |= bit;
    }
    let repeats = |&(print, _): &(u64, usize)| {
        let (word, bit) = place(print);
        again[word] & bit != 0
    };
    prints.iter().copied().zip(0..).filter(repeats).collect()
}

fn residues(v: DVec3) -> [Residue; 3] {
    v.to_array().map(Residue::of)
}

/// A number modulo `2^61 - 1`, below it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Residue(u64);

const PRIME: u64 = (1 << 61) - 1;

impl Residue {
    /// Returns the remainder of a finite number.
    fn of(x: f64) -> Self {
        let bits = x.to_bits();
        let (exponent, fraction) = (bits >> 52 & 0x7ff, bits & ((1 << 52) - 1));
        // x = digits 2^(exponent - 1075), and 1075 is 38 modulo 61. 2^61 is 1.
        let (digits, exponent) =
            if exponent == 0 { (fraction, 1) } else { (fraction | 1 << 52, exponent) };
        let size = Self::reduced(u128::from(digits) << ((exponent + 23) % 61));
        if x < 0.0 { Self(0) - size } else { size }
    }

    fn reduced(x: u128) -> Self {
        let once = (x & u128::from(PRIME)) as u64 + (x >> 61) as u64;
        let twice = (once & PRIME) + (once >> 61);
        Self(if twice >= PRIME { twice - PRIME } else { twice })
    }

    /// Returns the inverse of a number other than 0, by Fermat's little theorem.
    fn inverse(self) -> Self {
        let (mut power, mut square) = (Self(1), self);
        for bit in 0..61 {
            if (PRIME - 2) >> bit & 1 == 1 {
                power = power * square;
            }
            square = square * square;
        }
        power
    }
}

impl Add for Residue {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::reduced(u128::from(self.0) + u128::from(other.0))
    }
}

impl Sub for Residue {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self::reduced(u128::from(self.0) + u128::from(PRIME - other.0))
    }
}

impl Mul for Residue {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self::reduced(u128::from(self.0) * u128::from(other.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Camera, RenderSettings};

    fn scene(planes: &[(DVec3, DVec3)], triangles: &[[DVec3; 3]]) -> Scene {
        let material = 0;
        Scene {
            camera: Camera {
                position: DVec3::ZERO,
                look_at: DVec3::X,
                up: DVec3::Y,
                focal_length: 1.0,
                screen_width: 1.0,
            },
            render: RenderSettings::default(),
            lights: vec![],
            materials: vec![],
            planes: planes
                .iter()
                .map(|&(point, normal)| Plane { point, normal, material })
                .collect(),
            spheres: vec![],
            triangles: triangles.iter().map(|&vertices| Triangle { vertices, material }).collect(),
            cylinders: vec![],
        }
    }

    /// Catches remainders that are off by one or not reduced, and exponents that are off.
    #[test]
    fn remainders_obey_the_rules_of_numbers() {
        let of = Residue::of;
        assert_eq!([of(0.0), of(-0.0), of(1.0), of(3.0)], [0, 0, 1, 3].map(Residue));
        assert_eq!(of(-1.0), Residue(PRIME - 1));
        assert_eq!(of(f64::from_bits(1)) * of(2f64.powi(1000)) * of(2f64.powi(74)), of(1.0));
        assert_eq!(of(2f64.powi(61)), of(1.0));
        for (a, b) in [(0.1, -3e17), (1e300, 7.0), (-5e-324, 1e-10), (123.0, 321.5)] {
            // Exact in f64: halves of the digits, and powers of two.
            let high = f64::from_bits(f64::to_bits(a) & !((1 << 27) - 1));
            assert_eq!(of(high) + of(a - high), of(a));
            assert_eq!(of(b) * of(0.25) * of(4.0), of(b));
            assert_eq!((of(a) - of(b)) + of(b), of(a));
            assert_eq!(of(a) * of(a).inverse(), Residue(1));
        }
    }

    /// Catches planes and triangles that are told apart by their factor, their sign, their point or
    /// the order of their corners, and those that are not told apart at all.
    #[test]
    fn what_lies_in_one_plane_is_found() {
        let (point, normal) = (DVec3::new(0.5, -2.0, 3.0), DVec3::new(1.0, 2.0, -3.0));
        // 2 x - y and 3 x + z are across the normal.
        let across = |i: f64, j: f64| point + DVec3::new(2.0 * i + 3.0 * j, -i, j);
        let corners = [across(0.0, 0.0), across(5.0, 1.0), across(1.0, 7.0)];
        let [a, b, c] = corners;
        let up = DVec3::Y * 1e-12;
        let planes = [
            (point, normal),
            (across(4.0, 9.0), normal * -7.0),
            (point, normal + up),
            (point - up, normal),
        ];
        let lifted = corners.map(|v| v + up);
        let found = Coincident::of(&scene(&planes, &[lifted, corners]));
        assert_eq!((found.covered_planes, found.covered_triangles), (vec![1], vec![1]));

        let beside = [b, c, b + c - a];
        let turned = [[c, a, b], [b, a, c]];
        let found = Coincident::of(&scene(&[], &[corners, turned[0], beside, lifted, turned[1]]));
        assert_eq!(found, Coincident { covered_triangles: vec![1, 4], ..Coincident::default() });
        // It overlaps the first, and is the largest.
        let large = [across(-9.0, -9.0), across(20.0, 1.0), across(1.0, 0.5)];
        let found = Coincident::of(&scene(&[], &[corners, beside, large]));
        assert_eq!(found.sharing, [(0, 2), (2, 2)]);
    }

    /// Catches a search that compares each triangle of a flat mesh with each other.
    #[test]
    fn a_flat_mesh_has_no_overlaps() {
        let at = |i: usize, j: usize| DVec3::new(i as f64, j as f64, 0.0);
        let squares = (0..60).flat_map(|i| (0..60).map(move |j| (i, j)));
        let halves = |(i, j)| {
            let (a, c) = (at(i, j), at(i + 1, j + 1));
            [[a, at(i + 1, j), c], [a, c, at(i, j + 1)]]
        };
        let triangles: Vec<_> = squares.flat_map(halves).collect();
        assert_eq!(Coincident::of(&scene(&[], &triangles)), Coincident::default());
    }
}
