#!/usr/bin/env python3
"""Checks the results of a run with readers that are not coralpipe's: meshio and VTK.

    scripts/check_output.py output/twin_pipes

Both open every frame that the .pvd names, agree bit for bit, find every array there, and show at the probes the
displacements, velocities and accelerations that histories.csv has at the same time. What is derived is computed once more
from what it comes from: principal stresses by numpy's eigenvalues, hoop and radial stress about a circle through the
interface, vectors on the interfaces from scalars and geometry, jumps from displacements. meshio converts the last frame
to .vtu and .vtk and reads both back. Exit 1 with a sentence on failure.
"""

import argparse
import contextlib
import csv
import io
import json
import pathlib
import sys
import tempfile
import xml.etree.ElementTree as xml

import meshio
import meshio._cli
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkDataArray
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

MOTION_ARRAYS = {"displacement": 3, "velocity": 3, "acceleration": 3}
POINT_ARRAYS = MOTION_ARRAYS | {"nodal_stress": 6, "nodal_von_mises": 1}
PRINCIPAL = ["principal_stress_1", "principal_stress_2", "principal_stress_3"]
POLAR = ["hoop_stress", "radial_stress"]
FACE_ARRAYS = {"stress": 6, "strain": 6, "von_mises": 1, "material": 1} | {name: 1 for name in PRINCIPAL + POLAR}
VECTORS = ["gap_vector", "slip_vector", "jump_vector", "traction_vector"]
JOINT_ARRAYS = {"gap": 1, "slip": 1, "normal_traction": 1, "shear_traction": 1, "status": 1} | {name: 3 for name in VECTORS}
UNITS = {"displacement": "m", "velocity": "m/s", "acceleration": "m/s2", "strain": None, "status": "1 sticks; 2 slips; 3 open"}
UNITS |= {name: "m" for name in ("gap", "slip", "gap_vector", "slip_vector", "jump_vector")}
LINES = {"line", "line3"}
SINGLE = 2.0**-23  # relative spacing of numbers in single precision


class Failure(Exception):
    """A sentence for the user."""


def require(condition, sentence):
    if not condition:
        raise Failure(sentence)


def series_of(folder):
    """[(time as written, path)] of the one .pvd in the folder."""
    files = sorted(folder.glob("*.pvd"))
    require(len(files) == 1, f"{folder} should hold one .pvd file, but holds {len(files)}")
    entries = xml.parse(files[0]).getroot().iter("DataSet")
    frames = [(e.get("timestep"), folder / e.get("file")) for e in entries]
    require(frames, f"{files[0]} names no frame")
    times = [float(t) for t, _ in frames]
    require(all(a < b for a, b in zip(times, times[1:])), f"the times in {files[0]} do not rise from frame to frame")
    for _, path in frames:
        require(path.exists(), f"{files[0]} names {path}, which does not exist")
    return frames


def by_meshio(path):
    """({name: point array}, {name: cell array}, points, [node lists], {name: field array}, is a line), cells in order."""
    mesh = meshio.read(path)
    for block in mesh.cells:
        require(block.data.dtype.kind in "iu", f"meshio reads node numbers of {path} as {block.data.dtype}, and cannot index with them")
        require(np.isfinite(mesh.points[block.data]).all(), f"a cell of {path} has a node whose place is not finite")
    cells = [row for block in mesh.cells for row in block.data]
    line = np.concatenate([np.full(len(block.data), block.type in LINES) for block in mesh.cells])
    data = {name: np.concatenate(blocks) for name, blocks in mesh.cell_data.items()}
    return mesh.point_data, data, mesh.points, cells, mesh.field_data, line


def by_vtk(path):
    """The same by VTK, with the arrays' units instead of the line flags."""
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    require(reader.GetErrorCode() == 0, f"VTK cannot read {path} (error {reader.GetErrorCode()})")
    grid = reader.GetOutput()
    arrays, units = [], {}
    for data in (grid.GetPointData(), grid.GetCellData(), grid.GetFieldData()):
        each = [data.GetArray(i) for i in range(data.GetNumberOfArrays())]
        arrays.append({a.GetName(): vtk_to_numpy(a) for a in each})
        units |= {a.GetName(): a.GetInformation().Get(vtkDataArray.UNITS_LABEL()) for a in each}
    starts = vtk_to_numpy(grid.GetCells().GetOffsetsArray())
    nodes = vtk_to_numpy(grid.GetCells().GetConnectivityArray())
    cells = [nodes[a:b] for a, b in zip(starts, starts[1:])]
    return arrays[0], arrays[1], vtk_to_numpy(grid.GetPoints().GetData()), cells, arrays[2], units


def same_bits(a, b):
    return a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes()


def components(array):
    return 1 if array.ndim == 1 else array.shape[1]


def check_arrays(path, found, expected, where):
    for name, width in expected.items():
        require(name in found, f'{path} has no {where} array "{name}"; it has: {", ".join(sorted(found))}')
        require(
            components(found[name]) == width,
            f'the {where} array "{name}" of {path} has {components(found[name])} components instead of {width}',
        )


def check_finite(path, cell_data, line):
    """Values where they belong; what belongs elsewhere is NaN or 0."""
    for names, there in ((FACE_ARRAYS, ~line), (JOINT_ARRAYS, line)):
        for name in names:
            array = cell_data[name].astype(float)
            require(np.isfinite(array[there]).all(), f'the array "{name}" of {path} is not finite on its own cells')
            absent = np.nan_to_num(array[~there]) == 0
            require(name == "material" or absent.all(), f'the array "{name}" of {path} has values on cells it does not belong to')


def check_agreement(path, mine, theirs):
    for kind, a, b in (("point", mine[0], theirs[0]), ("cell", mine[1], theirs[1]), ("field", mine[4], theirs[4])):
        require(set(a) == set(b), f"meshio and VTK find different {kind} arrays in {path}")
        for name in a:
            require(same_bits(a[name], b[name]), f'meshio and VTK read different values of the {kind} array "{name}" in {path}')
    require(same_bits(mine[2], theirs[2]), f"meshio and VTK read different points in {path}")
    same = len(mine[3]) == len(theirs[3]) and all(np.array_equal(a, b) for a, b in zip(mine[3], theirs[3]))
    require(same, f"meshio and VTK read different cells in {path}")


def converted(path, copy):
    """What meshio reads from its own conversion of `path`."""
    told = io.StringIO()
    try:
        with contextlib.redirect_stdout(told), contextlib.redirect_stderr(told):
            code = meshio._cli.main(["convert", str(path), str(copy)])
            read = meshio.read(copy)
    except (Exception, SystemExit) as why:
        raise Failure(f"`meshio convert` of {path} to {copy.suffix} fails: {why!r} {told.getvalue()}") from why
    require(code in (0, None), f"`meshio convert` of {path} to {copy.suffix} ends with exit code {code}")
    return read


def check_conversion(path):
    """`meshio convert` to .vtu and .vtk, and to .msh where it can: it has no lines there (it thinks of Ansys's format)."""
    original = meshio.read(path)
    endings = ["vtu", "vtk"] + ["msh"] * all(block.type not in LINES for block in original.cells)
    with tempfile.TemporaryDirectory() as folder:
        for ending in endings:
            copy = pathlib.Path(folder) / f"converted.{ending}"
            read = converted(path, copy)
            require(np.allclose(read.points[:, :2], original.points[:, :2], rtol=1e-6), f"the points of {path} are others in .{ending}")
            same = len(read.cells) == len(original.cells) and all(
                a.type == b.type and np.array_equal(a.data, b.data) for a, b in zip(read.cells, original.cells)
            )
            require(same, f"the cells of {path} are others after conversion to .{ending}")
            for name, values in original.point_data.items() if ending != "msh" else ():
                found = read.point_data.get(name.replace(" ", "_"), read.point_data.get(name))
                require(found is not None and np.array_equal(np.squeeze(found), values),
                        f'the point array "{name}" of {path} is another after conversion to .{ending}')
            if ending == "vtu":  # VTK reads what meshio wrote
                require(np.array_equal(by_vtk(copy)[2], original.points), f"VTK cannot read what meshio makes of {path}")


def last_digit(text):
    """Half a unit of the last digit written."""
    mantissa, _, exponent = text.lower().partition("e")
    decimals = len(mantissa.partition(".")[2])
    return 0.5 * 10.0 ** (int(exponent or 0) - decimals)


class Histories:
    """histories.csv: its texts, so that the round-off of each number is known."""

    def __init__(self, path):
        with open(path, newline="") as file:
            self.header, *self.rows = csv.reader(file)
        self.path = path
        self.values = np.array(self.rows, dtype=float)
        self.peaks = np.abs(self.values).max(axis=0)

    def check(self, probe, time, vector, letter):
        """`vector` (x, y) at `time`, as it is written, against the columns PROBE.ux, PROBE.uy."""
        rows = [i for i, row in enumerate(self.rows) if row[0] == time]
        require(len(rows) == 1, f"{self.path} has {len(rows)} rows for t = {time} s, the time of a frame")
        row = rows[0]
        for axis, found in zip("xy", vector):
            name = f"{probe}.{letter}{axis}"
            require(name in self.header, f"{self.path} has no column {name}")
            column = self.header.index(name)
            written, peak = self.values[row, column], self.peaks[column]
            slack = min(last_digit(self.rows[row][column]), 1e-6 * peak) + 1e-15 * peak
            if found.dtype == np.float32:  # rounded to 24 bits
                slack += 2.0**-24 * abs(written)
            require(
                abs(found - written) <= slack,
                f"at t = {time} s the frame has {name} = {found!r}, but {self.path} has {written!r}",
            )


def check_names(path, field, units, cell_data):
    """Materials by name and number, groups as 0 and 1, units, and the notes."""
    materials = {name: entry[0] for name, entry in field.items() if len(entry) == 2}
    found = set(cell_data["material"][cell_data["material"] > 0])
    require(found == set(materials.values()), f"{path} names the materials {materials}, but its cells have {found}")
    for name, number in materials.items():
        require(f"group_{name}" in cell_data, f'{path} has no array "group_{name}" of the material "{name}"')
        require(np.array_equal(cell_data[f"group_{name}"] == 1, cell_data["material"] == number), f'"group_{name}" of {path} is not where material is {number}')
    for name in (name for name in cell_data if name.startswith("group_")):
        require(set(np.unique(cell_data[name])) <= {0, 1}, f'"{name}" of {path} holds more than 0 and 1')
    for note in ("units: SI", "signs: ", "totals: "):
        require(any(name.startswith(note) for name in field), f'the field data of {path} have no "{note}..."')
    for name in POINT_ARRAYS | FACE_ARRAYS | JOINT_ARRAYS:
        legend = "; ".join(f"{number} {of}" for of, number in sorted(materials.items(), key=lambda item: item[1]))
        expected = legend if name == "material" else UNITS.get(name, "Pa")
        require(units[name] == expected, f'the unit of "{name}" in {path} is {units[name]!r} instead of {expected!r}')


def check_principal(path, cell_data, line):
    """Eigenvalues of the tensor by numpy, to single precision."""
    xx, yy, zz, xy, yz, xz = cell_data["stress"][~line].T
    tensors = np.stack([xx, xy, xz, xy, yy, yz, xz, yz, zz], axis=1).reshape(-1, 3, 3)
    expected = np.linalg.eigvalsh(tensors)[:, ::-1]
    found = np.stack([cell_data[name][~line] for name in PRINCIPAL], axis=1)
    slack = 2 * SINGLE * np.abs(expected).max(axis=1, keepdims=True)
    require((np.abs(found - expected) <= slack).all(), f"the principal stresses of {path} are not the eigenvalues of its stress")


class Joint:
    """A line cell with the element of the body behind it."""

    def __init__(self, cell, nodes, body, points, body_nodes):
        self.cell, self.nodes, self.body_nodes = cell, nodes, body_nodes
        a, b = points[nodes[0], :2], points[nodes[1], :2]
        along = (b - a) / np.linalg.norm(b - a)
        self.normal = np.array([along[1], -along[0]])
        if self.normal @ ((a + b) / 2 - body) < 0:  # from the body into the ground
            self.normal = -self.normal
        self.tangent = np.array([-self.normal[1], self.normal[0]])


def joints_of(path, mesh, interfaces):
    """[Joint] of a frame, found by geometry and the groups' names."""
    _, cell_data, points, cells, _, line = mesh
    keys = [tuple(key) for key in np.round(points[:, :2] * 1e9).astype(np.int64)]
    joints = []
    for curve, interface in interfaces.items():
        if f"group_{curve}" not in cell_data:
            continue
        behind = {}
        for cell in np.flatnonzero(cell_data[f"group_{interface['body']}"]):
            for node in cells[cell]:
                behind.setdefault(keys[node], []).append((cell, node))
        for cell in np.flatnonzero(cell_data[f"group_{curve}"]):
            ends = cells[cell][:2]
            of_ends = [dict(behind[keys[node]]) for node in ends]
            common = set(of_ends[0]) & set(of_ends[1])
            require(len(common) == 1, f"the line cell {cell} of {path} has {len(common)} elements of its body behind it")
            body = common.pop()
            joints.append(Joint(cell, cells[cell], points[cells[body], :2].mean(axis=0), points, [at[body] for at in of_ends]))
    require(len(joints) == line.sum(), f"{path} has {line.sum()} line cells, {len(joints)} of them in the groups of interfaces")
    return joints


def check_vectors(path, cell_data, joints):
    """Each vector is its scalars along the joint's own axes, but for what the normal turns from joint to joint."""
    at = {}
    for joint in joints:
        for node in joint.nodes[:2]:
            at.setdefault(node, []).append(joint)
    for joint in joints:
        near = [other for node in joint.nodes[:2] for other in at[node]]
        turns = [np.linalg.norm(other.normal - joint.normal) for other in near]
        turn = max(turn for turn in turns if turn < 0.52)  # its own is 0; at corners joints keep their own normals
        value = lambda name: cell_data[name][joint.cell]
        for vector, along_normal, along_tangent in (
            ("gap_vector", "gap", None), ("slip_vector", None, "slip"), ("traction_vector", "normal_traction", "shear_traction"),
        ):
            of = lambda other, name: cell_data[name][other.cell] if name else 0.0
            expected = of(joint, along_normal) * joint.normal + of(joint, along_tangent) * joint.tangent
            size = max(np.hypot(of(other, along_normal), of(other, along_tangent)) for other in near)
            off = np.linalg.norm(value(vector)[:2] - expected)
            if len(joint.nodes) == 3 and turn > 0:
                turn = max(turn, 0.3)  # a curved joint turns within itself, too
            require(off <= (2 * turn + 1e-9) * size, f'"{vector}" of the line cell {joint.cell} of {path} is {value(vector)}, its scalars give {expected}')


def partings(point_data, joints):
    """u(ground) - u(body) of the joints with two nodes, the mean of their ends."""
    u = point_data["displacement"]
    straight = [joint for joint in joints if len(joint.nodes) == 2]
    return straight, np.array([np.mean([u[g] - u[b] for g, b in zip(j.nodes, j.body_nodes)], axis=0) for j in straight]).reshape(-1, 3)


class Jumps:
    """Jumps less those of the first frame against displacements less those of the first frame, which gravity may divide."""

    def __init__(self, first, joints):
        self.joints, self.parting = partings(first[0], joints)
        self.cells = [joint.cell for joint in self.joints]
        self.jump = first[1]["jump_vector"][self.cells]

    def check(self, path, point_data, cell_data):
        _, parting = partings(point_data, self.joints)
        jump = cell_data["jump_vector"][self.cells]
        off = np.abs((jump - self.jump) - (parting - self.parting))
        # round-off of displacements, and of the much larger ones under gravity, which the jumps have seen
        slack = 1e-12 * np.abs(point_data["displacement"]).max() + 1e-9 * np.abs(jump).max(initial=0)
        require((off <= slack).all(), f'"jump_vector" of {path} is not the displacement of the ground less that of the body')


def check_polar(path, mesh, joints, interfaces):
    """Hoop and radial stress about the centre of a circle through the interface's nodes, to single precision."""
    _, cell_data, points, cells, _, line = mesh
    for body in {interface["body"] for interface in interfaces.values()}:
        inside = np.flatnonzero(cell_data.get(f"group_{body}", np.zeros(len(line))))
        if not len(inside) or not cell_data["hoop_stress"][inside].any():
            continue
        curves = [f"group_{curve}" for curve, interface in interfaces.items() if interface["body"] == body]
        around = [j for j in joints if any(cell_data[curve][j.cell] for curve in curves if curve in cell_data)]
        if not around:  # bonded
            continue
        nodes = points[sorted({node for joint in around for node in joint.nodes[:2]}), :2]
        shift = nodes.mean(axis=0)
        centre = shift + np.linalg.lstsq(np.column_stack([2 * (nodes - shift), np.ones(len(nodes))]), ((nodes - shift) ** 2).sum(axis=1), rcond=None)[0][:2]
        corners = [cells[c][: len(cells[c]) if len(cells[c]) < 5 else len(cells[c]) // 2] for c in inside]
        e = np.array([points[c, :2].mean(axis=0) for c in corners]) - centre
        e /= np.linalg.norm(e, axis=1, keepdims=True)
        xx, yy, _, xy = cell_data["stress"][inside].T[:4]
        radial = e[:, 0] ** 2 * xx + e[:, 1] ** 2 * yy + 2 * e[:, 0] * e[:, 1] * xy
        for name, expected in (("radial_stress", radial), ("hoop_stress", xx + yy - radial)):
            off = np.abs(cell_data[name][inside] - expected)
            require((off <= 1e-6 * np.abs(cell_data["stress"][inside]).max()).all(), f'"{name}" in "{body}" of {path} is off by up to {off.max():.3g} Pa')


def check_frame(time, path, probes, histories, interfaces, jumps):
    """Returns the number of line cells, and what the next frames' jumps are compared with."""
    mine, theirs = by_meshio(path), by_vtk(path)
    point_data, cell_data, points, _, field, line = mine
    check_agreement(path, mine, theirs)
    check_arrays(path, point_data, POINT_ARRAYS, "point")
    check_arrays(path, cell_data, FACE_ARRAYS | JOINT_ARRAYS, "cell")
    check_finite(path, cell_data, line)
    for name in POINT_ARRAYS:
        require(np.isfinite(point_data[name]).all(), f'the array "{name}" of {path} is not finite')
    check_names(path, field, theirs[5], cell_data)
    check_principal(path, cell_data, line)
    joints = joints_of(path, mine, interfaces)
    check_vectors(path, cell_data, joints)
    check_polar(path, mine, joints, interfaces)
    jumps = jumps or Jumps(mine, joints)
    jumps.check(path, point_data, cell_data)
    for probe in probes:
        place = points[probe["node"], :2]
        require(
            np.allclose(place, [probe["x"], probe["y"]], rtol=0, atol=1e-9),
            f'probe {probe["name"]} is at ({probe["x"]}, {probe["y"]}) m, but its node in {path} at {place} m',
        )
        for name in MOTION_ARRAYS:
            vector = point_data[name][probe["node"], :2]
            histories.check(probe["name"], time, vector, {"displacement": "u"}.get(name, name[0]))
    return int(line.sum()), jumps


def check(folder):
    require(folder.is_dir(), f"there is no folder {folder}; make it with `coralpipe run`")
    frames = series_of(folder)
    for name in ["summary.json", "histories.csv"]:
        require((folder / name).exists(), f"{name} is missing, so the run has not ended; make it again with `coralpipe run`")
    summary = json.loads((folder / "summary.json").read_text())
    histories = Histories(folder / "histories.csv")
    probes = [p for p in summary["probes"] if p.get("node") is not None]
    interfaces = summary["inputs"]["effective_case"].get("interfaces", {})
    lines, jumps = set(), None
    for time, path in frames:
        count, jumps = check_frame(time, path, probes, histories, interfaces, jumps)
        lines.add(count)
    check_conversion(frames[-1][1])
    require(lines == {summary["counts"]["joints"]}, f"the frames have {lines} line cells, but there are {summary['counts']['joints']} joints")
    print(f"{folder}: meshio and VTK read {len(frames)} frames, t = {frames[0][0]} to {frames[-1][0]} s, bit for bit alike; meshio converts them.")
    print(f"{folder}: {len(probes)} probes agree with histories.csv in every frame; {lines.pop()} interface cells.")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", type=pathlib.Path)
    args = parser.parse_args()
    try:
        check(args.folder)
    except Failure as failure:
        sys.exit(f"{args.folder}: {failure}.")


if __name__ == "__main__":
    main()
