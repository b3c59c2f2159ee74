"""Peer: OpenSeesPy. Elements quad and tri31, joints zeroLengthContact2D, Newmark's method.

Its masses are diagonal, so coralpipe is compared with "mass": "lumped"; its nodes get the same diagonal. Bonded, the
system is linear and factored once; with contact the tangent is unsymmetric and factored in every iteration.
"""

import time

import numpy as np
import openseespy.opensees as ops

from .job import arguments, leave, model_of


def build(model):
    """Nodes, masses, supports, elements, joints, load and damping; node and element tags count from 1."""
    _, mass = model.matrices(lumped=True)
    mass = mass.diagonal()
    held = np.ones(2 * len(model.points), int)
    held[model.free] = 0
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 2)
    for n, (x, y) in enumerate(model.points):
        ops.node(n + 1, float(x), float(y))
        ops.mass(n + 1, *map(float, mass[2 * n:2 * n + 2]))
        if held[2 * n:2 * n + 2].any():
            ops.fix(n + 1, *map(int, held[2 * n:2 * n + 2]))
    tag = 0
    for number, (group, cells) in enumerate(model.faces(), 1):
        material = model.case["materials"][group]
        lam, shear = model.lame(group)
        young = shear * (3 * lam + 2 * shear) / (lam + shear)
        ops.nDMaterial("ElasticIsotropic", number, young, material["poisson"], 0.0)
        kind = "quad" if cells.shape[1] == 4 else "tri31"
        for nodes in cells:
            tag += 1
            ops.element(kind, tag, *(int(n) + 1 for n in anticlockwise(model, nodes)), 1.0, "PlaneStrain", number)
    for pair in model.pairs:
        tag += 1
        kn, ks, friction = model.joint_law(pair)
        stiffness = kn * pair.area, ks * pair.area
        ops.element("zeroLengthContact2D", tag, pair.ground + 1, pair.body + 1, *stiffness, friction,
                    "-normal", *map(float, pair.normal))
    ops.rayleigh(model.alpha, model.beta, 0.0, 0.0)
    times = [n * model.dt for n in range(model.steps + 2)]
    ops.timeSeries("Path", 1, "-dt", model.dt, "-values", *map(model.pulse, times))
    ops.pattern("Plain", 1, 1)
    for n in np.flatnonzero(model.load.reshape(-1, 2).any(1)):
        ops.load(int(n) + 1, *map(float, model.load[2 * n:2 * n + 2]))
        # a(0) = f(0) / m
        for axis in (0, 1):
            if not held[2 * n + axis]:
                start = model.load[2 * n + axis] * model.pulse(0) / mass[2 * n + axis]
                ops.setNodeAccel(int(n) + 1, axis + 1, float(start), "-commit")


def anticlockwise(model, nodes):
    x, y = model.points[nodes].T
    return nodes if x @ np.roll(y, -1) > y @ np.roll(x, -1) else nodes[::-1]


def analyse(bonded):
    ops.constraints("Plain")
    ops.numberer("AMD" if bonded else "RCM")
    ops.system("SparseGeneral")  # SuperLU; UmfPack is slower here, and factors again for every solution
    if bonded:
        ops.algorithm("Linear", "-factorOnce")
    else:
        # An iterate after the last change of status is exact: its correction is far below this norm [m].
        ops.test("NormDispIncr", 1e-9, 50)
        ops.algorithm("Newton")
    ops.integrator("Newmark", 0.5, 0.25)
    ops.analysis("Transient")


def main():
    a = arguments()
    model = model_of(a)
    build(model)
    analyse(a.bonded)
    history = np.zeros((a.steps + 1, 2 * len(model.probes)))
    start = time.perf_counter()
    for n in range(1, a.steps + 1):
        if ops.analyze(1, a.dt) != 0:
            raise SystemExit(f"OpenSees does not converge in step {n}")
        history[n] = [ops.nodeDisp(p + 1, axis) for p in model.probes for axis in (1, 2)]
    leave(a, history, time.perf_counter() - start, f"OpenSees {ops.version()}", unknowns=len(model.free))


if __name__ == "__main__":
    main()
