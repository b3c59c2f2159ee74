"""Peer: SciPy, pipe and ground bonded; one SuperLU factor, two sparse products and one solve a step."""

import time

import numpy as np
import scipy
from scipy.sparse.linalg import splu

from .job import arguments, leave, model_of


def factor(matrix):
    """SuperLU for a symmetric positive definite matrix: pivots on the diagonal, minimum degree of A + A'."""
    return splu(matrix.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})


class Newmark:
    """Average acceleration: a0 = 4/dt^2, a1 = 2/dt; a = a0 du - (4/dt) v - a."""

    def __init__(self, model, lumped):
        k, m = model.matrices(lumped)
        free = model.free
        self.k, self.m = (x[free][:, free] for x in (k, m))
        self.model, self.load, self.a0, self.a1 = model, model.load[free], 4 / model.dt**2, 2 / model.dt
        self.c = (model.alpha * self.m + model.beta * self.k).tocsr()
        self.effective = self.k + self.a0 * self.m + self.a1 * self.c
        self.u = np.zeros(len(free))
        self.v = np.zeros(len(free))
        self.a = factor(self.m).solve(self.load * model.pulse(0))

    def right_hand_side(self, time):
        """f + M (a0 u + 4/dt v + a) + C (a1 u + v), with C = alpha M + beta K: one product with M, one with K."""
        for_m = self.a0 * self.u + 2 * self.a1 * self.v + self.a
        for_c = self.a1 * self.u + self.v
        model = self.model
        return self.load * model.pulse(time) + self.m @ (for_m + model.alpha * for_c) + self.k @ (model.beta * for_c)

    def move_to(self, u):
        a = self.a0 * (u - self.u) - 2 * self.a1 * self.v - self.a
        self.v = self.v + self.model.dt / 2 * (self.a + a)
        self.u, self.a = u, a

    def probes(self):
        """Places of the probes among the free dofs."""
        return np.searchsorted(self.model.free, [2 * n + i for n in self.model.probes for i in (0, 1)])


def main():
    a = arguments()
    newmark = Newmark(model_of(a), a.lumped)
    lu = factor(newmark.effective)
    probes, history = newmark.probes(), np.zeros((a.steps + 1, 2 * len(newmark.model.probes)))
    start = time.perf_counter()
    for n in range(1, a.steps + 1):
        newmark.move_to(lu.solve(newmark.right_hand_side(n * a.dt)))
        history[n] = newmark.u[probes]
    leave(a, history, time.perf_counter() - start, f"SciPy {scipy.__version__}", unknowns=len(newmark.u))


if __name__ == "__main__":
    main()
