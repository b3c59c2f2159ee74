"""Item 9: a uniform column under a step of pressure swings like a string."""

import numpy as np

from book.lib import Page, Row

H, E, GAMMA, P = 10.0, 50e6, 20e3, 1e5  # m, Pa, N/m^3, Pa; nu = 0, so M = E
RHO = GAMMA / 9.81
C = np.sqrt(E / RHO)
PERIOD = 4 * H / C


def settlement(depth, t):
    """d'Alembert with the images at surface and base: w = (P/M) c integral of the passing fronts, T periodic."""
    bounded = np.mod(t, PERIOD)
    ramp = lambda s: C * np.clip(s, 0, None)
    arrivals = [(depth / C, 1), ((2 * H - depth) / C, -1), ((2 * H + depth) / C, -1), ((4 * H - depth) / C, 1)]
    return P / E * sum(sign * ramp(bounded - at) for at, sign in arrivals)


def page(book):
    size = 0.1 if book.quick else 0.05
    steps = 800 if book.quick else 1600
    run = book.run("uniform_column", geo={"size": size}, sets={
        "time": {"step": 2 * PERIOD / (2 * steps), "end": 2 * PERIOD}, "output": {"every": PERIOD}})
    history = run.histories
    t, top, middle = history["t"], -history["top.uy"], -history["middle.uy"]
    peak = 2 * P * H / E
    rows = []
    why = "the front is smeared over some elements"
    for name, w, depth in [("surface", top, 0.0), ("middle", middle, H / 2)]:
        error = abs(w - settlement(depth, t)).max() / peak
        rows.append(Row(f"w at the {name}, largest error over its peak at the surface", 0, error, 1e-2,
                        relative=False, why=why, quick=(1.5e-2, "elements twice as high")))
    at_half = lambda a, b: np.polyfit(t[(t > a) & (t < b)], top[(t > a) & (t < b)], 1)
    rising, falling = at_half(0.1 * PERIOD, 0.4 * PERIOD), at_half(0.6 * PERIOD, 0.9 * PERIOD)
    again = at_half(1.1 * PERIOD, 1.4 * PERIOD)
    zero = lambda line: -line[1] / line[0]
    crossing = (falling[1] - rising[1]) / (rising[0] - falling[0])
    why = "straight lines through the flanks of the zigzag, away from the smeared tips"
    rows += [
        Row("particle velocity behind the front, p/(rho c)", P / (RHO * C), rising[0], 1e-3, "m/s", why=why),
        Row("largest settlement 2pH/M", 1e3 * peak, 1e3 * np.polyval(rising, crossing), 1e-3, "mm", why=why),
        Row("its time 2H/c", 2 * H / C, crossing, 1e-3, "s", why=why),
        Row("period 4H/c", 0.2554, zero(again) - zero(rising), 1e-3, "s", why=why),
    ]

    def plot(axes):
        for w, depth, colour, name in [(top, 0.0, "C0", "surface"), (middle, H / 2, "C1", "half depth")]:
            axes.plot(t, 1e3 * w, colour, linewidth=0.9, label=name)
            axes.plot(t[::40], 1e3 * settlement(depth, t[::40]), colour + ".", markersize=3)
        axes.set(xlabel="t [s]", ylabel="settlement [mm]")
        axes.grid(alpha=0.3)
        axes.legend(title="line: program, dots: exact")

    return Page(
        "uniform_column", "Uniform column under a step", [9],
        problem="H = 10 m, E = 50 MPa, nu = 0, rho g = 20 kN/m3 (g = 9.81 m/s2) on a rigid base between rollers; 100 kPa on "
                "the surface from t = 0 on.",
        reference="d'Alembert: w(0) = p t/(rho c) until 2H/c, back to 0 at 4H/c = 0.2554 s, and so on.",
        rows=rows, plot=plot, example=(run, "w is -`top.uy` and -`middle.uy` in histories.csv."),
        notes=f"Elements of {size:g} m, {steps} steps a period, consistent mass, trapezium rule, no damping.",
        code=["src/solve/newmark.rs::Constants", "src/solve/start.rs::with_acceleration", "geo/verification/uniform_column.geo"],
    )
