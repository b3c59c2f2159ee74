"""Item 23: line contact of Hertz, the profile of the cylinder as one gap a joint."""

import json

import numpy as np

from book.lib import CASES, ROOT, Failed, Page, Row

RADIUS, FORCE = 0.6, 1e6  # [m], [N/m]
E, NU = 210e9, 0.3
WIDE, SIZE = 2.4e-3, 0.1  # of half the strip and half the block [m]


def exact():
    """b = sqrt(4 F R/(pi E*)), p0 = 2 F/(pi b), 1/E* = (1 - nu^2)/E (K. L. Johnson, Contact Mechanics, 4.2(c))."""
    b = np.sqrt(4 * FORCE * RADIUS * (1 - NU**2) / (np.pi * E))
    return b, 2 * FORCE / (np.pi * b)


def interfaces(n, integration="lobatto"):
    """A gap a joint: the profile x^2/2R where its law holds, at the outer node (Lobatto) or in the middle (one Gauss point).

    At a node two joints meet; the gap of the inner one is the profile there, and that of the outer one is wider, so that
    its point stays open.
    """
    x = (np.arange(n) + (1.0 if integration == "lobatto" else 0.5)) * WIDE / n
    return {f"joint_{i + 1}": {"body": "block", "integration": integration, "friction": 0, "gap": float(xi**2 / (2 * RADIUS)),
                               "normal_stiffness": 1e18, "tangential_stiffness": 1e18} for i, xi in enumerate(x)}


def pressed(book, n, integration="lobatto"):
    """(run, x, p, force): pressure p where the law holds, from the axis outwards, and the whole force [N/m]."""
    as_stored = (n, integration) == (32, "lobatto")  # the case file's own gaps
    run = book.run("hertz", geo={} if as_stored else {"n": n}, tag=f"n{n}_{integration}",
                   sets={} if as_stored else {"interfaces": interfaces(n, integration)})
    frame = run.frame()
    middles = np.array([frame.points[j].mean(axis=0)[0] for j in frame.joints])
    outwards = np.argsort(middles)
    x, p = middles[outwards], -frame.normal_traction[outwards]
    force = 2 * p.sum() * WIDE / n
    if integration == "lobatto":  # all of a joint's force stands at its outer node; the first one bears the axis' node too
        x, p = x[1:] + WIDE / n / 2, p[1:]
    return run, x, p, force


def measured(x, p):
    """(b, p0, rms error over p0, zig-zag): line through p^2 = p0^2 (1 - x^2/b^2) for x < 0.9 b; the largest second
    difference over 4 p0 there, next to the law's own."""
    b, p0 = exact()
    law = p0 * np.sqrt(np.clip(1 - (x / b) ** 2, 0, None))
    inside = x < 0.9 * b
    slope, top = np.polyfit(x[inside] ** 2, p[inside] ** 2, 1)
    zigzag = abs(np.diff((p - law)[inside], 2)).max() / (4 * p0)
    return np.sqrt(-top / slope), np.sqrt(top), np.sqrt(((p - law) ** 2).mean()) / p0, zigzag


def page(book):
    b, p0 = exact()
    stored = json.loads((ROOT / CASES / "hertz.json").read_text(encoding="utf-8"))["interfaces"]
    if stored != interfaces(32):
        raise Failed("geo/verification/hertz.json holds other gaps than scripts/book/hertz.py: write those of interfaces(32)")
    rows, curves, cells = [], [], []
    for n in [16, 32] if book.quick else [16, 32, 64]:
        for integration in ["gauss_1", "lobatto"]:
            run, x, p, force = pressed(book, n, integration)
            found = measured(x, p)
            curves.append((n, integration, x, p))
            cells.append([str(n), integration, f"{WIDE / n / b:.3f}", f"{1e3 * found[0]:.5f}", f"{found[1] / 1e6:.3f}",
                          f"{100 * found[2]:.2f} %", f"{100 * found[3]:.3f} %"])
        if n == 32:
            example = run
    why = "the edge of contact lies between two nodes 2 % of b apart; the error falls with their distance"
    quick = "nodes 4 % of b apart"
    rows += [Row("half-width of contact b", 1e3 * b, 1e3 * found[0], 5e-4, "mm", why=why, quick=(2e-3, quick)),
             Row("largest pressure p0", p0 / 1e6, found[1] / 1e6, 3e-4, "MPa", why=why, quick=(6e-4, quick)),
             Row("b beside the printed 1.819457 mm", 1.819457, 1e3 * found[0], 5e-4, "mm", why=why, quick=(2e-3, quick)),
             Row("p0 beside the printed 349.8955 MPa", 349.8955, found[1] / 1e6, 3e-4, "MPa", why=why, quick=(6e-4, quick)),
             Row("sum of the pressures", FORCE / 1e6, force / 1e6, 1e-9, "MN/m", why="equilibrium: the solver's tolerance is 1e-8 of its largest term, and the residual here far below"),
             Row("pressure along the contact, rms error over p0", 0, found[2], 2e-3, relative=False,
                 why="the node at the edge, where p falls with infinite slope, makes most of it", quick=(5e-3, quick)),
             Row("zig-zag from node to node within 0.9 b, over p0", 0, found[3], 5e-4, relative=False,
                 why="two points a joint, at the nodes: no pressure is without force", quick=(2e-3, quick))]

    def plot(axes):
        fine = np.linspace(0, WIDE, 500)
        axes.plot(1e3 * fine, p0 * np.sqrt(np.clip(1 - (fine / b) ** 2, 0, None)) / 1e6, "k", label="Hertz")
        for n, integration, x, p in curves[-2:]:
            axes.plot(1e3 * x, p / 1e6, {"lobatto": "o", "gauss_1": "x"}[integration], markersize=3, label=f"{n} joints, {integration}")
        axes.set(xlabel="distance from the axis [mm]", ylabel="contact pressure [MPa]")
        axes.grid(alpha=0.3)
        axes.legend()

    return Page(
        "hertz", "Line contact of Hertz", [23],
        problem="A steel cylinder of R = 0.6 m pressed on a rigid plane with 1 MN/m.",
        reference="b = sqrt(4 F R/(pi E*)), p0 = 2F/(pi b), p = p0 sqrt(1 - x^2/b^2), 1/E* = (1 - nu^2)/E (K. L. Johnson, "
                  "*Contact Mechanics*, section 4.2): b = 1.819457 mm, p0 = 349.8955 MPa.",
        rows=rows, plot=plot,
        example=(example, "32 joints: the table's b and p0 are the line through p^2 over x^2, p the `normal_traction` of the joints in the frame."),
        tables=[("Refinement, and one Gauss point a joint", ["joints", "integration", "length of a joint over b", "b [mm]", "p0 [MPa]", "rms of p", "zig-zag"], cells)],
        notes="Both sides of a joint lie on each other in the mesh and an interface has one gap, so that the cylinder is a flat "
              "block and its profile x^2/2R stands in the gaps of as many interfaces as there are joints, as in Hertz' theory "
              "itself: that of a joint is the profile at its outer node. The block is 0.2 x 0.1 m, the rigid plane a strip 1e5 times as stiff. b and p0 are those of the straight "
              "line through p^2 over x^2 for x < 0.9 b. **What misses:** with one Gauss point a joint, as the paper has it, the pressures "
              "zig-zag from joint to joint by up to 4 % of p0, and refinement does not mend it: pressures +q, -q, +q ... of joints of one "
              "length put no force on any node between them, so that nothing but the ends of the contact and the joints' own compliance "
              "fixes q. The nodal forces, means of two neighbours, are right. Lobatto's points have no such pressure.",
        code=["src/physics/joint.rs::respond", "src/solve/interface.rs::rule", "src/solve/contact.rs", "geo/verification/hertz.geo"],
    )
