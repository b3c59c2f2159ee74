#!/usr/bin/env python3
"""How far the size of the box shows: rigid or absorbing edges, 25 m x 15 m against 100 m x 60 m.

    PYTHONPATH=scripts .venv/bin/python scripts/box_size.py        prints a table, writes docs/box_size.png
"""

import numpy as np
from matplotlib.figure import Figure

from book.lib import ROOT, Book

CASE = "geo/twin_pipes.json"
PROBES = "ACHKLI"
# alpha and beta of the default case, the same in all: those of a ratio would change with the box
DAMPING = {"alpha": 3.302, "beta": 7.562e-4}
OPEN = {"supports": {}, "boundaries": {"base": "viscous", "side_left": "free_field", "side_right": "free_field"}}
LARGE = {"width": 100, "height": 60, "core_width": 25, "core_height": 15}
SMALL = {"core_width": 25, "core_height": 15}
BOXES = (
    ("100 m x 60 m, free field and viscous base", OPEN, LARGE, "k", 2.5),
    ("25 m x 15 m, free field and viscous base", OPEN, SMALL, "C1", 1.2),
    ("25 m x 15 m, rollers and rigid base", {}, SMALL, "C0", 1.2),
)


def motion(found, exact, what):
    """The worst probe: largest length of the vectors' difference over the largest vector of that probe in the large box."""

    def of_probe(p):
        difference = np.hypot(*(found[f"{p}.{what}{axis}"] - exact[f"{p}.{what}{axis}"] for axis in "xy"))
        return difference.max() / np.hypot(exact[f"{p}.{what}x"], exact[f"{p}.{what}y"]).max()

    return max(map(of_probe, PROBES))


def force(found, exact, what):
    """The largest difference at any frame and ray of both pipes, over the largest round that pipe in the large box."""
    assert np.array_equal(found["angle_deg"], exact["angle_deg"]) and np.array_equal(found["body"], exact["body"])
    bodies = [exact["body"] == body for body in np.unique(exact["body"])]
    return max(abs(found[what] - exact[what])[rows].max() / abs(exact[what][rows]).max() for rows in bodies)


def main():
    book = Book(quick=False)
    sets = {"damping": DAMPING, "output.every": "1 ms"}
    results = [book.run(CASE, sets={**sets, **edges}, geo=geo) for _, edges, geo, _, _ in BOXES]
    histories, rings = [r.histories for r in results], [r.rings() for r in results]
    drawing = Figure(figsize=(7.2, 3.6), layout="constrained")
    axes = drawing.subplots()
    for (words, _, _, colour, width), history, ring in zip(BOXES, histories, rings):
        errors = {what: motion(history, histories[0], what) for what in "uva"}
        errors |= {what: force(ring, rings[0], what) for what in ("N", "M")}
        print(f"{words}: " + ", ".join(f"{what} {100 * error:.2g} %" for what, error in errors.items()))
        axes.plot(1e3 * history["t"], 1e3 * history["A.uy"], colour, linewidth=width, label=words)
    axes.set(xlabel="t [ms]", ylabel="u_y of A [mm]")
    axes.grid(alpha=0.3)
    axes.legend(fontsize=8)
    drawing.savefig(ROOT / "docs" / "box_size.png", dpi=110, metadata={"Software": None})


if __name__ == "__main__":
    main()
