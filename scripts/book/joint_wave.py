"""Item 11: transmission and reflection of a harmonic P wave at a joint that stays closed."""

import numpy as np

from book.lib import Page, Row

E, NU, RHO = 519e6, 0.38, 2600.0
M = E * (1 - NU) / ((1 + NU) * (1 - 2 * NU))
Z = np.sqrt(M * RHO)  # impedance of a plane P wave [Pa s/m]
F = 500.0  # [Hz]
OMEGA = 2 * np.pi * F
RATIOS = {0.25: 0.447214, 0.5: 0.707107, 1.0: 0.894427, 2.0: 0.970143, 5.0: 0.995037}  # k/(Z omega): T


def load(dt):
    """A sine of 50 kPa on a pressure of 100 kPa, both rising smoothly in four periods."""
    t = np.arange(0, 0.03 + dt / 2, dt)
    rise = 0.5 - 0.5 * np.cos(np.pi * np.clip(t * F / 4, 0, 1))
    return {"law": "table", "times": t.round(9), "values": (rise * (1e5 + 5e4 * np.sin(OMEGA * t))).round(6)}


def amplitude(history, probe):
    """Complex velocity amplitude over the last five periods; the mean belongs to the constant pressure."""
    t = history["t"]
    last = t > t[-1] - 5 / F - 1e-9
    waves = np.stack([np.ones(last.sum()), np.cos(OMEGA * t[last]), np.sin(OMEGA * t[last])], axis=1)
    _, a, b = np.linalg.lstsq(waves, history[f"{probe}.vx"][last], rcond=None)[0]
    return a - 1j * b


def page(book):
    size = 0.04 if book.quick else 0.02
    dt = 4e-5 if book.quick else 2e-5
    sets = {"time.step": dt, "loads.end_left.pressure": load(dt)}
    incident = amplitude(book.run("joint_wave", geo={"size": size}, sets=sets, bonded=True, tag="bonded").histories, "after")
    rows, points = [], []
    for ratio, transmitted in RATIOS.items():
        result = book.run("joint_wave", geo={"size": size}, tag=f"k{ratio:g}",
                          sets={**sets, "interfaces.joint.normal_stiffness": ratio * Z * OMEGA})
        t = amplitude(result.histories, "after") / incident
        r = amplitude(result.histories, "before") / incident - 1
        points.append((ratio, abs(t), abs(r)))
        name = f"k/(Z w) = {ratio:g}"
        why = "trapezium rule and elements shift w and Z by less than (w dt)^2/12 and (2 pi h/wavelength)^2/12"
        quick = "elements of 4 cm and steps of 0.04 ms: four times the error"
        rows += [
            Row(f"{name}: transmission T", transmitted, abs(t), 1e-3, why=why, quick=(4e-3, quick)),
            Row(f"{name}: reflection (1 - T^2)^1/2", np.sqrt(1 - transmitted**2), abs(r), 2e-3, why=why, quick=(8e-3, quick)),
            Row(f"{name}: phase of T", -np.degrees(np.arctan(0.5 / ratio)), np.degrees(np.angle(t)), 0.3, "deg",
                relative=False, why=why),
            Row(f"{name}: widest opening over the sine's closing 25 kPa/k", 0,
                result.summary["contact"]["max_open"] * ratio * Z * OMEGA / 25e3, 1e-3, relative=False,
                why="waves too short for the mesh run ahead of the front and open the unloaded joint by nanometres; an opening by "
                    "the sine would be of order 1"),
        ]
    exact_transmission = np.array([2 * k / np.hypot(2 * k, 1) for k in RATIOS])
    if not np.allclose(exact_transmission, list(RATIOS.values()), atol=1e-6):
        raise ValueError("the printed values of T are not the formula's")

    def plot(axes):
        k = np.geomspace(0.1, 10, 200)
        axes.semilogx(k, 2 * k / np.hypot(2 * k, 1), "C0", label="T, exact")
        axes.semilogx(k, 1 / np.hypot(2 * k, 1), "C1", label="R, exact")
        ratios, t, r = zip(*points)
        axes.semilogx(ratios, t, "C0o", label="T, program")
        axes.semilogx(ratios, r, "C1s", label="R, program")
        axes.set(xlabel="k/(Z w)", ylabel="amplitude over the incident wave's")
        axes.grid(alpha=0.3)
        axes.legend()

    return Page(
        "joint_wave", "A joint under a P wave at normal incidence", [11],
        problem=f"A bar of layer 2 (plane P waves: M = {M / 1e6:.1f} MPa, Z = {Z / 1e6:.4f} MPa s/m) with one straight joint "
                "of normal stiffness k. Both ends are viscous; 100 kPa and a sine of 50 kPa at 500 Hz on the left end send "
                "a wave of half of that to the joint, and what comes back leaves through the same end.",
        reference="T = [4 k^2/(4 k^2 + (Z w)^2)]^1/2, R = (1 - T^2)^1/2, phase of T = -atan(Z w/2k), from v+ = v- - "
                  "d(s/k)/dt and s continuous (Schoenberg 1980; Pyrak-Nolte, Myer and Cook 1990).",
        rows=rows, plot=plot,
        notes="The incident wave is that of the same bar without the joint (`--bonded`), so that what the mesh does to the wave "
              "on its way cancels. The joint cannot pull: the constant pressure of 50 kPa in the wave exceeds the sine's "
              "25 kPa, so it stays closed and linear. Amplitudes are fitted over the last five periods.",
        code=["src/physics/joint.rs", "src/solve/condensed.rs", "geo/verification/joint_wave.geo"],
    )
