"""Random meshes of 10 to 200 elements: grids with boxes, beds, crosses and cracks, and pipes in square ground."""

import dataclasses
import math

from twins.drawing import Cell, Drawing, by_corner_angles, second_order

GRIDS = ["bonded", "box", "box_open", "box_T", "two_boxes", "cross", "layers", "crack"]
PIPES = ["ring", "two_rings", "ring_open", "ring_T"]


@dataclasses.dataclass
class Ground:
    """What a case is written for. Faces and lines are of first order until `finish`."""

    kind: str
    places: list
    quads: list  # [(nodes, groups)]
    lines: dict  # (a, b) as drawn -> groups
    interfaces: dict  # name -> body
    bodies: list
    fixed: set  # nodes that a distortion must leave alone
    circles: dict  # node -> (pipe, radius, centre)
    size: tuple  # width, height, side of an element

    def line(self, a, b, name):
        key = (a, b) if (b, a) not in self.lines else (b, a)
        self.lines.setdefault(key, set()).add(name)

    def interface(self, name, body, path):
        """The lines along `path` that are in no other interface."""
        taken = {frozenset(edge) for edge, groups in self.lines.items() if groups & set(self.interfaces)}
        free = [edge for edge in zip(path, path[1:]) if frozenset(edge) not in taken]
        for a, b in free:
            self.line(a, b, name)
        if free:
            self.interfaces[name] = body


def spaced(rng, count, length, even):
    """Ends of `count` parts of `length`, from 0."""
    parts = [1.0 if even else rng.uniform(0.6, 1.4) for _ in range(count)]
    return [length * sum(parts[:k]) / sum(parts) for k in range(count + 1)]


def grid(rng, kind):
    nx, ny = rng.randint(4, 9), rng.randint(4, 8)
    width = round(10 ** rng.uniform(-0.3, 1.3), 3)
    height = round(width * ny / nx * rng.uniform(0.6, 1.6), 3)
    left = round(rng.uniform(-0.8, -0.2) * width, 3)
    xs, ys = spaced(rng, nx, width, rng.random() < 0.5), spaced(rng, ny, height, rng.random() < 0.5)
    node = lambda i, j: j * (nx + 1) + i
    places = [(left + x, y - height) for y in ys for x in xs]
    layers = rng.randint(1, 3)
    tops = sorted(rng.sample(range(1, ny), min(layers - 1, ny - 1)))
    quads = []
    for j in range(ny):
        layer = f"layer_{1 + sum(j < top for top in tops)}"
        quads += [([node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)], {layer}) for i in range(nx)]
    border = {node(i, j) for i in range(nx + 1) for j in range(ny + 1) if i in (0, nx) or j in (0, ny)}
    ground = Ground(kind, places, quads, {}, {}, [], border, {}, (width, height, min(width / nx, height / ny)))
    for i in range(nx):
        ground.line(node(i, 0), node(i + 1, 0), "base")
        ground.line(node(i, ny), node(i + 1, ny), "surface")
    for j in range(ny):
        ground.line(node(0, j), node(0, j + 1), "side_left")
        ground.line(node(nx, j), node(nx, j + 1), "side_right")
    face = lambda i, j: quads[j * nx + i][1]

    def box(name, i0, i1, j0, j1):
        """A body of the faces between the columns i0, i1 and the rows j0, j1, and its outline, anticlockwise."""
        for j in range(j0, j1):
            for i in range(i0, i1):
                face(i, j).clear()
                face(i, j).add(name)
        ground.bodies.append(name)
        across, up = range(i0, i1 + 1), range(j0, j1 + 1)
        outline = [node(i, j0) for i in across] + [node(i1, j) for j in up[1:]]
        return outline + [node(i, j1) for i in reversed(across[:-1])] + [node(i0, j) for j in reversed(up[:-1])]

    def extent(count, least=1):
        """First and last line of something inside `count` elements."""
        low = rng.randint(1, count - 1 - least)
        return low, rng.randint(low + least, min(count - 1, low + max(least, 4)))

    if kind in ("box", "box_open", "box_T"):
        (i0, i1), (j0, j1) = extent(nx), extent(ny)
        outline = box("box_1", i0, i1, j0, j1)
        if kind == "box_open":
            turned = rng.randrange(len(outline) - 1)
            outline = outline[turned:-1] + outline[: turned + 1]
            outline = outline[: rng.randint(3, len(outline) - 1)]
        ground.interface("outline_1", "box_1", outline)
        if kind == "box_T":
            bed = rng.randint(j0, j1)
            for quad, groups in quads[bed * nx :]:
                groups.add("above")
            first = rng.choice([0, 0, max(i0 - 1, 0), i0])
            last = rng.choice([nx, nx, min(i1 + 1, nx), i1])
            ground.interface("bed", "above", [node(i, bed) for i in range(first, i0 + 1)] or [0])
            path = [node(i, bed) for i in range(i1, last + 1)]
            ground.interface("bed" if rng.random() < 0.5 else "bed_right", "above", path)
    elif kind == "two_boxes":
        (i0, i1), (j0, j1) = extent(nx, 2), extent(ny)
        middle = rng.randint(i0 + 1, i1 - 1)
        first = box("box_1", i0, middle, j0, j1)
        top = min(ny - 1, max(j0 + 1, j1 + rng.choice([-1, 0, 0, 1])))
        apart = rng.random() < 0.3 and middle + 1 < i1
        second = box("box_2", middle + apart, i1, j0, top)
        ground.interface("outline_1", "box_1", first)
        ground.interface("outline_2", "box_2", second)
    elif kind in ("cross", "layers"):
        row = rng.randint(1, ny - 1)
        for quad, groups in quads[row * nx :]:
            groups.add("above")
        low, high = (0, nx) if kind == "layers" or rng.random() < 0.5 else extent(nx, 2)
        ground.interface("level", "above", [node(i, row) for i in range(low, high + 1)])
        if kind == "cross":
            column = rng.randint(low, high) if rng.random() < 0.3 else rng.randint(1, nx - 1)
            column = min(max(column, 1), nx - 1)
            for number, (quad, groups) in enumerate(quads):
                if number % nx < column:
                    groups.add("left")
            low, high = (0, ny) if rng.random() < 0.5 else extent(ny, 2)
            ground.interface("upright", "left", [node(column, j) for j in range(low, high + 1)])
    elif kind == "crack":
        low, high = extent(nx, 2)
        row = rng.randint(1, ny - 1)
        for i in range(nx):  # one body on both sides
            for j in (row - 1, row):
                face(i, j).add("cracked")
        path = [node(i, row) for i in range(low, high + 1)]
        ground.interface("crack", "cracked", path if rng.random() < 0.5 else path[::-1])
    return ground


def pipes(rng, kind):
    count = 2 if kind == "two_rings" else 1
    around = rng.choice([8, 16] if kind == "ring_T" else [8, 12, 16] if count == 1 else [8, 12])
    through, rings = rng.randint(1, 2), rng.randint(2, 3)
    half = round(10 ** rng.uniform(-0.3, 1.0), 3)
    outer = half * rng.uniform(0.35, 0.6)
    inner = outer * rng.uniform(0.5, 0.93)
    depth = half * rng.uniform(1.0, 1.0)
    shift = round(rng.uniform(-0.5, 0.5) * half, 3)
    border_y = -depth + half * rng.uniform(-0.8, 0.8)
    two_layers = rng.random() < 0.5
    places, quads, number_of, circles, fixed = [], [], {}, {}, set()
    ground = Ground(kind, places, quads, {}, {}, [], fixed, circles, (2 * half * count, 2 * half, (outer - inner) / through))

    def node_at(x, y):
        key = (round(x / half, 9), round(y / half, 9))
        if key not in number_of:
            number_of[key] = len(places)
            places.append((x, y))
        return number_of[key]

    for pipe in range(count):
        centre = (shift + half * (2 * pipe - count + 1), -depth)
        name = f"pipe_{pipe + 1}"
        quarter = around // 4
        ring = []
        for k in range(around):
            angle = 2 * math.pi * k / around - math.pi / 4
            c, s = math.cos(angle), math.sin(angle)
            along = -half + 2 * half * (k % quarter) / quarter
            square = [(half, along), (-along, half), (-half, -along), (along, -half)][k // quarter]
            row = []
            for r in range(through + 1):
                radius = inner + (outer - inner) * r / through
                row.append(node_at(centre[0] + radius * c, centre[1] + radius * s))
                circles[row[-1]] = (pipe, radius, centre)
                fixed.add(row[-1])
            for g in range(1, rings + 1):
                w = g / rings
                x, y = ((1 - w) * outer * d + w * q for d, q in zip((c, s), square))
                row.append(node_at(centre[0] + x, centre[1] + y))
                if g == rings:
                    fixed.add(row[-1])
            ring.append(row)
        for k in range(around):
            here, there = ring[k], ring[(k + 1) % around]
            upper = around // 8 <= k < 5 * around // 8
            for r in range(through + rings):
                nodes = [here[r], here[r + 1], there[r + 1], there[r]]
                y = sum(places[n][1] for n in nodes) / 4
                groups = {name} if r < through else {"layer_2" if two_layers and y < border_y else "layer_1"}
                if kind == "ring_T" and upper:
                    groups.add("above")
                quads.append((nodes, groups))
            ground.line(here[0], there[0], f"bore_{pipe + 1}")
            for (axis, value, side) in ((0, shift + half * count, "side_right"), (0, shift - half * count, "side_left"),
                                        (1, -depth + half, "surface"), (1, -depth - half, "base")):
                if all(abs(places[n][axis] - value) < 1e-9 * half for n in (here[-1], there[-1])):
                    ground.line(here[-1], there[-1], side)
        circle = [ring[k % around][through] for k in range(around + 1)]
        if kind == "ring_open":
            turned = rng.randrange(around)
            circle = [ring[(turned + k) % around][through] for k in range(rng.randint(2, around - 1) + 1)]
        ground.bodies.append(name)
        ground.interface(f"outline_{pipe + 1}", name, circle)
        if kind == "ring_T":
            sides = rng.choice([[0], [1], [0, 1]])
            for side in sides:
                ray = ring[around // 8 + side * around // 2][through:]
                if rng.random() < 0.3:
                    ray = ray[:-1]
                ground.interface(f"bed_{side + 1}" if rng.random() < 0.5 else "bed", "above", ray)
    return ground


def distorted(rng, ground):
    """The ground with its inner nodes moved by up to a fifth of an element, less where that spoils a face."""
    amount = rng.choice([0.0, 0.1, 0.2, 0.2])
    moves = [(rng.uniform(-1, 1), rng.uniform(-1, 1)) for _ in ground.places]
    while True:
        step = amount * ground.size[2]
        places = [(x, y) if n in ground.fixed else (x + step * moves[n][0], y + step * moves[n][1])
                  for n, (x, y) in enumerate(ground.places)]
        if all(by_corner_angles(places, nodes) > 0.1 for nodes, _ in ground.quads) or amount < 0.01:
            return places
        amount /= 2


def finish(rng, ground, points):
    """The drawing: some quadrilaterals cut into triangles, of first or second order; `points` are node -> names."""
    places = distorted(rng, ground)
    share = rng.choice([0.0, 0.0, 0.5, 1.0]) if len(ground.quads) <= 100 else 0.0
    cells = []
    for nodes, groups in ground.quads:
        if rng.random() < share:
            k = rng.randrange(2)
            a, b, c, d = nodes[k:] + nodes[:k]
            cells += [Cell("face", [a, b, c], frozenset(groups)), Cell("face", [a, c, d], frozenset(groups))]
        else:
            cells.append(Cell("face", nodes, frozenset(groups)))
    cells += [Cell("line", [a, b], frozenset(groups)) for (a, b), groups in ground.lines.items()]
    cells += [Cell("point", [node], frozenset(names)) for node, names in points.items()]
    drawing = Drawing(places, cells)
    curved = share == 0 and rng.random() < 0.7  # a triangle in a thin wall would fold

    def middle(a, b):
        x, y = ((p + q) / 2 for p, q in zip(places[a], places[b]))
        one, other = ground.circles.get(a), ground.circles.get(b)
        if curved and one and other and one[0] == other[0] and abs(one[1] - other[1]) < 1e-9 * one[1]:
            (cx, cy), radius = one[2], one[1]
            far = math.hypot(x - cx, y - cy)
            return (cx + (x - cx) * radius / far, cy + (y - cy) * radius / far)
        return (x, y)

    order = rng.choice([1, 1, 2])
    return (second_order(drawing, middle) if order == 2 else drawing), order


def draw_ground(rng):
    kind = rng.choice(GRIDS[1:] * 2 + PIPES * 3 + GRIDS[:1])
    return pipes(rng, kind) if kind in PIPES else grid(rng, kind)
