"""The case that all programs compute, as arrays: a Gmsh mesh and a case file in, matrices, loads and joints out.

Written apart from coralpipe's Rust, so that agreement means something. dof(node n, axis i) = 2 n + i.
"""

import json
import re
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import meshio
import numpy as np
import scipy.sparse as sp

UNITS = {"N/cm^2": 1e4, "kg/cm^3": 1e6, "kPa": 1e3, "ms": 1e-3, "cm": 1e-2}
GAUSS = [(r / 3**0.5, s / 3**0.5) for r in (-1, 1) for s in (-1, 1)]


def si(quantity) -> float:
    """"1.83e4 N/cm^2" -> 1.83e8."""
    if not isinstance(quantity, str):
        return float(quantity)
    number, unit = quantity.split(maxsplit=1)
    return float(number) * UNITS[unit]


@dataclass
class Pair:
    """Two nodes at one place: the ground's, and the body's copy of it."""

    ground: int
    body: int
    normal: np.ndarray
    """unit vector from the body into the ground"""
    area: float
    """[m^2] per metre of depth"""
    group: str
    """the ground beside it, which gives stiffness and friction"""


class Model:
    """`bonded`: pipe and ground share their nodes; else each pair is a joint."""

    def __init__(self, case_file, mesh_file, bonded, alpha, beta, dt, steps):
        self.case = json.loads(Path(case_file).read_text())
        self.alpha, self.beta, self.dt, self.steps = alpha, beta, dt, steps
        mesh = meshio.read(mesh_file)
        self.points = mesh.points[:, :2].copy()
        self.groups = {
            name: {kind: mesh.cells_dict[kind][index] for kind, index in sets.items() if len(index)}
            for name, sets in mesh.cell_sets_dict.items() if not name.startswith("gmsh:")
        }
        self.probes = [int(self.groups[name]["vertex"][0, 0]) for name in self.case["probes"]]
        self.pairs = [] if bonded else [p for i in self.case["interfaces"] for p in self._open(i)]

    def faces(self):
        """(group, nodes of its triangles or quadrilaterals, one a row)."""
        for group in self.case["materials"]:
            for kind in ("triangle", "quad"):
                if kind in self.groups[group]:
                    yield group, self.groups[group][kind]

    def lame(self, group):
        """lambda, G [Pa]."""
        material = self.case["materials"][group]
        young, nu = si(material["young"]), material["poisson"]
        return young * nu / ((1 + nu) * (1 - 2 * nu)), young / (2 * (1 + nu))

    def density(self, group):
        return si(self.case["materials"][group]["density"])

    def joint_law(self, pair):
        """kappa_n, kappa_s [Pa/m] and friction, a layer of thickness t of the ground."""
        (lam, shear), interface = self.lame(pair.group), next(iter(self.case["interfaces"].values()))
        thickness = si(interface["thickness"])
        return (lam + 2 * shear) / thickness, shear / thickness, self.case["materials"][pair.group]["friction"]

    def pulse(self, t):
        """p(t) [Pa], linear."""
        law = self.case["loads"]["surface"]["pressure"]
        peak, duration = si(law["peak"]), si(law["duration"])
        return peak * (1 - t / duration) if 0 <= t <= duration else 0.0

    @cached_property
    def free(self):
        """The dofs that no support holds, ascending."""
        held = np.zeros(2 * len(self.points), bool)
        for group, axes in self.case["supports"].items():
            for axis in axes:
                held[2 * np.unique(self.groups[group]["line"]) + "xy".index(axis)] = True
        return np.flatnonzero(~held)

    @cached_property
    def load(self):
        """Nodal forces of a unit pressure on the surface."""
        f = np.zeros(2 * len(self.points))
        for a, b in self.groups["surface"]["line"]:
            along = self.points[b] - self.points[a]
            f[[2 * a + 1, 2 * b + 1]] -= abs(along[0]) / 2
        return f

    def matrices(self, lumped=False):
        """K, M over all dofs; `lumped`: each element's diagonal scaled to its mass."""
        blocks = [self._element_matrices(group, nodes, lumped) for group, nodes in self.faces()]
        rows, columns, k, m = (np.concatenate([b[i] for b in blocks]) for i in range(4))
        shape = (2 * len(self.points),) * 2
        return tuple(sp.coo_matrix((v, (rows, columns)), shape).tocsr() for v in (k, m))

    def _element_matrices(self, group, nodes, lumped):
        x, (lam, shear) = self.points[nodes], self.lame(group)
        d = np.array([[lam + 2 * shear, lam, 0], [lam, lam + 2 * shear, 0], [0, 0, shear]])
        n = nodes.shape[1]
        k, m = np.zeros((len(nodes), 2 * n, 2 * n)), np.zeros((len(nodes), n, n))
        for shape, gradient, weight in quadrature(n):
            jacobian = np.einsum("na,eni->eai", gradient, x)
            dv = np.linalg.det(jacobian) * weight
            dx = np.einsum("eia,na->eni", np.linalg.inv(jacobian), gradient)
            b = np.zeros((len(nodes), 3, 2 * n))
            b[:, 0, 0::2] = b[:, 2, 1::2] = dx[:, :, 0]
            b[:, 1, 1::2] = b[:, 2, 0::2] = dx[:, :, 1]
            k += np.einsum("eki,kl,elj,e->eij", b, d, b, np.abs(dv), optimize=True)
            m += np.einsum("i,j,e->eij", shape, shape, np.abs(dv))
        if lumped:
            diagonal = np.einsum("eii->ei", m)
            scaled = diagonal * (m.sum((1, 2)) / diagonal.sum(1))[:, None]
            m = np.einsum("ei,ij->eij", scaled, np.eye(n))
        dofs = (2 * nodes[:, :, None] + np.arange(2)).reshape(len(nodes), 2 * n)
        both = np.kron(m * self.density(group), np.eye(2))
        rows, columns = np.broadcast_arrays(dofs[:, :, None], dofs[:, None, :])
        return rows.ravel(), columns.ravel(), k.ravel(), both.ravel()

    def _open(self, interface):
        """Gives the body its own nodes along the curve; returns the pairs."""
        body, edges = self.case["interfaces"][interface]["body"], self.groups[interface]["line"]
        ground = np.unique(edges)
        copy = {int(n): len(self.points) + i for i, n in enumerate(ground)}
        beside = {frozenset(map(int, e)): self._ground_beside(e, body) for e in edges}
        centre = self.points[ground].mean(0)
        area, normal, groups = {}, {}, {}
        for a, b in edges:
            along = self.points[b] - self.points[a]
            outward = np.array([along[1], -along[0]])
            outward *= np.sign(outward @ (self.points[[a, b]].mean(0) - centre))
            for n in map(int, (a, b)):
                area[n] = area.get(n, 0) + np.hypot(*along) / 2
                normal[n] = normal.get(n, 0) + outward / 2
                groups.setdefault(n, set()).add(beside[frozenset(map(int, (a, b)))])
        assert all(len(g) == 1 for g in groups.values()), "a pipe that crosses layers needs a joint for each side"
        self.points = np.vstack([self.points, self.points[ground]])
        renumber = np.arange(len(self.points))
        renumber[list(copy)] = list(copy.values())
        for kind in ("triangle", "quad"):
            if kind in self.groups[body]:
                self.groups[body][kind] = renumber[self.groups[body][kind]]
        self.probes = [copy.get(n, n) for n in self.probes]
        return [Pair(n, copy[n], normal[n] / np.hypot(*normal[n]), area[n], *groups[n]) for n in copy]

    def _ground_beside(self, edge, body):
        for group, nodes in self.faces():
            if group != body and (np.isin(nodes, edge).sum(1) == 2).any():
                return group
        raise ValueError(f"no ground beside the edge {edge}")


def quadrature(nodes):
    """(N, dN/dr, weight) of T3 (its mass needs three points) and Q4."""
    if nodes == 3:
        gradient = np.array([[-1, -1], [1, 0], [0, 1.0]])
        return [(np.array(n), gradient, 1 / 6) for n in ([0.5, 0.5, 0], [0, 0.5, 0.5], [0.5, 0, 0.5])]
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    points = []
    for r, s in GAUSS:
        along_r, along_s = 1 + corners[:, 0] * r, 1 + corners[:, 1] * s
        gradient = np.stack([corners[:, 0] * along_s, corners[:, 1] * along_r], 1) / 4
        points.append((along_r * along_s / 4, gradient, 1.0))
    return points


def processor() -> str:
    names = re.findall(r"model name\s*: (.*)", Path("/proc/cpuinfo").read_text())
    return f"{names[0] if names else 'a processor'}, {len(names)} cores"
