"""Random grids with boxes, beds, crosses and cracks."""

import dataclasses
import random

from twins.ground import Ground

KINDS = ["bonded", "box", "box_open", "box_T", "two_boxes", "cross", "layers", "crack"]


@dataclasses.dataclass
class Grid:
    """A ground in columns and rows, `nx` and `ny` of them."""

    rng: random.Random
    nx: int
    ny: int
    ground: Ground

    def node(self, i, j):
        return j * (self.nx + 1) + i

    def groups(self, i, j):
        """Those of the face in column i and row j, to be changed in place."""
        return self.ground.quads[j * self.nx + i][1]

    def level(self, low, high, j):
        return [self.node(i, j) for i in range(low, high + 1)]

    def upright(self, i, low, high):
        return [self.node(i, j) for j in range(low, high + 1)]

    def mark(self, name, holds):
        """Adds a group to the faces whose (column, row) hold."""
        for j in range(self.ny):
            for i in range(self.nx):
                if holds(i, j):
                    self.groups(i, j).add(name)

    def box(self, name, i0, i1, j0, j1):
        """A body of the faces between two columns' and two rows' lines; returns its outline, anticlockwise."""
        for j in range(j0, j1):
            for i in range(i0, i1):
                self.groups(i, j).clear()
                self.groups(i, j).add(name)
        self.ground.bodies.append(name)
        there = self.level(i0, i1, j0) + self.upright(i1, j0, j1)[1:]
        return there + self.level(i0, i1, j1)[-2::-1] + self.upright(i0, j0, j1)[-2::-1]

    def extent(self, count, least=1):
        """First and last line of something inside `count` columns or rows."""
        low = self.rng.randint(1, count - 1 - least)
        return low, self.rng.randint(low + least, min(count - 1, low + max(least, 4)))


def spaced(rng, count, length, even):
    """Ends of `count` parts of `length`, from 0."""
    parts = [1.0 if even else rng.uniform(0.6, 1.4) for _ in range(count)]
    return [length * sum(parts[:k]) / sum(parts) for k in range(count + 1)]


def empty(rng, kind):
    """One to three layers, with base, surface and sides."""
    nx, ny = rng.randint(4, 9), rng.randint(4, 8)
    width = round(10 ** rng.uniform(-0.3, 1.3), 3)
    height = round(width * ny / nx * rng.uniform(0.6, 1.6), 3)
    left = round(rng.uniform(-0.8, -0.2) * width, 3)
    xs, ys = spaced(rng, nx, width, rng.random() < 0.5), spaced(rng, ny, height, rng.random() < 0.5)
    places = [(left + x, y - height) for y in ys for x in xs]
    size = (width, height, min(width / nx, height / ny))
    grid = Grid(rng, nx, ny, Ground(kind, places, [], {}, {}, [], set(), {}, size))
    tops = sorted(rng.sample(range(1, ny), rng.randint(0, 2)))
    ground, node = grid.ground, grid.node
    for j in range(ny):
        for i in range(nx):
            nodes = [node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)]
            ground.quads.append((nodes, {f"layer_{1 + sum(j < top for top in tops)}"}))
        ground.line(node(0, j), node(0, j + 1), "side_left")
        ground.line(node(nx, j), node(nx, j + 1), "side_right")
    for i in range(nx):
        ground.line(node(i, 0), node(i + 1, 0), "base")
        ground.line(node(i, ny), node(i + 1, ny), "surface")
    ground.fixed |= {n for edge in ground.lines for n in edge}
    return grid


def one_box(grid, kind):
    """A box; of its outline all or a part opens, and a bed may end in it."""
    rng, ground = grid.rng, grid.ground
    (i0, i1), (j0, j1) = grid.extent(grid.nx), grid.extent(grid.ny)
    outline = grid.box("box_1", i0, i1, j0, j1)
    if kind == "box_open":
        turned = rng.randrange(len(outline) - 1)
        outline = outline[turned:-1] + outline[: turned + 1]
        outline = outline[: rng.randint(3, len(outline) - 1)]
    ground.interface("outline_1", "box_1", outline)
    if kind == "box_T":
        bed = rng.randint(j0, j1)
        grid.mark("above", lambda _, j: j >= bed)
        first = rng.choice([0, 0, max(i0 - 1, 0), i0])
        last = rng.choice([grid.nx, grid.nx, min(i1 + 1, grid.nx), i1])
        ground.interface("bed", "above", grid.level(first, i0, bed))
        ground.interface(rng.choice(["bed", "bed_right"]), "above", grid.level(i1, last, bed))


def two_boxes(grid, _kind):
    """Side by side, as high or not, mostly touching: then their outlines meet."""
    rng = grid.rng
    (i0, i1), (j0, j1) = grid.extent(grid.nx, 2), grid.extent(grid.ny)
    middle = rng.randint(i0 + 1, i1 - 1)
    first = grid.box("box_1", i0, middle, j0, j1)
    top = min(grid.ny - 1, max(j0 + 1, j1 + rng.choice([-1, 0, 0, 1])))
    apart = rng.random() < 0.3 and middle + 1 < i1
    second = grid.box("box_2", middle + apart, i1, j0, top)
    grid.ground.interface("outline_1", "box_1", first)
    grid.ground.interface("outline_2", "box_2", second)


def cross(grid, kind):
    """A level line from side to side or ending inside, and in a cross an upright one that meets or misses it."""
    rng, ground = grid.rng, grid.ground
    row, column = rng.randint(1, grid.ny - 1), rng.randint(1, grid.nx - 1)
    grid.mark("above", lambda _, j: j >= row)
    low, high = (0, grid.nx) if kind == "layers" or rng.random() < 0.5 else grid.extent(grid.nx, 2)
    ground.interface("level", "above", grid.level(low, high, row))
    if kind == "cross":
        grid.mark("left", lambda i, _: i < column)
        low, high = (0, grid.ny) if rng.random() < 0.5 else grid.extent(grid.ny, 2)
        ground.interface("upright", "left", grid.upright(column, low, high))


def crack(grid, _kind):
    """A line inside a body, which is on both its sides."""
    low, high = grid.extent(grid.nx, 2)
    row = grid.rng.randint(1, grid.ny - 1)
    grid.mark("cracked", lambda _, j: j in (row - 1, row))
    path = grid.level(low, high, row)
    grid.ground.interface("crack", "cracked", path if grid.rng.random() < 0.5 else path[::-1])


def draw(rng, kind):
    grid = empty(rng, kind)
    ways = {"box": one_box, "box_open": one_box, "box_T": one_box, "two_boxes": two_boxes, "cross": cross, "layers": cross}
    ways |= {"crack": crack, "bonded": lambda *_: None}
    ways[kind](grid, kind)
    return grid.ground
