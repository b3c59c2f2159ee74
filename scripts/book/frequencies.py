"""Item 16: natural frequencies of a cantilever and of a free ring."""

from math import factorial, log

import numpy as np

from book.lib import Page, Row

E_STEEL, NU_STEEL, RHO_STEEL, LENGTH, DEPTH = 210e9, 0.3, 7800, 10, 0.5
E_RING, NU_RING, RHO_RING, RADIUS, WALL = 30e9, 0.2, 2500, 0.95, 0.1


def bisect(f, low, high):
    negative = f(low) < 0
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if (f(middle) < 0) == negative else (low, middle)
    return (low + high) / 2


def euler_cantilever(depth):
    plate = E_STEEL / (1 - NU_STEEL**2)
    return 1.8751040687**2 / (2 * np.pi * LENGTH**2) * np.sqrt(plate * depth**2 / 12 / RHO_STEEL)


def timoshenko_cantilever(depth):
    """First root of det T = 0, T the transfer of (moment, shear) from root to tip; shear factor 5/6, rotary inertia."""
    inertia, area = depth**3 / 12, depth
    bending = E_STEEL / (1 - NU_STEEL**2) * inertia
    shear = 5 / 6 * E_STEEL / (2 * (1 + NU_STEEL)) * area

    def det(f):
        w2 = (2 * np.pi * f) ** 2
        # (w, psi, M, Q): w' = psi + Q / kGA, psi' = M / EI, M' = -Q - rho I w2 psi, Q' = -rho A w2 w
        a = np.array([[0, 1, 0, 1 / shear], [0, 0, 1 / bending, 0], [0, -RHO_STEEL * inertia * w2, 0, -1],
                      [-RHO_STEEL * area * w2, 0, 0, 0]])
        scale = np.diag([1, 1, bending, bending])
        values, vectors = np.linalg.eig(np.linalg.inv(scale) @ a @ scale)
        transfer = ((vectors * np.exp(values * LENGTH)) @ np.linalg.inv(vectors)).real
        return np.linalg.det(transfer[2:, 2:])

    return bisect(det, 0.8 * euler_cantilever(depth), 1.05 * euler_cantilever(depth))


def strip_on_rollers():
    """First bending frequency of a strip whose ends may not rise but stand on rollers, exact in plane strain: the
    antisymmetric wave of Rayleigh and Lamb with k = pi / L has u_y = sigma_xx = 0 there (K. F. Graff, Wave Motion in
    Elastic Solids, 8.1). tanh(q d) / tanh(p d) = (q^2 + k^2)^2 / (4 k^2 p q), d half the depth."""
    shear = E_STEEL / (2 * (1 + NU_STEEL))
    pressure = shear * 2 * (1 - NU_STEEL) / (1 - 2 * NU_STEEL)
    k, d = np.pi / LENGTH, DEPTH / 2

    def equation(f):
        w2 = RHO_STEEL * (2 * np.pi * f) ** 2
        p, q = np.sqrt(k * k - w2 / pressure), np.sqrt(k * k - w2 / shear)
        return np.tanh(q * d) / np.tanh(p * d) - (q * q + k * k) ** 2 / (4 * k * k * p * q)

    euler = (np.pi / 1.8751040687) ** 2 * euler_cantilever(DEPTH)
    return bisect(equation, 0.9 * euler, 1.01 * euler)


def thin_ring(n):
    plate = E_RING / (1 - NU_RING**2)
    return n * (n * n - 1) / np.sqrt(n * n + 1) * np.sqrt(plate * WALL**2 / 12 / (RHO_RING * RADIUS**4)) / (2 * np.pi)


def bessel(n, x):
    """(J_n, Y_n) of small x by their series."""
    harmonic = lambda k: sum(1 / i for i in range(1, k + 1)) - 0.5772156649015329
    term = lambda k: (-1) ** k * (x / 2) ** (2 * k + n) / (factorial(k) * factorial(n + k))
    j = sum(term(k) for k in range(20))
    y = 2 / np.pi * j * log(x / 2) - sum((harmonic(k) + harmonic(n + k)) * term(k) for k in range(20)) / np.pi
    y -= sum(factorial(n - k - 1) / factorial(k) * (x / 2) ** (2 * k - n) for k in range(n)) / np.pi
    return j, y


def elastic_ring(n):
    """Exact plane strain (Gazis 1958): u_r = phi' + n psi / r, u_t = -n phi / r - psi', with phi, psi sums of J_n and Y_n,
    both edges free of traction; the frequency at which the determinant of their four amplitudes vanishes."""
    mu = E_RING / (2 * (1 + NU_RING))
    lam = E_RING * NU_RING / ((1 + NU_RING) * (1 - 2 * NU_RING))

    def det(f):
        omega = 2 * np.pi * f
        wave = {"p": omega * np.sqrt(RHO_RING / (lam + 2 * mu)), "s": omega * np.sqrt(RHO_RING / mu)}
        matrix = np.zeros((4, 4))
        for e, r in enumerate([RADIUS - WALL / 2, RADIUS + WALL / 2]):
            for c, (kind, which) in enumerate([("p", 0), ("p", 1), ("s", 0), ("s", 1)]):
                k = wave[kind]
                z = bessel(n, k * r)[which]
                d = k * bessel(n - 1, k * r)[which] - n / r * z
                dd = -d / r - (k * k - n * n / r**2) * z
                if kind == "p":
                    radial = -lam * k * k * z + 2 * mu * dd
                    shear = 2 * mu * n * (z / r**2 - d / r)
                else:
                    radial = 2 * mu * n * (d / r - z / r**2)
                    shear = mu * (d / r - dd - n * n * z / r**2)
                matrix[2 * e, c], matrix[2 * e + 1, c] = radial, shear
        return np.linalg.det(matrix / abs(matrix).max(axis=0))

    return bisect(det, 0.95 * thin_ring(n), 1.005 * thin_ring(n))


END = "Saint-Venant: the held root may not narrow, which shortens the beam by a part of its depth and raises f by twice that over the length"


def chain(k, n, is_lumped):
    """[Hz] of mode k of a column of n equal elements of two nodes, exact: theta = (2k - 1) pi / 2n;
    lumped 2 c/h sin(theta/2), consistent c/h sqrt(6 (1 - cos theta) / (2 + cos theta))."""
    speed, size, theta = np.sqrt(50e6 * 9.81 / 20e3), 10 / n, (2 * k - 1) * np.pi / (2 * n)
    factor = 2 * np.sin(theta / 2) if is_lumped else np.sqrt(6 * (1 - np.cos(theta)) / (2 + np.cos(theta)))
    return speed / size * factor / (2 * np.pi)


def page(book):
    beam = {"along": 80, "across": 4} if book.quick else {"along": 160, "across": 8}
    ring = {"around": 64, "through": 2} if book.quick else {"around": 128, "through": 4}
    f1 = book.modes("cantilever", 1, geo=beam)[0]
    slender = book.modes("cantilever", 1, geo={**beam, "along": 2 * beam["along"], "depth": DEPTH / 2})[0]
    # Here round-off moves the first eigenvalue by more than the 1e-8 of itself below which modes are counted first.
    stubborn = {"along": 80, "across": 4, "depth": DEPTH / 2}
    [alone], [of_two, _] = [book.modes("cantilever", n, geo=stubborn) for n in (1, 2)]
    beyond, beyond_slender = f1 / timoshenko_cantilever(DEPTH) - 1, slender / timoshenko_cantilever(DEPTH / 2) - 1
    rolling = book.modes("cantilever", 2, geo=beam, sets={"supports": {"root": ["y"], "end": ["y"]}})
    rings = book.modes("free_ring", 7, geo=ring)
    rows = [
        Row("strip on rollers: f_1, exact in plane strain", strip_on_rollers(), rolling[1], 1e-5, "Hz",
            why="error of the mesh, (depth / 8)^4"),
        Row("cantilever: f_1 is lower than that of Euler's beam", euler_cantilever(DEPTH), f1, 0, "Hz", bound="most",
            why="4.3933 Hz; shear and rotary inertia lower it by more than the held root raises it"),
        Row("the same: by less than (depth / length)^2 = 0.25 %", (1 - (DEPTH / LENGTH) ** 2) * euler_cantilever(DEPTH), f1, 0, "Hz",
            bound="least", why="the order of what shear and rotary inertia take"),
        Row("cantilever: f_1 beside Timoshenko's beam", timoshenko_cantilever(DEPTH), f1, NU_STEEL / 8 * DEPTH / LENGTH, "Hz",
            why=END),
        Row("cantilever: that difference, half as deep over full", 0.5, beyond_slender / beyond, 0.02,
            why="an end effect is of first order in depth / length, anything wrong in the beam itself is not; the next order adds depth / length of it"),
        Row("cantilever: that difference extrapolated to no depth", 0, 2 * beyond_slender - beyond, 5e-5, relative=False,
            why="what is of second order"),
        Row("cantilever: f_1 asked for alone, and as the first of two", of_two, alone, 1e-6, "Hz",
            why="round-off of a slender body: 1e-16 times the largest eigenvalue over the first, some 1e9"),
        Row("ring: rigid motions among the lowest modes", 3, sum(f < 1e-3 * rings[3] for f in rings), 0, relative=False,
            why="a count"),
    ]
    for n, place in [(2, 3), (3, 5)]:
        exact = elastic_ring(n)
        for twin in (place, place + 1):
            rows.append(Row(f"ring: n = {n}, exact in plane strain, mode {twin + 1}", exact, rings[twin], 5e-5, "Hz",
                            why="error of the mesh", quick=(6e-4, "half as many elements round and through")))
        for words, part, bound, why in [
                ("is lower than that of the thin ring", 1, "most", "48.30, 136.6 Hz; shear and rotary inertia can only lower it"),
                ("the same: by less than 2 %", 0.98, "least", "the order of what shear and rotary inertia of such a wall take")]:
            rows.append(Row(f"ring: n = {n}, {words}", part * thin_ring(n), rings[place], 0, "Hz", bound=bound, why=why))
    for kind, is_lumped in [("lumped", True), ("consistent", False)]:
        found = book.modes("uniform_column", 3, geo={"size": 0.5}, sets={"mass": kind})
        rows += [Row(f"column of 20 elements, {kind} mass: mode {k}", chain(k, 20, is_lumped), found[k - 1], 1e-5, "Hz",
                     why="the digits that `coralpipe modes` prints") for k in (1, 2, 3)]

    def plot(axes):
        k = np.arange(1, 21)
        continuous = (2 * k - 1) * np.sqrt(50e6 * 9.81 / 20e3) / 40
        for is_lumped, colour, name in [(True, "C0", "lumped"), (False, "C1", "consistent")]:
            found = book.modes("uniform_column", 3, geo={"size": 0.5}, sets={"mass": name})
            axes.plot(k, chain(k, 20, is_lumped) / continuous, colour, linewidth=0.9, label=f"{name} mass, exact")
            axes.plot(k[:3], np.array(found) / continuous[:3], colour + "o", markersize=4, label=f"{name} mass, program")
        axes.set(xlabel="mode of a column of 20 elements", ylabel="frequency / that of the continuous column", xticks=[1, 5, 10, 15, 20])
        axes.grid(alpha=0.3)
        axes.legend()

    return Page(
        "frequencies", "Natural frequencies: strip on rollers, cantilever, free ring", [16],
        problem="`coralpipe modes` of a steel cantilever of 10 x 0.5 m and of a concrete ring of mean radius 0.95 m and wall 0.1 m "
                "that nothing holds, in Q8 elements; and of a column of 20 Q4 with lumped and with consistent mass.",
        reference="Beams with E / (1 - nu^2): Euler in closed form, Timoshenko (shear factor 5/6) by the transfer matrix. Ring: "
                  "n (n^2 - 1) / sqrt(n^2 + 1) sqrt(E' I / m R^4) for a thin one, and the exact plane-strain solution in Bessel "
                  "functions (D. C. Gazis 1958), its determinant solved here. Column of n elements of height h: c/h 2 sin(theta/2) with lumped and "
                  "c/h sqrt(6 (1 - cos theta)/(2 + cos theta)) with consistent mass, theta = (2k - 1) pi/2n, exact for the mesh.",
        rows=rows, code=["src/solve/modes.rs::natural_modes", "src/sparse/lanczos.rs", "src/physics/element.rs::lumped_mass"], plot=plot,
        notes=f"Measured: the cantilever is {100 * (f1 / euler_cantilever(DEPTH) - 1):+.2f} % beside Euler, the ring {100 * (rings[3] / thin_ring(2) - 1):+.2f} % "
              f"(n = 2) and {100 * (rings[5] / thin_ring(3) - 1):+.2f} % (n = 3) beside the thin ring. The held root keeps the solid from narrowing, which a beam "
              "does not know. Lumped and consistent mass stand on either side of the continuous column. A ring's modes come in twins, turned against each other by a quarter of a wave; both are compared.",
    )
