"""Joints that meet in a T and cross in an X: a uniform stress, and stiff joints beside a merged mesh."""

import numpy as np

from book.element_forces import joint_forces, joint_sides, node_of, residual
from book.joint_patch import ELEMENTS, turned
from book.lib import Page, Row, step

SIGMA = np.array([[-3e5, 4e4], [4e4, -2e5]])  # [Pa]
KN, KS = 3e9, 1e9  # [Pa/m]
LEAN = 0.15  # shift of the top of the upright curve [m]
OUTWARD = {"bottom": (0, -1), "top": (0, 1), "left_side": (-1, 0), "right_side": (1, 0)}
BLOCKS = ["above_left", "above_right", "below_left", "below_right"]
SOFT, HARD = 50e6, 150e6  # Young's moduli of the bent square [Pa]


def along(book):
    """Elements along half a side."""
    return 3 if book.quick else 6


def sides(degrees, sigma):
    """sigma n on each side of the turned square."""
    t = {side: sigma @ turned(degrees) @ np.array(n, float) for side, n in OUTWARD.items()}
    return {side: {"traction": step(np.hypot(*v), list(v))} for side, v in t.items()}


def uniform(arms, degrees):
    """Stress that a junction bears with one shift a block: any at an X; at a T one that leaves the upright arm unloaded."""
    arm = turned(degrees) @ [2 * LEAN, 1]
    return SIGMA if arms == 4 else -2e5 * np.outer(arm, arm) / (arm @ arm)


def patch(book, arms, degrees, corners, order):
    """Largest relative errors of jump, traction and stress."""
    sigma = uniform(arms, degrees)
    across = "y" if abs(np.cos(np.radians(degrees))) > 0.5 else "x"
    sets = {"loads": sides(degrees, sigma), "supports": {"pin": ["x", "y"], "roller": [across]}}
    geo = {"arms": arms, "angle": degrees, "corners": corners, "order": order, "along": along(book)}
    frame = book.run("junctions", geo=geo, sets=sets, tag=f"{arms}_{corners}_{order}_{degrees}").frame()
    size = abs(sigma).max()
    jump = traction = 0
    for (ground, body), found in zip(joint_sides(frame), frame.traction_vector):
        tangent = frame.points[ground[1]] - frame.points[ground[0]]
        tangent /= np.hypot(*tangent)
        normal = np.array([tangent[1], -tangent[0]])
        exact = normal * (normal @ sigma @ normal) / KN + tangent * (tangent @ sigma @ normal) / KS
        jumps = frame.displacement[ground] - frame.displacement[body]
        # the frame may list a joint's nodes against the body's sense: the sign is that of the traction on the body
        sign = min((1, -1), key=lambda s: abs(s * jumps - exact).max())
        jump = max(jump, abs(sign * jumps - exact).max() / (size / KS))
        traction = max(traction, abs(sign * found - sigma @ normal).max() / size)
    stress = abs(frame.stress[:, [0, 1, 3]] - [sigma[0, 0], sigma[1, 1], sigma[0, 1]]).max() / size
    return jump, traction, stress


def bent(book, arms, stiffness, order, bonded=False):
    """A square of four moduli under a pressure above and a traction on its left that bends it."""
    young = {f"materials.{block}.young": SOFT if i % 2 else HARD for i, block in enumerate(BLOCKS)}
    joints = {f"interfaces.{name}.{axis}_stiffness": stiffness for name in ["level", "upright"] for axis in ["normal", "tangential"]}
    friction = {f"materials.{block}.friction": 1e9 for block in BLOCKS}
    # pressed from all sides, so that no joint opens
    loads = {"left_side": {"traction": step(9e5, [1, 0.1])}, "right_side": {"traction": step(8e5, [-1, 0])}, "top": {"pressure": step(1e6)}}
    sets = {**young, **joints, **friction, "loads": loads, "supports": {"bottom": ["x", "y"]}}
    geo = {"arms": arms, "angle": 17, "corners": 4, "order": order, "along": along(book)}
    tag = f"{'merged' if bonded else 'bent'}_{arms}_{order}_{stiffness:g}"
    return book.run("junctions", geo=geo, sets=sets, tag=tag, bonded=bonded).frame()


def difference(stiff, glued):
    """Largest difference of displacement over the largest displacement."""
    distance = np.hypot(*(stiff.points[:, None] - glued.points[None]).transpose(2, 0, 1))
    return abs(stiff.displacement - glued.displacement[distance.argmin(axis=1)]).max() / abs(glued.displacement).max()


def balance(frame, stiffness):
    """Copies of the middle node, and the largest force that one lacks, or a node inside, over the largest force of the joints."""
    materials = [(SOFT if i % 2 else HARD, 0.3, 1) for i in range(4)]
    lacking = residual(frame, materials, {name: (stiffness, stiffness) for name in ["level", "upright"]})
    nodes = node_of(frame)
    at_node = np.zeros((nodes.max() + 1, 2))
    np.add.at(at_node, nodes, lacking)
    of_point = np.hypot(*at_node[nodes].T) / np.hypot(*joint_forces(frame).T).max()
    middle = np.hypot(*frame.points.T) < 1e-9
    inside = abs(frame.points @ turned(17)).max(axis=1) < 0.5 - 1e-6
    return len(set(nodes[middle])), of_point[middle].max(), of_point[inside].max()


def page(book):
    rows, kinds = [], {"Q8": (4, 2)} if book.quick else ELEMENTS
    angles = [17] if book.quick else [0, 17, 45, 90, 133, -68, 180]
    for arms, letter in [(3, "T"), (4, "X")]:
        for name, (corners, order) in kinds.items():
            found = np.array([patch(book, arms, angle, corners, order) for angle in angles])
            for i, what in enumerate(["jump of a pair", "traction of a joint", "stress of an element"]):
                rows.append(Row(f"{letter}, {name}: largest relative error of the {what}, angles: {len(angles)}", 0, found[:, i].max(), 1e-11,
                                relative=False, why="round-off, times the ratio of the joint's stiffness to the elements' (10 to 100)"))
    stiffness = np.array([1e13, 1e14, 1e15])
    curves = {}
    for arms, letter in [(3, "T"), (4, "X")]:
        glued = bent(book, arms, stiffness[-1], 2, bonded=True)
        frames = [bent(book, arms, k, 2) for k in (stiffness[2:] if book.quick else stiffness)]
        curves[letter] = np.array([difference(frame, glued) for frame in frames])
        rows.append(Row(f"{letter}, bent: difference from the merged mesh at k = 1e15 Pa/m", 0, curves[letter][-1], 1e-6, relative=False,
                        why="a joint adds E/(k L) = 2e-7 to the compliance of 1 m of its stiffer neighbour"))
        rows.append(Row(f"{letter}, bent: open joint points", 0, (frames[-1].status == 3).sum(), 0, relative=False,
                        why="a merged mesh cannot open: the load keeps all joints pressed"))
        if not book.quick:
            rows += [Row(f"{letter}: that difference, k {stiffness[i]:.0e} over {stiffness[i + 1]:.0e}", 10, curves[letter][i] / curves[letter][i + 1],
                         0.05, why="in proportion to 1/k, the next term is smaller by E/(k h)") for i in (0, 1)]
        copies, middle, inside = balance(bent(book, arms, 1e10, 2), 1e10)
        rows.append(Row(f"{letter}, bent: nodes at the junction", arms, copies, 0, relative=False, why="a count: one a block"))
        for what, lacking in [("a node of the junction", middle), ("any node inside the square", inside)]:
            rows.append(Row(f"{letter}, bent, k = 1e10 Pa/m: force that {what} lacks, over the largest of a joint", 0, lacking, 1e-11,
                            relative=False, why="round-off of differences of displacements times k"))

    def plot(axes):
        for letter, mark in [("T", "o-"), ("X", "s--")]:
            axes.loglog(stiffness, curves[letter], mark, label=f"{letter}, elements of second order")
        axes.loglog(stiffness, curves["T"][0] * stiffness[0] / stiffness, "k:", label="1/k")
        axes.set(xlabel="stiffness of the joints [Pa/m]", ylabel="difference from the merged mesh")
        axes.grid(alpha=0.3)
        axes.legend()

    return Page(
        "junctions", "Joints that meet in a T and cross in an X", [],
        problem="A square of 1 m in four blocks. The level joint runs through its middle, the upright one, inclined to it, meets it there "
                "in a T or crosses it in an X; the joints' elements differ in length by 1 to 3.7. First a uniform stress on all sides, at several "
                "angles of the square; then blocks of 50 and 150 MPa under a pressure and a traction that bend the square, the joints stiff, "
                "beside the same mesh without joints.",
        reference="Under a uniform stress S each joint carries S n and jumps by the same along its whole length: n.S n/k_n and t.S n/k_s. Round an "
                  "X the four jumps cancel by pairs, so that four blocks which only shift fit together: the solution is exact for any S. Round a T the "
                  "jump of the upright arm stays over, so it must be zero: exact for S along that arm. Stiff joints are none, and the difference "
                  "falls as 1/k. The balance at the nodes is computed anew from the displacements by the page's script: elements of section 2 of the "
                  "theory, joints by Lobatto's rule.",
        rows=rows, plot=plot,
        notes="`newton.tolerance` is 1e-12. Friction is set so high that nothing slides. Slip at a triple point is tested in `tests/junctions.rs`.",
        code=["src/model/split.rs", "src/model/split/sectors.rs", "src/solve/unknowns.rs", "tests/junctions.rs"],
    )
