"""Item 23: line contact of Hertz, the profile of the cylinder as one gap a joint."""

import numpy as np

from book.lib import Page, Row

RADIUS, FORCE = 0.6, 1e6  # [m], [N/m]
E, NU = 210e9, 0.3
WIDE, SIZE = 2.4e-3, 0.1  # of half the strip and half the block [m]


def exact():
    """b = sqrt(4 F R/(pi E*)), p0 = 2 F/(pi b), 1/E* = (1 - nu^2)/E (K. L. Johnson, Contact Mechanics, 4.2(c))."""
    b = np.sqrt(4 * FORCE * RADIUS * (1 - NU**2) / (np.pi * E))
    return b, 2 * FORCE / (np.pi * b)


def interfaces(n):
    """Each joint's gap is the profile x^2/2R at its middle point, where its law holds."""
    x = (np.arange(n) + 0.5) * WIDE / n
    return {f"joint_{i + 1}": {"body": "block", "integration": "gauss_1", "friction": 0, "gap": float(xi**2 / (2 * RADIUS)),
                               "normal_stiffness": 1e18, "tangential_stiffness": 1e18} for i, xi in enumerate(x)}


def without_zigzag(x, p):
    """Joints from the axis outwards, each pressure with half of either neighbour's: what alternates from joint to joint, which
    a joint with one point does not see, falls out. The axis is a plane of symmetry."""
    order = np.argsort(x)
    p = np.concatenate([p[order[:1]], p[order], [0]])
    return x[order], (p[:-2] + 2 * p[1:-1] + p[2:]) / 4


def page(book):
    b, p0 = exact()
    rows, curves, cells = [], [], []
    counts = [16, 32] if book.quick else [16, 32, 64]
    for n in counts:
        frame = book.run("hertz", geo={"n": n}, sets={"interfaces": interfaces(n)}, tag=f"n{n}").frame()
        x = np.array([frame.points[j].mean(axis=0)[0] for j in frame.joints])
        p = -frame.normal_traction
        total = 2 * (p * WIDE / n).sum()
        x, p = without_zigzag(x, p)
        inside = x < 0.9 * b
        slope, top = np.polyfit(x[inside] ** 2, p[inside] ** 2, 1)  # p^2 = p0^2 (1 - x^2/b^2)
        found = np.sqrt(-top / slope), np.sqrt(top)
        curves.append((n, x, p))
        cells.append([str(n), f"{WIDE / n / b:.3f}", f"{1e3 * found[0]:.5f}", f"{found[1] / 1e6:.3f}"])
    why = "0.5 % is the book's aim; the quick form has 24 joints in the half-width"
    rows.append(Row("half-width of contact b", 1e3 * b, 1e3 * found[0], 0.005, "mm", why=why))
    rows.append(Row("largest pressure p0", p0 / 1e6, found[1] / 1e6, 0.005, "MPa", why=why))
    rows.append(Row("sum of the pressures", FORCE / 1e6, total / 1e6, 1e-6, "MN/m", why="equilibrium, to the solver's tolerance"))
    n, x, p = curves[-1]
    _, law = without_zigzag(x, p0 * np.sqrt(np.clip(1 - (x / b) ** 2, 0, None)))
    rows.append(Row("pressure along the contact, rms error over p0", 0, np.sqrt(((p - law) ** 2).mean()) / p0, 0.01,
                    relative=False, why="1 %: the joints at the edge of contact, where the law, averaged like the pressures, has an upright tangent"))

    def plot(axes):
        fine = np.linspace(0, WIDE, 500)
        axes.plot(1e3 * fine, p0 * np.sqrt(np.clip(1 - (fine / b) ** 2, 0, None)) / 1e6, "k", label="Hertz")
        for n, x, p in curves:
            order = np.argsort(x)
            axes.plot(1e3 * x[order], p[order] / 1e6, ".", label=f"{n} joints")
        axes.set(xlabel="distance from the axis [mm]", ylabel="contact pressure [MPa]")
        axes.grid(alpha=0.3)
        axes.legend()

    return Page(
        "hertz", "Line contact of Hertz", [23],
        problem="A steel cylinder of R = 0.6 m pressed on a rigid plane with 1 MN/m.",
        reference="b = sqrt(4 F R/(pi E*)), p0 = 2F/(pi b), p = p0 sqrt(1 - x^2/b^2), 1/E* = (1 - nu^2)/E (K. L. Johnson, "
                  "*Contact Mechanics*, section 4.2): b = 1.819457 mm, p0 = 349.8955 MPa.",
        rows=rows, plot=plot,
        tables=[("Refinement", ["joints", "length of a joint over b", "b [mm]", "p0 [MPa]"], cells)],
        notes="Both sides of a joint lie on each other in the mesh and an interface has one gap, so that the cylinder is a flat "
              "block and its profile x^2/2R stands in the gaps of as many interfaces as there are joints, as in Hertz' theory "
              "itself. The block is 0.2 x 0.1 m, the rigid plane a strip 1e5 times as stiff. The joint that the edge of contact "
              "cuts sets off a zig-zag of pressure from joint to joint, up to 6 % of p0 next to the edge with 64 joints, which joints "
              "with one point cannot resist; pressures are therefore means over three joints, (1, 2, 1) / 4. b and p0 are those of the straight "
              "line through p^2 over x^2 for x < 0.9 b.",
        code=["src/physics/joint.rs", "src/solve/contact.rs", "geo/verification/hertz.geo"],
    )
