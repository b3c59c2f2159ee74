#!/usr/bin/env python3
"""Meshes and runs every case of geo/gallery/, and weighs its bodies.

    scripts/check_gallery.py [NAME ...] [--binary target/release/coralpipe] [--out output/gallery]

Each case runs under gravity alone, in statics, and under its blast. Each must end with exit code 0 and without warnings,
but for the one that a body is no pipe. Under gravity the weight of a body of an interface is the sum of its joints'
tractions, by their own quadrature, and of the forces of what is bonded to it, computed anew from the displacements; and
the reactions of the supports are the weight of the whole. Exit 1 with a sentence on failure.
"""

import argparse
import json
import os
import pathlib
import re
import subprocess
import sys
import time

import numpy as np

from book.element_forces import joint_forces, joint_sides, node_of, of_elements
from book.lib import Result

ROOT = pathlib.Path(__file__).resolve().parent.parent
GALLERY = ROOT / "geo" / "gallery"
GRAVITY = 9.81
STATICS = ["--set=analysis=static", "--set=loads={}", "--set=damping=null", "--set=time.step=1", "--set=time.end=1", "--set=output.every=1"]
# newton.tolerance is 1e-8 of the largest force of the joints, which is some times the weight of a light body
TOLERANCE = 1e-7
# boxes, blocks and arches are no rings; under gravity alone the curves of the loads have no use
EXPECTED = re.compile(r"rings.csv has no section forces of|groups of \S+ that the case does not use: [a-z, ]+$")


class Failure(Exception):
    """A sentence for the user."""


def value(text):
    """Number in SI of "30 GPa", "2500 kg/m^3" or a number."""
    factor = {"GPa": 1e9, "MPa": 1e6, "kPa": 1e3, "kg/m^3": 1.0}
    if not isinstance(text, str):
        return float(text)
    number, unit = text.split()
    return float(number) * factor[unit]


def run(binary, name, out, options=()):
    """The results of `coralpipe run`, checked for its exit code and its warnings."""
    path = os.pathsep.join([str(ROOT / ".venv" / "bin"), os.environ.get("PATH", "")])
    command = [str(binary), "run", str(GALLERY / f"{name}.json"), "--quiet", "--out", str(out), *options]
    ended = subprocess.run(command, cwd=ROOT, env={**os.environ, "PATH": path}, capture_output=True, text=True, encoding="utf-8")
    if ended.returncode != 0:
        raise Failure(f"{' '.join(command)} ends with exit code {ended.returncode}: {ended.stderr.strip()}")
    result = Result(out)
    strange = [warning for warning in result.summary["warnings"] if not EXPECTED.match(warning)]
    if strange:
        raise Failure(f"{' '.join(command)} warns: {strange[0]}")
    return result


class Balance:
    """Forces of a frame in equilibrium under gravity: upright and level, per metre [N/m]."""

    def __init__(self, frame, case):
        names = sorted(case["materials"])
        materials = [[value(case["materials"][name][key]) for key in ("young", "poisson", "density")] for name in names]
        self.frame, self.names, self.node = frame, names, node_of(frame)
        self.elements = of_elements(frame, materials, GRAVITY)
        # the elements' own weight is what gravity changes in their forces
        bare = of_elements(frame, materials)
        self.weights = np.array([(a - b)[:, 1].sum() for a, b in zip(self.elements, bare)])

    def of_material(self, name):
        return self.frame.material == self.names.index(name) + 1

    def weight(self, name):
        return self.weights[self.of_material(name)].sum()

    def on_body(self, name):
        """(force of the joints, force of what is bonded to it)."""
        mine, frame = self.of_material(name), self.frame
        nodes = set(np.concatenate([self.node[face] for face, inside in zip(frame.faces, mine) if inside]))
        joints = np.zeros(2)
        for force, (ground, body) in zip(joint_forces(frame), joint_sides(frame)):
            # a joint's middle node, or an end that is not shared, tells on which side the material lies
            joints += force * (all(self.node[n] in nodes for n in body) * 1 - all(self.node[n] in nodes for n in ground) * 1)
        bonded = np.zeros(2)
        for face, force, inside in zip(frame.faces, self.elements, mine):
            if not inside:
                bonded -= force[[self.node[n] in nodes for n in face]].sum(axis=0)
        return joints, bonded

    def reaction(self, groups):
        """Force of the supports on the nodes of the groups."""
        at_point = np.zeros_like(self.frame.points)
        for face, force in zip(self.frame.faces, self.elements):
            at_point[face] += force
        held = np.logical_or.reduce([self.frame.point_groups[group] for group in groups])
        return at_point[np.isin(self.node, self.node[held])].sum(axis=0)


def weigh(case, result):
    """Rows of the table: (body, weight, joints, bonded, error)."""
    balance = Balance(result.frame(), case)
    rows = []
    for body in sorted({interface["body"] for key, interface in case["interfaces"].items() if not key.startswith("_comment")}):
        weight, (joints, bonded) = balance.weight(body), balance.on_body(body)
        rows.append((body, weight, joints[1], bonded[1], np.hypot(*(joints + bonded - [0, weight])) / weight))
    whole, up = balance.weights.sum(), balance.reaction(["base"])[1]
    rows.append(("all", whole, 0.0, up, abs(up / whole - 1)))
    for body, weight, *_, error in rows:
        if not error < TOLERANCE:
            raise Failure(f"{case['title']}: what holds {body} and its weight of {weight:.6g} N/m miss each other by {error:.1e} of it")
    return rows


def check(name, binary, out):
    started = time.monotonic()
    case = json.loads((GALLERY / f"{name}.json").read_text(encoding="utf-8"))
    rows = weigh(case, run(binary, name, out / f"{name}_gravity", STATICS))
    blast = run(binary, name, out / name)
    counts, contact = blast.summary["counts"], blast.summary["contact"]
    print(f"{name}: {counts['nodes']} nodes, {counts['joints']} joints, at most {contact['max_open_points']} points open and "
          f"{contact['max_slipping_points']} slipping, {time.monotonic() - started:.1f} s")
    for body, weight, joints, bonded, error in rows:
        print(f"    {body:12} weighs {weight / 1e3:10.4f} kN/m; joints {joints / 1e3:10.4f}, "
              f"bonded or supports {bonded / 1e3:10.4f}; error {error:.1e}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", help="cases; default: all")
    parser.add_argument("--binary", type=pathlib.Path, default=os.environ.get("CORALPIPE") or ROOT / "target" / "release" / "coralpipe")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "output" / "gallery")
    arguments = parser.parse_args()
    known = sorted(path.stem for path in GALLERY.glob("*.json"))
    failed = 0
    for name in arguments.names or known:
        try:
            if name not in known:
                raise Failure(f"there is no case {name}; there are: {', '.join(known)}")
            check(name, arguments.binary, arguments.out)
        except Failure as failure:
            print(f"check_gallery: {failure}", file=sys.stderr)
            failed = 1
    return failed


if __name__ == "__main__":
    sys.exit(main())
