//! The exact irradiance from a polygon of uniform radiance: the truth that estimates are held against. In `f64`, and
//! not for inner loops: it allocates.
//!
//! Lambert 1760: E = ½ L Σ θᵢ (n · Γᵢ), θᵢ the angle that edge i subtends and Γᵢ the unit normal of its plane through
//! the receiver (Arvo 1995, "Analytic Methods for Simulated Light Transport", equations 3.1 to 3.3), after what lies
//! below the horizon is cut off (Sutherland and Hodgman 1974).

use glam::DVec3;

/// The irradiance [lx] at the origin, on a surface of unit `normal`, from the planar convex polygon `corners` (in
/// order, relative to the receiver [m]) of radiance 1 cd/m², seen from either side and unoccluded. The receiver lies
/// on no edge.
pub fn polygon_irradiance(corners: &[DVec3], normal: DVec3) -> f64 {
    let above = clip(corners, normal);
    let edges = above.iter().zip(above.iter().cycle().skip(1));
    0.5 * edges.map(|(&a, &b)| edge_term(a, b, normal)).sum::<f64>().abs()
}

/// θ (n · Γ) of one edge; 0 of an edge that points at the receiver.
fn edge_term(a: DVec3, b: DVec3, normal: DVec3) -> f64 {
    let cross = a.cross(b);
    let length = cross.length();
    if length == 0.0 { 0.0 } else { length.atan2(a.dot(b)) * normal.dot(cross) / length }
}

/// The part of the polygon above the plane through the origin at right angles to `normal`.
fn clip(corners: &[DVec3], normal: DVec3) -> Vec<DVec3> {
    let mut above = Vec::with_capacity(corners.len() + 1);
    for (&a, &b) in corners.iter().zip(corners.iter().cycle().skip(1)) {
        let (height_a, height_b) = (a.dot(normal), b.dot(normal));
        if height_a >= 0.0 {
            above.push(a);
        }
        if (height_a > 0.0 && height_b < 0.0) || (height_a < 0.0 && height_b > 0.0) {
            above.push(a.lerp(b, height_a / (height_a - height_b)));
        }
    }
    above
}
