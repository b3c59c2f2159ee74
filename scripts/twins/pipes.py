"""Random pipes, each in the middle of a square of ground, in rings of quadrilaterals that end in the square's sides."""

import dataclasses
import math

from twins.ground import Ground

KINDS = ["ring", "two_rings", "ring_open", "ring_T"]


@dataclasses.dataclass
class Pipe:
    """One square: `nodes[k][r]` on ray k, from the bore outwards; `through` rings are the wall."""

    name: str
    centre: tuple
    half: float
    radii: tuple  # of the bore and of the outline
    counts: tuple  # around, through the wall, through the ground
    nodes: list = dataclasses.field(default_factory=list)

    def place(self, k, r):
        """Rays are even along the circle and along the square, whose corner at the lower right is that of ray 0."""
        around, through, rings = self.counts
        angle = 2 * math.pi * k / around - math.pi / 4
        circle = (math.cos(angle), math.sin(angle))
        side, step = divmod(k, around // 4)
        along = -self.half + 2 * self.half * step / (around // 4)
        square = [(self.half, along), (-along, self.half), (-self.half, -along), (along, -self.half)][side]
        w = max(r - through, 0) / rings
        radius = self.radius(min(r, through))
        return tuple(c + (1 - w) * radius * d + w * q for c, d, q in zip(self.centre, circle, square))

    def radius(self, r):
        inner, outer = self.radii
        return inner + (outer - inner) * r / self.counts[1]


def add(ground, pipe, number_at, layer_at):
    """The pipe's and its ground's nodes, faces and lines."""
    around, through, rings = pipe.counts
    for k in range(around):
        pipe.nodes.append([number_at(pipe.place(k, r)) for r in range(through + rings + 1)])
        for r in range(through + 1):
            ground.circles[pipe.nodes[k][r]] = (pipe.name, pipe.radius(r), pipe.centre)
        ground.fixed |= {*pipe.nodes[k][: through + 1], pipe.nodes[k][-1]}
    for k in range(around):
        here, there = pipe.nodes[k], pipe.nodes[(k + 1) % around]
        for r in range(through + rings):
            nodes = [here[r], here[r + 1], there[r + 1], there[r]]
            groups = {pipe.name if r < through else layer_at(sum(ground.places[n][1] for n in nodes) / 4)}
            # between the level rays to the right and to the left
            above = {"above"} if ground.kind == "ring_T" and around // 8 <= k < 5 * around // 8 else set()
            ground.quads.append((nodes, groups | above))
        ground.line(here[0], there[0], f"bore_{pipe.name[-1]}")
    ground.bodies.append(pipe.name)


def add_borders(ground, pipes):
    xs = [pipe.centre[0] + sign * pipe.half for pipe in pipes for sign in (-1, 1)]
    bottom, top = (pipes[0].centre[1] + sign * pipes[0].half for sign in (-1, 1))
    sides = [(0, min(xs), "side_left"), (0, max(xs), "side_right"), (1, bottom, "base"), (1, top, "surface")]
    for pipe in pipes:
        for k in range(len(pipe.nodes)):
            a, b = pipe.nodes[k][-1], pipe.nodes[(k + 1) % len(pipe.nodes)][-1]
            for axis, value, name in sides:
                if all(abs(ground.places[n][axis] - value) < 1e-9 * pipe.half for n in (a, b)):
                    ground.line(a, b, name)


def add_interfaces(rng, ground, pipe):
    """The pipe's outline or an arc of it, and beds from it to the sides or into the ground."""
    around, through, _ = pipe.counts
    first, count = (rng.randrange(around), rng.randint(2, around - 1)) if ground.kind == "ring_open" else (0, around)
    arc = [pipe.nodes[(first + k) % around][through] for k in range(count + 1)]
    ground.interface(f"outline_{pipe.name[-1]}", pipe.name, arc)
    if ground.kind == "ring_T":
        for side in rng.choice([[0], [1], [0, 1]]):
            ray = pipe.nodes[around // 8 + side * around // 2][through:]
            ground.interface(rng.choice(["bed", f"bed_{side + 1}"]), "above", ray[:-1] if rng.random() < 0.3 else ray)


def draw(rng, kind):
    count = 2 if kind == "two_rings" else 1
    around = rng.choice({"ring_T": [8, 16], "two_rings": [8, 12]}.get(kind, [8, 12, 16]))
    counts = (around, rng.randint(1, 2), rng.randint(2, 3))
    half = round(10 ** rng.uniform(-0.3, 1.0), 3)
    outer = half * rng.uniform(0.35, 0.6)
    inner = outer * rng.uniform(0.5, 0.93)
    shift = round(rng.uniform(-0.5, 0.5) * half, 3)
    border = half * rng.uniform(-1.8, -0.2) if rng.random() < 0.5 else -3 * half
    ground = Ground(kind, [], [], {}, {}, [], set(), {}, (2 * half * count, 2 * half, (outer - inner) / counts[1]))
    numbers = {}

    def number_at(place):
        key = tuple(round(x / half, 9) for x in place)
        if key not in numbers:
            numbers[key] = len(ground.places)
            ground.places.append(place)
        return numbers[key]

    centres = [(shift + half * (2 * n - count + 1), -half) for n in range(count)]
    pipes = [Pipe(f"pipe_{n + 1}", centre, half, (inner, outer), counts) for n, centre in enumerate(centres)]
    for pipe in pipes:
        add(ground, pipe, number_at, lambda y: "layer_2" if y < border else "layer_1")
    add_borders(ground, pipes)
    for pipe in pipes:
        add_interfaces(rng, ground, pipe)
    return ground
