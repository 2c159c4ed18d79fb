//! What an unwrap takes, from a thousand to a million triangles.
fn main() {}
