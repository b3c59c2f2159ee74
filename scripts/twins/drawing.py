"""A mesh under construction: places, faces, lines and points, each in any number of named groups, and its MSH 4.1 text."""

import dataclasses

MSH_TYPES = {("point", 1): 15, ("line", 2): 1, ("line", 3): 8, ("face", 3): 2, ("face", 4): 3, ("face", 6): 9, ("face", 8): 16}
DIMENSIONS = {"point": 0, "line": 1, "face": 2}


@dataclasses.dataclass
class Cell:
    """Corners first, anticlockwise, then the middles of the sides."""

    kind: str
    nodes: list
    groups: frozenset


@dataclasses.dataclass
class Drawing:
    places: list
    cells: list

    def group_names(self, kind):
        return sorted({name for cell in self.cells if cell.kind == kind for name in cell.groups})


def corners(cell):
    """Its corner nodes; a second-order cell has as many middles of sides behind them, a line one."""
    count = len(cell.nodes)
    if cell.kind == "line":
        return cell.nodes[:2]
    return cell.nodes if count < 6 else cell.nodes[: count // 2]


def reversed_nodes(cell):
    """The same cell walked round the other way."""
    own = corners(cell)
    if cell.kind == "point":
        return cell.nodes
    if cell.kind == "line":
        return own[::-1] + cell.nodes[2:]
    middles = cell.nodes[len(own) :]
    # middle k lies between corners k and k + 1
    return own[:1] + own[:0:-1] + middles[::-1]


def by_corner_angles(places, nodes):
    """Least of the cross products at the corners over the squared longest side: > 0 where the face is convex."""
    least, longest = float("inf"), 0.0
    for k in range(len(nodes)):
        a, b, c = (places[nodes[(k + i) % len(nodes)]] for i in range(3))
        u, v = (b[0] - a[0], b[1] - a[1]), (c[0] - b[0], c[1] - b[1])
        least = min(least, u[0] * v[1] - u[1] * v[0])
        longest = max(longest, u[0] ** 2 + u[1] ** 2)
    return least / longest


def second_order(drawing, middle):
    """Every cell with the middles of its sides; `middle(a, b)` is the place between the nodes a and b."""
    places, middles = list(drawing.places), {}

    def node_between(a, b):
        key = (min(a, b), max(a, b))
        if key not in middles:
            middles[key] = len(places)
            places.append(middle(*key))
        return middles[key]

    cells = []
    for cell in drawing.cells:
        n = len(cell.nodes)
        sides = [(0, 1)] if cell.kind == "line" else [(k, (k + 1) % n) for k in range(n)] if cell.kind == "face" else []
        cells.append(Cell(cell.kind, cell.nodes + [node_between(cell.nodes[a], cell.nodes[b]) for a, b in sides], cell.groups))
    return Drawing(places, cells)


def msh(drawing, node_tags=None, first_group=1):
    """MSH 4.1 text; cells with the same groups form an entity. `node_tags` are 1, 2, ... unless given."""
    tags = node_tags or range(1, len(drawing.places) + 1)
    names = [(DIMENSIONS[kind], name) for kind in ("point", "line", "face") for name in drawing.group_names(kind)]
    group_tag = {name: first_group + number for number, name in enumerate(names)}
    entities, blocks = {0: {}, 1: {}, 2: {}}, {}
    for cell in drawing.cells:
        dimension = DIMENSIONS[cell.kind]
        of_dimension = entities[dimension]
        entity = of_dimension.setdefault((cell.groups, cell.nodes[0] if dimension == 0 else None), len(of_dimension) + 1)
        blocks.setdefault((dimension, entity, MSH_TYPES[cell.kind, len(cell.nodes)]), []).append(cell)
    out = ["$MeshFormat", "4.1 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(names))]
    out += [f'{dimension} {group_tag[dimension, name]} "{name}"' for dimension, name in names]
    out += ["$EndPhysicalNames", "$Entities", f"{len(entities[0])} {len(entities[1])} {len(entities[2])} 0"]
    for dimension, of_dimension in entities.items():
        for (groups, node), entity in of_dimension.items():
            physical = " ".join(str(group_tag[dimension, name]) for name in sorted(groups))
            box = "{!r} {!r} 0".format(*drawing.places[node]) if dimension == 0 else "0 0 0 0 0 0"
            out.append(f"{entity} {box} {len(groups)} {physical}" + ("" if dimension == 0 else " 0"))
    count = len(drawing.places)
    out += ["$EndEntities", "$Nodes", f"1 {count} {min(tags)} {max(tags)}", f"2 1 0 {count}"]
    out += [str(tag) for tag in tags] + [f"{x!r} {y!r} 0" for x, y in drawing.places] + ["$EndNodes"]
    out += ["$Elements", f"{len(blocks)} {len(drawing.cells)} 1 {len(drawing.cells)}"]
    number = 0
    for (dimension, entity, shape), cells in blocks.items():
        out.append(f"{dimension} {entity} {shape} {len(cells)}")
        for cell in cells:
            number += 1
            out.append(" ".join(str(n) for n in [number, *(tags[node] for node in cell.nodes)]))
    return "\n".join([*out, "$EndElements", ""])
