//! What is to be solved: the mesh, the case file, and the two joined by the names of the groups.

pub mod mesh;
