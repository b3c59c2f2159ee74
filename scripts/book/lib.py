"""What the cases share: runs of the program, their results as arrays, rows of comparison, pages."""

import csv
import json
import os
import re
import shlex
import subprocess
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from types import SimpleNamespace
from typing import Callable

import meshio
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
BINARY = "coralpipe.exe" if os.name == "nt" else "coralpipe"
PROGRAM = os.environ.get("CORALPIPE") or ROOT / "target" / "release" / BINARY
OUTPUT = Path("output") / "book"
CASES = Path("geo") / "verification"


class Failed(Exception):
    """A run of the program that did not end well, with what it said."""


@dataclass
class Row:
    """One number of the program beside its reference."""

    quantity: str
    reference: float
    value: float
    tolerance: float
    unit: str = ""
    relative: bool = True
    """of the reference; else the error is a difference in the row's unit"""
    why: str = ""
    """where the tolerance comes from"""
    bound: str = ""
    """"least" or "most": the reference is a bound, and only a value beyond it is an error"""
    quick: tuple = ()
    """(tolerance, reason) of the quick form, where its coarser mesh needs another"""

    @property
    def error(self) -> float:
        difference = abs(self.value - self.reference)
        if self.bound and (self.value >= self.reference) == (self.bound == "least") and difference == difference:
            return 0.0
        return difference / abs(self.reference) if self.relative else difference

    def allowed(self, quick: bool) -> float:
        return self.quick[0] if quick and self.quick else self.tolerance

    def holds(self, quick: bool) -> bool:
        return bool(self.error <= self.allowed(quick))  # NaN does not


@dataclass
class Page:
    """A case of the book."""

    name: str
    title: str
    items: list
    """numbers in the list of verification cases"""
    problem: str
    reference: str
    rows: list
    notes: str = ""
    """what was assumed, what misses"""
    code: list = field(default_factory=list)
    """what computes it: a file of the repository, or file::function"""
    plot: Callable | None = None
    """draws into a matplotlib Axes"""
    tables: list = field(default_factory=list)
    """further tables: (heading, [column, ...], [[text, ...], ...])"""
    example: tuple = ()
    """(a `Result`, where in its folder which number of the page stands)"""
    commands: list = field(default_factory=list)
    """every call of the program, as typed"""

    def holds(self, quick: bool) -> bool:
        return bool(self.rows) and all(row.holds(quick) for row in self.rows)


class Result:
    """The results folder of a run, and the command that made it."""

    def __init__(self, folder: Path, command: str = ""):
        self.folder = Path(folder)
        self.command = command
        self._frames = {}

    @cached_property
    def summary(self) -> dict:
        return json.loads((self.folder / "summary.json").read_text(encoding="utf-8"))

    @cached_property
    def histories(self) -> dict:
        """Column -> values: "t", then "A.ux", "A.uy", "A.vx", ... of every probe."""
        return table(self.folder / "histories.csv")

    def rings(self) -> dict:
        """Columns of rings.csv; "body" as text, the others as numbers."""
        return table(self.folder / "rings.csv")

    def frame(self, i: int = -1) -> SimpleNamespace:
        """One written moment: see `read_frame`."""
        files = sorted((self.folder / "frames").glob("*.vtu"))
        path = files[i]
        if path not in self._frames:
            self._frames[path] = read_frame(path)
        return self._frames[path]


class Book:
    """Runs the program, each set of arguments once."""

    def __init__(self, quick: bool):
        self.quick = quick
        self.commands = []
        self._results = {}

    def run(self, case, *, sets=None, geo=None, mesh=None, tag="", bonded=False) -> Result:
        """`coralpipe run` of geo/verification/CASE.json (or of a path).

        sets: dotted path -> value of any JSON kind; geo: constant -> number; mesh: a .msh in place of the script's;
        tag: folder beside other runs of the case, made from the arguments where none is given.
        """
        arguments = self._arguments(case, sets or {}, geo or {}, mesh) + (["--bonded"] if bonded else [])
        key = tuple(arguments)
        if key not in self._results:
            folder = OUTPUT / ("quick" if self.quick else "full") / Path(case).stem / (tag or label(sets, geo, bonded))
            if any(folder == other.folder for other in self._results.values()):
                folder = folder.with_name(f"{folder.name}_{len(self._results)}")
            command(["run", *arguments, "--quiet", "--out", str(folder)])
            self.commands.append(typed(["run", *arguments]))
            self._results[key] = Result(ROOT / folder, self.commands[-1])
        return self._results[key]

    def modes(self, case, n: int, *, sets=None, geo=None, mesh=None) -> list:
        """The lowest n natural frequencies [Hz], from the table `coralpipe modes` prints."""
        out = OUTPUT / ("quick" if self.quick else "full") / Path(case).stem / "modes"
        arguments = ["modes", *self._arguments(case, sets or {}, geo or {}, mesh), "-n", str(n)]
        text = command([*arguments, "--out", str(out)])
        self.commands.append(typed(arguments))
        return [float(m.group(1)) for m in re.finditer(r"^ *\d+ +([-+.\deE]+) ", text, re.M)]

    @staticmethod
    def _arguments(case, sets, geo, mesh) -> list:
        path = case if str(case).endswith(".json") else CASES / f"{case}.json"
        arguments = [str(path)]
        arguments += [f"--geo={name}={number(value)}" for name, value in geo.items()]
        arguments += [f"--set={path}={json.dumps(plain(value))}" for path, value in sets.items()]
        return arguments + (["--mesh", str(mesh)] if mesh else [])


def command(arguments: list) -> str:
    """What the program prints; `Failed` with what it says if it ends with another code than 0."""
    path = os.pathsep.join([str(ROOT / ".venv" / "bin"), os.environ.get("PATH", "")])
    run = subprocess.run([str(PROGRAM), *arguments], cwd=ROOT, env={**os.environ, "PATH": path}, capture_output=True,
                         text=True, encoding="utf-8")
    if run.returncode != 0:
        raise Failed(f"coralpipe {' '.join(arguments)} ended with exit code {run.returncode}: {run.stderr.strip()[-2000:]}")
    return run.stdout


def typed(arguments: list) -> str:
    """The command line of a call, for a shell."""
    return shlex.join(["coralpipe", *map(str, arguments)])


def number(value) -> str:
    return repr(int(value)) if float(value).is_integer() else repr(float(value))


def plain(value):
    """The value with numpy's types made JSON's."""
    return json.loads(json.dumps(value, default=lambda v: v.tolist()))


def label(sets, geo, bonded) -> str:
    """A folder's name from the arguments."""
    parts = [f"{name}{number(value)}" for name, value in (geo or {}).items()]
    parts += [f"{path.split('.')[-1]}{json.dumps(plain(value))}" for path, value in (sets or {}).items()]
    text = re.sub(r"[^\w.+-]+", "_", "_".join(parts + ["bonded"] * bonded)).strip("_")
    return text[:80] or "default"


def table(path: Path) -> dict:
    """A CSV with a heading: column -> array of numbers, or of texts. Lines that start with # are comments."""
    with open(path, encoding="utf-8", newline="") as file:
        rows = list(csv.reader(line for line in file if not line.startswith("#")))
    columns = {}
    for i, name in enumerate(rows[0]):
        texts = [row[i] for row in rows[1:] if row]
        try:
            columns[name.strip()] = np.array([float(text) for text in texts])
        except ValueError:
            columns[name.strip()] = np.array(texts)
    return columns


def reference(name: str, until: float, count: int) -> dict:
    """A table of scripts/book/reference/ with `count` times "t_ms" that end at `until` [ms]; `Failed` if it is not whole."""
    path = Path(__file__).parent / "reference" / name
    if not path.is_file():
        raise Failed(f"the reference scripts/book/reference/{name} is missing; it belongs to the repository: `git checkout` it")
    columns = table(path)
    times = columns["t_ms"]
    if len(times) != count or abs(times[-1] - until) > 1e-6 * until or (np.diff(times) <= 0).any():
        raise Failed(f"the reference scripts/book/reference/{name} has {len(times)} rows and ends at {times[-1]:g} ms; whole, it "
                     f"has {count}, in order, and ends at {until:g} ms: `git checkout` it")
    return columns


FACES = {"triangle": 3, "quad": 4, "triangle6": 3, "quad8": 4}


def read_frame(path: Path) -> SimpleNamespace:
    """A frame as arrays.

    points (n, 2) [m], one for each material at a node; displacement, velocity, acceleration (n, 2); nodal_stress (n, 4):
    xx, yy, zz, xy recovered at the points; faces: list of node lists, all elements in the file's order; kinds: their
    types; centres (m, 2): where stress holds; stress, strain (m, 4): xx, yy, zz, xy;
    material (m,): place of the group among the case's materials by name, from 1; joints: node lists of the ground's
    side, with gap, slip, normal_traction, shear_traction, status (k,) each, traction_vector (k, 2) on the body; point_groups,
    cell_groups, joint_groups: name of a group -> whether a point, an element or a joint belongs to it.
    """
    mesh = meshio.read(path)
    points = mesh.points[:, :2]
    motion = {name: mesh.point_data[name][:, :2] for name in ["displacement", "velocity", "acceleration"]}
    frame = SimpleNamespace(points=points, nodal_stress=mesh.point_data["nodal_stress"][:, :4], **motion)
    face_blocks = [i for i, block in enumerate(mesh.cells) if block.type in FACES]
    line_blocks = [i for i, block in enumerate(mesh.cells) if block.type not in FACES]
    joined = lambda name, blocks: np.concatenate([np.asarray(mesh.cell_data[name][i]) for i in blocks] or [np.zeros(0)])
    frame.faces = [cell for i in face_blocks for cell in mesh.cells[i].data.astype(int)]
    frame.kinds = [mesh.cells[i].type for i in face_blocks for _ in mesh.cells[i].data]
    frame.centres = np.array([centre(kind, points[cell]) for kind, cell in zip(frame.kinds, frame.faces)])
    frame.stress = joined("stress", face_blocks).reshape(-1, 6)[:, :4]
    frame.strain = joined("strain", face_blocks).reshape(-1, 6)[:, :4]
    frame.material = joined("material", face_blocks)
    frame.joints = [cell for i in line_blocks for cell in mesh.cells[i].data.astype(int)]
    for name in ["gap", "slip", "normal_traction", "shear_traction", "status"]:
        setattr(frame, name, joined(name, line_blocks))
    frame.traction_vector = joined("traction_vector", line_blocks).reshape(-1, 3)[:, :2]
    frame.point_groups = {name: array == 1 for name, array in groups(mesh.point_data).items()}
    frame.cell_groups = {name: joined(f"group_{name}", face_blocks) == 1 for name in groups(mesh.cell_data)}
    frame.joint_groups = {name: joined(f"group_{name}", line_blocks) == 1 for name in groups(mesh.cell_data)}
    return frame


def groups(arrays: dict) -> dict:
    """Name of the group -> its array, of the arrays called group_NAME."""
    return {name.removeprefix("group_"): array for name, array in arrays.items() if name.startswith("group_")}


def centre(kind: str, nodes: np.ndarray) -> np.ndarray:
    """Image of the reference element's centre, where the program gives stress."""
    corners = FACES[kind]
    if len(nodes) == corners:
        return nodes.mean(axis=0)
    if kind == "triangle6":
        return -nodes[:3].sum(axis=0) / 9 + 4 * nodes[3:].sum(axis=0) / 9
    return -nodes[:4].sum(axis=0) / 4 + nodes[4:].sum(axis=0) / 2


def polar(tensors: np.ndarray, angles: np.ndarray) -> np.ndarray:
    """(rr, tt, zz, rt) of (xx, yy, zz, xy) at the angles [rad] of their places."""
    xx, yy, zz, xy = tensors.T
    c, s = np.cos(angles), np.sin(angles)
    rr = xx * c * c + yy * s * s + 2 * xy * s * c
    tt = xx * s * s + yy * c * c - 2 * xy * s * c
    return np.stack([rr, tt, zz, (yy - xx) * s * c + xy * (c * c - s * s)], axis=1)


def step(peak, direction=None) -> dict:
    """The law that acts from t = 0 on, in full."""
    return {"law": "step", "peak": peak, **({"direction": direction} if direction is not None else {})}


def order(sizes, errors) -> float:
    """Slope of log error over log size between the two finest."""
    (h0, h1), (e0, e1) = sizes[-2:], errors[-2:]
    return float(np.log(e0 / e1) / np.log(h0 / h1))


def write_msh(path: Path, nodes, cells) -> Path:
    """A small mesh as MSH 2.2 text. nodes: (x, y) each; cells: (group, kind, node numbers from 0), kind as in meshio."""
    kinds = {"vertex": (15, 0), "line": (1, 1), "line3": (8, 1), "triangle": (2, 2), "quad": (3, 2),
             "triangle6": (9, 2), "quad8": (16, 2)}
    groups = list(dict.fromkeys((kinds[kind][1], group) for group, kind, _ in cells))
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(groups))]
    lines += [f'{dimension} {i + 1} "{name}"' for i, (dimension, name) in enumerate(groups)]
    lines += ["$EndPhysicalNames", "$Nodes", str(len(nodes))]
    lines += [f"{i + 1} {float(x)!r} {float(y)!r} 0" for i, (x, y) in enumerate(nodes)]
    lines += ["$EndNodes", "$Elements", str(len(cells))]
    for i, (group, kind, places) in enumerate(cells):
        gmsh_type, dimension = kinds[kind]
        tag = groups.index((dimension, group)) + 1
        lines.append(f"{i + 1} {gmsh_type} 2 {tag} {tag} " + " ".join(str(int(n) + 1) for n in places))
    lines += ["$EndElements", ""]
    path = ROOT / path
    path.parent.mkdir(parents=True, exist_ok=True)
    text = "\n".join(lines)
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")
    return path.relative_to(ROOT)


def say(value: float) -> str:
    """A number for a table."""
    if value == 0 or not np.isfinite(value):
        return f"{value:g}"
    if 1e-3 <= abs(value) < 1e6:
        return f"{value:.7g}"
    return f"{value:.6e}"
