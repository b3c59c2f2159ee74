"""Item 1: the patch test of MacNeal and Harder, and the rigid motions of its plate."""

import numpy as np

from book.lib import Page, Row

STRESS = np.array([1600.0, 1600.0, 800.0, 400.0])  # xx, yy, zz, xy [Pa]
ELEMENTS = {"T3": (3, 1, "standard"), "Q4": (4, 1, "standard"), "B-bar Q4": (4, 1, "b_bar"),
            "T6": (3, 2, "standard"), "Q8": (4, 2, "standard")}  # corners, order, quad4


def displacement(points):
    """u = 1e-3 (x + y/2), v = 1e-3 (y + x/2) turned by -5e-4, so that the edge y = 0 rests on its supports."""
    x, y = points.T
    return 1e-3 * np.stack([x + y, y], axis=1)


def page(book):
    rows = []
    for name, (corners, order, quad4) in ELEMENTS.items():
        geo, sets = {"corners": corners, "order": order}, {"elements.quad4": quad4}
        run = book.run("patch", geo=geo, sets=sets)
        frame = run.frame()
        exact = displacement(frame.points)
        stress = abs(frame.stress / STRESS - 1).max()
        rows.append(Row(f"{name}: largest error of stress over the exact's", 0, stress, 1e-12, relative=False,
                        why="round-off of a small system"))
        rows.append(Row(f"{name}: largest error of displacement over the largest", 0,
                        abs(frame.displacement - exact).max() / abs(exact).max(), 1e-12, relative=False,
                        why="round-off of a small system"))
        rows += rigid_motions(book, name, geo, sets)
    for i, (component, exact) in enumerate(zip(["s_xx", "s_yy", "s_zz", "s_xy"], STRESS)):
        far = frame.stress[np.argmax(abs(frame.stress[:, i] - exact)), i]
        rows.append(Row(f"Q8: {component}, of all elements the one farthest off", exact, far, 1e-12, "Pa", why="round-off of a small system"))

    def plot(axes):
        for face in frame.faces:
            loop = [*face[:4], face[0]]
            axes.plot(*frame.points[loop].T, "0.6", linewidth=0.8)
            axes.plot(*(frame.points + 60 * frame.displacement)[loop].T, "C0", linewidth=0.8)
        axes.plot(*frame.points.T, ".", color="0.6", label="mesh (Q8)")
        axes.plot(*(frame.points + 60 * frame.displacement).T, "C0.", label="displacements of the program, 60 times")
        axes.plot(*(frame.points + 60 * displacement(frame.points)).T, "k+", label="exact")
        axes.set(aspect="equal", xlabel="x", ylabel="y")
        axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1), ncols=3, fontsize=8)

    return Page(
        "patch", "Patch test (MacNeal and Harder)", [1],
        problem="A plate of 0.24 x 0.12 in five distorted quadrilaterals with the inner nodes (.04, .02), (.18, .03), "
                "(.16, .08), (.08, .08), each cut in two for triangles; E = 1e6, nu = 0.25, plane strain. Tractions of the "
                "uniform stress s_xx = s_yy = 1600, s_xy = 400 act on the edges, on three supports that only keep it from "
                "moving as a rigid body.",
        reference="R. H. MacNeal and R. L. Harder, A proposed standard set of problems to test finite element accuracy, "
                  "*Finite Elements in Analysis and Design* 1 (1985): u = 1e-3 (x + y/2), v = 1e-3 (y + x/2). Here the plate "
                  "is turned by -5e-4, so that its lower edge rests on the supports: u = 1e-3 (x + y), v = 1e-3 y. In plane "
                  "strain s_zz = nu (s_xx + s_yy) = 800. A body without supports moves freely in exactly three ways.",
        rows=rows,
        notes="The edge is loaded, not moved: the program has no prescribed displacements. The test with moved edges stands in "
              "`tests/patch.rs`, on the same elements. Rigid motions are counted on the whole plate, by its natural "
              "frequencies without supports; Q8 has 3 x 3 integration points, with 2 x 2 it had a fourth one of its own.",
        plot=plot, example=(run, "the stresses of the last rows are `stress` in the .vtu frame."),
        code=["src/physics/element.rs::stiffness", "src/physics/shape.rs::functions", "src/results/stress.rs", "tests/patch.rs"],
    )


def rigid_motions(book, name, geo, sets):
    frequencies = book.modes("patch", 4, geo=geo, sets={**sets, "supports": {}})
    zero = sum(f < 1e-4 * frequencies[-1] for f in frequencies)
    return [Row(f"{name}: rigid motions among the lowest four modes", 3, zero, 0, relative=False, why="a count")]
