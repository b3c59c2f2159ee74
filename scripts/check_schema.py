#!/usr/bin/env python3
"""The schemas that `coralpipe schema` prints refuse what the program refuses, by a validator that is not coralpipe's.

    scripts/check_schema.py [--binary target/release/coralpipe] [--mutations 400] [--seed 1]

Every case of geo/ and every case of RIGHT must pass both; every case of WRONG must be refused by both. Then the cases are
changed at random: the program must accept just what the schema accepts, but for the sentences in BEYOND, which no schema
can say. Plans of sweeps are compared in the same way. Exit 1 with a list on failure.
"""

import argparse
import copy
import json
import pathlib
import random
import re
import subprocess
import sys
import tempfile

import jsonschema

ROOT = pathlib.Path(__file__).resolve().parent.parent

MESH = """$MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
3
1 0 0 0
2 1 0 0
3 0 1 0
$EndNodes
$Elements
1
1 2 2 1 1 1 2 3
$EndElements
"""

GROUND = {"young": "100 MPa", "poisson": 0.3, "density": 2000, "friction": 0.3}
PRESSURES = {
    "linear": {"law": "linear", "peak": "1 bar", "duration": "20 ms"},
    "step": {"law": "step", "peak": -3e5, "rise": "1 ms"},
    "table": {"law": "table", "times": [0, "5 ms"], "values": ["1 kPa", 0]},
    "file": {"law": "table", "file": "p.csv", "scale": 2},
    "ramp": {"law": "ramp", "peak": 1e5, "duration": 0.02, "start": "1 ms"},
    "half_sine": {"law": "half_sine", "peak": 1e5, "duration": 0.02, "rise": 0},
    "decay": {"law": "friedlander", "peak": "100 kPa", "duration": "20 ms", "decay": 1, "form": "tangent"},
    "impulse": {"law": "friedlander", "peak": "100 kPa", "duration": "20 ms", "impulse": "700 kPa ms",
                "negative_peak": "20 kPa", "negative_duration": "60 ms"},
    "distance": {"law": "charge", "explosion": {"charge": "1 t", "standoff": "30 m", "wave": "incident", "form": "tangent"},
                 "front": {"direction": [1, 0]}},
    "height": {"law": "charge", "explosion": {"charge": 500, "height": 30, "wave": "reflected", "formula": "sadovsky"}},
    "place": {"law": "charge", "explosion": {"charge": "1 t", "at": [-42.5, 0], "burst": "hemispherical", "wave": "incident",
                                             "clock": "detonation", "equivalence": 1.2}},
    "front": {"law": "linear", "peak": "1 bar", "duration": "20 ms", "front": {"speed": "479 m/s", "from": [0, "5 m"]}},
}
BASE = {
    "$schema": "../case.schema.json",
    "_comment": "made for a test",
    "title": "all keys",
    "geometry": {"script": "x.geo", "parameters": {"width": 3}, "unit": "mm"},
    "materials": {"ground": GROUND, "pipe": {"young": 2.1e11, "poisson": 0.3, "density": "7.8 t/m^3"}},
    "interfaces": {"ring": {"body": "pipe", "thickness": "1 cm", "integration": "lobatto", "friction": 0.2, "gap": 0,
                            "normal_stiffness": "1 GPa/m", "tangential_stiffness": 1e9}},
    "supports": {"base": ["x", "y"]},
    "boundaries": {"side": "free_field"},
    "loads": {"top": {"pressure": PRESSURES["linear"]}},
    "damping": {"ratio": 0.05, "modes": [1, 2], "interfaces": True},
    "gravity": "1 g",
    "initial": {"pipe": {"velocity": [0, "1 m/s"], "displacement": [0, 0]}},
    "elements": {"quad4": "b_bar"},
    "mass": "lumped",
    "time": {"step": "0.1 ms", "end": "10 ms", "newmark": {"alpha": 0.3025, "delta": 0.6}, "energy_tolerance": 0.01,
             "start": "rest"},
    "newton": {"tolerance": 1e-8, "max_iterations": 30},
    "probes": ["A", {"name": "P", "at": [1, "50 cm"], "body": "pipe"}],
    "output": {"every": "1 ms"},
}
REMOVE = object()


def changed(case, path, value):
    """A copy with the value at a dotted path replaced, or taken out."""
    case = copy.deepcopy(case)
    inner = case
    keys = [int(key) if key.isdigit() else key for key in path.split(".")]
    for key in keys[:-1]:
        inner = inner[key]
    if value is REMOVE:
        del inner[keys[-1]]
    else:
        inner[keys[-1]] = value
    return case


def loaded(load):
    return changed(BASE, "loads", {"top": load})


def right():
    yield "all keys", BASE
    for name, law in PRESSURES.items():
        yield f"pressure {name}", loaded({"pressure": law})
    along = {"direction": [3, -4]}
    for name in ["linear", "step", "table", "file", "ramp", "half_sine", "decay", "impulse"]:
        yield f"traction {name}", loaded({"traction": PRESSURES[name] | along})
    yield "body force", loaded({"body_force": {"law": "step", "peak": "4 kN/m^3", "direction": [0, -1]}})
    yield "force", loaded({"force": {"law": "table", "times": [0, 1], "values": [0, "6 kN/m"], "direction": [1, 0]}})
    yield "list of loads", changed(BASE, "loads", [{"top": {"pressure": law}} for law in PRESSURES.values()])
    yield "no loads", changed(BASE, "loads", {})
    yield "mesh", changed(BASE, "geometry", {"mesh": "x.msh"})
    yield "unit alone", changed(BASE, "geometry", {"unit": "in"})
    yield "no geometry", changed(BASE, "geometry", REMOVE)
    yield "coefficients", changed(BASE, "damping", {"alpha": "5 1/s", "beta": 0})
    yield "undamped", changed(BASE, "damping", None)
    yield "numerical damping", changed(BASE, "time", {"step": 1e-4, "end": 1e-2, "hht": -0.1})
    yield "static", changed(changed(changed(BASE, "time.energy_tolerance", REMOVE), "initial", {"_comment": 1}), "analysis", "static")
    comments = changed(BASE, "materials._comment", ["from", {"the": "report"}])
    for place in ["materials.ground", "loads", "loads.top", "loads.top.pressure", "probes.1", "time", "supports", "interfaces"]:
        comments = changed(comments, f"{place}._comment_2", "why")
    yield "comments", comments


def wrong():
    """(path, value) in BASE."""
    sets = [
        ("materials", REMOVE), ("time", REMOVE), ("materials.ground.young", REMOVE), ("materials.ground.young", 0),
        ("materials.ground.young", "-3 MPa"), ("materials.ground.young", "100 kg"), ("materials.ground.young", "0.00 MPa"),
        ("materials.ground.poisson", 0.5), ("materials.ground.poisson", -1), ("materials.ground.density", -2000),
        ("materials.ground.friction", -0.1), ("materials.ground.yuong", 1), ("interfaces.ring.body", REMOVE),
        ("interfaces.ring.thickness", 0), ("interfaces.ring.gap", "-1 mm"), ("interfaces.ring.integration", "gauss"),
        ("interfaces.ring.normal_stiffness", "5 MPa"), ("supports.base", "x"), ("supports.base", ["z"]),
        ("boundaries.side", "absorbing"), ("damping.ratio", 1), ("damping.ratio", REMOVE), ("damping.alpha", 5),
        ("damping.modes", [1]), ("damping.modes", [1, 1]), ("damping.modes", [0, 1]), ("gravity", -9.81), ("gravity", "-0.1 g"),
        ("initial.pipe.velocity", [1]), ("elements.quad4", "bbar"), ("mass", "Lumped"), ("time.step", 0), ("time.end", REMOVE),
        ("time.hht", -0.1), ("time.newmark.delta", 0.4), ("time.energy_tolerance", 1), ("time.start", "later"), ("time.zebra", 1),
        ("newton.tolerance", 0), ("newton.max_iterations", 0), ("newton.max_iterations", 2.5), ("analysis", "static"),
        ("probes.1.at", [1]), ("probes.1.at", REMOVE), ("probes.0", ""), ("probes.0", 5), ("output.every", "0 ms"), ("title", 5),
        ("tim", {}), ("geometry", {}), ("geometry.mesh", "x.msh"), ("geometry.unit", "yd"), ("geometry.unit", "MM"),
        ("geometry", {"mesh": "x.msh", "parameters": {"width": 3}}), ("geometry", {"unit": "mm", "parameters": {"a": 1}}),
        ("geometry.parameters.width", "wide"), ("loads", 5), ("loads.top", {}), ("loads.top.traction", PRESSURES["step"]),
        ("_coment", 1), ("$schema", 5), ("time", [1e-4, 1e-2]), ("materials.ground", [1e8, 0.3, 2000]), ("damping", [0.05]),
    ]
    for path, value in sets:
        yield f"{path} = {'removed' if value is REMOVE else json.dumps(value)}", changed(BASE, path, value)
    for name, path, value in [
        ("linear", "law", "linaer"), ("linear", "law", REMOVE), ("linear", "law", "step"), ("linear", "peak", REMOVE),
        ("linear", "peak", "1 kg"), ("linear", "duration", 0), ("linear", "direction", [1, 0]), ("linear", "start", -1),
        ("linear", "explosion", {}), ("step", "duration", 1), ("step", "rise", "-1 ms"), ("table", "values", REMOVE),
        ("table", "file", "p.csv"), ("table", "times", [0]), ("table", "times", [-1, 1]), ("ramp", "rise", "1 ms"),
        ("decay", "decay", -1), ("decay", "impulse", 700), ("decay", "decay", REMOVE), ("impulse", "negative_peak", REMOVE),
        ("impulse", "form", "tangent"), ("impulse", "negative_duration", "-1 ms"), ("distance", "explosion.standoff", REMOVE),
        ("distance", "explosion.clock", "arrival"), ("distance", "explosion.wave", REMOVE), ("distance", "explosion.charge", 0),
        ("distance", "explosion.explosive", "dynamite"), ("distance", "explosion.at", [0, 1]), ("place", "explosion.burst", REMOVE),
        ("place", "front", {"direction": [1, 0]}), ("front", "front.speed", REMOVE), ("front", "front.direction", [1, 0]),
        ("front", "front.from", REMOVE), ("front", "front.speed", "-1 m/s"),
    ]:
        law = changed(PRESSURES[name], path, value)
        yield f"pressure {name}: {path} = {'removed' if value is REMOVE else json.dumps(value)}", loaded({"pressure": law})
    for name, more in [
        ("linear", {}), ("linear", {"direction": [0, 0]}), ("linear", {"direction": [1, 0, 0]}), ("distance", {"direction": [1, 0]}),
        ("linear", {"direction": [1, 0], "front": {"speed": 1, "direction": [1, 0]}}),
    ]:
        yield f"traction {name}: {json.dumps(more)}", loaded({"traction": PRESSURES[name] | more})


# What two values decide together, what files hold, and how JSON writes numbers: no schema can say it.
BEYOND = [
    r"must be at least one step", r"at least one time step", r"not unconditionally stable", r"there is a probe .* already",
    r"as many values as times", r"must ascend", r"\"impulse\" is .* of peak times duration", r"\"rise\" replaces a jump",
    r"is out of|outside|range of|holds? from|between .* and .* m/kg|scaled distance", r"cannot read the table",
    r"must be a finite number", r"stands where a whole number",
]

PLAN = {
    "$schema": "sweep.schema.json",
    "_comment": "why",
    "case": "none.json",
    "set": {"loads.top.pressure.peak": ["50 kPa", 1e5], "_comment": [1, 1], "loads.top.pressure": [{"law": "step", "_comment": 1}]},
    "geo": {"spacing": [1.8, 2.4]},
    "bonded": False,
    "frames": True,
}
RIGHT_PLANS = [PLAN, {"case": "none.json", "geo": {"n": [1]}}, {"case": "none.json", "set": {"time.step": ["1 ms"]}}]
WRONG_PLANS = [
    changed(PLAN, path, value)
    for path, value in [
        ("case", REMOVE), ("case", 5), ("set", []), ("set.time", "1 ms"), ("set.time", []), ("set.time", [1, 1.0]), ("geo.n", 5),
        ("geo.n", ["2"]), ("geo.n", [2, 2]), ("bonded", "yes"), ("frames", None), ("sets", {}), ("$schema", 5),
    ]
] + [{"case": "none.json"}, {"case": "none.json", "set": {}, "geo": {"_comment": [1]}}, [], 5]

VALUES = [
    None, True, False, 0, 1, -1, 2, 0.5, -0.2, 1e-4, 1e7, -0.0, "", "x", "y", "A", "1 m", "-1 ms", "0 kPa", "3 kPa", "2 ms", "1 kg", "-0.0 s",
    "+.5e1 m", "1 MPa/m", "10 t", "1 g", "linear", "step", "static", "lumped", "friedlander", "viscous", "mm", "p.csv", [], [0, 0], [1, 2],
    [0, "1 ms"], [1, 2, 3], ["x"], {}, {"_comment": 1}, {"x": 1},
]


def places(value, place=()):
    """The path of everything inside a value."""
    inner = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else []
    for key, deeper in inner:
        yield (*place, key)
        yield from places(deeper, (*place, key))


def mutated(rng, value):
    """A key taken out, renamed or added, or a value replaced by another, also one from elsewhere in the case."""
    value = copy.deepcopy(value)
    paths = list(places(value))
    *way, last = rng.choice(paths)
    inner = value
    for key in way:
        inner = inner[key]
    kind = rng.choice(["replace", "replace", "borrow", "remove", "rename", "add"])
    other = rng.choice(VALUES)
    if kind == "borrow":
        other = value
        for key in rng.choice(paths):
            other = other[key]
        other = copy.deepcopy(other)
    if kind in ("replace", "borrow"):
        inner[last] = other
    elif kind == "remove" or isinstance(inner, list):
        del inner[last]
    else:
        keys = [key for path in paths for key in path if isinstance(key, str)]
        moved = inner.pop(last) if kind == "rename" else other
        inner[rng.choice(keys + ["zebra", "_comment_3"])] = moved
    return value


class Judge:
    """The program's and the schema's opinion of a file."""

    def __init__(self, binary, folder):
        self.binary, self.folder = binary, folder
        self.case_schema, self.plan_schema = self.validator([]), self.validator(["--sweep"])
        (folder / "tiny.msh").write_text(MESH)
        (folder / "p.csv").write_text("t,p\n0,1\n1,0\n")

    def validator(self, options):
        printed = subprocess.run([self.binary, "schema", *options], check=True, capture_output=True, text=True).stdout
        schema = json.loads(printed)
        jsonschema.Draft202012Validator.check_schema(schema)
        return jsonschema.Draft202012Validator(schema)

    def run(self, *arguments):
        return subprocess.run([self.binary, *arguments], cwd=self.folder, capture_output=True, text=True)

    def case(self, case):
        """(why the program refuses it, whether the schema accepts it)"""
        (self.folder / "c.json").write_text(json.dumps(case))
        run = self.run("mesh", "c.json", "--mesh", "tiny.msh")
        if run.returncode not in (0, 1):
            sys.exit(f"the program ended with {run.returncode} on {json.dumps(case)}: {run.stderr}")
        return run.stderr if run.returncode else None, self.case_schema.is_valid(case)

    def plan(self, plan):
        """A plan is accepted where the next thing that is missing is its case."""
        (self.folder / "plan.json").write_text(json.dumps(plan))
        run = self.run("sweep", "plan.json")
        return None if "cannot read the case" in run.stderr else run.stderr, self.plan_schema.is_valid(plan)


def check(judge, mutations, rng):
    """Sentences on what does not fit."""
    def compare(name, opinion, accepted):
        why, valid = opinion
        if (why is None) != accepted:
            yield f"{name}: the program {'accepts' if why is None else f'refuses ({why.strip()})'}"
        if valid != accepted:
            yield f"{name}: the schema {'accepts' if valid else 'refuses'}"

    for path in sorted((ROOT / "geo").rglob("*.json")):
        if not judge.case_schema.is_valid(json.loads(path.read_text())):
            yield f"{path}: the schema refuses"
    rights, wrongs = list(right()), list(wrong())
    for name, case in rights:
        yield from compare(name, judge.case(case), True)
    for name, case in wrongs:
        yield from compare(name, judge.case(case), False)
    for law in ["linaer", "Step", "triangle", 5]:
        case = loaded({"pressure": PRESSURES["linear"] | {"law": law}})
        if "$.loads.top.pressure.law" not in [error.json_path for error in judge.case_schema.iter_errors(case)]:
            yield f"the law {law} is not reported at its place"
    for number, plan in enumerate(RIGHT_PLANS):
        yield from compare(f"plan {number}", judge.plan(plan), True)
    for plan in WRONG_PLANS:
        yield from compare(f"plan {json.dumps(plan)}", judge.plan(plan), False)
    counts = {"accepted": 0, "refused": 0, "beyond": 0}
    for _ in range(mutations):
        name, case = rng.choice(rights)
        for _ in range(rng.randint(1, 2)):
            case = mutated(rng, case)
        why, valid = judge.case(case)
        if why is not None and valid and any(re.search(sentence, why) for sentence in BEYOND):
            counts["beyond"] += 1
        elif (why is None) != valid:
            yield f"{name}, changed: the schema {'accepts' if valid else 'refuses'}, the program says {why}: {json.dumps(case)}"
        else:
            counts["accepted" if valid else "refused"] += 1
    for _ in range(mutations // 4):
        plan = mutated(rng, PLAN)
        why, valid = judge.plan(plan)
        if (why is None) != valid:
            yield f"plan: the schema {'accepts' if valid else 'refuses'}, the program says {why}: {json.dumps(plan)}"
    print(f"{len(rights)} cases accepted and {len(wrongs)} refused by program and schema; {mutations} changed at random: "
          f"{counts['accepted']} accepted and {counts['refused']} refused by both, {counts['beyond']} by what no schema can say")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--binary", default=ROOT / "target/release/coralpipe", type=pathlib.Path)
    parser.add_argument("--mutations", default=400, type=int)
    parser.add_argument("--seed", default=1, type=int)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        judge = Judge(options.binary.resolve(), pathlib.Path(folder))
        failures = list(check(judge, options.mutations, random.Random(options.seed)))
    if failures:
        sys.exit("\n".join(failures))


if __name__ == "__main__":
    main()
