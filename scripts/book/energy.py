"""Item 17: the energy identity of the average acceleration."""

import numpy as np

from book.lib import Page, Row
from book.time_integration import marched

TWIN, MESH = "geo/twin_pipes.json", "meshes/twin_pipes.msh"


def identity(h, dt, alpha, beta, duration):
    """Largest |change of energy - work + loss| in a step over the largest energy, of the mass on a spring under its pulse."""
    area = 0.02
    k, m, p = (2 * np.pi) ** 2 * area, area, (2 * np.pi) ** 2 * area
    t, u, v = h["t"], h["P1.uy"], h["P1.vy"]
    load = -p * np.where(t <= duration, 1 - t / duration, 0)
    energy = m * v**2 / 2 + k * u**2 / 2
    mean = (v[1:] + v[:-1]) / 2
    loss = dt * mean * (alpha * m + beta * k) * mean
    work = (load[1:] + load[:-1]) / 2 * np.diff(u)
    return abs(np.diff(energy) - work + loss).max() / energy.max()


def page(book):
    dt, alpha, beta = 0.01, 0.3, 0.002
    sets = {"time.step": dt, "time.end": 4, "output.every": 4, "loads.top_1.pressure.duration": 0.505,
            "damping": {"alpha": alpha, "beta": beta}}
    plain = book.run("load_factor", sets=sets)
    damped = book.run("load_factor", sets={**sets, "time.hht": -0.1})
    end = "10 ms" if book.quick else "50 ms"
    twin = book.run(TWIN, mesh=MESH, sets={"time.end": end, "output.every": end}, tag="energy_bonded", bonded=True)
    contact = book.run(TWIN, mesh=MESH, sets={"time.end": end, "output.every": end}, tag="energy_contact")
    lost = identity(damped.histories, dt, alpha, beta, 0.505)
    omega = 2 * np.pi
    pulse = lambda t: -(omega**2) * (1 - t / 0.505) * (t <= 0.505)
    u, v, _ = marched(400, dt, omega, alpha + beta * omega**2, pulse, alpha=-0.1)
    expected = identity({"t": dt * np.arange(401), "P1.uy": u, "P1.vy": v}, dt, alpha, beta, 0.505)
    rows = [
        Row("one mass, damped, pulse: identity in every step, from u and v of the histories", 0,
            identity(plain.histories, dt, alpha, beta, 0.505), 1e-12, relative=False, why="round-off"),
        Row("the same with HHT alpha = -0.1, which must break it: as HHT's own recurrence does", expected, lost, 1e-9,
            why="round-off: the loss of the recurrence of the page `time_integration`, an independent one"),
        Row("the same: it is far above the identity's tolerance", 1e-6, lost, 0, relative=False, bound="least",
            why="its numerical damping: shows that the first row can fail"),
        Row("twin pipes glued: ledger's largest residual over the peak energy", 0, twin.summary["energy"]["max_relative_error"],
            1e-9, relative=False, why="round-off of sums over the steps"),
        Row("twin pipes with contact: the same", 0, contact.summary["energy"]["max_relative_error"], 1e-6, relative=False,
            why="Newton's tolerance of 1e-8, over all steps"),
    ]
    last = contact.summary["energy"]["last"]

    def plot(axes):
        t, area, k = plain.histories["t"], 0.02, omega**2 * 0.02
        for run, colour, name in [(plain, "C0", "average acceleration"), (damped, "C1", "HHT alpha = -0.1")]:
            u, v = run.histories["P1.uy"], run.histories["P1.vy"]
            axes.plot(t, area * v**2 / 2 + k * u**2 / 2, colour, linewidth=0.9, label=f"kinetic + strain, {name}")
        axes.set(xlabel="t [s]", ylabel="energy of the mass on its spring [J/m]")
        axes.grid(alpha=0.3)
        axes.legend()

    return Page(
        "energy", "Energy identity of the average acceleration", [17],
        problem="A mass on a spring with damping under a pulse that ends inside a step; the default twin pipes, glued and with contact.",
        reference="In a step, kinetic + strain energy change by (R_n + R_n+1)'(u_n+1 - u_n) / 2 - dt v'C v, v the mean velocity, exactly "
                  "(S. Krenk 2006, for one).",
        rows=rows, code=["src/solve/energy.rs::after", "src/solve/newmark.rs::Constants"], plot=plot,
        example=(contact, "the ledger is `energy` in summary.json, its residual `energy.max_relative_error`."),
        tables=[("The ledger of the twin pipes with contact at " + end + " [J/m]", ["part", "energy"],
                 [[name, f"{value:.4g}"] for name, value in last.items()])],
        notes="With contact, the ledger's line `contact` takes what a joint that opens, closes or begins to slip inside a step wins or "
              "loses; so there the small residual proves the equations of motion, not the contact law.",
    )
