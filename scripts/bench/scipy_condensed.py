"""Peer: a condensed contact program as one would write it in Python: one SuperLU factor, Newton on the jumps alone.

With j = B u the jumps in each pair's tangential and normal direction: u = K*^-1 (f* - B' r(j)), so
j + G r(j) = B K*^-1 f*, G = B K*^-1 B' dense. In place of a second solve a step, K*^-1 B' is kept.
"""

import time

import numpy as np
import scipy
import scipy.sparse as sp
from scipy.linalg import lu_factor, lu_solve

from .job import arguments, leave, model_of
from .scipy_bonded import Newmark, factor

OPEN, STICK, FORWARD, BACKWARD = range(4)


class Joints:
    """Forces of all pairs from their jumps, and the plastic slip that they remember.

    `law`: coralpipe's, or that of OpenSees' zeroLengthContact2D, which takes the whole jump for slip where it slips and keeps
    its slip where it is open.
    """

    def __init__(self, model, law):
        laws = np.array([model.joint_law(p) for p in model.pairs])
        area = np.array([p.area for p in model.pairs])
        self.kn, self.ks, self.friction = laws[:, 0] * area, laws[:, 1] * area, laws[:, 2]
        self.slip = np.zeros(len(area))
        self.law = law

    def jumps(self, model):
        """B: the tangential, then the normal jump of every pair, ground minus body, over the free dofs."""
        place = np.full(2 * len(model.points), -1)
        place[model.free] = np.arange(len(model.free))
        entries = [
            (row, place[2 * node + axis], sign * direction[axis])
            for i, pair in enumerate(model.pairs)
            for row, direction in ((i, (-pair.normal[1], pair.normal[0])), (len(model.pairs) + i, pair.normal))
            for node, sign in ((pair.ground, 1), (pair.body, -1))
            for axis in (0, 1)
        ]
        rows, columns, values = zip(*entries)
        return sp.csr_matrix((values, (rows, columns)), (2 * len(model.pairs), len(model.free)))

    def respond(self, j):
        """Force, statuses, and the slip that an accepted step leaves."""
        s, n = np.split(j, 2)
        pressure = np.maximum(-self.kn * n, 0)
        trial, limit = self.ks * (s - self.slip), self.friction * pressure
        closed = n <= 0
        sticks = closed & (np.abs(trial) <= limit)
        tau = np.where(sticks, trial, np.copysign(limit, trial))
        status = np.where(~closed, OPEN, np.where(sticks, STICK, np.where(trial > 0, FORWARD, BACKWARD)))
        if self.law == "opensees":
            slip = np.where(status >= FORWARD, s, self.slip)
        else:
            slip = np.where(sticks, self.slip, s - tau / self.ks)
        return np.concatenate([tau, -pressure]), status, slip

    def tangent(self, status):
        """d force / d jump as three diagonals: tau by s, tau by n, sigma by n."""
        kn = np.where(status == OPEN, 0, self.kn)
        side = np.where(status == FORWARD, -1.0, np.where(status == BACKWARD, 1.0, 0.0))
        return np.where(status == STICK, self.ks, 0), side * self.friction * kn, kn


class Contact:
    """Newton's method, the LU kept while no status changes."""

    def __init__(self, g, joints):
        self.g, self.joints, self.key, self.lu = g, joints, None, None
        self.iterations = 0

    def solve(self, target, j):
        """j + G r(j) = target. Accepted where the statuses of two iterates agree: r is linear while none changes."""
        before = None
        for _ in range(50):
            force, status, slip = self.joints.respond(j)
            if before is not None and (status == before).all():
                return j, force, slip
            j = j - self.correction(j + self.g @ force - target, status)
            before = status
            self.iterations += 1
        raise SystemExit("the joints do not settle")

    def correction(self, residual, status):
        if self.key is None or (status != self.key).any():
            m, (ss, sn, nn) = len(status), self.joints.tangent(status)
            matrix = np.eye(2 * m)
            matrix[:, :m] += self.g[:, :m] * ss
            matrix[:, m:] += self.g[:, :m] * sn + self.g[:, m:] * nn
            self.key, self.lu = status, lu_factor(matrix, overwrite_a=True, check_finite=False)
        return lu_solve(self.lu, residual, check_finite=False)


def main():
    a = arguments()
    model = model_of(a)
    newmark, joints = Newmark(model, a.lumped), Joints(model, a.law)
    b, lu = joints.jumps(model), factor(newmark.effective)
    spread = lu.solve(b.T.toarray())
    contact = Contact(b @ spread, joints)
    probes, history = newmark.probes(), np.zeros((a.steps + 1, 2 * len(model.probes)))
    j = np.zeros(b.shape[0])
    start = time.perf_counter()
    for n in range(1, a.steps + 1):
        free = lu.solve(newmark.right_hand_side(n * a.dt))
        j, force, joints.slip = contact.solve(b @ free, j)
        newmark.move_to(free - spread @ force)
        history[n] = newmark.u[probes]
    leave(a, history, time.perf_counter() - start, f"SciPy {scipy.__version__}",
          unknowns=len(newmark.u), iterations=contact.iterations)


if __name__ == "__main__":
    main()
