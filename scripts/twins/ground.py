"""Quadrilaterals and named lines that a case is written for, and the mesh that is made of them."""

import dataclasses
import math

from twins.drawing import Cell, Drawing, by_corner_angles, second_order


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
