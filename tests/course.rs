//! What the course teaches, held against closed forms, and the product against the course's own small path tracer
//! (`examples/course/teacher.rs`), which shares its rays and neither its light sampling nor its random numbers.
//!
//! docs/course.md names these tests topic by topic.

mod common;
#[allow(dead_code, reason = "the example makes pictures, the tests use its numbers")]
#[path = "../examples/course/film.rs"]
mod film;
#[allow(dead_code, reason = "the example uses the rest")]
#[path = "../examples/course/scenes.rs"]
mod scenes;
#[allow(dead_code, reason = "the example uses the rest")]
#[path = "../examples/course/stage.rs"]
mod stage;
#[allow(dead_code, reason = "the example uses the rest")]
#[path = "../examples/course/teacher.rs"]
mod teacher;

#[path = "course/lamps.rs"]
mod lamps;
#[path = "course/page.rs"]
mod page;
#[path = "course/paths.rs"]
mod paths;
#[path = "course/surfaces.rs"]
mod surfaces;
