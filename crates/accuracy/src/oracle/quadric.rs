//! The equation `|f + t d| = r` in the plane (cylinder) or in space (sphere), with `f` from the
//! centre to the origin.

use std::cmp::Ordering;

use dashu_ratio::RBig;

use super::exact::{Surd, abs, dot, dot_of_sizes, float, products, sign, sum};
use super::margin;

/// A ray against a circle or a sphere around 0, as the polynomial `a t^2 + 2 h t + c`.
pub(super) struct Quadric<const N: usize> {
    pub(super) from_center: [RBig; N],
    direction: [RBig; N],
    radius: RBig,
    a: RBig,
    h: RBig,
    c: RBig,
    /// A quarter of the discriminant, `h^2 - a c`.
    discriminant: RBig,
}

impl<const N: usize> Quadric<N> {
    /// Creates the polynomial; `direction` must not be 0, and `radius` must be above 0.
    pub(super) fn new(from_center: [RBig; N], direction: [RBig; N], radius: RBig) -> Self {
        let a = dot(&direction, &direction);
        let h = dot(&from_center, &direction);
        let c = dot(&from_center, &from_center) - &radius * &radius;
        let discriminant = &h * &h - &a * &c;
        Self { from_center, direction, radius, a, h, c, discriminant }
    }

    /// Returns whether the ray's line touches or crosses the circle or sphere.
    pub(super) fn is_met(&self) -> bool {
        sign(&self.discriminant).is_ge()
    }

    /// Returns the nearer and the farther root, for a line that meets the circle or sphere.
    pub(super) fn roots(&self) -> [Surd; 2] {
        let middle = -&self.h / &self.a;
        let half_chord = RBig::ONE / &self.a;
        [-&half_chord, half_chord].map(|s| Surd::root(s, self.discriminant.clone()).plus(&middle))
    }

    /// Returns the margin of the discriminant's sign.
    ///
    /// The sign tells whether the closest approach `l = f - (h/a) d` is longer than `r`. Perturbing
    /// `f`, `d` and `r` by an ulp moves `l` by at most an ulp of `|f_i| + |h/a d_i|` in each
    /// direction, and `r` by an ulp of `r`.
    pub(super) fn approach_margin(&self) -> f64 {
        let s = &self.h / &self.a;
        let steps: [RBig; N] = std::array::from_fn(|i| &s * &self.direction[i]);
        let approach: [RBig; N] = std::array::from_fn(|i| &self.from_center[i] - &steps[i]);
        let moved: [RBig; N] = std::array::from_fn(|i| abs(&self.from_center[i]) + abs(&steps[i]));
        let gap = Surd::root(RBig::ONE, dot(&approach, &approach)).plus(&-&self.radius);
        margin::in_ulps(gap.size(), float(&dot(&moved, &moved)).sqrt() + float(&self.radius))
    }

    /// Returns the same margin where it decides the verdict, else infinity: a line from inside or
    /// from the surface always meets the surface.
    pub(super) fn meeting_margin(&self) -> f64 {
        if sign(&self.c).is_gt() { self.approach_margin() } else { f64::INFINITY }
    }

    /// Returns the margin of the signs of the roots. The sign of `c` tells whether the origin is
    /// inside. On the surface, where one root is 0, the sign of `h` tells whether the ray goes in.
    pub(super) fn side_margin(&self) -> f64 {
        let squares = products(&self.from_center, &self.from_center);
        let square_radius = &self.radius * &self.radius;
        let terms: Vec<RBig> = squares.into_iter().chain([square_radius]).collect();
        let going_in = margin::of(&self.h, &dot_of_sizes(&self.from_center, &self.direction));
        match (self.c.is_zero(), margin::computed_exactly(&terms)) {
            (true, true) => going_in,
            (true, false) => 0.0,
            (false, _) => margin::of(&self.c, &(RBig::from(2) * sum(&terms))),
        }
    }

    /// Returns the relative condition number of a root. By the derivative of `|f + t d|^2 = r^2` it
    /// is `(sum |f_i p_i| + |t| sum |d_i p_i| + r^2) / (|p.d| |t|)` at the point `p`, where `|p.d|`
    /// is the root of the discriminant. It is infinite for a tangent and for a root of 0.
    pub(super) fn condition(&self, t: &Surd) -> f64 {
        let t_size = t.size();
        let mut sum = float(&self.radius) * float(&self.radius);
        for (f, d) in self.from_center.iter().zip(&self.direction) {
            sum += (float(f).abs() + float(d).abs() * t_size) * t.times(d).plus(f).size();
        }
        sum / (float(&self.discriminant).sqrt() * t_size)
    }

    /// Returns the outward normal at a root, one component per axis.
    pub(super) fn normal(&self, t: &Surd) -> [Surd; N] {
        let inverse = RBig::ONE / &self.radius;
        std::array::from_fn(|i| {
            t.times(&self.direction[i]).plus(&self.from_center[i]).times(&inverse)
        })
    }
}

/// Returns whether a root is on the ray, neither behind its origin nor at it.
pub(super) fn is_ahead(t: &Surd) -> bool {
    t.sign() == Ordering::Greater
}
