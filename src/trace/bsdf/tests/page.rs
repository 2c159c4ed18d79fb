//! `docs/albedo.md`.
