//! Fresnel's law, written a second time as the judge of the first.

/// Unpolarised reflectance of a smooth interface (Born and Wolf 1999, § 1.5.2), 1 beyond the critical angle.
pub fn fresnel(cosine: f64, eta: f64) -> f64 {
    let sine_squared = (1.0 - cosine * cosine) / (eta * eta);
    if sine_squared >= 1.0 {
        return 1.0;
    }
    let refracted = (1.0 - sine_squared).sqrt();
    let parallel = (eta * cosine - refracted) / (eta * cosine + refracted);
    let perpendicular = (cosine - eta * refracted) / (cosine + eta * refracted);
    0.5 * (parallel * parallel + perpendicular * perpendicular)
}
