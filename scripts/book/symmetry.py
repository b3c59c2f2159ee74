"""Item 25: mirror symmetry of the twin pipes; friction at its two ends."""

import numpy as np

from book.energy import MESH, TWIN
from book.lib import Page, Row

SLOW = {"law": "table", "times": [0, 0.1], "values": [0, 1e5]}


def page(book):
    step, end = (2e-4, 0.02) if book.quick else (1e-4, 0.05)
    thicknesses = [1e-4, 1e-5] if book.quick else [1e-3, 1e-4, 1e-5]
    run = book.run(TWIN, mesh=MESH, sets={"time.step": step, "time.end": end, "output.every": end}, tag="symmetry")
    h = run.histories
    largest = max(abs(h[c]).max() for c in h if c.endswith((".ux", ".uy")))
    mirrored = lambda a, b, axis, sign: abs(h[f"{a}.{axis}"] - sign * h[f"{b}.{axis}"]).max() / largest
    rows = [Row(f"{axis}({a}) = {'-' * (sign < 0)}{axis}({b}): largest difference over the largest displacement", 0,
                mirrored(a, b, axis, sign), 1e-6, relative=False, why="Newton's tolerance; the mesh is its own mirror image")
            for a, b in [("H", "I"), ("K", "L")] for axis, sign in [("ux", -1), ("uy", 1)]]
    both = lambda key, value: {f"interfaces.{side}.{key}": value for side in ("interface_left", "interface_right")}
    smooth = book.run(TWIN, mesh=MESH, sets={**both("friction", 0), "time.step": step, "time.end": end, "output.every": "10 ms"}, tag="no_friction")
    frames = [smooth.frame(i) for i in range(-2, 0)]
    rows += [
        Row("f = 0: largest shear traction of any joint", 0, max(abs(f.shear_traction).max() for f in frames), 0, "Pa",
            relative=False, why="exactly"),
        Row("f = 0: largest pressure meanwhile", 1e3, max(abs(f.normal_traction).max() for f in frames), 0, "Pa", relative=False,
            bound="least", why="else nothing is shown"),
    ]
    slow = {"loads.surface.pressure": SLOW, "time.step": 5e-3, "time.end": 0.15, "output.every": 0.15, "newton.tolerance": 1e-12}
    glued = book.run(TWIN, mesh=MESH, sets=slow, tag="glued", bonded=True).histories
    columns = [c for c in glued if c.endswith((".ux", ".uy"))]
    peak = max(abs(glued[c]).max() for c in columns)
    differences = []
    for thickness in thicknesses:
        joined = book.run(TWIN, mesh=MESH, sets={**slow, **both("friction", 1e6), **both("thickness", thickness)},
                          tag=f"glue_{thickness:g}").histories
        differences.append(max(abs(joined[c] - glued[c]).max() for c in columns) / peak)
    rows.append(Row("f = 1e6, nothing pulled, t = 0.01 mm: largest difference from the glued pipes over the peak", 0,
                    differences[-1], 1e-4, relative=False, why="of the order of t / pipe radius"))
    rows.append(Row("the same: it falls ten times where t does", 10, differences[-2] / differences[-1], 0.05, why="first order in t"))

    def plot(axes):
        for a, b, colour in [("H", "I", "C0"), ("K", "L", "C1")]:
            axes.plot(1e3 * h["t"], 1e6 * h[f"{a}.ux"], colour, label=f"u_x({a})", linewidth=0.9)
            axes.plot(1e3 * h["t"][::10], -1e6 * h[f"{b}.ux"][::10], colour + "o", markersize=3, fillstyle="none", label=f"-u_x({b})")
        axes.set(xlabel="t [ms]", ylabel="[um]")
        axes.grid(alpha=0.3)
        axes.legend()

    return Page(
        "symmetry", "Mirror symmetry, no friction, much friction", [25],
        problem="The default twin pipes on their symmetric mesh under the default blast; the same with f = 0; and with f = 1e6 under a "
                "pressure that grows within 0.1 s, so that no joint is ever pulled, beside the run with `--bonded`.",
        reference="Mirror images move alike: u_x(H) = -u_x(I), u_x(K) = -u_x(L). Without friction no joint carries shear. Joints that "
                  "neither open nor slip become glue as their thickness goes to zero.",
        rows=rows, code=["src/physics/joint.rs::respond", "src/model/split.rs", "tests/invariants.rs"], plot=plot,
        example=(run, "the largest difference between `H.ux` and -`I.ux`, and so on, is in histories.csv."),
        notes="Symmetry needs the mesh to be its own mirror image, as that of the default geometry is; on another mesh the two pipes differ by "
              "the error of the mesh. Glue is the limit t -> 0 only while no joint is pulled, hence the slow load: under the blast joints open, and "
              "no friction makes them glue. **What misses:** a joint without friction and one that is open carry no shear alike, so f = 0 "
              "is checked on moments in which joints press.",
        tables=[("Difference from the glued pipes", ["thickness [m]", "over the peak"],
                 [[f"{t:g}", f"{d:.2e}"] for t, d in zip(thicknesses, differences)])],
    )
