#!/usr/bin/env python3
"""Checks the results of a run with readers that are not coralpipe's: meshio and VTK.

    scripts/check_output.py output/twin_pipes

Both open every frame that the .pvd names, agree bit for bit, find every array there, and show at the probes the
displacements, velocities and accelerations that histories.csv has at the same time. Exit 1 with a sentence on failure.
"""

import argparse
import csv
import json
import pathlib
import sys
import xml.etree.ElementTree as xml

import meshio
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

MOTION_ARRAYS = {"displacement": 3, "velocity": 3, "acceleration": 3}
POINT_ARRAYS = MOTION_ARRAYS | {"nodal_stress": 6, "nodal_von_mises": 1}
FACE_ARRAYS = {"stress": 6, "strain": 6, "von_mises": 1, "material": 1}
JOINT_ARRAYS = {"gap": 1, "slip": 1, "normal_traction": 1, "shear_traction": 1, "status": 1}
LINES = {"line", "line3"}


class Failure(Exception):
    """A sentence for the user."""


def require(condition, sentence):
    if not condition:
        raise Failure(sentence)


def series_of(folder):
    """[(time, path)] of the one .pvd in the folder."""
    files = sorted(folder.glob("*.pvd"))
    require(len(files) == 1, f"{folder} should hold one .pvd file, but holds {len(files)}")
    entries = xml.parse(files[0]).getroot().iter("DataSet")
    frames = [(float(e.get("timestep")), folder / e.get("file")) for e in entries]
    require(frames, f"{files[0]} names no frame")
    times = [t for t, _ in frames]
    require(all(a < b for a, b in zip(times, times[1:])), f"the times in {files[0]} do not rise from frame to frame")
    for _, path in frames:
        require(path.exists(), f"{files[0]} names {path}, which does not exist")
    return frames


def by_meshio(path):
    """({name: point array}, {name: cell array}, points, [node lists], is a line), cells in the file's order."""
    mesh = meshio.read(path)
    cells = [row for block in mesh.cells for row in block.data]
    line = np.concatenate([np.full(len(block.data), block.type in LINES) for block in mesh.cells])
    data = {name: np.concatenate(blocks) for name, blocks in mesh.cell_data.items()}
    return mesh.point_data, data, mesh.points, cells, line


def by_vtk(path):
    """The same by VTK, without the line flags."""
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    require(reader.GetErrorCode() == 0, f"VTK cannot read {path} (error {reader.GetErrorCode()})")
    grid = reader.GetOutput()
    arrays = []
    for data in (grid.GetPointData(), grid.GetCellData()):
        each = [data.GetArray(i) for i in range(data.GetNumberOfArrays())]
        arrays.append({a.GetName(): vtk_to_numpy(a) for a in each})
    starts = vtk_to_numpy(grid.GetCells().GetOffsetsArray())
    nodes = vtk_to_numpy(grid.GetCells().GetConnectivityArray())
    cells = [nodes[a:b] for a, b in zip(starts, starts[1:])]
    return arrays[0], arrays[1], vtk_to_numpy(grid.GetPoints().GetData()), cells


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
    for kind, a, b in (("point", mine[0], theirs[0]), ("cell", mine[1], theirs[1])):
        require(set(a) == set(b), f"meshio and VTK find different {kind} arrays in {path}")
        for name in a:
            require(same_bits(a[name], b[name]), f'meshio and VTK read different values of the {kind} array "{name}" in {path}')
    require(same_bits(mine[2], theirs[2]), f"meshio and VTK read different points in {path}")
    same = len(mine[3]) == len(theirs[3]) and all(np.array_equal(a, b) for a, b in zip(mine[3], theirs[3]))
    require(same, f"meshio and VTK read different cells in {path}")


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
        """`vector` (x, y) at `time` against the columns PROBE.ux, PROBE.uy."""
        row = int(np.abs(self.values[:, 0] - time).argmin())
        require(abs(self.values[row, 0] - time) <= 1e-9 * self.peaks[0], f"{self.path} has no row for t = {time} s")
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


def check_frame(time, path, probes, histories):
    mine, theirs = by_meshio(path), by_vtk(path)
    point_data, cell_data, points, _, line = mine
    check_agreement(path, mine, theirs)
    check_arrays(path, point_data, POINT_ARRAYS, "point")
    check_arrays(path, cell_data, FACE_ARRAYS | JOINT_ARRAYS, "cell")
    check_finite(path, cell_data, line)
    for name in POINT_ARRAYS:
        require(np.isfinite(point_data[name]).all(), f'the array "{name}" of {path} is not finite')
    for probe in probes:
        place = points[probe["node"], :2]
        require(
            np.allclose(place, [probe["x"], probe["y"]], rtol=0, atol=1e-9),
            f'probe {probe["name"]} is at ({probe["x"]}, {probe["y"]}) m, but its node in {path} at {place} m',
        )
        for name in MOTION_ARRAYS:
            vector = point_data[name][probe["node"], :2]
            histories.check(probe["name"], time, vector, {"displacement": "u"}.get(name, name[0]))
    return int(line.sum())


def check(folder):
    require(folder.is_dir(), f"there is no folder {folder}; make it with `coralpipe run`")
    frames = series_of(folder)
    for name in ["summary.json", "histories.csv"]:
        require((folder / name).exists(), f"{name} is missing, so the run has not ended; make it again with `coralpipe run`")
    summary = json.loads((folder / "summary.json").read_text())
    histories = Histories(folder / "histories.csv")
    probes = [p for p in summary["probes"] if p.get("node") is not None]
    lines = {check_frame(time, path, probes, histories) for time, path in frames}
    require(lines == {summary["counts"]["joints"]}, f"the frames have {lines} line cells, but there are {summary['counts']['joints']} joints")
    print(f"{folder}: meshio and VTK read {len(frames)} frames, t = {frames[0][0]} to {frames[-1][0]} s, bit for bit alike.")
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
