"""Renders one moment of a run with ParaView 5.11 (no screen needed):

    xvfb-run -a pvpython scripts/render.py output/twin_pipes picture.png [--field von_mises] [--time 0.012]

Without --time, the moment when some point has moved furthest down. The picture spans from the ground's surface to
below the pipes, in true position plus displacements times a round factor; black lines bound the materials.
"""

import argparse
import glob
import math
import os
import sys

from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy

FIELDS = {  # association, value in the unit shown, title, unit
    "displacement": ("POINTS", "1e3*mag(displacement)", "Displacement", "mm"),
    "velocity": ("POINTS", "1e3*velocity_Y", "Vertical velocity", "mm/s"),
    "pressure": ("CELLS", "-1e-3*stress_YY", "Vertical pressure", "kPa"),
    "von_mises": ("CELLS", "1e-6*von_mises", "Von Mises stress", "MPa"),
}
SIZE = (1600, 900)
BAND = 0.28  # for the words above the ground, in half heights of the picture
BELOW = 1.45  # depth that is shown, in depths of the lowest interface


def open_series(folder):
    files = glob.glob(os.path.join(folder, "*.pvd"))
    if len(files) != 1:
        sys.exit(f"{folder} should hold one .pvd file, but holds {len(files)}.")
    return simple.PVDReader(FileName=files[0])


def fetch(source, time):
    """The grid at `time`, in this process."""
    source.UpdatePipeline(time)
    return servermanager.Fetch(source)


def displacements(reader, time):
    """(x, y, z) of every point at `time` [m]."""
    return vtk_to_numpy(fetch(reader, time).GetPointData().GetArray("displacement"))


def telling_time(reader):
    return min(reader.TimestepValues, key=lambda time: displacements(reader, time)[:, 1].min())


def nearest_time(reader, time):
    return min(reader.TimestepValues, key=lambda t: abs(t - time))


def round_factor(length, greatest):
    """1, 2 or 5 times a power of ten that shows `greatest` as `length` or a little less."""
    if greatest == 0:
        return 1.0
    power = 10.0 ** math.floor(math.log10(length / greatest))
    return max(f for f in (1, 2, 5) if f * power <= length / greatest) * power


def window(grid):
    """(centre x, centre y, half height) of what is shown [m]: from the words above the surface to below the interfaces."""
    lines = [i for i in range(grid.GetNumberOfCells()) if grid.GetCellType(i) in (3, 21)]
    boxes = [grid.GetCell(i).GetBounds() for i in lines] or [grid.GetBounds()]
    left, right, lowest = min(b[0] for b in boxes), max(b[1] for b in boxes), min(b[2] for b in boxes)
    surface = grid.GetBounds()[3]
    half = max(BELOW * (surface - lowest) / (2 - BAND), 0.6 * (right - left) * SIZE[1] / SIZE[0])
    return (left + right) / 2, surface + (BAND - 1) * half, half


def show_field(source, field, limits, view):
    """The field as colours between `limits` (those of the data, if None), with its bar."""
    association, value, title, unit = FIELDS[field]
    kind = "Point Data" if association == "POINTS" else "Cell Data"
    shown = simple.Calculator(Input=source, ResultArrayName="shown", AttributeType=kind, Function=value)
    display = simple.Show(shown, view)
    display.Ambient, display.Diffuse = 1, 0  # the bar's own colours: no lamp
    simple.ColorBy(display, (association, "shown"))
    table = simple.GetColorTransferFunction("shown")
    table.ApplyPreset("Viridis (matplotlib)", True)
    if limits is None:
        display.RescaleTransferFunctionToDataRange(False, True)
    else:
        table.RescaleTransferFunction(*limits)
    bar = simple.GetScalarBar(table, view)
    bar.Title, bar.ComponentTitle = f"{title} [{unit}]", ""
    bar.AddRangeLabels = 0
    bar.Orientation, bar.WindowLocation, bar.ScalarBarLength = "Horizontal", "Upper Right Corner", 0.4
    for part in ("Title", "Label"):
        setattr(bar, f"{part}Color", [0, 0, 0])
        setattr(bar, f"{part}FontSize", 20)
    display.SetScalarBarVisibility(view, True)


def show_outlines(source, grid, view):
    """Black lines round each material."""
    for material in sorted(set(vtk_to_numpy(grid.GetCellData().GetArray("material")))):
        one = simple.Threshold(Input=source, Scalars=["CELLS", "material"])
        one.LowerThreshold, one.UpperThreshold = material - 0.5, material + 0.5
        edges = simple.FeatureEdges(Input=simple.ExtractSurface(Input=one), FeatureEdges=0, NonManifoldEdges=0)
        display = simple.Show(edges, view)
        display.ColorArrayName = [None, ""]
        display.AmbientColor = display.DiffuseColor = [0, 0, 0]
        display.LineWidth = 2.0


def show_caption(words, view):
    display = simple.Show(simple.Text(Text=words), view)
    display.Color, display.FontSize, display.WindowLocation = [0, 0, 0], 20, "Upper Left Corner"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("folder")
    parser.add_argument("picture")
    parser.add_argument("--field", choices=sorted(FIELDS), default="displacement")
    parser.add_argument("--range", type=float, nargs=2, metavar=("LEAST", "MOST"), help="of the colours; default: all values")
    parser.add_argument("--time", type=float, help="in seconds; the nearest frame is taken")
    args = parser.parse_args()

    reader = open_series(args.folder)
    time = telling_time(reader) if args.time is None else nearest_time(reader, args.time)
    greatest = abs(displacements(reader, time)).max()
    grid = fetch(reader, time)
    x, y, half = window(grid)
    factor = round_factor(0.06 * half, greatest)

    view = simple.CreateRenderView(ViewSize=SIZE, OrientationAxesVisibility=0, UseColorPaletteForBackground=0)
    view.Background = [1, 1, 1]
    simple.GetAnimationScene().AnimationTime = time  # what every filter and view now shows
    warped = simple.WarpByVector(Input=reader, Vectors=["POINTS", "displacement"], ScaleFactor=factor)
    show_field(warped, args.field, args.range, view)
    show_outlines(warped, grid, view)
    show_caption(f"t = {1e3 * time:.3g} ms, displacements x {factor:g}", view)
    view.CameraParallelProjection = 1
    view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = [x, y, 10], [x, y, 0], [0, 1, 0]
    view.CameraParallelScale = half
    simple.SaveScreenshot(args.picture, view, ImageResolution=SIZE)
    print(f"{args.picture}: {args.field} of {args.folder} at t = {time} s, displacements x {factor:g}.")


main()
