"""Item 15: greatest displacement of a mass on a spring under a triangular pulse."""

import numpy as np

from book.lib import Page, Row

PRINTED = {0.1: 0.31073, 0.25: 0.73303, 0.5: 1.19619, 0.75: 1.42208, 1: 1.55024, 1.5: 1.68910, 2: 1.76264,
           5: 1.90203, 10: 1.95051}  # td / T: factor


def motion(t, td, omega=2 * np.pi):
    """u / u_static of the undamped oscillator from rest under p (1 - t / td)."""
    at = lambda s: 1 - np.cos(omega * s) + np.sin(omega * s) / (omega * td) - s / td
    rate = lambda s: omega * np.sin(omega * s) + (np.cos(omega * s) - 1) / td
    free = at(td) * np.cos(omega * (t - td)) + rate(td) / omega * np.sin(omega * (t - td))
    return np.where(t <= td, at(t), free)


def factor(td):
    """The greatest |u| / u_static, T = 1; the first cycle holds it."""
    return abs(motion(np.linspace(0, 1.2, 1_200_001), td)).max()


def page(book):
    dt = 1e-3 if book.quick else 5e-4
    tolerance = (2 * np.pi * dt) ** 2 / 4 + 1e-8
    rows, found = [], {}
    for td, printed in PRINTED.items():
        sets = {"time.step": dt, "loads.top_1.pressure.duration": td}
        run = book.run("load_factor", sets=sets)
        found[td] = abs(run.histories["P1.uy"]).max()
        rows.append(Row(f"load factor at td / T = {td:g}", factor(td), found[td], tolerance, relative=False,
                        why="(omega dt)^2 / 4: error of the method, and of a maximum between two steps"))
        rows.append(Row(f"the same, printed: {printed:.5f}", printed, found[td], tolerance + 5e-6, relative=False,
                        why="and half a digit"))

    def plot(axes):
        td = np.geomspace(0.08, 12, 60)
        axes.semilogx(td, [abs(motion(np.linspace(0, 1.2, 2001), x)).max() for x in td], color="0.6", label="exact")
        axes.semilogx(list(found), list(found.values()), "o", label="program")
        axes.set(xlabel="td / T", ylabel="greatest u / (p / k)")
        axes.legend()

    return Page(
        "load_factor", "Triangular pulse: load factors", [15],
        problem="A mass on a spring of 1 Hz from rest under the pressure p (1 - t / td), which jumps to p at t = 0: the law of the "
                "paper's blast.",
        reference="The closed solution: 1 - cos wt + sin wt / (w td) - t / td until td, free vibration after it; its greatest value "
                  "computed here, and as printed by J. M. Biggs (Introduction to Structural Dynamics) to five digits.",
        rows=rows, code=["src/physics/pulse.rs::at", "src/solve/start.rs::with_acceleration", "src/solve/newmark.rs::Constants"], plot=plot,
        example=(run, "the factor at td / T = 10 is the largest -`P1.uy` in histories.csv, in m since p / k = 1 m."),
        notes="The acceleration at t = 0 is p / m. A start from a = 0 would miss half a step of the load, pi dt / T in the "
              "factor at short pulses: 1.6e-3 here, a thousand times the tolerance.",
    )
