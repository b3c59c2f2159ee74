//! Gmsh's element types: how many nodes follow an element's tag (Gmsh reference manual, "Element types").

/// A type of element.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ElementType {
    /// Gmsh's number of the type
    pub number: i64,
    /// 0 point, 1 line, 2 face, 3 solid
    pub dimension: usize,
    pub nodes: usize,
    /// `triangle`, `hexahedron`, ...
    pub family: &'static str,
}

/// Gmsh's type `number`; none for types without a fixed number of nodes and for numbers that are no type.
pub fn element_type(number: i64) -> Option<ElementType> {
    FAMILIES.iter().find_map(|&(family, dimension, types)| {
        let &(_, nodes) = types.iter().find(|&&(n, _)| i64::from(n) == number)?;
        Some(ElementType { number, dimension, nodes: usize::from(nodes), family })
    })
}

/// A family's (type number, nodes of it), the full ones in order, then those without nodes inside.
type Types = &'static [(u8, u16)];

#[rustfmt::skip]
const FAMILIES: [(&str, usize, Types); 8] = [
    ("point", 0, &[(15, 1)]),
    ("line", 1, &[(1, 2), (8, 3), (26, 4), (27, 5), (28, 6), (62, 7), (63, 8), (64, 9), (65, 10), (66, 11), (84, 1)]),
    ("triangle", 2, &[
        (2, 3), (9, 6), (21, 10), (23, 15), (25, 21), (42, 28), (43, 36), (44, 45), (45, 55), (46, 66),
        (20, 9), (22, 12), (24, 15), (52, 18), (53, 21), (54, 24), (55, 27), (56, 30), (85, 1),
    ]),
    ("quadrangle", 2, &[
        (3, 4), (10, 9), (36, 16), (37, 25), (38, 36), (47, 49), (48, 64), (49, 81), (50, 100), (51, 121),
        (16, 8), (39, 12), (40, 16), (41, 20), (57, 24), (58, 28), (59, 32), (60, 36), (61, 40), (86, 1),
    ]),
    ("tetrahedron", 3, &[
        (4, 4), (11, 10), (29, 20), (30, 35), (31, 56), (71, 84), (72, 120), (73, 165), (74, 220), (75, 286),
        (137, 16), (32, 22), (33, 28), (79, 34), (80, 40), (81, 46), (82, 52), (83, 58), (87, 1),
    ]),
    ("hexahedron", 3, &[
        (5, 8), (12, 27), (92, 64), (93, 125), (94, 216), (95, 343), (96, 512), (97, 729), (98, 1000),
        (17, 20), (99, 32), (100, 44), (101, 56), (102, 68), (103, 80), (104, 92), (105, 104), (88, 1),
    ]),
    ("prism", 3, &[
        (6, 6), (13, 18), (90, 40), (91, 75), (106, 126), (107, 196), (108, 288), (109, 405), (110, 550),
        (18, 15), (111, 24), (112, 33), (113, 42), (114, 51), (115, 60), (116, 69), (117, 78), (89, 1),
    ]),
    ("pyramid", 3, &[
        (7, 5), (14, 14), (118, 30), (119, 55), (120, 91), (121, 140), (122, 204), (123, 285), (124, 385),
        (19, 13), (125, 21), (126, 29), (127, 37), (128, 45), (129, 53), (130, 61), (131, 69), (132, 1),
    ]),
];
