"""The programs that run against each other, each a process of its own."""

import csv
import json
import os
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "target" / "release" / "coralpipe"
CASE = ROOT / "geo" / "twin_pipes.json"
MESH = ROOT / "meshes" / "twin_pipes.msh"
OUTPUT = ROOT / "output" / "bench"


class Failed(Exception):
    """A program that did not end well, with the end of what it said."""


@dataclass
class Setting:
    """What all compute: the default case over its whole time, C = alpha M + beta K."""

    alpha: float
    beta: float
    dt: float = 0.25e-3
    steps: int = 400


@dataclass
class Run:
    """`history`: displacements of the probes [m], a row a step; columns A.ux, A.uy, C.ux, ..."""

    history: np.ndarray
    steps: int
    steps_s: float
    """of all steps, without set-up"""
    wall_s: float
    """of the whole process"""
    version: str
    unknowns: int

    @property
    def step_s(self):
        return self.steps_s / self.steps


def watch(command, **environment):
    """Seconds of the whole process."""
    start = time.perf_counter()
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, env={**os.environ, **environment})
    if done.returncode != 0:
        said = (done.stdout + done.stderr).strip().splitlines()[-3:]
        raise Failed(f"{' '.join(map(str, command[:4]))} ... ended with {done.returncode}: {' / '.join(said)}")
    return time.perf_counter() - start


def coralpipe(setting, *, bonded=False, lumped=False) -> Run:
    """Two frames only, the first and the last state; the Newton tolerance is round-off, as the peers' is."""
    out, end = OUTPUT / "coralpipe", setting.steps * setting.dt
    sets = [f"time.step={setting.dt}", f"time.end={end}", f"output.every={end}", "newton.tolerance=1e-12",
            f'damping={{"alpha": {setting.alpha!r}, "beta": {setting.beta!r}}}',
            f"mass={'lumped' if lumped else 'consistent'}"]
    flags = ["--bonded"] if bonded else []
    settings = [x for s in sets for x in ("--set", s)]
    wall = watch([PROGRAM, "run", CASE, "--mesh", MESH, "--quiet", "--out", out, *flags, *settings])
    summary = json.loads((out / "summary.json").read_text())
    with (out / "histories.csv").open() as file:
        head, *rows = csv.reader(file)
    probes = json.loads(CASE.read_text())["probes"]
    columns = [head.index(f"{p}.{u}") for p in probes for u in ("ux", "uy")]
    history = np.array([[float(row[c]) for c in columns] for row in rows])
    return Run(history, summary["steps"], summary["timing"]["steps_s"], wall,
               f"coralpipe {summary['inputs']['coralpipe']}", summary["counts"]["unknowns"])


def peer(name, setting, *, bonded=False, lumped=False, law="coulomb", steps=None) -> Run:
    """A script of this folder, run by the Python that runs this."""
    out, steps = OUTPUT / f"{name}.json", steps or setting.steps
    flags = ["--bonded"] * bonded + ["--lumped"] * lumped
    wall = watch([sys.executable, "-m", f"bench.{name}", "--case", CASE, "--mesh", MESH, "--out", out, "--law", law,
                  "--alpha", repr(setting.alpha), "--beta", repr(setting.beta), "--dt", repr(setting.dt),
                  "--steps", str(steps), *flags], PYTHONPATH=str(ROOT / "scripts"))
    left = json.loads(out.read_text())
    return Run(np.load(out.with_suffix(".npy")), steps, left["steps_s"], wall, left["version"], left["unknowns"])


def difference(a: Run, b: Run) -> float:
    """Largest difference of a displacement over the largest displacement, as far as both go."""
    n = min(len(a.history), len(b.history))
    return float(np.abs(a.history[:n] - b.history[:n]).max() / np.abs(b.history[:n]).max())
