//! Meshes whose interfaces meet.

use super::Drawing;
use coralpipe::model::mesh::Shape;

/// Squares along x and y.
const ACROSS: [usize; 2] = [12, 8];

/// A rectangle of 6 m x 4 m in squares of 0.5 m. The bedding plane "bed" at y = 2 m separates "layer_2" above from
/// "layer_1" below and ends in both sides of the square "pipe_left", whose outline is "interface_left".
pub fn box_on_a_bed() -> Drawing {
    let mut drawing = Drawing::default();
    let [nx, ny] = ACROSS;
    let node = |i: usize, j: usize| j * (nx + 1) + i;
    for j in 0..=ny {
        for i in 0..=nx {
            drawing.node([i as f64 / 2., j as f64 / 2.]);
        }
    }
    // the box: squares 5 and 6 along x, 3 and 4 along y
    let in_box = |i: usize, j: usize| (5..7).contains(&i) && (3..5).contains(&j);
    for j in 0..ny {
        for i in 0..nx {
            let group = if in_box(i, j) {
                "pipe_left"
            } else if j < 4 {
                "layer_1"
            } else {
                "layer_2"
            };
            let nodes = [node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)];
            drawing.cell(group, Shape::Quad4, &nodes);
        }
    }
    for i in 0..nx {
        drawing.cell("base", Shape::Line2, &[node(i, 0), node(i + 1, 0)]);
        drawing.cell("surface", Shape::Line2, &[node(i, ny), node(i + 1, ny)]);
        if !in_box(i, 4) {
            drawing.cell("bed", Shape::Line2, &[node(i, 4), node(i + 1, 4)]);
        }
    }
    for j in 0..ny {
        drawing.cell("side_left", Shape::Line2, &[node(0, j), node(0, j + 1)]);
        drawing.cell("side_right", Shape::Line2, &[node(nx, j), node(nx, j + 1)]);
    }
    for k in 0..2 {
        for (a, b) in
            [((5 + k, 3), (6 + k, 3)), ((5 + k, 5), (6 + k, 5)), ((5, 3 + k), (5, 4 + k)), ((7, 3 + k), (7, 4 + k))]
        {
            drawing.cell("interface_left", Shape::Line2, &[node(a.0, a.1), node(b.0, b.1)]);
        }
    }
    drawing
}

/// The rectangle in four blocks: "level" at y = 2 m separates "layer_2" above from "layer_1" below, "upright" at
/// x = 3 m the surfaces "left" from those on its right.
pub fn four_blocks() -> Drawing {
    let mut drawing = Drawing::default();
    let [nx, ny] = ACROSS;
    let node = |i: usize, j: usize| j * (nx + 1) + i;
    (0..=ny).for_each(|j| (0..=nx).for_each(|i| _ = drawing.node([i as f64 / 2., j as f64 / 2.])));
    for j in 0..ny {
        for i in 0..nx {
            let nodes = [node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)];
            drawing.cell(if j < 4 { "layer_1" } else { "layer_2" }, Shape::Quad4, &nodes);
            if i < 6 {
                drawing.cell("left", Shape::Quad4, &nodes);
            }
        }
        drawing.cell("upright", Shape::Line2, &[node(6, j), node(6, j + 1)]);
        drawing.cell("side_left", Shape::Line2, &[node(0, j), node(0, j + 1)]);
        drawing.cell("side_right", Shape::Line2, &[node(nx, j), node(nx, j + 1)]);
    }
    for i in 0..nx {
        drawing.cell("base", Shape::Line2, &[node(i, 0), node(i + 1, 0)]);
        drawing.cell("level", Shape::Line2, &[node(i, 4), node(i + 1, 4)]);
        drawing.cell("surface", Shape::Line2, &[node(i, ny), node(i + 1, ny)]);
    }
    drawing
}
