"""A key block pressed between two side blocks: forces on five joints against statics and Coulomb's law."""

import numpy as np

from book.element_forces import joint_forces, of_elements
from book.lib import Page, Row

G, PRESSURE = 9.81, 100e3
BLOCK, BUFFER = 2500, 1000  # [kg/m3]
TIP, HEIGHT, HALF, LENGTH, CLEAR = 0.4, 1.0, 1.5, 0.5, 0.25  # wedge.geo [m]
LEAN = {"left": np.radians(20), "right": np.radians(30)}
# (young, poisson, density), in the order of the materials' names
MATERIALS = [(50e6, 0, BUFFER), (100e6, 0, BUFFER), (100e9, 0.2, BLOCK), (100e9, 0.2, BLOCK), (100e9, 0.2, BLOCK), (100e9, 0.2, BLOCK)]


def exact(plane, floor):
    """Forces per metre by hand: {side: (N, T) on a plane, (N, T) on a floor, force of a buffer}; plane, floor: coefficients of friction."""
    deep = HEIGHT - TIP
    width = {side: deep * np.tan(lean) for side, lean in LEAN.items()}
    down = PRESSURE * sum(width.values()) + BLOCK * G * deep * sum(width.values()) / 2
    # of each N: upwards, and inwards on the side block
    up = {side: np.sin(lean) + plane * np.cos(lean) for side, lean in LEAN.items()}
    out = {side: np.cos(lean) - plane * np.sin(lean) for side, lean in LEAN.items()}
    left, right = np.linalg.solve([[up["left"], up["right"]], [out["left"], -out["right"]]], [down, 0])
    forces = {}
    for side, n in [("left", left), ("right", right)]:
        weight = G * (BLOCK * (HALF * HEIGHT - deep * width[side] / 2) + BUFFER * LENGTH * (HEIGHT - CLEAR))
        foot = weight + n * up[side]
        forces[side] = (n, plane * n), (foot, floor * foot), n * out[side] - floor * foot
    return forces


def found(frame):
    """The same from the joints' tractions and the elements at the rollers, and the sums on plane, foot and split."""
    joints, forces = joint_forces(frame), {}
    on = lambda name: joints[frame.joint_groups[name]].sum(axis=0)
    elements = np.zeros_like(frame.points)
    for face, force in zip(frame.faces, of_elements(frame, MATERIALS, G)):
        elements[face] += force
    for side, sign in [("left", 1), ("right", -1)]:
        c, s = np.cos(LEAN[side]), np.sin(LEAN[side])
        on_key, on_foot = on(f"plane_{side}") * [sign, 1], on(f"floor_{side}") * [sign, 1]
        normal, upwards = on_key @ [c, s], on_key @ [-s, c]
        roller = sign * elements[frame.point_groups[f"roller_{side}"], 0].sum()
        forces[side] = (normal, upwards), (on_foot[1], on_foot[0]), roller
    return forces, np.hypot(*on("split"))


def compared(book, plane, floor):
    friction = {f"interfaces.plane_{side}.friction": plane for side in LEAN} | {f"interfaces.floor_{side}.friction": floor for side in LEAN}
    result = book.run("wedge", geo={"size": 0.2 if book.quick else 0.05}, sets=friction, tag=f"{plane:g}_{floor:g}")
    frame = result.frame()
    by_hand, (forces, split) = exact(plane, floor), found(frame)
    title = f"friction {plane:g}, {floor:g}" if plane else "no friction"
    balance = "round-off: whole blocks balance on any mesh, and all points slip one way"
    scale = by_hand["left"][0][0]
    rows = []
    for side in LEAN:
        for what, i in [("plane", 0), ("floor", 1)]:
            for part, k in [("N", 0), ("T", 1)]:
                rows.append(Row(f"{title}: {part} on the {side} {what}", by_hand[side][i][k] / 1e3, forces[side][i][k] / 1e3,
                                1e-8 if by_hand[side][i][k] else 1e-8 * scale / 1e3, "kN/m", relative=by_hand[side][i][k] != 0, why=balance))
        rows.append(Row(f"{title}: force of the {side} buffer", by_hand[side][2] / 1e3, forces[side][2] / 1e3, 1e-8, "kN/m", why=balance))
    rows.append(Row(f"{title}: force on the split, over N on the left plane", 0, split / scale, 0, relative=False, why="it is open: no tension"))
    sliding = np.logical_or.reduce([frame.joint_groups[f"{what}_{side}"] for what in ["plane", "floor"] for side in LEAN])
    rows.append(Row(f"{title}: sticking joints on planes and floor", 0, (frame.status[sliding] == 1).sum() if plane else 0, 0, relative=False,
                    why="the buffers give way by 1e3 times what the joints do"))
    last = {name: values[-1] for name, values in result.histories.items()}
    apart = last["RIGHT.ux"] - last["LEFT.ux"]
    down = apart / (np.tan(LEAN["left"]) + np.tan(LEAN["right"]))
    rows.append(Row(f"{title}: settlement of the key", 1e3 * down, -1e3 * last["KEY.uy"], 5e-3, "mm",
                    why="blocks and joints give way by some 1e-6 m, where the buffers give way by 4e-4 m"))
    return rows, frame


def pumped(book, plane=0.2, floor=0.3, pressure=50e3):
    """50 kPa in the open joint between the side blocks: nothing changes but the buffers' forces, by pressure times height."""
    fluid = {"loads.split": {"pressure": {"law": "ramp", "peak": pressure, "duration": 1}}}
    frame = book.run("wedge", geo={"size": 0.2 if book.quick else 0.05}, sets=fluid, tag="pumped").frame()
    by_hand, (forces, _) = exact(plane, floor), found(frame)
    why = "round-off: the pressure acts on both sides, from triple point to triple point"
    return [Row(f"50 kPa in the split: force of the {side} buffer", (by_hand[side][2] + pressure * TIP) / 1e3, forces[side][2] / 1e3, 1e-8,
                "kN/m", why=why) for side in LEAN]


def page(book):
    smooth, _ = compared(book, 0, 0)
    rough, frame = compared(book, 0.2, 0.3)

    def plot(axes):
        colours = {1: "0.9", 2: "0.9", 3: "moccasin", 4: "0.7", 5: "lightblue", 6: "lightgreen"}
        factor = 100
        moved = frame.points + factor * frame.displacement
        for face, material in zip(frame.faces, frame.material):
            axes.fill(*moved[face].T, facecolor=colours[int(material)], edgecolor="white", linewidth=0.2)
        joints, base = joint_forces(frame), 4e-6
        for side in LEAN:
            for what in ["plane", "floor"]:
                of = frame.joint_groups[f"{what}_{side}"]
                force = joints[of].sum(axis=0)
                at = np.mean([moved[joint[:2]].mean(axis=0) for joint, inside in zip(frame.joints, of) if inside], axis=0)
                axes.annotate("", at, at - base * force, arrowprops={"arrowstyle": "->", "linewidth": 1.5})
                axes.text(*(at - base * force), f"{np.hypot(*force) / 1e3:.1f}", ha="center", va="top")
        axes.set(aspect="equal", xlabel="x [m]", ylabel="y [m]", title=f"resultants on key and feet [kN/m]; displacements x {factor}")
        axes.set_ylim(bottom=-0.7)

    return Page(
        "wedge", "Key block between two sliding blocks", [],
        problem="A key block under its weight and 100 kPa on its top drives two side blocks apart. It rests on two planes that lean by "
                "a = 20 and b = 30 degrees from the vertical and meet in its tip; the side blocks stand on a floor and push soft "
                "buffers, whose outer ends are on rollers. The three joints between the blocks meet in the tip, the one between the "
                "side blocks ends on the floor in a second triple point. Once without friction, once with f = 0.2 on the planes and "
                "0.3 on the floor, and once more with a pressure of 50 kPa in the joint between the side blocks.",
        reference="Every joint that slides carries T = f N against its motion: upwards on the key, inwards on the side blocks. With V the "
                  "load and weight of the key,\n\n"
                  "    N_a (sin a + f cos a) + N_b (sin b + f cos b) = V\n"
                  "    N_a (cos a - f sin a) - N_b (cos b - f sin b) = 0\n\n"
                  "A foot carries F = W + N (sin + f cos), W the weight of its side block and buffer, and the buffer the rest of the "
                  "thrust, B = N (cos - f sin) - f' F. The joint between the side blocks opens and carries nothing; a pressure in it adds "
                  "itself times the joint's height to both buffers. Blocks that are much stiffer than the buffers only shift, so that the "
                  "key settles by the blocks' distance over tan a + tan b.",
        rows=smooth + rough + pumped(book), plot=plot, code=["src/model/split.rs", "src/physics/joint.rs", "src/solve/contact.rs"],
        notes="The resultants are those of the frame's `traction_vector` times the lengths of the joints, which is the joints' own "
              "quadrature; the buffers' forces are computed anew from the displacements. Where the pressure on a foot acts is not determined by statics, and not compared.",
    )
