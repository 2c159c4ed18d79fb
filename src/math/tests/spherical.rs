//! Spherical rectangles and triangles from easy and hard points of view.
