//! Decodes bytes into a ray and a primitive.
//!
//! A number is any `f32`, a special value, a small fraction with few bits, or an ordinary one. A
//! ray goes anywhere, or to a point on or beside the primitive.

use libfuzzer_sys::arbitrary::{Result, Unstructured};
use rayweave_accuracy::{Primitive, Ray, guarantees};

/// A source of numbers; an exhausted one gives zeros.
pub type Bytes<'a, 'b> = &'a mut Unstructured<'b>;

/// Decodes a primitive and a point to aim at, and fails where the kernel violates a guarantee.
///
/// # Panics
///
/// On a violation, with the case as `rayweave intersect` reads it.
pub fn check(primitive: impl FnOnce(Bytes<'_, '_>) -> Result<(Primitive, [f32; 3])>, bytes: &[u8]) {
    let mut bytes = Unstructured::new(bytes);
    let decoded = primitive(&mut bytes);
    if let Ok((primitive, aim)) = decoded
        && let Ok(ray) = ray(&mut bytes, aim)
        && let Err(violation) = guarantees::check(&primitive, &ray)
    {
        panic!("{violation}");
    }
}

/// Decodes a plane, and a point that is moved from it by the normal turned a quarter or so.
pub fn plane(bytes: Bytes<'_, '_>) -> Result<(Primitive, [f32; 3])> {
    let (point, normal) = (vector(bytes)?, vector(bytes)?);
    let [x, y, z] = normal;
    Ok((Primitive::Plane { point, normal }, moved(point, [y, -x, z], share(bytes)?)))
}

/// Decodes a sphere, and a point beside its centre by some part of the radius.
pub fn sphere(bytes: Bytes<'_, '_>) -> Result<(Primitive, [f32; 3])> {
    let (center, radius) = (vector(bytes)?, number(bytes)?);
    let aside = [share(bytes)?, share(bytes)?, share(bytes)?];
    Ok((Primitive::Sphere { center, radius }, moved(center, aside, radius)))
}

/// Decodes a triangle, and a point of its plane.
pub fn triangle(bytes: Bytes<'_, '_>) -> Result<(Primitive, [f32; 3])> {
    let [a, b, c] = [vector(bytes)?, vector(bytes)?, vector(bytes)?];
    let on_edge = moved(a, difference(b, a), share(bytes)?);
    Ok((Primitive::Triangle { a, b, c }, moved(on_edge, difference(c, a), share(bytes)?)))
}

/// Decodes a cylinder, upright except one time in 16, and a point in or near it.
pub fn cylinder(bytes: Bytes<'_, '_>) -> Result<(Primitive, [f32; 3])> {
    let (bottom, radius) = (vector(bytes)?, number(bytes)?);
    let mut top = bottom;
    top[1] = if bytes.arbitrary()? { number(bytes)? } else { bottom[1] + number(bytes)?.abs() };
    if bytes.ratio(1, 16)? {
        top[0] = number(bytes)?;
    }
    let aside = moved(bottom, [share(bytes)?, 0.0, share(bytes)?], radius);
    let aim = moved(aside, difference(top, bottom), share(bytes)?);
    Ok((Primitive::Cylinder { bottom, top, radius }, aim))
}

fn ray(bytes: Bytes<'_, '_>, aim: [f32; 3]) -> Result<Ray> {
    let mut origin = vector(bytes)?;
    if bytes.arbitrary()? {
        // Near the primitive, however far that is.
        origin = moved(aim, origin, 1.0);
    }
    let direction = if bytes.arbitrary()? { difference(aim, origin) } else { vector(bytes)? };
    Ok(Ray { origin, direction })
}

fn vector(bytes: Bytes<'_, '_>) -> Result<[f32; 3]> {
    Ok([number(bytes)?, number(bytes)?, number(bytes)?])
}

fn number(bytes: Bytes<'_, '_>) -> Result<f32> {
    Ok(match bytes.int_in_range(0..=63)? {
        0 => f32::from_bits(bytes.arbitrary()?),
        1 => *bytes.choose(&SPECIAL)?,
        2..24 => fraction(bytes)?,
        _ => {
            // Near 2^-12 to 2^12, all bits of the fraction, either sign.
            let (bits, exponent): (u32, u32) = (bytes.arbitrary()?, bytes.int_in_range(115..=139)?);
            f32::from_bits((bits & 0x807f_ffff) | (exponent << 23))
        }
    })
}

/// A multiple of 1/16 in -8..8.
fn fraction(bytes: Bytes<'_, '_>) -> Result<f32> {
    Ok(f32::from(bytes.arbitrary::<i8>()?) / 16.0)
}

/// A share of the way from one end to the other: anywhere, at an end, or just beside one.
fn share(bytes: Bytes<'_, '_>) -> Result<f32> {
    if bytes.arbitrary()? {
        return fraction(bytes);
    }
    let end = f32::from(bytes.int_in_range(0..=1_u8)?);
    let beside = 2f32.powi(-bytes.int_in_range(4..=24)?);
    Ok(if bytes.arbitrary()? { end + beside } else { end - beside })
}

/// Zeros, ones and their neighbours, powers of two at limits, subnormals, infinities and NaN.
const SPECIAL: [f32; 16] = [
    0.0,
    -0.0,
    1.0,
    1.0 + f32::EPSILON,
    1.0 - f32::EPSILON / 2.0,
    16_777_216.0,
    f32::MAX,
    f32::MIN,
    1.844_674_4e19,
    1.084_202_2e-19,
    f32::MIN_POSITIVE,
    1e-45,
    -1e-40,
    f32::INFINITY,
    f32::NEG_INFINITY,
    f32::NAN,
];

fn moved(point: [f32; 3], way: [f32; 3], times: f32) -> [f32; 3] {
    std::array::from_fn(|i| point[i] + way[i] * times)
}

fn difference(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}
