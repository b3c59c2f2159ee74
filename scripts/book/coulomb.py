"""Item 22: a mass on a spring with dry friction, which stops at a known place."""

import numpy as np

from book.lib import Page, Row

EXTREMES = [0.105, -0.085, 0.065, -0.045, 0.025, -0.005]


def page(book):
    dt = 2e-4 if book.quick else 5e-5
    h = book.run("coulomb", sets={"time.step": dt}).histories
    t, u = h["t"], h["FOOT.ux"]
    half = np.pi / 10
    rows = []
    for i, exact in enumerate(EXTREMES):
        window = (t > (i - 0.5) * half) & (t < (i + 0.5) * half)
        found = u[window].max() if exact > 0 else u[window].min()
        rows.append(Row(f"extreme {i + 1}", exact, found, 5e-6 + (10 * dt) ** 2 / 40, "m", relative=False,
                        why="elastic offset 2 F / kappa = 2e-8 m, weight of the mesh's own compliance, and (omega dt)^2 / 4 of 0.1 m"))
    stop = u[t > 5 * half + 0.05]
    rows += [
        Row("stop position", -0.005, stop.mean(), 5e-6 + (10 * dt) ** 2 / 40, "m", relative=False, why="the same"),
        Row("motion after the stop, peak to peak", 0, np.ptp(stop), 1e-6, "m", relative=False, why="elastic vibration of the joint"),
        Row("time of the stop", np.pi / 2, t[np.flatnonzero(abs(u - stop.mean()) > 2e-5)[-1]], 0.01, "s",
            why="1 %: the last 2e-5 m take 6 ms of a parabola"),
    ]

    def plot(axes):
        axes.plot(t, 1e3 * u, label="program")
        axes.plot(half * np.arange(6), 1e3 * np.array(EXTREMES), "o", markersize=3, label="exact extremes")
        axes.set(xlabel="t [s]", ylabel="x [mm]")
        axes.legend()

    return Page(
        "coulomb", "Coulomb oscillator", [22],
        problem="A flat block of 1 kg under g = 2 m/s2 on a joint with friction 0.5 (F = 1 N), held sideways by a strip of 100 N/m, "
                "released 0.105 m off.",
        reference="Each half-swing is a cosine about +-F / k and loses 2 F / k = 0.02 m: extremes 0.105, -0.085, 0.065, -0.045, "
                  "0.025, -0.005, then |k x| < F: rest from 5 pi / 10 = 1.5708 s on.",
        rows=rows, code=["src/physics/joint.rs", "src/solve/contact.rs"], plot=plot,
        notes="The joint's elastic stiffness in shear, 1e8 Pa/m, gives way by 1e-8 m before it slips. The step must resolve the block on "
              "this stiffness (1.6 kHz): at dt = 1 ms the stopped block chatters about and creeps 1.3 mm in the 1.4 s after its stop; HHT with alpha = "
              "-0.1 stops that.",
    )
