"""A pipe whose joint runs along its arch only: an arc crack under tension, and section forces of a pipe that slips there."""

import numpy as np

from book.element_forces import joint_forces, of_elements
from book.lib import Page, Row, step
from book.ring import last

YOUNG, POISSON, TENSION = 100e6, 0.25, 100e3  # of ground and disc [Pa]; all round [Pa]
PIPE = (30e9, 0.2, 2500)
INNER, OUTER = 0.8, 1.0
DISC = {"young": YOUNG, "poisson": POISSON, "density": 2000}


def exact(angle):
    """Opening and slide (ground less disc, along e_r and e_theta) of a crack along the upper half of the unit circle [m].

    angle: from the crown, anticlockwise [rad].
    """
    size = 8 * (1 - POISSON**2) * TENSION / (3 * YOUNG) * np.sqrt(2 * np.cos(angle))
    return size * np.cos(angle / 2), -size * np.sin(angle / 2)


def pairs(frame):
    """Angle from the crown, and jump along e_r and e_theta, ground less body, of the pairs of nodes inside the arch."""
    radius, angle = np.hypot(*frame.points.T), np.arctan2(-frame.points[:, 0], frame.points[:, 1])
    on = (abs(radius - OUTER) < 1e-6) & (abs(angle) < np.pi / 2 - 1e-6)
    outside = np.zeros(len(frame.points), bool)
    for face in frame.faces:
        outside[face] |= np.hypot(*frame.points[face].mean(axis=0)) > OUTER
    order = lambda where: np.flatnonzero(where)[np.argsort(angle[where])]
    ground, body = order(on & outside), order(on & ~outside)
    jump, a = frame.displacement[ground] - frame.displacement[body], angle[ground]
    return a, np.cos(a) * jump[:, 1] - np.sin(a) * jump[:, 0], -np.cos(a) * jump[:, 0] - np.sin(a) * jump[:, 1]


def torn(book):
    """The disc torn off its ground along the upper half by a tension all round."""
    sets = {"materials": {"pipe": DISC, "core": DISC, "soil": {**DISC, "friction": 0}},
            "loads": {side: {"pressure": step(-TENSION)} for side in ["top", "bottom", "left", "right"]}}
    geo = {"solid": 1, "far": 20 if book.quick else 40, "octant": 6 if book.quick else 16}
    return book.run("arch", geo=geo, sets=sets, tag="torn").frame()


def crack_rows(book, frame):
    angle, opening, slide = pairs(frame)
    sizes = exact(angle)
    inner = abs(angle) < 0.9 * np.pi / 2
    largest = sizes[0].max()
    why = "elements of 1/32 of the arc's half length at its tips, where stress is infinite; the ground ends at 40 radii"
    quick = (0.03, "elements of 1/12, the ground ends at 20 radii")
    crown = np.argmin(abs(angle))
    rows = [Row("arc crack: opening at the crown", 1e3 * sizes[0][crown], 1e3 * opening[crown], 0.01, "mm", why=why, quick=quick)]
    for what, got, should in [("opening", opening, sizes[0]), ("slide", slide, sizes[1])]:
        rows.append(Row(f"arc crack: largest error of the {what} over 0.9 of the arc, over the opening at the crown", 0,
                        abs(got - should)[inner].max() / largest, 0.01, relative=False, why=why, quick=quick))
    rows.append(Row("arc crack: traction of a joint over the tension", 0, abs(frame.traction_vector).max() / TENSION, 0, relative=False,
                    why="open everywhere"))
    return rows


def ground_at(frame, materials, places):
    """Force of the ground's elements on their nodes at the places (n, 2) [N/m]."""
    total = np.zeros_like(frame.points)
    for face, force in zip(frame.faces, of_elements(frame, materials)):
        if np.hypot(*frame.points[face].mean(axis=0)) > OUTER:
            total[face] += force
    return np.array([total[np.hypot(*(frame.points - place).T) < 1e-6].sum(axis=0) for place in places])


def section_rows(book):
    """A frictionless arch on a bonded bed: section forces against tractions."""
    result = book.run("arch", geo={"far": 6, "octant": 4} if book.quick else {"far": 10}, tag="pipe")
    frame, rings = result.frame(), last(result.rings())
    angle = np.radians(rings["angle_deg"])
    normal, tangent = np.stack([np.cos(angle), np.sin(angle)], 1), np.stack([-np.sin(angle), np.cos(angle)], 1)
    # force on what lies anticlockwise of a ray, and its moment about the centre
    force = -rings["N"][:, None] * tangent - rings["Q"][:, None] * normal
    moment = -(rings["N"] * (INNER + OUTER) / 2 + rings["M"])
    on_body = joint_forces(frame)
    middles = np.array([frame.points[joint[:2]].mean(axis=0) for joint in frame.joints])
    place = np.arctan2(middles[:, 1], middles[:, 0])
    # rays inside the arch: the parts between neighbours carry the tractions of the joints between them
    inside = np.flatnonzero((angle > 1e-6) & (angle < np.pi - 1e-6))
    carried = np.array([on_body[(place > angle[i]) & (place < angle[j])].sum(axis=0) for i, j in zip(inside, inside[1:])])
    lacking = force[inside[:-1]] - force[inside[1:]] + carried
    scale = abs(rings["N"]).max()
    why = "round-off: the cuts are balanced element by element"
    rows = [Row("pipe: force that a piece between two rays of the arch lacks, over the largest N", 0, abs(lacking).max() / scale, 1e-9,
                relative=False, why=why)]
    span = np.ptp(moment[inside]) / abs(rings["M"]).max()
    rows.append(Row("pipe: change of N r_m + M along the arch, over the largest M", 0, span, 1e-8, relative=False,
                    why="no friction, no moment about the centre: round-off of N r_m, which is ten times M"))
    # at the tips pipe and ground share a node, and a cut gives half of the ground's force there to either side
    tips = np.array([[OUTER, 0], [-OUTER, 0]])
    shared = -ground_at(frame, [PIPE, (YOUNG, POISSON, 2000)], tips).sum(axis=0) / 2
    right, left = np.argmin(abs(angle)), np.argmin(abs(angle - np.pi))
    whole = force[right] - force[left] + on_body.sum(axis=0) + shared
    rows.append(Row("pipe: force that the whole arch lacks between its tips, over the largest N", 0, abs(whole).max() / scale, 1e-9,
                    relative=False, why=why))
    rows.append(Row("pipe: load on the arch, upright, over that of the bed", -1, on_body[:, 1].sum() / bed(frame)[1], 1e-9,
                    why="round-off: a pipe without weight balances"))
    return rows, rings


def bed(frame):
    """Force of the ground's elements on the lower half of the pipe, tips included [N/m]."""
    low = frame.points[(abs(np.hypot(*frame.points.T) - OUTER) < 1e-6) & (frame.points[:, 1] < 1e-6)]
    return -ground_at(frame, [PIPE, (YOUNG, POISSON, 2000)], np.unique(np.round(low, 7), axis=0)).sum(axis=0)


def stiff_rows(book):
    """The arch stuck by stiff joints, beside pipe and ground in one."""
    stiffness = 1e15
    sets = {"interfaces.arch.friction": 1e9, "interfaces.arch.normal_stiffness": stiffness, "interfaces.arch.tangential_stiffness": stiffness}
    geo = {"far": 6, "octant": 4} if book.quick else {"far": 10}
    stuck = book.run("arch", geo=geo, sets=sets, tag="stuck").frame()
    merged = book.run("arch", geo=geo, sets=sets, tag="merged", bonded=True)
    found, should = last(book.run("arch", geo=geo, sets=sets, tag="stuck").rings()), last(merged.rings())
    glued = merged.frame()
    near = [np.flatnonzero(np.hypot(*(glued.points - p).T) < 1e-6)[0] for p in stuck.points]
    difference = abs(stuck.displacement - glued.displacement[near]).max() / abs(glued.displacement).max()
    why = "joints of 1e15 Pa/m add E/(k r) = 1e-7 to the compliance of 1 m of ground"
    rows = [Row("stuck arch: difference of displacement from the merged mesh", 0, difference, 1e-6, relative=False, why=why)]
    for column in ["N", "M"]:
        error = abs(found[column] - should[column]).max() / abs(should[column]).max()
        rows.append(Row(f"stuck arch: difference of {column} from the merged mesh, over the largest", 0, error, 1e-6, relative=False, why=why))
    return rows


def page(book):
    frame = torn(book)
    sections, rings = section_rows(book)
    rows = crack_rows(book, frame) + sections + stiff_rows(book)

    def plot(axes):
        angle, opening, slide = pairs(frame)
        line = np.linspace(-np.pi / 2, np.pi / 2, 400)
        for what, mark, got, should in [("opening", "o", opening, exact(line)[0]), ("slide", "s", slide, exact(line)[1])]:
            axes.plot(np.degrees(angle), 1e3 * got, mark, markersize=2, label=f"{what}, program")
            axes.plot(np.degrees(line), 1e3 * should, "k-", linewidth=0.6)
        axes.set(xlabel="angle from the crown [degrees]", ylabel="jump from disc to ground [mm]")
        axes.legend()

    return Page(
        "arch", "Pipe with a joint along its arch only", [],
        problem="A body of 1 m radius in wide ground; the joint runs along its upper half, and ends in the solid at both springlines. "
                "First a solid disc of the ground's own material under a tension of 100 kPa all round, which tears it off. Then a "
                "concrete pipe, wall 0.2 m, under 100 kPa from above and below and 50 kPa from the sides, whose arch slips without "
                "friction on a bonded bed; and the same with a stiff, stuck joint.",
        reference="An arc crack of half angle a in an infinite plane under a tension S all round (Muskhelishvili): with "
                  "Phi = C (z - cos a)/X + D/2, Omega = Phi - D, X^2 = z^2 - 2 z cos a + 1, no resultant and one value of displacement, "
                  "C = S/(3 - cos a), and the jump across the arc at the angle t from its middle is\n\n"
                  "    u_r + i u_t = 8 (1 - nu^2) S r / (E (3 - cos a)) (2 (cos t - cos a))^(1/2) exp(-i t/2)\n\n"
                  "which tends to the straight crack's 4 (1 - nu^2) S (a^2 - t^2)^(1/2) r / E for small a; here a = 90 degrees. For the "
                  "pipe statics says: pieces of the arch balance under their section forces and the tractions of their joints, and "
                  "pressures without friction turn nothing about the centre, so that N r_m + M is one number all along the arch.",
        rows=rows, plot=plot, code=["src/model/split.rs", "src/physics/joint.rs", "src/results/ring.rs"],
        notes="The tip's node belongs to pipe and ground: `rings.csv` gives half of the ground's force on it to each side of the cut, "
              "and so does the balance of the whole arch. The ground's forces there and on the bed are computed anew from the displacements.",
    )
