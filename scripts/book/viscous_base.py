"""Item 10: a step of pressure leaves a column through a viscous base."""

import numpy as np

from book.lib import Page, Row

H, E, NU, RHO, P = 10.0, 1e7, 0.2, 1855.0, 10.0
M = E * (1 - NU) / ((1 + NU) * (1 - 2 * NU))
C = np.sqrt(M / RHO)
V = P / (RHO * C)
RISE = 0.02  # [s]


def page(book):
    size = 0.1 if book.quick else 0.05
    run = book.run("viscous_base", geo={"size": size}, sets={"time.step": size / C / 3})
    history = run.histories
    t = history["t"]
    rows = []
    for name, depth in [("top", 0.0), ("middle", H / 2), ("base", H)]:
        v = -history[f"{name}.vy"]
        plateau = (t > depth / C + 0.03) & (t < 0.38)
        rows.append(Row(f"particle velocity behind the front, {name}: mean", 6.96545e-5, v[plateau].mean(), 2e-3, "m/s",
                        why="what rings behind the front averages out"))
        w = -history[f"{name}.uy"]
        exact = V * np.clip(t - depth / C, 0, None)
        rows.append(Row(f"displacement, {name}: largest error over that at the end", 0, abs(w - exact).max() / (V * 0.4),
                        3e-3, relative=False, why="the front is smeared over some elements"))
    w = -history["base.uy"]
    late = t > H / C + 0.03
    line = np.polyfit(t[late], w[late], 1)
    rows.append(Row("arrival at 10 m", 0.12921, -line[1] / line[0], 2e-3, "s", why="where the straight line of w(t) meets 0"))
    returned = lambda t: (t > 2 * H / C + 0.03) & (t < 0.38)
    ringing = np.sqrt(((-history["top.vy"][returned(t)] / V - 1) ** 2).mean())
    smooth = np.linspace(0, RISE, 41)
    risen = book.run("viscous_base", geo={"size": size}, tag="risen", sets={
        "time.step": size / C / 3, "loads.surface.pressure": {
            "law": "table", "times": smooth, "values": P * (0.5 - 0.5 * np.cos(np.pi * smooth / RISE))}}).histories
    why = "with a rise of 20 ms (1.5 m of way) the mesh resolves the wave: a reflection r would stand here as r"
    for name in ["top", "middle", "base"]:
        v = -risen[f"{name}.vy"][returned(risen["t"])]
        rows.append(Row(f"smooth rise, {name}: what returns, largest over v", 0, abs(v / V - 1).max(), 1e-3, relative=False, why=why))

    def plot(axes):
        for name, depth, colour in [("top", 0.0, "C0"), ("middle", H / 2, "C1"), ("base", H, "C2")]:
            axes.plot(t, -1e5 * history[f"{name}.vy"], colour, linewidth=0.7, label=f"z = {depth:g} m")
            axes.plot([0, depth / C, depth / C, t[-1]], [0, 0, 1e5 * V, 1e5 * V], colour + "--", linewidth=0.8)
        axes.axvline(2 * H / C, color="0.6", linewidth=0.8)
        axes.set(xlabel="t [s] (grey: 2H/c, when a wave could be back)", ylabel="particle velocity [1e-5 m/s]")
        axes.legend(title="line: program, dashes: exact")

    return Page(
        "viscous_base", "Viscous base", [10],
        problem="H = 10 m, E = 10 MPa, nu = 0.2, rho = 1855 kg/m3 between rollers, dashpots of rho c_p at the base; 10 Pa on "
                "the surface from t = 0 on.",
        reference="d'Alembert in a half-space: v = p/(rho c) = 6.96545e-5 m/s behind the front, c = 77.394 m/s, arrival at "
                  "10 m at 0.12921 s, and nothing returns (Lysmer and Kuhlemeyer 1969: exact at normal incidence).",
        rows=rows, plot=plot, example=(run, "v behind the front is `top.vy`, `middle.vy`, `base.vy` in histories.csv."),
        notes="The jump of the load contains waves too short for the mesh. With consistent mass and a step this "
              "short they travel faster than c: they run ahead of the front, as the picture shows, and ring behind it, "
              f"{100 * ringing:.1f} % of v (rms) at the surface after 2H/c, so that velocities are averaged; that "
              "nothing returns is therefore shown with a smooth rise of 20 ms. A "
              "dashpot has no static stiffness: the column goes on moving, as a half-space does. A P wave at normal incidence meets "
              "only the dashpots of rho c_p; those of rho c_s have the page `viscous_shear`.",
        code=["src/solve/assembly.rs::dashpots", "src/solve/assembly.rs::dashpot_block", "geo/verification/uniform_column.geo"],
    )
