"""Item 13: period elongation and digits of the average acceleration, damping of HHT, on one mass and spring."""

import numpy as np

from book.lib import Page, Row

PRINTED = {0.01: 0.0329, 0.02: 0.1315, 0.05: 0.8171, 0.1: 3.2075, 0.2: 12.0033}  # dt / T: elongation [%]
HHT = {-0.05: 0.00118, -0.1: 0.00211}  # alpha: damping ratio at dt / T = 0.1


def decay(u):
    """(rho, phi) of u_n = rho^n cos(n phi + ...), by the recurrence u_n+1 = 2 rho cos(phi) u_n - rho^2 u_n-1."""
    a, b = np.linalg.lstsq(np.stack([u[1:-1], u[:-2]], axis=1), u[2:], rcond=None)[0]
    rho = np.sqrt(-b)
    return rho, np.arccos(a / (2 * rho))


def damping_ratio(rho, phi):
    """xi of the exact motion with this decay a step: rho = exp(-xi w dt), phi = w dt sqrt(1 - xi^2)."""
    return -np.log(rho) / np.hypot(np.log(rho), phi)


def average_acceleration(omega_dt):
    """phi of the method: tan(phi / 2) = omega dt / 2."""
    return 2 * np.arctan(omega_dt / 2)


def hht(alpha, omega_dt):
    """(rho, phi) of the principal root of the amplification matrix in (u, dt v, dt^2 a)."""
    beta, gamma, w2 = (1 - alpha) ** 2 / 4, 0.5 - alpha, omega_dt**2
    predictor = np.array([1, 1, 0.5 - beta])
    new_a = -w2 * ((1 + alpha) * predictor - alpha * np.array([1, 0, 0])) / (1 + (1 + alpha) * beta * w2)
    matrix = np.array([predictor + beta * new_a, np.array([0, 1, 1 - gamma]) + gamma * new_a, new_a])
    root = max(np.linalg.eigvals(matrix), key=lambda z: (z.imag > 0) * abs(z))
    return abs(root), np.angle(root)


def marched(n, dt, omega, c, force, start=(0.0, 0.0), alpha=0.0):
    """(u, v, a) of u'' + c u' + omega^2 u = force(t) by the step that Hilber, Hughes and Taylor print; alpha = 0: Newmark."""
    beta, gamma = (1 - alpha) ** 2 / 4, 0.5 - alpha
    u, v = start
    a = force(0.0) - c * v - omega**2 * u
    history = [(u, v, a)]
    for i in range(n):
        held = (1 + alpha) * force((i + 1) * dt) - alpha * force(i * dt) + alpha * (c * v + omega**2 * u)
        u_, v_ = u + dt * v + dt**2 * (0.5 - beta) * a, v + dt * (1 - gamma) * a
        a = (held - (1 + alpha) * (c * v_ + omega**2 * u_)) / (1 + (1 + alpha) * (c * gamma * dt + omega**2 * beta * dt**2))
        u, v = u_ + dt**2 * beta * a, v_ + dt * gamma * a
        history.append((u, v, a))
    return np.array(history).T


def damped_rows(book):
    """Damping, load and initial velocity, with HHT and without, beside `marched`: every term of a step and of the start."""
    omega, dt, n = 2 * np.pi, 0.02, 150
    rayleigh = {"alpha": 0.3, "beta": 0.002}
    c = rayleigh["alpha"] + rayleigh["beta"] * omega**2
    pulse = lambda t: -(omega**2) * (1 - t / 0.505) * (t <= 0.505)
    sets = {"time.step": dt, "time.end": n * dt, "output.every": n * dt, "damping": rayleigh}
    round_off = "round-off: the same recurrence in other words"
    rows = []
    for alpha in [0, -0.1]:
        h = book.run("load_factor", sets={**sets, "loads.top_1.pressure.duration": 0.505, "time.hht": alpha}).histories
        u = marched(n, dt, omega, c, pulse, alpha=alpha)[0]
        rows.append(Row(f"damped mass under a pulse, alpha = {alpha:g}: u at all steps, largest difference over the largest", 0,
                        abs(h["P1.uy"] - u).max() / abs(u).max(), 1e-10, relative=False, why=round_off))
        h = book.run("oscillator", sets={**sets, "initial.top_1": {"velocity": [0, 1]}, "time.hht": alpha}).histories
        u, _, a = marched(n, dt, omega, c, lambda t: 0.0, (0.0, 1.0), alpha)
        rows.append(Row(f"damped mass with v(0) = 1 m/s, alpha = {alpha:g}: u at all steps, largest difference over the largest", 0,
                        abs(h["P1.uy"] - u).max() / abs(u).max(), 1e-10, relative=False, why=round_off))
    rows.append(Row("the same: a(0) = -(alpha + beta omega^2) v(0)", a[0], h["P1.ay"][0], 1e-10, "m/s2", why=round_off))
    return rows


def page(book):
    rows, curves = damped_rows(book), {}
    for ratio, printed in PRINTED.items():
        h = book.run("oscillator", sets={"time.step": ratio, "time.end": 4, "output.every": 4}).histories
        phi = decay(h["P1.uy"])[1]
        found = 100 * (2 * np.pi * ratio / phi - 1)
        exact = 100 * (2 * np.pi * ratio / average_acceleration(2 * np.pi * ratio) - 1)
        rows.append(Row(f"period elongation at dt / T = {ratio:g}", exact, found, 1e-7, "%", relative=False,
                        why="round-off; the printed digits follow"))
        rows.append(Row(f"the same, printed: {printed}", printed, found, 6e-5, "%", relative=False,
                        why="half a digit in the last place"))
        curves[ratio] = h
    released = book.run("oscillator")
    u = released.histories["P1.uy"][20]
    rows.append(Row("u(1 s) at dt = 0.05 s, omega = 2 pi, u(0) = 1 m", 0.99870359, u, 6e-9, "m", relative=False,
                    why="the digits given"))
    for alpha, printed in HHT.items():
        sets = {"time.step": 0.1, "time.end": 10, "time.hht": alpha, "output.every": 10}
        h = book.run("oscillator", sets=sets).histories
        rho, phi = decay(h["P1.uy"][40:])
        exact_rho, exact_phi = hht(alpha, 0.2 * np.pi)
        exact = -np.log(exact_rho) / exact_phi
        rows.append(Row(f"HHT alpha = {alpha:g}: damping ratio at dt / T = 0.1", exact, -np.log(rho) / phi, 1e-9,
                        relative=False, why="round-off; of the amplification matrix"))
        rows.append(Row(f"the same, printed: {printed}", printed, -np.log(rho) / phi, 6e-6, relative=False,
                        why="half a digit in the last place"))
        rows.append(Row(f"HHT alpha = {alpha:g}: phase a step", exact_phi, phi, 1e-9, "rad", why="round-off"))

    def plot(axes):
        t = np.linspace(0, 4, 400)
        axes.plot(t, np.cos(2 * np.pi * t), color="0.7", label="exact")
        for ratio in [0.05, 0.1, 0.2]:
            axes.plot(curves[ratio]["t"], curves[ratio]["P1.uy"], ".-", markersize=3, linewidth=0.8, label=f"dt / T = {ratio}")
        axes.set(xlabel="t / T", ylabel="u [m]")
        axes.legend(loc="upper right")

    return Page(
        "time_integration", "Time integration: period and numerical damping", [13],
        problem="One four-node element with nu = 0 on a held base between rollers: k = E A / H and m = rho A H / 3, a mass on a "
                "spring of 1 Hz, released from 1 m; with damping alpha = 0.3 1/s, beta = 2 ms under a triangular pulse of 0.505 s, or "
                "with an initial velocity.",
        reference="Average acceleration: tan(phi / 2) = omega dt / 2 is the phase of a step, exactly; the printed table is that "
                  "of the textbooks (K.-J. Bathe, Finite Element Procedures, ch. 9). HHT: the principal root of the "
                  "amplification matrix (H. M. Hilber, T. J. R. Hughes and R. L. Taylor, 1977), computed here; with damping and load, their "
                  "recurrence of one mass, written out here: m a + (1 + alpha)(c v + k u) - alpha (c v + k u)_t = (1 + alpha) f - alpha f_t.",
        rows=rows,
        notes="The phase of a step is read from the history by the two-term recurrence that any such motion satisfies. The "
              "joints' forces are taken at the end of the step also with HHT; this case has none.",
        code=["src/solve/newmark.rs::Constants", "src/solve/step.rs::right_hand_sides", "src/solve/start.rs::with_acceleration"], plot=plot,
        example=(released, "u(1 s) is the last `P1.uy` in histories.csv."),
    )
