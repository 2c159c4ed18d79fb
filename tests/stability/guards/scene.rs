//! Guards of scenes: what is refused by name, what is kept, and in which order and frame it is compiled.

use crate::guard::{Edit, Guard};

pub static VALIDATED: Guard = Guard {
    name: "scenes are looked through",
    does: "every mesh and every instance is looked through before anything is traced; what is wrong is named and left \
           out",
    edits: &[
        Edit {
            file: "src/scene/validate.rs",
            text: "let mut kinds = Vec::new();\n        let vertex_count",
            instead: "let mut kinds = Vec::new();\n        if true { return kinds; }\n        let vertex_count",
        },
        Edit {
            file: "src/scene/validate.rs",
            text: "if !is_invertible(&instance.world_from_local) {",
            instead: "if false {",
        },
        Edit { file: "src/scene/validate.rs", text: "kinds.extend(mesh.uv1_fault());", instead: "" },
        Edit {
            file: "src/scene/validate.rs",
            text: "kinds.extend(too_far(mesh, &instance.world_from_local));",
            instead: "",
        },
    ],
};

pub static RELATIVE_DETERMINANT: Guard = Guard {
    name: "flatness has no unit",
    does: "a transform is singular if its determinant is below 1e-9 of the product of its axes' lengths, in f64; taken \
           out, if it is below 1e-9",
    edits: &[Edit {
        file: "src/scene/validate.rs",
        text: "determinant.abs() > 1e-9 * bound",
        instead: "determinant.abs() > 1e-9",
    }],
};

pub static DIRECTIONS: Guard = Guard {
    name: "directions have a length",
    does: "a triangle without area is dropped when the scene is compiled; a shading normal that is zero, no number or \
           against the face gives way to the face's own",
    edits: &[
        Edit {
            file: "src/trace/surface.rs",
            text: "(c - a).try_normalize()?.as_vec3();",
            instead: "(c - a).normalize().as_vec3();",
        },
        Edit { file: "src/trace/surface.rs", text: "normal.is_finite().then", instead: "true.then" },
        Edit {
            file: "src/trace/path/start.rs",
            text: "smooth.try_normalize().filter(|smooth| smooth.dot(shape.normal) > 0.0);",
            instead: "Some(smooth.normalize());",
        },
    ],
};

pub static FRAMES: Guard = Guard {
    name: "fronts and normals of a transform",
    does: "a mirrored triangle is wound the other way, so that a front stays a front; normals go by the matrix of \
           cofactors, which needs no inverse and overflows for no scale",
    edits: &[
        Edit {
            file: "src/trace/surface.rs",
            text: "let vertices = if self.is_mirrored() { [a, c, b] } else { [a, b, c] };",
            instead: "let vertices = [a, b, c];",
        },
        Edit {
            file: "src/trace/surface.rs",
            text: "(sign * (cofactors * local.as_dvec3()))",
            instead: "(sign * sign * 0.0 * (cofactors * local.as_dvec3()) + self.matrix * local.as_dvec3())",
        },
    ],
};

pub static SORTED: Guard = Guard {
    name: "one order of things",
    does: "instances and lights are compiled in the order of their ids, whatever the order in which the scene lists \
           them",
    edits: &[
        Edit {
            file: "src/trace/compile.rs",
            text: "instances.sort_by(|&a, &b| scene.instances[a].id.cmp(&scene.instances[b].id));",
            instead: "instances.rotate_left(0);",
        },
        Edit {
            file: "src/trace/compile.rs",
            text: "lights.sort_by(|a, b| a.id().cmp(b.id()));",
            instead: "lights.rotate_left(0);",
        },
    ],
};

pub static TEXELS_IN_WORLD: Guard = Guard {
    name: "texels counted in the world",
    does: "an object's texels follow the stretch of its UV1 over its triangles as they lie in the world, under all its \
           transforms",
    edits: &[Edit {
        file: "src/bake/atlas.rs",
        text: "let [a, b, c] = self.tracer.vertices(world).map(|vertex| vertex.as_dvec3());",
        instead: "let mesh = &self.scene.meshes[self.scene.instances[self.receiver.instance].mesh]; \
                  let [a, b, c] = vertices.map(|vertex| mesh.positions[vertex as usize].as_dvec3());",
    }],
};
