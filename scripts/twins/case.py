"""A random case for a random ground, and what is known about it without running it."""

import dataclasses
import math

from twins import grid, pipes
from twins.drawing import Drawing
from twins.ground import finish


@dataclasses.dataclass
class Case:
    """`scale` holds sizes [SI] of the histories' quantities below which no digits are asked for: of the settlement under
    gravity a hundredth, since that is in balance to `newton.tolerance` (1e-8), and 1e-9 of what the loads do in statics."""

    drawing: Drawing
    json: dict
    kind: str
    features: list
    scale: dict


def chance(rng, share):
    return rng.random() < share


def log(rng, low, high):
    return 10 ** rng.uniform(math.log10(low), math.log10(high))


def oedometric(material):
    e, nu = material["young"], material["poisson"]
    return e * (1 - nu) / ((1 + nu) * (1 - 2 * nu))


def draw_materials(rng, drawing):
    """One for each layer and body; helper groups have none."""
    materials = {}
    for name in drawing.group_names("face"):
        if name.startswith("layer"):
            materials[name] = {"young": log(rng, 2e7, 1e9), "poisson": rng.choice([0.1, 0.25, 0.3, 0.4, 0.46]),
                               "density": rng.uniform(1600, 2700), "friction": draw_friction(rng)}
        elif name.startswith(("box", "pipe")):
            stiff = chance(rng, 0.5)
            materials[name] = {"young": 2.1e11 if stiff else log(rng, 1e8, 3e10), "poisson": rng.choice([0.2, 0.3]),
                               "density": 7850 if stiff else rng.uniform(1000, 2600)}
            materials[name]["friction"] = draw_friction(rng)
    return materials


def draw_friction(rng):
    return rng.choice([0, 0.2, 0.3, 0.41, 0.6, 0.8, 1, 1.2, rng.uniform(0, 1.2)])


def draw_interface(rng, body, side, gaps, order):
    interface = {"body": body}
    if chance(rng, 0.7):
        interface["friction"] = draw_friction(rng)
    if chance(rng, 0.7):
        interface["thickness"] = log(rng, 1e-4, 0.1) * side
    else:
        interface["normal_stiffness"] = log(rng, 1e8, 1e13) / max(side, 0.1)
        if chance(rng, 0.7):
            interface["tangential_stiffness"] = interface["normal_stiffness"] * rng.uniform(0.2, 1)
    if gaps and chance(rng, 0.7):
        interface["gap"] = log(rng, 1e-7, 1e-3) * side
    if order == 1 and chance(rng, 0.15):
        interface["integration"] = "gauss_1"
    return interface


def draw_pulse(rng, span, peak, charges):
    """A law with its keys; `span` is the time that the pulse should take."""
    law = rng.choice(["linear", "step", "ramp", "half_sine", "friedlander", "table"] + ["charge"] * charges)
    long = span * rng.uniform(0.3, 1.5)
    pulse = {"law": law, "peak": peak}
    if law in ("linear", "ramp", "half_sine", "friedlander"):
        pulse["duration"] = long
    if law == "friedlander":
        pulse["decay"] = rng.uniform(0.2, 3)
        if chance(rng, 0.5):
            pulse |= {"negative_peak": peak * rng.uniform(0.05, 0.4), "negative_duration": long * rng.uniform(0.5, 2)}
    if law == "table":
        times = sorted(rng.uniform(0, span) for _ in range(rng.randint(2, 6)))
        pulse = {"law": law, "times": times, "values": [peak * rng.uniform(-0.3, 1) for _ in times]}
    if law == "charge":
        pulse = {"law": law, "explosion": {"charge": log(rng, 1, 1000), "standoff": log(rng, 5, 30), "wave": "incident"}}
        pulse["scale"] = log(rng, 0.05, 1)
    if chance(rng, 0.15):
        pulse["start"] = span * rng.uniform(0, 0.3)
    if chance(rng, 0.15) and law not in ("ramp", "half_sine"):
        pulse["rise"] = span * rng.uniform(0.02, 0.2)
    return pulse


def add_front(rng, pulse, wave_speed, far):
    """The pulse behind a plane front, a circular one, or that of a charge on the ground beside the curve."""
    place = [round(rng.uniform(1, 3) * far * rng.choice([-1, 1]), 3), 0]
    if pulse["law"] == "charge":
        place[0] += math.copysign(10, place[0])  # nearer no formula holds
        explosion = {"charge": log(rng, 1, 100), "at": place, "burst": "hemispherical", "wave": "incident"}
        pulse["explosion"] = explosion | {"clock": "arrival"}
    else:
        to = rng.choice([{"direction": [1, 0]}, {"direction": [-1, 0]}, {"from": place}])
        pulse["front"] = {"speed": wave_speed * rng.uniform(0.5, 3)} | to


def direction(rng):
    return rng.choice([[1, 0], [-1, 0], [0, -1], [0, 1], [round(rng.uniform(-1, 1), 3), -1]])


def draw_loads(rng, drawing, bodies, interfaces, span, peak, size, free_field, static, wave_speed):
    """One to three loads, each an object of its own, so that they add up."""
    curves = drawing.group_names("line")
    bores = [name for name in curves if name.startswith("bore")]
    loads = []
    for _ in range(rng.choice([1, 1, 1, 2, 3])):
        what = rng.choice(["surface"] * 5 + ["strip", "strip", "traction", "force", "body_force", "bore", "joint", "side"])
        pressure = peak * rng.uniform(0.3, 1)
        pulse = draw_pulse(rng, span, pressure, what == "surface" and not static)
        if what in ("surface", "strip"):
            load = {what if what in curves else "surface": {"pressure": pulse}}
            if not free_field and not static and chance(rng, 0.15):
                add_front(rng, pulse, wave_speed, size * 10)
        elif what == "traction" and not free_field:
            curve = rng.choice(["surface", "strip"]) if "strip" in curves else "surface"
            load = {curve: {"traction": pulse | {"direction": direction(rng)}}}
        elif what == "force":
            scale_pulse(pulse, size)
            load = {"P2": {"force": pulse | {"direction": direction(rng)}}}
        elif what == "body_force" and bodies:
            scale_pulse(pulse, 1 / size)
            load = {rng.choice(bodies): {"body_force": pulse | {"direction": direction(rng)}}}
        elif what == "bore" and bores:
            load = {rng.choice(bores): {"pressure": pulse}}
        elif what == "joint" and interfaces:
            load = {rng.choice(sorted(interfaces)): {"pressure": pulse}}
        elif what == "side" and interfaces:
            name = f"{rng.choice(sorted(interfaces))}@{rng.choice(['body', 'ground'])}"
            load = {name: {"traction": pulse | {"direction": direction(rng)}}}
        else:
            load = {"surface": {"pressure": pulse}}
        loads.append(load)
    return loads


def scale_pulse(pulse, factor):
    for key in ("peak", "negative_peak"):
        if key in pulse:
            pulse[key] *= factor
    if "values" in pulse:
        pulse["values"] = [v * factor for v in pulse["values"]]


def touches(ground):
    """Whether an interface ends in a side of the ground."""
    ends = lambda names: {n for edge, groups in ground.lines.items() if groups & names for n in edge}
    return bool(ends(set(ground.interfaces)) & ends({"side_left", "side_right"}))


def draw_borders(rng, sides_opened):
    """(supports, boundaries); a free field needs sides without a break"""
    rollers = {"base": ["x", "y"], "side_left": ["x"], "side_right": ["x"]}
    free_fields = [] if sides_opened else ["free_field", "free_field_fixed"]
    way = rng.choice(["rollers"] * 4 + ["base", "fixed", "viscous_base"] + free_fields)
    if way == "rollers":
        return rollers, {}
    if way == "base":
        return {"base": ["x", "y"]}, {}
    if way == "fixed":
        return {"base": ["x", "y"], "side_left": ["x", "y"], "side_right": ["x", "y"]}, {}
    if way == "viscous_base":
        return {"side_left": ["x"], "side_right": ["x"]}, {"base": "viscous"}
    sides = {"side_left": "free_field", "side_right": "free_field"}
    return ({"base": ["x", "y"]}, sides) if way == "free_field_fixed" else ({}, sides | {"base": "viscous"})


def draw_damping(rng):
    if chance(rng, 0.25):
        return None
    keys = {"ratio": rng.choice([0.01, 0.05, 0.1, 0.2])} if chance(rng, 0.6) else None
    if keys and chance(rng, 0.3):
        keys["modes"] = [1, 3]
    return keys or {}


def draw_time(rng, transit):
    """Steps that resolve the run of a P wave through the ground."""
    step = transit * log(rng, 0.02, 0.2)
    steps = rng.randint(20, 80)
    time = {"step": step, "end": step * steps}
    if chance(rng, 0.2):
        time["hht"] = -round(rng.uniform(0.02, 0.33), 3)
    if chance(rng, 0.1):
        time["energy_tolerance"] = rng.choice([0.005, 0.02, 0.1])
    if chance(rng, 0.1):
        time["start"] = "rest"
    return time


def probe_points(rng, ground):
    """{node: names} of points to watch, the probes' names, and whether one lies where interfaces meet or end."""
    own = lambda name: sorted({n for edge, groups in ground.lines.items() if name in groups for n in edge})
    count, border = {}, {n for edge, groups in ground.lines.items() if not groups & set(ground.interfaces) for n in edge}
    for (a, b), groups in ground.lines.items():
        for name in groups & set(ground.interfaces):
            for n in (a, b):
                count.setdefault(n, []).append(name)
    inner = sorted(n for n, names in count.items() if len(names) == 2 and len(set(names)) == 1 and n not in border)
    points, probes = {}, []

    def watch(name, node):
        points.setdefault(node, set()).add(name)
        probes.append(name)

    watch("P1", rng.choice(own("surface")))
    loose = [n for n in range(len(ground.places)) if n not in count]
    watch("P2", rng.choice([n for n in loose if n not in border]))  # a force acts there, so no support may hold it
    watch("P3", rng.choice(loose))
    for k, node in enumerate(rng.sample(inner, min(2, len(inner)))):
        watch(f"I{k + 1}", node)
        probes.append(f"I{k + 1}@ground")
    in_bodies = [n for nodes, groups in ground.quads if groups & set(ground.bodies) for n in nodes if n not in count]
    if in_bodies:
        watch("B1", rng.choice(in_bodies))
    return points, probes


def draw(rng):
    kind = rng.choice(grid.KINDS[1:] * 2 + pipes.KINDS * 3 + grid.KINDS[:1])
    ground = (pipes if kind in pipes.KINDS else grid).draw(rng, kind)
    width, height, side = ground.size
    if chance(rng, 0.3):
        top = [edge for edge, groups in ground.lines.items() if "surface" in groups]
        for edge in top[: rng.randint(1, len(top))]:
            ground.lines[edge].add("strip")
    points, probes = probe_points(rng, ground)
    drawing, order = finish(rng, ground, points)
    materials = draw_materials(rng, drawing)
    layers = [m for name, m in materials.items() if name.startswith("layer")]
    soft, speed = min(m["young"] for m in materials.values()), max(math.sqrt(oedometric(m) / m["density"]) for m in layers)
    static = chance(rng, 0.35)
    gravity = 9.81 if chance(rng, 0.35) else 0
    weight = 2000 * gravity * height
    supports, boundaries = draw_borders(rng, touches(ground))
    free_field = "free_field" in boundaries.values()
    time = {"step": 1, "end": rng.randint(1, 12)} if static else draw_time(rng, height / speed)
    span = time["end"]
    peak = log(rng, 1e3, 1e6) if not gravity else weight * log(rng, 0.3, 10)
    gaps = chance(rng, 0.25)
    interfaces = {name: draw_interface(rng, body, side, gaps, order) for name, body in ground.interfaces.items()}
    case = {"analysis": "static" if static else "dynamic", "materials": materials, "interfaces": interfaces,
            "supports": supports, "boundaries": boundaries, "time": time, "probes": probes,
            "output": {"every": time["end"]}}
    if not (gravity and chance(rng, 0.15)):
        case["loads"] = draw_loads(rng, drawing, ground.bodies, interfaces, span, peak, side, free_field, static, speed)
    if gravity:
        case["gravity"] = gravity
    if "loads" not in case or (not static and chance(rng, 0.06)):
        name = rng.choice(ground.bodies or ["layer_1"])
        if not static:
            case["initial"] = {name: {"velocity": [rng.uniform(-1, 1) * peak / speed / 2000 for _ in range(2)]}}
    if not static:
        damping = draw_damping(rng)
        if damping == {}:
            damping = {"alpha": log(rng, 0.05, 2) / span, "beta": log(rng, 0.02, 2) * time["step"]}
        if damping:
            if chance(rng, 0.2):
                damping["interfaces"] = True
            case["damping"] = damping
        if chance(rng, 0.15):
            case["mass"] = "lumped"
    if chance(rng, 0.2):
        case["elements"] = {"quad4": "b_bar"}
    settle = weight * height / soft
    u = max(1e-2 * settle, 1e-9 * peak * height / soft)
    step, energy = time["step"], u * max(weight, 1e-9 * peak) * width
    scale = {"step": step, "u": u, "v": u / step, "a": u / step**2, "energy": energy}
    return Case(drawing, case, ground.kind, features(case, order), scale)


def features(case, order):
    """Words for what may matter, to count failures by."""
    faces = case["interfaces"].values()
    friction = [i.get("friction", None) for i in faces]
    loads = [pulse for load in case.get("loads", []) for of_group in load.values() for pulse in of_group.values()]
    tests = {
        "order 2": order == 2,
        "gap": any("gap" in i for i in faces),
        "friction 0": 0 in friction or any(m.get("friction") == 0 for m in case["materials"].values()) and None in friction,
        "friction >= 0.8": any(f is not None and f >= 0.8 for f in friction),
        "gauss_1": any("integration" in i for i in faces),
        "gravity": "gravity" in case,
        "no load": "loads" not in case,
        "undamped": case["analysis"] == "dynamic" and "damping" not in case,
        "damping.interfaces": case.get("damping", {}).get("interfaces", False),
        "hht": "hht" in case["time"],
        "energy_tolerance": "energy_tolerance" in case["time"],
        "start rest": "start" in case["time"],
        "lumped": case.get("mass") == "lumped",
        "b_bar": "elements" in case,
        "viscous": "viscous" in case["boundaries"].values(),
        "free_field": "free_field" in case["boundaries"].values(),
        "front": any("front" in pulse or "at" in pulse.get("explosion", {}) for pulse in loads),
        "pulse ends": any(pulse["law"] in ("linear", "half_sine", "friedlander", "charge") for pulse in loads),
        "load on a joint": any(name.split("@")[0] in case["interfaces"] for load in case.get("loads", []) for name in load),
        "initial": "initial" in case,
    }
    return [name for name, holds in tests.items() if holds]
