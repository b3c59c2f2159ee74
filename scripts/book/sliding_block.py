"""Item 21: a block on an incline, and a block that is pulled."""

import numpy as np

from book.lib import Page, Row

G, SLOPE = 9.81, np.pi / 6
STIFF, LOAD = 1e7, 1000 * 0.002 * G  # of the incline's joint [Pa/m], weight over area [Pa]


def incline(book, mu):
    """Motion down the slope of the block, released in the joint's own elastic equilibrium."""
    shift = LOAD / STIFF  # joint of one stiffness in both directions: the spring lies along the weight
    start = [0, -shift]
    h = book.run("incline", sets={"interfaces.foot.friction": mu, "initial.block.displacement": start}).histories
    down = np.array([-np.cos(SLOPE), -np.sin(SLOPE)])
    return h["t"], (h["FOOT.ux"] - start[0]) * down[0] + (h["FOOT.uy"] - start[1]) * down[1]


def page(book):
    mu, rows = 0.3, []
    acceleration = G * (np.sin(SLOPE) - mu * np.cos(SLOPE))
    t, s = incline(book, mu)
    offset = mu * LOAD * np.cos(SLOPE) / STIFF
    rows += [
        Row("incline, mu = 0.3: s(1 s)", acceleration / 2, s[-1], 1e-4, "m",
            why=f"the joint's elastic offset mu p / kappa = {offset:.1e} m and its vibration"),
        Row("the same beside the printed 1.178144", 1.178144, s[-1], 1e-4, "m", why="the same"),
        Row("incline, mu = 0.3: acceleration, by a parabola through s(t)", 2.356287, 2 * np.polyfit(t, s, 2)[0], 1e-4, "m/s2",
            why="the same"),
    ]
    for factor, slides in [(0.99, True), (1.01, False)]:
        mu_here = factor * np.tan(SLOPE)
        _, s_here = incline(book, mu_here)
        exact = G * (np.sin(SLOPE) - mu_here * np.cos(SLOPE)) / 2 if slides else 0
        rows.append(Row(f"incline, mu = {factor} tan 30 deg: s(1 s), it {'slides' if slides else 'sticks'}", exact, s_here[-1],
                        1e-5, "m", relative=False, why="some times the joint's elastic offset of 1e-6 m"))
    pulled = {}
    for factor in [0.99, 1.01]:
        sets = {"loads.block.body_force.values": [0, 500 * factor]}
        h = book.run("pulled_block", sets=sets).histories
        pulled[factor] = h["t"], h["FOOT.ux"]
    rows.append(Row("block pulled up to 0.99 mu N: velocity kept after 1 s", 0, drift(*pulled[0.99]), 1e-6, "m/s", relative=False,
                    why="joint's elastic motion of 5e-8 m"))
    # F = 5 min(t, 1) of 1 kg against mu N = 5 N: free from t = 1 / 1.01 on
    begin, rate = 1 / 1.01, 5 * 1.01
    speed = rate / 2 * (1 - begin) ** 2
    exact = rate / 6 * (1 - begin) ** 3 + speed + (rate - 5) / 2
    rows.append(Row("block pulled up to 1.01 mu N: way at 2 s", exact, pulled[1.01][1][-1], 5e-3, "m",
                    why="the foot's two sides begin to slide one after the other, since the pull acts above the foot"))

    def plot(axes):
        axes.plot(t, s, label="incline, mu = 0.3")
        axes.plot(t, acceleration * t**2 / 2, "--", color="0.5", label="exact")
        for factor, (time, u) in pulled.items():
            axes.plot(time, 10 * u, label=f"pulled at {factor} mu N, 10 x")
        axes.set(xlabel="t [s]", ylabel="way [m]")
        axes.legend()

    return Page(
        "sliding_block", "Block on an incline, block pulled", [21],
        problem="A flat block on a foundation turned by 30 degrees under its weight as a body force, released where the joint "
                "already carries it; and a block on level ground under gravity whose pull grows to 0.99 or 1.01 of mu N within 1 s.",
        reference="a = g (sin - mu cos) = 2.356287 m/s2 for mu = 0.3; it sticks where tan 30 deg <= mu. The pulled block moves once F "
                  "> mu N.",
        rows=rows, code=["src/physics/joint.rs", "src/solve/contact.rs", "src/solve/start.rs"], plot=plot,
        notes="The blocks are 1 m wide and flat, so that the moment of friction about their middle is small and no corner lifts.",
    )


def drift(t, u):
    """Mean velocity over the last second."""
    late = t >= 1
    return abs(np.polyfit(t[late], u[late], 1)[0])
