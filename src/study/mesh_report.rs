//! What `check` says of a mesh by itself: its groups, the shapes of its elements, what is doubtful about it.

use crate::escape;
use crate::model::mesh::{Group, Mesh};
use crate::model::quality;
use crate::number::{fixed, place};
use std::collections::BTreeMap;

/// Below this an element's stiffness suffers.
const SMALLEST_GOOD_ANGLE: f64 = 10.;

pub fn counts(mesh: &Mesh) -> String {
    let mut by_shape = BTreeMap::new();
    for cell in mesh.cells.iter().filter(|c| c.shape.dimension() == 2) {
        *by_shape.entry(cell.shape).or_insert(0) += 1;
    }
    let shapes: Vec<String> = by_shape.iter().map(|(shape, n)| format!("{n} {shape:?}")).collect();
    format!("{}: {} nodes; {}; {} turned anticlockwise\n", mesh.name, mesh.points.len(), shapes.join(", "), mesh.turned)
}

pub fn groups(mesh: &Mesh, taken_for: impl Fn(&Group) -> String) -> String {
    let row = |group: &Group| {
        let size = match group.dimension {
            0 => mesh.nodes_of(group).first().map_or(String::new(), |&n| format!("point at {}", place(mesh.points[n]))),
            1 => format!("{:6} lines, {:>10} m", group.cells.len(), fixed(4, mesh.measure_of(group))),
            _ => format!("{:6} elements, {:>10} m2", group.cells.len(), fixed(4, mesh.measure_of(group))),
        };
        format!("  {:<18} {size:<30} {}", escape::name(&group.name), taken_for(group)).trim_end().to_string() + "\n"
    };
    mesh.groups.iter().rev().map(row).fold("groups\n".to_string(), |text, row| text + &row)
}

/// The worst angle and the sides, each with its place.
pub fn shapes(mesh: &Mesh) -> String {
    let faces: Vec<usize> = (0..mesh.cells.len()).filter(|&c| mesh.cells[c].shape.dimension() == 2).collect();
    let extreme = |value: &dyn Fn(usize) -> f64| {
        let worst = faces.iter().copied().min_by(|&a, &b| value(a).total_cmp(&value(b)));
        worst.map(|cell| (value(cell), mesh.place(cell)))
    };
    let rows = [
        ("smallest angle", "degrees", 1., extreme(&|c| quality::angles(mesh, &mesh.cells[c])[0])),
        ("largest angle", "degrees", -1., extreme(&|c| -quality::angles(mesh, &mesh.cells[c])[1])),
        ("shortest side", "m", 1., extreme(&|c| quality::sides(mesh, &mesh.cells[c])[0])),
        ("longest side", "m", -1., extreme(&|c| -quality::sides(mesh, &mesh.cells[c])[1])),
    ];
    let row = |(what, unit, sign, found): &(&str, &str, f64, Option<(f64, String)>)| {
        found.as_ref().map_or(String::new(), |(value, place)| {
            format!("  {what:<15} {:>9} {unit} at {place}\n", fixed(4, sign * value))
        })
    };
    rows.iter().map(row).fold("elements\n".to_string(), |text, row| text + &row)
}

/// Bad shapes, empty groups, elements that stood twice.
pub fn warnings(mesh: &Mesh) -> Vec<String> {
    let mut warnings = mesh.remarks.clone();
    let faces = (0..mesh.cells.len()).filter(|&c| mesh.cells[c].shape.dimension() == 2);
    let angles = faces.map(|c| (quality::angles(mesh, &mesh.cells[c])[0], c));
    let bad: Vec<(f64, usize)> = angles.filter(|(angle, _)| *angle < SMALLEST_GOOD_ANGLE).collect();
    if let Some((angle, cell)) = bad.iter().min_by(|a, b| a.0.total_cmp(&b.0)) {
        let angle = if *angle < 0.1 { format!("{angle:.1e}") } else { format!("{angle:.1}") };
        warnings.push(format!(
            "the smallest angle, {angle} degrees at {}, is below {SMALLEST_GOOD_ANGLE}, as in {} of the elements: stresses \
             there are poor",
            mesh.place(*cell),
            bad.len()
        ));
    }
    let empty: Vec<_> = mesh.groups.iter().filter(|g| g.cells.is_empty()).map(|g| escape::name(&g.name)).collect();
    if !empty.is_empty() {
        warnings.push(format!("groups of {} without any element: {}", mesh.name, empty.join(", ")));
    }
    if mesh.dropped > 0 {
        let count =
            if mesh.dropped == 1 { "1 element stands".into() } else { format!("{} elements stand", mesh.dropped) };
        warnings.push(format!("{count} more than once in {}, and is used once", mesh.name));
    }
    warnings
}

/// Faces that no material can be given to.
pub fn without_group(mesh: &Mesh) -> Option<String> {
    let loose = |&c: &usize| mesh.cells[c].shape.dimension() == 2 && mesh.groups_of(c).next().is_none();
    let faces: Vec<usize> = (0..mesh.cells.len()).filter(loose).collect();
    faces.first().map(|&first| {
        format!(
            "{} surface elements belong to no physical group, one at {}: a case can give them no material",
            faces.len(),
            mesh.place(first)
        )
    })
}
