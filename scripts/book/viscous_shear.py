"""Item 10: shear leaves a column through the tangential dashpots of a viscous base."""

import numpy as np

from book.lib import Page, Row

H, E, NU, RHO, TAU = 10.0, 1e7, 0.2, 1855.0, 10.0
C = np.sqrt(E / (2 * (1 + NU)) / RHO)  # S wave [m/s]
V = TAU / (RHO * C)
RISE, END = 0.04, 0.65  # [s]


def page(book):
    size = 0.1 if book.quick else 0.05
    step = {"time.step": size / C / 3}
    run = book.run("viscous_shear", geo={"size": size}, sets=step)
    smooth = np.linspace(0, RISE, 41)
    risen = book.run("viscous_shear", geo={"size": size}, tag="risen", sets={
        **step, "loads.surface.traction.law": "table", "loads.surface.traction.peak": None,
        "loads.surface.traction.times": smooth, "loads.surface.traction.values": TAU * (0.5 - 0.5 * np.cos(np.pi * smooth / RISE))})
    t, u = run.histories["t"], run.histories["base.ux"]
    arrived = t > H / C + 0.05
    slope, offset = np.polyfit(t[arrived], u[arrived], 1)
    ringing = "what rings behind the front averages out over 0.3 s and more"
    rows = [
        Row("displacement of the base grows with tau / (rho c_s)", V, slope, 2e-3, "m/s", why=ringing),
        Row("arrival at 10 m, H / c_s", H / C, -offset / slope, 2e-3, "s", why="where the straight line of u(t) meets 0"),
    ]
    why = "with a rise of 40 ms (1.9 m of way) the mesh resolves the wave: a reflection r would stand here as r"
    after = (risen.histories["t"] > 2 * H / C + RISE + 0.02) & (risen.histories["t"] < END)
    for name in ["top", "middle", "base"]:
        v = risen.histories[f"{name}.vx"][after]
        rows.append(Row(f"smooth rise, {name}: what returns, largest over v", 0, abs(v / V - 1).max(), 1e-3, relative=False, why=why))
    across = max(abs(risen.histories[f"{name}.uy"]).max() for name in ["top", "middle", "base"])
    rows.append(Row("motion along the column", 0, across, 1e-15, "m", relative=False, why="shear alone; round-off of 4 mm"))

    def plot(axes):
        for name, depth, colour in [("top", 0.0, "C0"), ("middle", H / 2, "C1"), ("base", H, "C2")]:
            h = risen.histories
            axes.plot(h["t"], 1e5 * h[f"{name}.vx"], colour, linewidth=0.9, label=f"z = {depth:g} m")
            s = np.clip((h["t"] - depth / C) / RISE, 0, 1)
            axes.plot(h["t"][::20], 1e5 * V * (0.5 - 0.5 * np.cos(np.pi * s[::20])), colour + ".", markersize=3)
        axes.axvline(2 * H / C, color="0.6", linewidth=0.8)
        axes.set(xlabel="t [s] (grey: 2H/c_s, when a wave could be back)", ylabel="particle velocity [1e-5 m/s]")
        axes.legend(title="line: program, dots: exact")

    return Page(
        "viscous_shear", "Viscous base under shear", [10],
        problem="The column of the page `viscous_base` with its sides held along y in place of x, so that it carries S waves, under a "
                "shear traction of 10 Pa on its surface: at once, and with a smooth rise of 40 ms.",
        reference=f"d'Alembert in a half-space: v = tau / (rho c_s) = {V:.6e} m/s, c_s = sqrt(G / rho) = {C:.4f} m/s, and nothing returns "
                  "(Lysmer and Kuhlemeyer 1969: rho c_s along the boundary is exact at normal incidence).",
        rows=rows, plot=plot, example=(run, "tau / (rho c_s) is the slope of `base.ux` over `t` in histories.csv."),
        notes="A dashpot of rho c_p in place of rho c_s would return (c_p - c_s) / (c_p + c_s) = 24 % of the wave. Velocities behind a jump "
              "ring, as the page `viscous_base` shows; so the first rows take the displacement and the last ones a smooth rise.",
        code=["src/solve/assembly.rs::dashpots", "src/solve/assembly.rs::dashpot_block", "geo/verification/uniform_column.geo"],
    )
