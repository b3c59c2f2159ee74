"""Item 20: a mass between two one-sided springs of different stiffness."""

import numpy as np

from book.drop import crossings
from book.lib import Page, Row


def page(book):
    dt = 1e-3 if book.quick else 1e-4
    h = book.run("bilinear", sets={"time.step": dt}).histories
    t, u = h["t"], h["M.uy"]
    zeros = crossings(t[1:], u[1:])
    period = (zeros[-1] - zeros[1 if len(zeros) % 2 == 0 else 0]) / ((len(zeros) - 1) // 2)
    tolerance = (20 * dt) ** 2 / 4 + 2e-6
    rows = [
        Row("period, mean of ten", np.pi / 10 + np.pi / 20, period, tolerance, "s", why="(omega dt)^2 / 4, omega = 20 1/s"),
        Row("the same beside the printed 0.4712389", 0.4712389, period, tolerance, "s", why="the same"),
        Row("amplitude towards k = 100 N/m", 0.1, u[t < 0.4].max(), tolerance, "m", why="the same"),
        Row("amplitude towards k = 400 N/m", -0.05, u[t < 0.5].min(), tolerance, "m", why="the same"),
        Row("last amplitude towards k = 100 N/m", 0.1, u[t > 4.5].max(), 100 * tolerance, "m",
            why="a hundred times that: each change of spring inside a step may add or take energy"),
    ]

    def plot(axes):
        axes.plot(t[t < 2], 1e3 * u[t < 2])
        for level in (100, -50):
            axes.axhline(level, color="0.7", linewidth=0.8)
        axes.set(xlabel="t [s]", ylabel="u [mm]")

    return Page(
        "bilinear", "Bilinear oscillator", [20],
        problem="A block of 1 kg between two joints, 100 N/m above and 400 N/m below, each only pressing; it starts upwards with "
                "1 m/s.",
        reference="Half a period on each spring: T = pi / 10 + pi / 20 = 0.4712389 s, amplitudes v / omega = 0.1 and 0.05 m.",
        rows=rows, code=["src/physics/joint.rs", "src/solve/contact.rs"], plot=plot,
        notes="With both joints closed the block would swing at sqrt(500) 1/s; the frequency that a summary tells is that one.",
    )
