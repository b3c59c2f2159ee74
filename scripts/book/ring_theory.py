"""Elastic ring in an infinite elastic plane under s_y = -p, s_x = -K p far away, exactly.

Airy's function of each body is that of Michell (1899) with the terms of cos 0 and cos 2 theta (J. R. Barber, Elasticity,
tables 8.1 and 9.1); the constants follow from the bore, the interface and the far field. theta from the x axis.
"""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Body:
    young: float
    poisson: float

    @property
    def shear(self):
        return self.young / (2 * (1 + self.poisson))


def mean_terms(r, body):
    """Columns for phi = A r^2, B ln r; rows s_r, s_theta, u_r."""
    nu, g = body.poisson, 2 * body.shear
    return np.array([[2, 1 / r**2], [2, -1 / r**2], [2 * (1 - 2 * nu) * r / g, -1 / r / g]])


def double_terms(r, body):
    """Columns for phi = (A r^2 + B r^4 + C/r^2 + D) cos 2 theta; rows s_r, s_theta, u_r (cos 2 theta), tau, u_theta (sin)."""
    nu, g = body.poisson, 2 * body.shear
    return np.array([
        [-2, 0, -6 / r**4, -4 / r**2],
        [2, 12 * r**2, 6 / r**4, 0],
        [-2 * r / g, -4 * nu * r**3 / g, 2 / r**3 / g, 4 * (1 - nu) / r / g],
        [2, 6 * r**2, -6 / r**4, -2 / r**2],
        [2 * r / g, (6 - 4 * nu) * r**3 / g, 2 / r**3 / g, -2 * (1 - 2 * nu) / r / g],
    ])


class Ring:
    """The solution: functions of the angle [rad]; stress positive in tension, forces per metre."""

    def __init__(self, soil: Body, ring: Body, inner, outer, pressure, k, friction: bool):
        self.soil, self.ring, self.inner, self.outer = soil, ring, inner, outer
        mean, deviator = -(1 + k) / 2 * pressure, (1 - k) / 2 * pressure  # far: s_r = mean + deviator cos 2 theta
        at_bore, at_ring, at_soil = mean_terms(inner, ring), mean_terms(outer, ring), mean_terms(outer, soil)
        far = np.array([mean / 2, 0])
        # unknown: A, B of the ring, B of the ground
        matrix = [[*at_bore[0], 0], [*at_ring[0], -at_soil[0, 1]], [*at_ring[2], -at_soil[2, 1]]]
        a, b, c = np.linalg.solve(np.array(matrix), [0, *(at_soil @ far)[[0, 2]]])
        self.mean_ring, self.mean_soil = np.array([a, b]), far + [0, c]

        at_bore, at_ring, at_soil = double_terms(inner, ring), double_terms(outer, ring), double_terms(outer, soil)
        far = np.array([-deviator / 2, 0, 0, 0])
        from_far = at_soil @ far
        own = at_soil[:, 2:]  # C, D vanish far away
        rows = [[*at_bore[i], 0, 0] for i in (0, 3)] + [[*at_ring[i], *-own[i]] for i in (0, 2)]
        right = [0, 0, from_far[0], from_far[2]]
        if friction:  # bonded: tau and u_theta go through
            rows += [[*at_ring[i], *-own[i]] for i in (3, 4)]
            right += [from_far[3], from_far[4]]
        else:  # no shear on either side
            rows += [[*at_ring[3], 0, 0], [0, 0, 0, 0, *own[3]]]
            right += [0, -from_far[3]]
        matrix = np.array(rows)
        scale = abs(matrix).max(axis=0)
        x = np.linalg.solve(matrix / scale, right) / scale
        self.double_ring, self.double_soil = x[:4], far + [0, 0, *x[4:]]

    def _of(self, row_mean, row_double, theta, r, in_ring):
        body, mean, double = ((self.ring, self.mean_ring, self.double_ring) if in_ring else
                              (self.soil, self.mean_soil, self.double_soil))
        varying = (double_terms(r, body) @ double)[row_double]
        if row_mean is None:
            return varying * np.sin(2 * np.asarray(theta))
        return (mean_terms(r, body) @ mean)[row_mean] + varying * np.cos(2 * np.asarray(theta))

    def hoop(self, theta, r):
        return self._of(1, 1, theta, r, True)

    def contact(self, theta):
        """(s_r, tau) between ring and ground [Pa]."""
        return self._of(0, 0, theta, self.outer, False), self._of(None, 3, theta, self.outer, False)

    def u_r(self, theta):
        return self._of(2, 2, theta, self.outer, True)

    def slip(self, theta):
        """u_theta of the ground less that of the ring [m]."""
        return self._of(None, 4, theta, self.outer, False) - self._of(None, 4, theta, self.outer, True)

    def forces(self, theta):
        """(N, M): tension [N/m]; moment [N m/m] positive where the inner fibre is compressed."""
        x, w = np.polynomial.legendre.leggauss(20)
        half, middle = (self.outer - self.inner) / 2, (self.outer + self.inner) / 2
        hoop = np.array([self.hoop(theta, middle + half * xi) for xi in x])
        return np.tensordot(w * half, hoop, 1), np.tensordot(w * half * half * x, hoop, 1)
