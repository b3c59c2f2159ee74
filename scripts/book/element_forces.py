"""Forces of the elements on their nodes, and of the joints on their bodies, computed anew from a static frame."""

import numpy as np


def shapes(kind: str, r: float, s: float):
    """N (n,) and dN/d(r, s) (n, 2) at a place of the reference element."""
    if kind.startswith("triangle"):
        l = np.array([1 - r - s, r, s])
        d = np.array([[-1.0, -1], [1, 0], [0, 1]])
        if kind == "triangle":
            return l, d
        ends = [(0, 1), (1, 2), (2, 0)]
        corner, middle = l * (2 * l - 1), np.array([4 * l[a] * l[b] for a, b in ends])
        of_middle = np.array([4 * (d[a] * l[b] + l[a] * d[b]) for a, b in ends])
        return np.r_[corner, middle], np.r_[d * (4 * l - 1)[:, None], of_middle]
    a = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    x, y = 1 + a[:, 0] * r, 1 + a[:, 1] * s
    n, d = x * y / 4, np.stack([a[:, 0] * y, x * a[:, 1]], axis=1) / 4
    if kind == "quad":
        return n, d
    middle = np.array([(1 - r * r) * (1 - s), (1 + r) * (1 - s * s), (1 - r * r) * (1 + s), (1 - r) * (1 - s * s)]) / 2
    of_middle = np.array([[-2 * r * (1 - s), -(1 - r * r)], [1 - s * s, -2 * s * (1 + r)],
                          [-2 * r * (1 + s), 1 - r * r], [-(1 - s * s), -2 * s * (1 - r)]]) / 2
    beside = np.array([[0.5, 0, 0, 0.5], [0.5, 0.5, 0, 0], [0, 0.5, 0.5, 0], [0, 0, 0.5, 0.5]])
    return np.r_[n - beside @ middle, middle], np.r_[d - beside @ of_middle, of_middle]


def of_degree_4():
    """Six points of a triangle (Dunavant 1985)."""
    rings = [(0.445948490915965, 0.223381589678011 / 2), (0.091576213509771, 0.109951743655322 / 2)]
    return [(r, s, w) for a, w in rings for r, s in [(a, a), (1 - 2 * a, a), (a, 1 - 2 * a)]]


def gauss(kind: str, weight=False):
    """(r, s, weight) of the program's points for stiffness or an element's weight: src/physics/element.rs."""
    if weight and kind.startswith("triangle"):
        return of_degree_4()
    if kind == "triangle":
        return [(1 / 3, 1 / 3, 0.5)]
    if kind == "triangle6":
        return [(1 / 6, 1 / 6, 1 / 6), (2 / 3, 1 / 6, 1 / 6), (1 / 6, 2 / 3, 1 / 6)]
    x, w = np.polynomial.legendre.leggauss(2 if kind == "quad" else 3)
    return [(a, b, v * u) for a, v in zip(x, w) for b, u in zip(x, w)]


def plane_strain(young, poisson):
    """D of (xx, yy, gamma_xy) [Pa]."""
    shear = young / (2 * (1 + poisson))
    across = 2 * shear * poisson / (1 - 2 * poisson)
    return np.array([[across + 2 * shear, across, 0], [across, across + 2 * shear, 0], [0, 0, shear]])


def forces_of(kind, points, u, laws, weights):
    """K u - weight of elements of one kind (e, n, 2) [N/m].

    points, u: places and displacements of their nodes (e, n, 2); laws: D (e, 3, 3); weights: density times gravity (e,).
    """
    forces = np.zeros_like(points)
    for r, s, weight in gauss(kind):
        n, d = shapes(kind, r, s)
        jacobian = np.einsum("nk,eni->eki", d, points)
        dv = weight * np.linalg.det(jacobian)
        slope = np.einsum("nk,eik->eni", d, np.linalg.inv(jacobian))  # dN/dx
        du = np.einsum("eni,enj->eij", slope, u)  # du_j/dx_i
        strain = np.stack([du[:, 0, 0], du[:, 1, 1], du[:, 1, 0] + du[:, 0, 1]], axis=1)
        xx, yy, xy = np.einsum("eij,ej->ie", laws, strain)
        stress = np.array([[xx, xy], [xy, yy]])
        forces += np.einsum("e,eni,ije->enj", dv, slope, stress)
    for r, s, weight in gauss(kind, weight=True):
        n, d = shapes(kind, r, s)
        dv = weight * np.linalg.det(np.einsum("nk,eni->eki", d, points))
        forces[:, :, 1] += np.einsum("e,e,n->en", dv, weights, n)
    return forces


def of_elements(frame, materials: list, gravity=0.0) -> list:
    """K u - weight of every element (n, 2) [N/m], in the frame's order.

    materials: (young, poisson, density) in the order of their names; four-node quadrilaterals are the standard ones.
    """
    laws = np.array([plane_strain(young, poisson) for young, poisson, _ in materials])
    weights = np.array([density * gravity for *_, density in materials])
    material, kinds, forces = frame.material.astype(int) - 1, np.array(frame.kinds), [None] * len(frame.faces)
    for kind in set(frame.kinds):
        which = np.flatnonzero(kinds == kind)
        nodes = np.array([frame.faces[i] for i in which])
        of = material[which]
        found = forces_of(kind, frame.points[nodes], frame.displacement[nodes], laws[of], weights[of])
        for i, force in zip(which, found):
            forces[i] = force
    return forces


def joint_areas(frame) -> list:
    """Lengths of the joints that their nodes stand for [m], by the joints' own quadrature (Lobatto), over the ground's nodes."""
    areas = []
    for joint in frame.joints:
        p = frame.points[joint]
        if len(joint) == 2:
            areas.append(np.hypot(*(p[1] - p[0])) * np.array([0.5, 0.5]))
        else:  # ends, then middle: dx/dr at r = -1, 1, 0
            slopes = np.array([-1.5 * p[0] - 0.5 * p[1] + 2 * p[2], 0.5 * p[0] + 1.5 * p[1] - 2 * p[2], (p[1] - p[0]) / 2])
            areas.append(np.hypot(*slopes.T) * np.array([1, 1, 4]) / 3)
    return areas


def joint_forces(frame) -> np.ndarray:
    """Force of each joint on its body (k, 2) [N/m]: the frame's traction vector is the mean over the joint's points."""
    return np.array([sum(area) for area in joint_areas(frame)])[:, None] * frame.traction_vector


def joint_sides(frame) -> list:
    """(nodes of the ground, nodes of the body) of every joint; the faces on its two sides have edges at one place."""
    place = lambda nodes: frozenset(map(tuple, np.round(frame.points[nodes], 9)))
    edges = {}
    for face, kind in zip(frame.faces, frame.kinds):
        corners = 3 if kind.startswith("triangle") else 4
        for i in range(corners):
            ends = [face[i], face[(i + 1) % corners]]
            edges.setdefault(place(ends), []).append([*ends, face[corners + i]] if len(face) > corners else ends)
    sides, node = [], node_of(frame)
    for joint in frame.joints:
        # a bonded material has a point of its own in a node, so that nodes are compared
        body, = (edge for edge in edges[place(joint[:2])] if set(node[edge]) != set(node[joint]))
        nearest = [min(body, key=lambda b: np.hypot(*(frame.points[b] - frame.points[g]))) for g in joint]
        sides.append((list(joint), nearest))
    return sides


def residual(frame, materials: list, stiffness: dict, gravity=0.0) -> np.ndarray:
    """Force that each point lacks (n, 2) [N/m] where only supports and loads act, all joints closed and sticking.

    stiffness: name of an interface -> (normal, tangential) [Pa/m].
    """
    lacking = np.zeros_like(frame.points)
    for face, force in zip(frame.faces, of_elements(frame, materials, gravity)):
        lacking[face] += force
    names = [next(name for name in stiffness if frame.joint_groups[name][i]) for i in range(len(frame.joints))]
    for name, areas, (ground, body) in zip(names, joint_areas(frame), joint_sides(frame)):
        tangent = frame.points[ground[1]] - frame.points[ground[0]]
        tangent /= np.hypot(*tangent)
        normal = np.array([tangent[1], -tangent[0]])
        normal_k, tangent_k = stiffness[name]
        for area, g, b in zip(areas, ground, body):
            jump = frame.displacement[g] - frame.displacement[b]
            force = area * (normal_k * normal * (normal @ jump) + tangent_k * tangent * (tangent @ jump))
            lacking[g] += force
            lacking[b] -= force
    return lacking


def node_of(frame) -> np.ndarray:
    """Number of the node of every point: points of bonded materials at one place are one node, with one displacement."""
    key = np.concatenate([np.round(frame.points, 9), frame.displacement], axis=1)
    return np.unique(key, axis=0, return_inverse=True)[1].ravel()
