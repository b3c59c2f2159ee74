"""Item 14: Rayleigh damping, its coefficients and the free decay it causes at four frequencies."""

import numpy as np

from book.lib import Page, Row
from book.time_integration import damping_ratio, decay

FREQUENCIES = [5, 75**0.5, 15, 50]  # of the case [Hz]


def page(book):
    dt = 1e-4 if book.quick else 2e-5
    run = book.run("free_decay", sets={"time.step": dt})
    omega = 2 * np.pi * np.array(FREQUENCIES)
    beta = 2 * 0.05 / (omega[0] + omega[2])
    alpha = omega[0] * omega[2] * beta
    rayleigh = run.summary["rayleigh"]
    rows = [Row(f"natural frequency {i + 1}", f, run.summary["frequencies_hz"][i], 1e-9, "Hz", why="round-off")
            for i, f in enumerate(FREQUENCIES)]
    rows += [Row("alpha", alpha, rayleigh["alpha"], 1e-8, "1/s", why="2.356194; round-off of the frequencies"),
             Row("beta", beta, rayleigh["beta"], 1e-8, "s", why="7.957747e-4; round-off of the frequencies")]
    measured = []
    for i, (f, w) in enumerate(zip(FREQUENCIES, omega)):
        rho, phi = decay(run.histories[f"P{i + 1}.uy"])
        exact = alpha / (2 * w) + beta * w / 2
        measured.append(damping_ratio(rho, phi))
        rows.append(Row(f"damping ratio at {f:.4g} Hz", exact, measured[-1], (w * dt) ** 2 / 4 + 1e-9,
                        why="(omega dt)^2 / 4: the method's phase error is (omega dt)^2 / 12"))
        if i in (0, 2):
            rows.append(Row(f"logarithmic decrement at {f:g} Hz", 0.3145527, -2 * np.pi * np.log(rho) / phi,
                            (w * dt) ** 2 / 4 + 2e-7, why="the same, and the printed digits"))

    def plot(axes):
        f = np.linspace(2, 60, 300)
        axes.plot(f, 100 * (alpha / (4 * np.pi * f) + np.pi * beta * f), color="0.6", label="alpha / 2 omega + beta omega / 2")
        axes.plot(FREQUENCIES, 100 * np.array(measured), "o", label="program")
        axes.set(xlabel="frequency [Hz]", ylabel="damping ratio [%]", ylim=(0, 16))
        axes.legend()

    return Page(
        "free_decay", "Rayleigh damping: free decay", [14],
        problem="Four separate masses on springs of 5, 8.66, 15 and 50 Hz in one case, with `\"damping\": {\"ratio\": 0.05, "
                "\"modes\": [1, 3]}`, released from 1 m.",
        reference="beta = 2 xi / (omega_1 + omega_2), alpha = omega_1 omega_2 beta; xi(omega) = alpha / (2 omega) + beta omega / 2, "
                  "the least, 4.330 %, at sqrt(5 x 15) = 8.66 Hz and 12.9 % at 50 Hz; decrement 2 pi xi / sqrt(1 - xi^2) = 0.3145527 "
                  "for 5 %.",
        rows=rows, code=["src/solve/modes.rs", "src/solve/system.rs", "src/study/prepare.rs"], plot=plot,
        notes="The program takes alpha and beta from the natural frequencies it finds itself.",
    )
