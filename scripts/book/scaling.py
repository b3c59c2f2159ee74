"""Item 24: without gap, cohesion and prestress, displacements scale with the load, contact included."""

import numpy as np

from book.energy import MESH, TWIN
from book.lib import Page, Row


def histories(book, factor, extra=None):
    step, end = (2e-4, 0.016) if book.quick else (1e-4, 0.05)
    sets = {"loads.surface.pressure.peak": 1e5 * factor, "loads.surface.pressure.duration": 5e-3, "time.step": step, "time.end": end,
            "output.every": end, **(extra or {})}
    return book.run(TWIN, mesh=MESH, sets=sets, tag=f"scaling_{factor:g}{'_gravity' if extra else ''}")


def differ(one, other, factor):
    columns = [c for c in one.histories if c.endswith((".ux", ".uy"))]
    largest = max(abs(factor * one.histories[c]).max() for c in columns)
    return max(abs(factor * one.histories[c] - other.histories[c]).max() for c in columns) / largest


def page(book):
    one = histories(book, 1)
    rows = [Row("gap during the run: the joints must open", 1e-6, one.summary["contact"]["max_open"], 0, "m", relative=False,
                bound="least", why="else nothing is shown"),
            Row("slip during the run: the joints must slip", 1e-6, one.summary["contact"]["max_slip"], 0, "m", relative=False,
                bound="least", why="else nothing is shown")]
    for factor in [7.3] if book.quick else [7.3, 1e-3]:
        rows.append(Row(f"p x {factor:g}: largest difference of any probe at any time over the largest displacement", 0,
                        differ(one, histories(book, factor), factor), 1e-7, relative=False,
                        why="Newton's tolerance of 1e-8 on the forces"))
    heavy = {"gravity": 9.81}
    rows.append(Row("with gravity, which must break it: the same for p x 7.3", 1e-4,
                    differ(histories(book, 1, heavy), histories(book, 7.3, heavy), 7.3), 0, relative=False, bound="least",
                    why="prestress has a scale of its own: shows that the rows above can fail"))
    larger = histories(book, 7.3)

    def plot(axes):
        for run, factor, mark in [(one, 1, "-"), (larger, 7.3, "--")]:
            for probe, colour in [("A.uy", "C0"), ("C.uy", "C1")]:
                axes.plot(1e3 * run.histories["t"], 1e3 * run.histories[probe] / factor, colour + mark, label=f"{probe} / {factor:g}",
                          linewidth=2.2 if factor == 1 else 1, alpha=0.5 if factor == 1 else 1)
        axes.set(xlabel="t [ms]", ylabel="displacement / factor of the pressure [mm]")
        axes.grid(alpha=0.3)
        axes.legend()

    return Page(
        "scaling", "Homogeneity: U(lambda p) = lambda U(p)", [24],
        problem="The default twin pipes under a blast of 5 ms, which opens and slips the joints, with the peak pressure times 7.3 and "
                "times 0.001.",
        reference="Linear solids and joints without gap, cohesion or prestress have no stress of their own to compare with: every "
                  "displacement is proportional to the pressure.",
        rows=rows, code=["src/physics/joint.rs::respond", "src/solve/contact.rs", "tests/invariants.rs"], plot=plot,
        notes="Assumed: joints closed without pressure at the start, no gap, no gravity, no limit to the solids' strength. Newton's test "
              "is relative, so it scales too. So the paper's lost peak pressure only scales its curves, as long as nothing but the blast acts.",
    )
