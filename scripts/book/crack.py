"""A closed crack with friction, inclined to the pressure on a plate: an interface with two ends inside the solid."""

import numpy as np

from book.lib import Page, Row

YOUNG, POISSON, FRICTION, PRESSURE = 1e9, 0.25, 0.3, 1e6


def slips(angle):
    """Shear stress on the crack beyond what friction carries [Pa], the far field's pressure resolved on its line."""
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    return PRESSURE * (s * c - FRICTION * c * c)


def exact(x, angle):
    """Tangential jump at the distance x [m] from the middle of a crack of half length 1 m in an infinite plane [m]."""
    return 4 * (1 - POISSON**2) / YOUNG * slips(angle) * np.sqrt(1 - x**2)


def page(book):
    along = 20 if book.quick else 60
    rows, curves = [], []
    for angle in [45] if book.quick else [30, 45, 60]:
        result = book.run("crack", geo={"angle": angle, "along": along})
        h = result.histories
        jump = np.hypot(*[h[f"middle@ground.{u}"][-1] - h[f"middle.{u}"][-1] for u in ("ux", "uy")])
        rows.append(Row(f"slip at the middle, crack at {angle} degrees", exact(0, angle), jump, 0.01, "m",
                        why="plate of 20 times the crack for an infinite one: (1/20)^2; elements of 1/30 at the tips",
                        quick=(0.03, "elements of 1/10 at the tips")))
        frame = result.frame()
        centres = np.array([frame.points[list(nodes)[:2]].mean(axis=0) for nodes in frame.joints])
        x = np.hypot(*centres.T)
        inner = x < 0.9
        error = abs(abs(frame.slip[inner]) / exact(x[inner], angle) - 1).max()
        rows.append(Row(f"largest relative error of the slip of a joint with |x| < 0.9, {angle} degrees", 0, error, 0.03,
                        relative=False, why="a joint's mean over 1/30 of the half length, where the slip falls to 44 %",
                        quick=(0.08, "joints of 1/10")))
        rows.append(Row(f"open joint points, {angle} degrees", 0, (frame.status == 3).sum(), 0, relative=False,
                        why="the crack is pressed together everywhere"))
        signed = x * np.sign(centres[:, 0])
        curves.append((angle, signed[np.argsort(signed)], 1e3 * abs(frame.slip)[np.argsort(signed)]))

    def plot(axes):
        x = np.linspace(-1, 1, 400)
        for angle, place, slip in curves:
            axes.plot(place, slip, "o", markersize=2, label=f"program, {angle} degrees")
            axes.plot(x, 1e3 * exact(x, angle), "k-", linewidth=0.6)
        axes.set(xlabel="distance from the middle over half the length", ylabel="slip [mm]")
        axes.legend()

    return Page(
        "crack", "Closed crack with friction", [],
        problem="A plate of 40 m with a straight crack of 2 m in its middle, inclined to the pressure of 1 MPa on its top; "
                "friction 0.3. The crack is an interface inside one material, with two ends in it.",
        reference="The pressure resolved on the crack leaves tau - f sigma_n = p (sin a cos a - f cos^2 a) to drive the slip of a "
                  "mode II crack in an infinite plane: jump(x) = 4 (1 - nu^2)/E (tau - f sigma_n) (a^2 - x^2)^(1/2).",
        rows=rows, code=["src/model/split.rs", "src/physics/joint.rs"], plot=plot,
        notes="The joints, 1e12 Pa/m, give way by 5e-7 m before they slip, 4e-4 of the slip at 45 degrees. At 1e13 Pa/m, 300 times the stiffness of the elements beside them, equilibrium is found as well; at 1e14 Pa/m round-off is above newton.tolerance = 1e-12 at some angles.",
    )
