"""Item 19: a block falls on a one-sided spring and jumps."""

import numpy as np

from book.lib import Page, Row

MASS, SPRING, HEIGHT, G = 1, 1e4, 0.1, 9.81


def page(book):
    dt = 1e-4 if book.quick else 2e-5
    run = book.run("drop", sets={"time.step": dt})
    h = run.histories
    t, u, v = (h[k] for k in ["t", "FOOT.uy", "FOOT.vy"])
    speed = np.sqrt(2 * G * HEIGHT)
    omega = np.sqrt(SPRING / MASS)
    sink = G / omega**2
    deepest = sink + np.hypot(sink, speed / omega)
    contact = (2 * np.pi - 2 * np.arctan2(speed / omega, sink)) / omega
    period = 2 * speed / G + contact
    crossing = crossings(t, u + HEIGHT)
    tops = maxima(t, v)
    tolerance = (omega * dt) ** 2 / 4 + 2e-5
    why = "(omega dt)^2 / 4, and 2e-5 for the block's own compliance"
    rows = [
        Row("speed at touch", speed, -np.interp(crossing[0], t, v), tolerance, "m/s", why=why),
        Row("deepest compression", deepest, -HEIGHT - u.min(), tolerance, "m", why=why),
        Row("greatest force", SPRING * deepest, MASS * (mean_acceleration(t, v) + G), 1e-4, "N", why="mean over 0.2 ms"),
        Row("contact lasts", contact, crossing[1] - crossing[0], 4 * tolerance, "s", why="four times that: two ends of a step each"),
        Row("period of the jumps", period, tops[1] - tops[0], tolerance, "s", why=why),
        Row("height after the first jump", 0, u[(t > crossing[1]) & (t < crossing[2])].max(), 1e-3 * HEIGHT, "m", relative=False,
            why="0.1 %: a step that begins or ends inside contact keeps energy only as dt goes to zero"),
    ]
    printed = ["1.400714", "0.01502245", "150.2245", "0.03281436", "0.31838298"]
    rows += [Row(f"{row.quantity}, printed: {p}", float(p), row.value, row.tolerance, row.unit, why=row.why)
             for row, p in zip(rows, printed)]

    def plot(axes):
        axes.plot(t, 1e3 * u, label="program")
        axes.plot(tops, [0] * len(tops), "+", label="tops")
        axes.axhline(-1e3 * (HEIGHT + deepest), color="0.7", linewidth=0.8, label="deepest, exact")
        axes.set(xlabel="t [s]", ylabel="height [mm]")
        axes.legend()

    return Page(
        "drop", "Drop on a one-sided spring", [19],
        problem="A block of 1 kg, as good as rigid, falls 0.1 m on a joint of 10 kN/m that only presses. Gravity is a body force, "
                "since the key `gravity` would start from equilibrium, and there is none above an open joint.",
        reference="v = sqrt(2 g h); compression g/w^2 + sqrt((g/w^2)^2 + (v/w)^2); contact (2 pi - 2 atan(v w / g)) / w; period "
                  "2 v / g + contact.",
        rows=rows, code=["src/physics/joint.rs::respond", "src/solve/contact.rs"], plot=plot,
        example=(run, "the deepest compression is -0.1 m less the smallest `FOOT.uy` in histories.csv."),
        notes="Two bounces are followed without any loss put in. The block is one element of steel-like stiffness, not a point: its own "
              "compliance and vibration are the 2e-5 of the tolerances, and the greatest force is a mean over 0.2 ms.",
    )


def crossings(t, x):
    """Times at which x changes sign, by straight lines."""
    i = np.flatnonzero(np.sign(x[:-1]) * np.sign(x[1:]) < 0)
    return t[i] - x[i] * (t[i + 1] - t[i]) / (x[i + 1] - x[i])


def maxima(t, v):
    """Times of the tops: t = 0, and where the velocity goes from up to down."""
    i = np.flatnonzero((v[:-1] > 0) & (v[1:] <= 0))
    return np.concatenate([[0], t[i] - v[i] * (t[i + 1] - t[i]) / (v[i + 1] - v[i])])


def mean_acceleration(t, v):
    """The greatest acceleration, of means over 0.2 ms: the block's own vibration is left out."""
    n = max(1, round(2e-4 / (t[1] - t[0])))
    means = (v[n:] - v[:-n]) / (t[n:] - t[:-n])
    return means.max()
