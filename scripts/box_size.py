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
LARGE = {"width": 100, "height": 60}
BOXES = (
    ("100 m x 60 m, free field and viscous base", OPEN, LARGE, "k", 2.5),
    ("25 m x 15 m, free field and viscous base", OPEN, {}, "C1", 1.2),
    ("25 m x 15 m, rollers and rigid base", {}, {}, "C0", 1.2),
)


def difference(found, exact, component):
    """Largest over time and probes of the difference, over the largest displacement of any probe in the large box."""
    peak = max(np.hypot(exact[f"{p}.ux"], exact[f"{p}.uy"]).max() for p in PROBES)
    return max(abs(found[f"{p}.{component}"] - exact[f"{p}.{component}"]).max() for p in PROBES) / peak


def main():
    book = Book(quick=False)
    sets = {"damping": DAMPING, "output.every": "100 ms"}
    histories = [book.run(CASE, sets={**sets, **edges}, geo=geo).histories for _, edges, geo, _, _ in BOXES]
    exact = histories[0]
    drawing = Figure(figsize=(7.2, 3.6), layout="constrained")
    axes = drawing.subplots()
    for (words, _, _, colour, width), history in zip(BOXES, histories):
        errors = [100 * difference(history, exact, component) for component in ("ux", "uy")]
        print(f"{words}: ux {errors[0]:.3f} %, uy {errors[1]:.3f} % of the peak")
        axes.plot(1e3 * history["t"], 1e3 * history["A.uy"], colour, linewidth=width, label=words)
    axes.set(xlabel="t [ms]", ylabel="u_y of A [mm]")
    axes.grid(alpha=0.3)
    axes.legend(fontsize=8)
    drawing.savefig(ROOT / "docs" / "box_size.png", dpi=110, metadata={"Software": None})


if __name__ == "__main__":
    main()
