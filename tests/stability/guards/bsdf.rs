//! Guards of lobes: limits of roughness, of indices, of angles.

use crate::guard::{Edit, Guard};

pub static INDEX_TURNED: Guard = Guard {
    name: "index turned by side",
    does: "the quotient of the indices is turned around on a surface's back, so that L/n² is what stays the same \
           (Nicodemus 1963)",
    edits: &[Edit {
        file: "src/trace/shade.rs",
        text: "if side < 0.0 { ior.recip() } else { ior };",
        instead: "if side < -2.0 { ior.recip() } else { ior };",
    }],
};

pub static RADIANCE_BY_INDEX: Guard = Guard {
    name: "radiance by the index squared",
    does: "what crosses an interface is divided by the quotient of the indices squared (Veach 1997, § 5.2)",
    edits: &[Edit {
        file: "src/trace/bsdf/refraction.rs",
        text: "self.tint * (crosses / (self.eta * self.eta));",
        instead: "self.tint * crosses;",
    }],
};

pub static TOTAL_REFLECTION: Guard = Guard {
    name: "total reflection",
    does: "where Snell's law has no solution, all is reflected, before a root is taken of what is negative",
    edits: &[
        Edit {
            file: "src/trace/bsdf/fresnel.rs",
            text: "    if sin2 >= 1.0 {\n",
            instead: "    if sin2 >= f32::INFINITY {\n",
        },
        Edit {
            file: "src/trace/bsdf/fresnel.rs",
            text: "Refracted { reflectance: reflectance.min(1.0), cos: cos_far }",
            instead: "Refracted { reflectance, cos: cos_far }",
        },
    ],
};

pub static MATCHED: Guard = Guard {
    name: "matched indices",
    does: "indices that differ by less than 1e-3 are no interface: the half vector of refraction is then a difference \
           of equal vectors",
    edits: &[Edit {
        file: "src/trace/bsdf/dielectric.rs",
        text: "(eta - 1.0).abs() < MATCHED_BELOW;",
        instead: "(eta - 1.0).abs() < 0.0;",
    }],
};

pub static SMOOTH_LIMIT: Guard = Guard {
    name: "smooth below α = 1e-3",
    does: "a surface of α < 1e-3, the square of the roughness, reflects in single directions: its lobe would have a \
           density of 1/(π α²), infinite at 0",
    edits: &[Edit {
        file: "src/trace/bsdf/ggx.rs",
        text: "(alpha >= SMOOTH_BELOW).then_some(Self { alpha })",
        instead: "(alpha >= 0.0).then_some(Self { alpha })",
    }],
};

pub static MORE_THAN_ONE_FACET: Guard = Guard {
    name: "light of more than one facet",
    does: "what one facet sends to another is given back as a diffuse lobe, the same both ways (Kulla and Conty 2017)",
    edits: &[
        Edit {
            file: "src/trace/bsdf/specular.rs",
            text: "value: self.fresnel.at(wo.dot(m)) * lobe + self.tint * more,",
            instead: "value: self.fresnel.at(wo.dot(m)) * lobe + self.tint * (0.0 * more),",
        },
        Edit {
            file: "src/trace/bsdf/dielectric.rs",
            text: "value: once.value + rough.again.evaluate(missing, wi),",
            instead: "value: once.value + 0.0 * rough.again.evaluate(missing, wi),",
        },
    ],
};

pub static WHAT_THE_COAT_LEAVES: Guard = Guard {
    name: "what the coat leaves",
    does: "what lies under a coat gets what that does not reflect, the same both ways (Kelemen and Szirmay-Kalos 2001)",
    edits: &[
        Edit {
            file: "src/trace/bsdf/standard.rs",
            text: "let diffuse = base * left(&view.specular) * left(&seen_i) / self.average_left;",
            instead: "let diffuse = if left(&view.specular) == left(&seen_i) { base } else { base };",
        },
        Edit {
            file: "src/trace/bsdf/standard.rs",
            text: "        value *= Clearcoat::leaves(view.coat, coat_i);\n",
            instead: "        let _ = Clearcoat::leaves(view.coat, coat_i);\n",
        },
    ],
};

pub static PHONG: Guard = Guard {
    name: "Phong's lobe by distance",
    does: "the cosine to the mirror direction is 1 less half the square of the distance of two unit vectors, which \
           keeps the digits that an exponent of 1e6 needs; directions below the surface are no samples",
    edits: &[
        Edit {
            file: "src/trace/bsdf/phong.rs",
            text: "let lack = 0.5 * (mirror(wo) - wi).length_squared();",
            instead: "let lack = 1.0 - mirror(wo).dot(wi);",
        },
        Edit {
            file: "src/trace/bsdf/phong.rs",
            text: "(wi.z > 0.0 && pdf > 0.0).then_some(sample)",
            instead: "Some(sample)",
        },
    ],
};

pub static FLAT_WHERE_UNSEEN: Guard = Guard {
    name: "the flat normal where the other looks away",
    does: "a shading normal that is zero, or that looks away from the viewer or from the surface's own side, gives way \
           to the flat one",
    edits: &[
        Edit {
            file: "src/trace/shade.rs",
            text: "if normal.dot(wo) > 0.0 && normal.dot(geometric) > 0.0 { Frame::new(normal) } else { Frame::new(geometric) }",
            instead: "if wo.x < 9.0 { Frame::new(normal) } else { Frame::new(geometric) }",
        },
        Edit {
            file: "src/trace/shade.rs",
            text: "mapped.try_normalize().map_or(normal, |mapped| mapped * side)",
            instead: "mapped.normalize() * side",
        },
    ],
};
