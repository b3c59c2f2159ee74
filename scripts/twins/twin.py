"""The same problem written in another way: numbers, names, side, unit, and parts of the load."""

import copy
import dataclasses

from twins.drawing import Cell, Drawing, corners, msh, reversed_nodes

UNITS = {"mm": 1e3, "km": 1e-3}


@dataclasses.dataclass
class Written:
    """Files of a twin; `mirrored` says that components along x have the other sign."""

    json: dict
    mesh: str
    mirrored: bool = False


def as_drawn(case):
    return Written(case.json, msh(case.drawing))


def each_load(json):
    """(object of one load, group, its kind) of every load."""
    for load in json.get("loads", []):
        for name, of_group in load.items():
            for kind in of_group:
                yield of_group, name, kind


def loaded_times(case, factor):
    """Every load and gravity times a factor, or the initial motion where there is neither."""
    json = copy.deepcopy(case.json)
    for of_group, _, kind in each_load(json):
        of_group[kind]["scale"] = of_group[kind].get("scale", 1) * factor
    if "loads" not in json:
        json["gravity"] = json.get("gravity", 0) * factor
        for motion in json.get("initial", {}).values():
            motion["velocity"] = [v * factor for v in motion["velocity"]]
    return Written(json, msh(case.drawing))


def perturbed(case, factor, rng):
    """The load times a factor that is 1 to 14 digits, and every inner node moved by as little of the mesh's extent."""
    written = loaded_times(case, factor)
    border = {n for cell in case.drawing.cells if cell.kind == "line" for n in cell.nodes}
    size = max(abs(x) + abs(y) for x, y in case.drawing.places) * abs(factor - 1)
    move = lambda v: v + size * rng.uniform(-1, 1)
    places = [(x, y) if n in border else (move(x), move(y)) for n, (x, y) in enumerate(case.drawing.places)]
    return Written(written.json, msh(Drawing(places, case.drawing.cells)))


def in_parts(case, rng):
    """Every load as two halves, or as three parts."""
    json = copy.deepcopy(case.json)
    parts = rng.choice([[0.5, 0.5], [0.25, 0.5, 0.25], [0.2, 0.3, 0.5]])
    split = []
    for load in json.get("loads", []):
        for part in parts:
            piece = copy.deepcopy(load)
            for of_group in piece.values():
                for pulse in of_group.values():
                    pulse["scale"] = pulse.get("scale", 1) * part
            split.append(piece)
    if split:
        json["loads"] = split
    return Written(json, msh(case.drawing))


def in_unit(case, unit):
    json = copy.deepcopy(case.json) | {"geometry": {"unit": unit, "mesh": "mesh.msh"}}
    places = [(x * UNITS[unit], y * UNITS[unit]) for x, y in case.drawing.places]
    return Written(json, msh(Drawing(places, case.drawing.cells)))


def mirrored(case):
    """x -> -x. A line is drawn the other way, too, so that a crack keeps its body on the left."""
    json = copy.deepcopy(case.json)
    for of_group, _, kind in each_load(json):
        pulse = of_group[kind]
        for keys in (pulse, pulse.get("front", {}), pulse.get("explosion", {})):
            for name in {"direction", "from", "at"} & set(keys):
                keys[name] = [-keys[name][0], keys[name][1]]
    for motion in json.get("initial", {}).values():
        motion["velocity"] = [-motion["velocity"][0], motion["velocity"][1]]
    places = [(-x, y) for x, y in case.drawing.places]
    cells = [Cell(c.kind, reversed_nodes(c), c.groups) for c in case.drawing.cells]
    return Written(json, msh(Drawing(places, cells)), mirrored=True)


def turned(rng, cell):
    """The same cell from another corner on; a line stays, since a crack has a direction."""
    if cell.kind != "face":
        return cell
    own = corners(cell)
    k, middles = rng.randrange(len(own)), cell.nodes[len(own) :]
    return Cell(cell.kind, own[k:] + own[:k] + middles[k:] + middles[:k], cell.groups)


def shuffled(rng, keys):
    names = list(keys)
    rng.shuffle(names)
    return {name: keys[name] for name in names}


def renumbered(case, rng):
    """Nodes, elements and groups in another order, tags with holes, other names of curves and surfaces."""
    old = case.drawing
    order = list(range(len(old.places)))
    rng.shuffle(order)
    new = {node: number for number, node in enumerate(order)}
    names = case.drawing.group_names("face") + case.drawing.group_names("line")
    other = {name: f"{rng.choice('abcdefghijklmnopqrstuvwxyz')}_{k}" for k, name in enumerate(names)}
    cells = [turned(rng, cell) for cell in old.cells]
    rng.shuffle(cells)
    rename = lambda cell: cell.groups if cell.kind == "point" else frozenset(other[g] for g in cell.groups)
    cells = [Cell(c.kind, [new[n] for n in c.nodes], rename(c)) for c in cells]
    tags = sorted(rng.sample(range(1, 3 * len(order)), len(order)))
    json = renamed(case.json, other)
    for key in ("materials", "interfaces", "supports", "boundaries"):
        json[key] = shuffled(rng, json[key])
    return Written(shuffled(rng, json), msh(Drawing([old.places[n] for n in order], cells), tags, rng.randint(1, 50)))


def renamed(json, other):
    """The case with other names of curves and surfaces."""
    json = copy.deepcopy(json)

    def name_of(name):
        curve, at, side = name.partition("@")
        return other.get(curve, curve) + at + side

    for key in ("materials", "interfaces", "supports", "boundaries", "initial"):
        if key in json:
            json[key] = {name_of(name): value for name, value in json[key].items()}
    for interface in json["interfaces"].values():
        interface["body"] = name_of(interface["body"])
    if "loads" in json:
        json["loads"] = [{name_of(name): value for name, value in load.items()} for load in json["loads"]]
    return json
