"""Item 26: no load, no motion; and ground without pipes is the column everywhere."""

import numpy as np

from book.lib import Page, Row

BLAST = {"law": "linear", "peak": 1e5, "duration": 0.05}
LAYERS = [(3, 2200), (4, 2600), (8, 2700)]  # thickness [m], density [kg/m^3]


def overburden(depth):
    """Mass above a depth [kg/m^2]."""
    mass = 0.0
    for thickness, density in LAYERS:
        mass += density * min(max(depth, 0), thickness)
        depth -= thickness
    return mass


def motion(result):
    """Largest displacement of any node in any frame, and of any probe at any step [m]."""
    frames = sorted((result.folder / "frames").glob("*.vtu"))
    nodes = max(abs(result.frame(i).displacement).max() for i in range(len(frames)))
    history = result.histories
    return max(nodes, max(abs(values).max() for name, values in history.items() if name.endswith((".ux", ".uy"))))


def page(book):
    rows = []
    still = book.run("silence", sets={"gravity": 0}, tag="no_gravity")
    rows.append(Row("no gravity, no load: largest displacement", 0, motion(still), 0, "m", relative=False, why="zero is exact"))
    heavy = book.run("silence", tag="gravity")
    rows.append(Row("gravity, no load: largest displacement", 0, motion(heavy), 1e-12, "m", relative=False,
                    why="round-off: the ground has settled by millimetres before"))
    first, last = heavy.frame(0), heavy.frame(-1)
    shear = abs(first.shear_traction).max()
    rows += [
        Row("gravity, no load: largest change of a joint's slip", 0, abs(last.slip - first.slip).max(), 1e-12, "m", relative=False,
            why="round-off"),
        Row("gravity, no load: largest change of a joint's shear over the largest shear", 0,
            abs(last.shear_traction - first.shear_traction).max() / shear, 1e-9, relative=False,
            why="the joints' equilibrium is solved to 1e-8 of the load or better"),
    ]
    changes = heavy.summary["contact"]["status_changes"]

    size, dt = (0.2, 4e-4) if book.quick else (0.1, 1e-4)
    blast = {"loads.surface.pressure": BLAST, "time": {"step": dt, "end": 0.06}, "output": {"every": 0.02}}
    column = book.run("layered_column", geo={"size": size}, sets=blast, tag="column")
    wide = book.run("layered_column", geo={"size": size, "width": 25, "across": 25}, sets=blast, tag="wide")
    levels = {}
    for i in range(len(column.frame(0).points)):
        levels[round(column.frame(0).points[i, 1], 6)] = i
    for i, when in [(1, "20"), (2, "40"), (3, "60")]:
        a, b = column.frame(i), wide.frame(i)
        same = np.array([a.displacement[levels[round(y, 6)]] for y in b.points[:, 1]])
        error = abs(b.displacement - same).max() / abs(a.displacement).max()
        rows.append(Row(f"25 m of ground without pipes at {when} ms: every node as the column's", 0, error, 1e-10,
                        relative=False, why="round-off"))

    settled = book.run("layered_column", geo={"size": size}, tag="gravity", sets={
        "gravity": 9.81, "loads.surface.pressure.peak": 0, "time": {"step": 1e-3, "end": 0.02}, "output": {"every": 0.01}})
    frame = settled.frame(0)
    weight = np.array([9.81 * overburden(-y) for y in frame.centres[:, 1]])
    error = abs(-frame.stress[:, 1] / weight - 1).max()
    rows.append(Row("gravity in the column: vertical stress at every element over the weight above, - 1", 0, error, 1e-9,
                    relative=False, why="round-off: the mean stress of an element is exact in one dimension"))
    rows.append(Row("gravity in the column, no load: largest displacement", 0, motion(settled), 1e-12, "m", relative=False,
                    why="round-off: the ground has settled by millimetres before"))

    def plot(axes):
        for i, colour, when in [(1, "C0", "20 ms"), (2, "C1", "40 ms"), (3, "C2", "60 ms")]:
            a, b = column.frame(i), wide.frame(i)
            axes.plot(-1e3 * b.displacement[:, 1], -b.points[:, 1], colour + ".", markersize=2)
            order = np.argsort(a.points[:, 1])
            axes.plot(-1e3 * a.displacement[order, 1], -a.points[order, 1], colour, linewidth=0.8, label=when)
        axes.set(xlabel="settlement [mm]", ylabel="depth [m]")
        axes.invert_yaxis()
        axes.grid(alpha=0.3)
        axes.legend(title="line: column, dots: all nodes of 25 m of ground")

    return Page(
        "silence", "Silence, and ground without pipes", [26],
        problem="The paper's ground and pipes with open joints: no load; gravity and no load; and the same ground without "
                "pipes, 25 m wide, under 100 kPa that fall to zero in 50 ms.",
        reference="No load, no motion: exact. Between rollers a uniform load makes the same plane wave in every column, exact in "
                  "the mesh of rectangles too.",
        rows=rows,
        notes="Displacements are counted from the equilibrium under gravity. Joint points that slipped while gravity came stand "
              "exactly at the limit of friction, and round-off calls them sticking in one step and slipping in the next: "
              f"{changes} changes of the name here, with the slips and tractions of the table. The comparison with the column "
              "needs ground without holes; pipes made of soil would still be hollow.",
        plot=plot, example=(heavy, "no column of histories.csv leaves zero by more than round-off."),
        code=["src/solve/start.rs::under_gravity", "src/results/histories.rs", "geo/twin_pipes.geo", "geo/verification/layered_column.geo"],
    )
