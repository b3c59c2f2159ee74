#!/usr/bin/env python3
"""Compares a blast front that runs over the surface of the default case with the same pulse everywhere at once.

    PYTHONPATH=scripts .venv/bin/python scripts/front.py        writes docs/front.png and prints the peaks
"""

import numpy as np
from matplotlib.figure import Figure

from book.lib import ROOT, Book

CASE = "geo/twin_pipes.json"
SPEED = 479
"""of the shock of 115.7 kPa [m/s]: 1000 kg of TNT on the ground at 30 m"""
PRESSURE = {"law": "linear", "peak": "100 kPa", "duration": "50 ms"}
FRONT = {"speed": f"{SPEED} m/s", "direction": [1, 0]}
LOADS = {
    "everywhere at once": PRESSURE,
    f"front at {SPEED} m/s from the left": {**PRESSURE, "front": FRONT},
}
PANELS = (
    ("A.uy", "crown A of the left pipe, vertical"),
    ("H.ux", "springline H of the left pipe, horizontal"),
    ("I.ux", "springline I of the right pipe, horizontal"),
)
STYLES = ("--", "-")


def main():
    book = Book(quick=False)
    results = {words: book.run(CASE, sets={"loads.surface.pressure": load}) for words, load in LOADS.items()}
    drawing = Figure(figsize=(9.6, 3.2), layout="constrained")
    for axis, (column, title) in zip(drawing.subplots(1, len(PANELS), sharey=True), PANELS):
        for style, (words, result) in zip(STYLES, results.items()):
            history = result.histories
            axis.plot(1e3 * history["t"], 1e3 * history[column], style, label=words, linewidth=1.2)
            largest = np.abs(history[column]).argmax()
            print(f"{column} {words}: {1e3 * history[column][largest]:.4f} mm at {1e3 * history['t'][largest]:.1f} ms")
        axis.set_title(title, fontsize=9)
        axis.set_xlabel("t [ms]")
        axis.grid(alpha=0.3)
        if column == "A.uy":
            axis.set_ylabel("displacement [mm]")
        if column == "H.ux":
            axis.legend(fontsize=7, loc="lower left")
    drawing.savefig(ROOT / "docs" / "front.png", dpi=110)
    for words, result in results.items():
        summary = result.summary
        print(f"{words}: energy {summary['energy']['max_relative_error']:.1e}, contact {summary['contact']}")


if __name__ == "__main__":
    main()
