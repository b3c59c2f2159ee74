#!/usr/bin/env python3
"""Meshes and checks random geometries: each must mesh and pass `coralpipe check`, or stop with a sentence; none may panic.

    scripts/random_geometries.py 50 1 [--binary target/release/coralpipe] [--case geo/twin_pipes.json]

Pipes cross layers, come in ones to fours, in both orders and both ground elements; about one set in six is impossible
on purpose. What meshes is also checked against exact areas by check_mesh.py. Works on copies in a temporary folder.
"""

import argparse
import json
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile

import check_mesh

ROOT = pathlib.Path(__file__).resolve().parent.parent


def plausible(rng):
    """A set that can usually be built, with rounded values so that lines meet crowns and axes now and then."""
    outer = rng.choice([0.4, 0.6, 1.0, 1.2, 2.0, 3.0])
    crown = round(rng.uniform(0.3, 6.0), 1)
    first = round(rng.uniform(0.3, 5.0), 1)
    second = round(first + rng.uniform(0.3, 5.0), 1)
    around = rng.choice([16, 24, 32, 50, 64])
    edge = 3.1416 * outer / around
    return {
        "width": rng.choice([12, 20, 25, 40]),
        "height": round(max(second, crown + outer) + rng.uniform(0.5, 8.0), 1),
        "layer_1_depth": first,
        "layer_2_depth": second,
        "pipes": rng.randint(1, 4),
        "crown": crown,
        "spacing": round(outer * rng.uniform(1.1, 3.0), 2),
        "outer": outer,
        "inner": round(outer * rng.uniform(0.5, 0.95), 3),
        "around": around,
        "through": rng.randint(1, 4),
        "size_near": round(edge * rng.uniform(0.7, 1.5), 3),
        "size_far": round(rng.uniform(0.5, 1.5), 2),
        "ground_nodes": rng.choice([3, 4]),
        "order": rng.choice([1, 2]),
    }


def impossible(rng):
    """A set with one thing that cannot be."""
    values = plausible(rng)
    spoil = {
        "pipes": rng.choice([0, 5, 2.5]),
        "spacing": values["outer"] * 0.9,
        "crown": rng.choice([-1, 0, 100]),
        "inner": values["outer"] * rng.choice([1, 1.5]),
        "outer": rng.choice([0, -1]),
        "layer_2_depth": values["layer_1_depth"] * 0.5,
        "layer_1_depth": values["crown"],
        "height": values["crown"],
        "width": rng.choice([0, values["outer"]]),
        "around": rng.choice([0, -8, 16.5]),
        "through": 0,
        "size_near": rng.choice([0, -1]),
        "ground_nodes": 5,
        "order": rng.choice([0, 3]),
    }
    name = rng.choice(sorted(spoil))
    if name == "spacing":
        values["pipes"] = rng.randint(2, 4)
    return {**values, name: spoil[name]}


def draw(rng):
    """(parameters, whether they are impossible on purpose)"""
    spoiled = rng.random() < 1 / 6
    return (impossible(rng) if spoiled else plausible(rng)), spoiled


def case_for(case, pipes):
    """The case with as many pipes as the geometry: further ones are made like the left one."""
    names = check_mesh.pipe_names(int(pipes))
    materials = {k: v for k, v in case["materials"].items() if not k.startswith("pipe_")}
    steel, joint = case["materials"]["pipe_left"], case["interfaces"]["interface_left"]
    materials.update({f"pipe_{n}": steel for n in names})
    interfaces = {f"interface_{n}": {**joint, "body": f"pipe_{n}"} for n in names}
    return {**case, "materials": materials, "interfaces": interfaces}


def ran_well(done):
    """True for exit 0, False for exit 1 with a sentence; anything else is a failure."""
    said = done.stderr.strip()
    if "panicked" in done.stderr or done.returncode not in (0, 1):
        raise check_mesh.Failure(f"ended with code {done.returncode}: {said[-400:]}")
    if done.returncode == 1 and len(said.split()) < 5:
        raise check_mesh.Failure(f"stopped without a sentence: {said!r}")
    return done.returncode == 0


def with_gmsh():
    """The environment, with the gmsh of this project named: the geometries are drawn far from its .venv."""
    ours = ROOT / ".venv/bin/gmsh"
    return {**({"CORALPIPE_GMSH": str(ours)} if ours.exists() else {}), **os.environ}


def try_one(binary, case_file, values, folder):
    """'meshed' or the sentence it stopped with."""
    case = json.loads(case_file.read_text())
    (folder / "geo").mkdir()
    (folder / "meshes").mkdir()
    shutil.copy(case_file.parent / case["geometry"]["script"], folder / "geo")
    copy = folder / "geo" / case_file.name
    copy.write_text(json.dumps(case_for(case, min(max(values["pipes"], 1), 4))))
    geo = [word for name, value in values.items() for word in ("--geo", f"{name}={value}")]
    for command in ("mesh", "check"):
        words = [str(binary), command, str(copy), *geo]
        done = subprocess.run(words, cwd=folder, capture_output=True, text=True, timeout=120, env=with_gmsh())
        if not ran_well(done):
            return done.stderr.strip().splitlines()[-1]
    for mesh in folder.rglob("*.msh"):
        check_mesh.check(mesh, None)
    return "meshed"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("count", type=int)
    parser.add_argument("seed", type=int)
    parser.add_argument("--binary", type=pathlib.Path, default=ROOT / "target/release/coralpipe")
    parser.add_argument("--case", type=pathlib.Path, default=ROOT / "geo/twin_pipes.json")
    args = parser.parse_args()
    rng = random.Random(args.seed)
    meshed = 0
    for number in range(args.count):
        values, spoiled = draw(rng)
        with tempfile.TemporaryDirectory() as folder:
            try:
                outcome = try_one(args.binary.resolve(), args.case.resolve(), values, pathlib.Path(folder))
                if spoiled and outcome == "meshed":
                    raise check_mesh.Failure("was meshed although it is impossible")
            except (check_mesh.Failure, subprocess.TimeoutExpired) as failure:
                words = " ".join(f"--geo {name}={value}" for name, value in values.items())
                sys.exit(f"geometry {number} of seed {args.seed} {failure}\n  {words}")
        meshed += outcome == "meshed"
        print(f"{number:4}  {outcome}")
    if meshed < args.count / 3:
        sys.exit(f"Only {meshed} of {args.count} random geometries were meshed: the draw tests too little.")
    print(f"{meshed} of {args.count} random geometries were meshed and are right; the rest stopped with a sentence.")


if __name__ == "__main__":
    main()
