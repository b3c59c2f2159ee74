"""Item 2: a straight joint at several angles under a uniform stress, and a stiff joint beside a merged mesh."""

import numpy as np

from book.lib import Page, Row, step

SIGMA = np.array([[-3e5, 4e4], [4e4, -2e5]])  # [Pa]
KN, KS = 3e9, 1e9  # [Pa/m]
ELEMENTS = {"T3": (3, 1), "Q4": (4, 1), "T6": (3, 2), "Q8": (4, 2)}
OUTWARD = {"bottom": (0, -1), "top": (0, 1), "left": (-1, 0), "right": (1, 0)}


def turned(degrees):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([[c, -s], [s, c]])


def tractions(degrees, sides=OUTWARD, sigma=SIGMA):
    """sigma n on each side of the turned square."""
    t = {side: sigma @ turned(degrees) @ np.array(OUTWARD[side], float) for side in sides}
    return {side: {"traction": step(np.hypot(*v), list(v))} for side, v in t.items()}


def patch(book, degrees, corners, order):
    across = "y" if abs(np.cos(np.radians(degrees))) > 0.5 else "x"
    sets = {"loads": tractions(degrees), "supports": {"pin": ["x", "y"], "roller": [across]}}
    geo = {"angle": degrees, "corners": corners, "order": order}
    frame = book.run("joint_patch", geo=geo, sets=sets, tag=f"{corners}_{order}_{degrees}").frame()
    normal = turned(degrees) @ [0, -1]  # out of the body, which lies above
    tangent = np.array([-normal[1], normal[0]])
    pressed, shear = normal @ SIGMA @ normal, tangent @ SIGMA @ normal
    # the two sides of the joint: nodes at one place
    _, place, count = np.unique(np.round(frame.points, 9), axis=0, return_inverse=True, return_counts=True)
    pairs = [np.flatnonzero(place == i) for i in np.flatnonzero(count == 2)]
    jumps = np.array([frame.displacement[b] - frame.displacement[a] for a, b in pairs])
    exact = tangent * shear / KS + normal * pressed / KN
    jump = min(abs(sign * jumps - exact).max() for sign in (1, -1)) / np.hypot(*exact)
    normal_traction = abs(frame.normal_traction / pressed - 1).max()
    # across the joint only the sign of the shear depends on which way its tangent points
    shear_traction = abs(abs(frame.shear_traction) - abs(shear)).max() / abs(pressed)
    stress = abs(frame.stress[:, [0, 1, 3]] - [SIGMA[0, 0], SIGMA[1, 1], SIGMA[0, 1]]).max() / 3e5
    return len(pairs), jump, max(normal_traction, shear_traction), stress


def merged(book, stiffness):
    """Largest difference of displacement from the merged mesh over the largest displacement, under a load that bends."""
    sets = {"loads": tractions(17, ["left"]), "supports": {"bottom": ["x", "y"]}}
    joint = {"interfaces.joint.normal_stiffness": stiffness, "interfaces.joint.tangential_stiffness": stiffness,
             "materials.below.friction": 1e9, "loads": {**sets["loads"], "top": {"pressure": step(1e6)}}}
    geo = {"angle": 17, "along": 12}
    stiff = book.run("joint_patch", geo=geo, sets={**sets, **joint}, tag=f"stiff_{stiffness:g}").frame()
    glued = book.run("joint_patch", geo=geo, sets={**sets, **joint}, tag=f"merged_{stiffness:g}", bonded=True).frame()
    distance = np.hypot(*(stiff.points[:, None] - glued.points[None]).transpose(2, 0, 1))
    same = distance.argmin(axis=1)
    return abs(stiff.displacement - glued.displacement[same]).max() / abs(glued.displacement).max()


def page(book):
    angles = [17, 90] if book.quick else [0, 17, 45, 90, 133, -68, 180]
    rows = []
    for name, (corners, order) in ELEMENTS.items():
        found = np.array([patch(book, angle, corners, order) for angle in angles])
        why = "round-off, times the ratio of the joint's stiffness to the elements' (10 to 100)"
        rows.append(Row(f"{name}: pairs of nodes along the joint", 5 * order + 1, found[:, 0].min(), 0, relative=False, why="a count"))
        for i, what in enumerate(["jump", "traction of the joint", "stress of the elements"], start=1):
            rows.append(Row(f"{name}: largest relative error of the {what}, {len(angles)} angles", 0, found[:, i].max(), 1e-11,
                            relative=False, why=why))
    stiffness = np.array([1e11, 1e12, 1e13])
    difference = np.array([merged(book, k) for k in stiffness])
    rows.append(Row("difference from the merged mesh at k = 1e13 Pa/m", 0, difference[-1], 1e-5, relative=False,
                    why="E/(k h) with h = 0.1 m is 5e-5 of the joint's neighbours' strain"))
    for i in (0, 1):
        rows.append(Row(f"that difference, k {stiffness[i]:.0e} over {stiffness[i + 1]:.0e}", 10,
                        difference[i] / difference[i + 1], 0.05, why="in proportion to 1/k, the next term is smaller by E/(k h)"))

    def plot(axes):
        axes.loglog(stiffness, difference, "o-", label="Q4, bent square")
        axes.loglog(stiffness, difference[0] * stiffness[0] / stiffness, "k:", label="1/k")
        axes.set(xlabel="stiffness of the joint [Pa/m]", ylabel="difference from the merged mesh")
        axes.grid(alpha=0.3)
        axes.legend()

    return Page(
        "joint_patch", "Inclined joint under uniform stress", [2],
        problem="A square of 1 m with a straight joint through its middle, turned by several angles; the joint's elements have "
                "lengths that differ by 1 to 3.8. Tractions of the stress s_xx = -300, s_yy = -200, s_xy = 40 kPa act on all "
                "sides. Then the joint is made stiff in a bent square, beside the same mesh without a joint.",
        reference="The stress is uniform, so that the joint carries s_n = n.S n and t = s.S n everywhere and opens by "
                  "g_n = s_n/k_n and slides by g_t = t/k_s. With k to infinity it is no joint, and the difference falls as 1/k.",
        rows=rows, plot=plot,
        notes="`newton.tolerance` is 1e-12 here: with the default 1e-8 the iteration of a static step may stop 1e-9 from the "
              "solution. Friction is set so high that nothing slides. The one middle point of the paper (\"gauss_1\") is not shown here; "
              "see `tests/patch.rs`.",
        code=["src/physics/joint.rs", "src/solve/interface.rs", "src/solve/contact.rs", "tests/patch.rs"],
    )
