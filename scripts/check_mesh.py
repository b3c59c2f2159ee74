#!/usr/bin/env python3
"""Checks a mesh of geo/twin_pipes.geo with a reader that is not coralpipe's: meshio.

    scripts/check_mesh.py meshes/twin_pipes.msh [--case geo/twin_pipes.json]

Groups exist and are not empty, layers and pipes have their exact areas, pipe walls are quadrilaterals, interfaces
are closed curves, and each interface edge has one pipe and one ground element beside it: what matching pairs are
made from. The parameters are read from the record beside the mesh (NAME.json). Exit 1 with a sentence on failure.
"""

import argparse
import collections
import json
import math
import pathlib
import sys

import meshio
import numpy as np

FACES = {"triangle": 3, "triangle6": 3, "quad": 4, "quad8": 4}
LINES = {"line": 2, "line3": 2}


class Failure(Exception):
    """A sentence for the user."""


def require(condition, sentence):
    if not condition:
        raise Failure(sentence)


def groups_of(mesh):
    """{name: [(cell type, connectivity)]} of the physical groups."""
    groups = {}
    for name, blocks in mesh.cell_sets.items():
        if name.startswith("gmsh:"):
            continue
        groups[name] = [
            (block.type, block.data[np.asarray(chosen, dtype=int)])
            for block, chosen in zip(mesh.cells, blocks)
            if chosen is not None and len(chosen) > 0
        ]
    return groups


def pipe_names(count):
    """Left to right, as the script's header says."""
    middle = [str(k) for k in range(2, count)]
    return ["left"] + middle + (["right"] if count > 1 else [])


def corners(points, kind, cells):
    """Corner coordinates, one row of (x, y) pairs an element."""
    return points[cells[:, : FACES[kind]], :2]


def area_of(points, blocks):
    """Area of straight-sided elements [m^2], signed by the direction of their corners."""
    total = 0.0
    for kind, cells in blocks:
        x, y = np.moveaxis(corners(points, kind, cells), 2, 0)
        total += 0.5 * np.sum(x * np.roll(y, -1, axis=1) - np.roll(x, -1, axis=1) * y)
    return total


def edges_of(blocks, sizes):
    """Corner-node edges of faces (closed) or lines (open), as a list of node sets."""
    edges = []
    for kind, cells in blocks:
        n = sizes[kind]
        for nodes in cells[:, :n]:
            steps = range(n) if n > 2 else range(1)
            edges += [frozenset((int(nodes[k]), int(nodes[(k + 1) % n]))) for k in steps]
    return edges


def half_disc_below(depth, axis_depth, radius):
    """Area of a disc's part above `depth` (depths downward) [m^2]."""
    h = min(max((depth - axis_depth) / radius, -1.0), 1.0)
    return radius**2 * (math.pi / 2 + math.asin(h) + h * math.sqrt(1 - h * h))


def polygon_area(points, blocks):
    """Area inside a closed chain of edges [m^2]: what the facets of a round face enclose."""
    neighbours = collections.defaultdict(list)
    for edge in edges_of(blocks, LINES):
        a, b = tuple(edge)
        neighbours[a].append(b)
        neighbours[b].append(a)
    start = next(iter(neighbours))
    chain, previous = [start], None
    while True:
        here = chain[-1]
        following = [n for n in neighbours[here] if n != previous][0]
        if following == start:
            break
        previous = here
        chain.append(following)
    require(len(chain) == len(neighbours), "an interface falls into several closed curves")
    x, y = points[chain, 0], points[chain, 1]
    return abs(0.5 * np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


def check_names(groups, names):
    expected = ["layer_1", "layer_2", "layer_3", "surface", "base", "side_left", "side_right", *"ACHKLI"]
    expected += [f"{part}_{name}" for name in names for part in ("pipe", "interface")]
    for name in expected:
        require(name in groups, f'there is no physical group "{name}"; there are: {", ".join(sorted(groups))}')
        require(groups[name], f'the physical group "{name}" is empty')


def check_areas(points, groups, names, par):
    """Exact areas, less what the facets of the round faces cut off."""
    radius, bore = par["outer"] / 2, par["inner"] / 2
    axis = par["crown"] + radius
    levels = [0.0, par["layer_1_depth"], par["layer_2_depth"], par["height"]]
    facets = {}
    for name in names:
        facets[name] = math.pi * radius**2 - polygon_area(points, groups[f"interface_{name}"])
        require(
            0 <= facets[name] < 0.05 * math.pi * radius**2,
            f"interface_{name} does not enclose the disc of a pipe",
        )
        exact = math.pi * (radius**2 - bore**2)
        found = area_of(points, groups[f"pipe_{name}"])
        slack = facets[name] + exact * 1e-9
        require(
            abs(abs(found) - exact) <= slack,
            f"pipe_{name} has {abs(found):.6f} m^2, but its wall is {exact:.6f} m^2",
        )
    for k in (1, 2, 3):
        top, bottom = levels[k - 1], levels[k]
        disc = half_disc_below(bottom, axis, radius) - half_disc_below(top, axis, radius)
        exact = par["width"] * (bottom - top) - len(names) * disc
        found = abs(area_of(points, groups[f"layer_{k}"]))
        slack = sum(facets.values()) + 1e-9 * exact
        require(abs(found - exact) <= slack, f"layer_{k} has {found:.6f} m^2, but should have {exact:.6f} m^2")


def check_interface(groups, name):
    """Closed, and every edge between exactly one element of the pipe and one of the ground."""
    edges = edges_of(groups[f"interface_{name}"], LINES)
    degree = collections.Counter(node for edge in edges for node in edge)
    require(set(degree.values()) == {2}, f"interface_{name} is not a closed curve")
    pipe = collections.Counter(edges_of(groups[f"pipe_{name}"], FACES))
    ground = collections.Counter()
    for k in (1, 2, 3):
        ground.update(edges_of(groups[f"layer_{k}"], FACES))
    for edge in edges:
        require(
            pipe[edge] == 1 and ground[edge] == 1,
            f"the edge between nodes {sorted(edge)} of interface_{name} has {pipe[edge]} pipe and {ground[edge]} ground "
            "elements beside it; a pair needs one of each",
        )
    return len(edges)


def check_walls(groups, names):
    for name in names:
        kinds = {kind for kind, _ in groups[f"pipe_{name}"]}
        require(kinds <= {"quad", "quad8"}, f"pipe_{name} has elements that are not quadrilaterals: {', '.join(sorted(kinds))}")


def check_places(points, groups, par):
    """The named points lie where the script's header says."""
    radius = par["outer"] / 2
    row, axis = (par["pipes"] - 1) * par["spacing"] / 2, -(par["crown"] + radius)
    places = {
        "A": (-row, axis + radius), "C": (-row, axis - radius), "H": (-row - radius, axis),
        "K": (-row + radius, axis), "L": (row - radius, axis), "I": (row + radius, axis),
    }  # fmt: skip
    for name, place in places.items():
        nodes = np.concatenate([cells.ravel() for _, cells in groups[name]])
        require(len(nodes) == 1, f'the point "{name}" has {len(nodes)} nodes')
        distance = np.linalg.norm(points[nodes[0], :2] - place)
        require(distance < 1e-6, f'the point "{name}" lies {distance:.3g} m from its place {place}')


def check_materials(case_file, groups):
    case = json.loads(pathlib.Path(case_file).read_text())
    for section in ("materials", "interfaces", "supports", "loads"):
        entries = case.get(section, {})
        for name in entries if isinstance(entries, dict) else [n for item in entries for n in item]:
            require(name in groups, f'{case_file} names "{name}" under {section}, but the mesh has no such group')


def angles(points, kind, cells):
    """Corner angles [degrees], one row an element."""
    xy = corners(points, kind, cells)
    before, after = np.roll(xy, 1, axis=1) - xy, np.roll(xy, -1, axis=1) - xy
    cosine = np.sum(before * after, axis=2) / np.linalg.norm(before, axis=2) / np.linalg.norm(after, axis=2)
    return np.degrees(np.arccos(np.clip(cosine, -1, 1)))


def quality(points, groups, names):
    """(least angle, greatest angle, centre of the worst element, counts by kind)."""
    least, greatest, where, counts = 180.0, 0.0, None, collections.Counter()
    for group in [f"layer_{k}" for k in (1, 2, 3)] + [f"pipe_{n}" for n in names]:
        for kind, cells in groups[group]:
            counts[kind] += len(cells)
            each = angles(points, kind, cells)
            greatest = max(greatest, each.max())
            worst = each.min(axis=1).argmin()
            if each[worst].min() < least:
                least, where = each[worst].min(), corners(points, kind, cells)[worst].mean(axis=0)
    return least, greatest, where, counts


def check(mesh_file, case_file):
    record_file = mesh_file.with_suffix(".json")
    require(mesh_file.exists(), f"there is no mesh {mesh_file}; make it with `coralpipe mesh`")
    require(record_file.exists(), f"there is no record {record_file} of the parameters of {mesh_file}; `coralpipe mesh` writes it")
    par = json.loads(record_file.read_text())["parameters"]
    mesh = meshio.read(mesh_file)
    groups, points = groups_of(mesh), mesh.points
    names = pipe_names(int(par["pipes"]))
    check_names(groups, names)
    check_places(points, groups, par)
    check_walls(groups, names)
    joints = sum(check_interface(groups, name) for name in names)
    check_areas(points, groups, names, par)
    if case_file:
        check_materials(case_file, groups)
    least, greatest, where, counts = quality(points, groups, names)
    kinds = ", ".join(f"{n} {kind}" for kind, n in sorted(counts.items()))
    print(f"{mesh_file}: {len(points)} nodes, {kinds}, {joints} interface edges.")
    print(f"{mesh_file}: angles {least:.1f} to {greatest:.1f} degrees, the sharpest at x = {where[0]:.3f} m, y = {where[1]:.3f} m.")
    print(f"{mesh_file}: groups, areas and interface pairs are right.")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("mesh", type=pathlib.Path)
    parser.add_argument("--case", help="also check that the mesh has every group this case names")
    args = parser.parse_args()
    try:
        check(args.mesh, args.case)
    except Failure as failure:
        sys.exit(f"{args.mesh}: {failure}.")


if __name__ == "__main__":
    main()
