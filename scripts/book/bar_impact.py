"""Item 18: an elastic bar strikes a rigid wall."""

import numpy as np

from book.lib import Failed, Page, Row

LENGTH, YOUNG, DENSITY, SPEED, GAP = 0.2, 200e9, 8000, 100, 2e-3
WAVE = np.sqrt(YOUNG / DENSITY)  # 5000 m/s
STRESS = DENSITY * WAVE * SPEED  # 4.0 GPa


def page(book):
    up = 400 if book.quick else 800
    dt = 0.5 * LENGTH / up / WAVE
    stiffness = YOUNG * up / LENGTH  # the joint gives way as much as one element does
    frames = 75
    run = book.run("bar_impact", geo={"up": up}, sets={"time.step": dt, "time.end": 1.5e-4, "output.every": 1.5e-4 / frames,
                                                       "interfaces.foot.normal_stiffness": stiffness})
    times = np.linspace(0, 1.5e-4, frames + 1)
    moments = [run.frame(i) for i in range(frames + 1)]
    pressure = np.array([-f.normal_traction.mean() for f in moments])
    bar = moments[0].points[:, 1] >= 0
    velocity = lambda f: mean_velocity(f, bar)
    first, last = GAP / SPEED, GAP / SPEED + 2 * LENGTH / WAVE
    # rho c (V - v) = kappa g, g' = v: the pressure comes up as 1 - exp(-t / delay), its impulse that much late
    delay = DENSITY * WAVE / stiffness
    plateau = (times > first + 5e-6) & (times < last - 5e-6)
    before, after = velocity(moments[0]), velocity(moments[-1])
    # the momentum turns at a constant rate while the bar is in contact: duration = change / rate
    middle = [i for i, on in enumerate(plateau) if on]
    rate = np.polyfit(times[middle], [velocity(moments[i]) for i in middle], 1)
    begin = (before - rate[1]) / rate[0]
    end = (after - rate[1]) / rate[0]
    energy = run.summary["energy"]["last"]
    kinetic = DENSITY * LENGTH * 0.01 * SPEED**2 / 2
    rows = [
        Row("contact begins at", first, begin, 1.1 * delay / first, "s",
            why=f"the joint's compliance delays the front by rho c / kappa = {delay:.2g} s, {100 * delay / first:.2g} % of this; a tenth more for the mesh"),
        Row("contact begins, the joint's compliance counted: gap / V + rho c / kappa", first + delay, begin, 1e-4, "s",
            why="0.01 %: the straight line is fitted through a pressure that ripples"),
        Row("contact lasts", 2 * LENGTH / WAVE, end - begin, 0.01, "s", why="1 %: a front is smeared over elements"),
        Row("mean pressure on the wall meanwhile", STRESS, pressure[plateau].mean(), 0.01, "Pa", why="the same"),
        Row("mean velocity after it", SPEED, after, 0.01, "m/s", why="the same; some energy stays as ripples behind the front"),
        Row("impulse of the wall", 2 * DENSITY * LENGTH * SPEED, DENSITY * LENGTH * (after - before), 0.01, "Pa s",
            why="the same"),
        Row("pressure on the wall after it", 0, abs(pressure[times > last + 1e-5]).max(), 0, "Pa", relative=False,
            why="open joints carry nothing"),
        Row("stress in the middle when the front has passed", -STRESS, middle_stress(moments, times, first), 1e-3, "Pa",
            why="mean over the middle fifth of the bar: ripples of the mesh"),
        Row("kinetic + strain + contact's numerical loss over the first kinetic energy", 1,
            (energy["kinetic"] + energy["strain"] + energy["contact"]) / kinetic, 1e-6, relative=False,
            why="the ledger closes to round-off"),
        Row("what contact takes of the energy", 0, energy["contact"] / kinetic, 1e-4, relative=False,
            why="0 in the limit; Newmark's method with a one-sided joint keeps energy only as the step goes to zero"),
    ]

    def left(stiffness):
        """[steps, kinetic + strain after the impact over the kinetic energy before], or why the run ended."""
        try:
            run = book.run("bar_impact", geo={"up": 200}, sets={"time.step": 1e-7, "time.end": 1.5e-4, "output.every": 1.5e-4,
                                                                "interfaces.foot.normal_stiffness": stiffness})
        except Failed as why:
            if "of the energy supplied" not in str(why):
                raise
            return ["", "exit code 3: joints made more than 2 %"]
        e = run.summary["energy"]["last"]
        return [str(run.summary["steps"]), f"{100 * (e['kinetic'] + e['strain']) / kinetic:.3f} %"]

    table = [[f"{k:.0e}", *left(k)] for k in ([] if book.quick else [2e13, 2e14, 2e15, 1e16])]

    def plot(axes):
        axes.plot(1e6 * times, pressure / 1e9, label="pressure on the wall [GPa]")
        axes.plot(1e6 * times, [velocity(f) / 25 for f in moments], label="mean velocity [25 m/s]")
        axes.plot(1e6 * np.array([0, first, first, last, last, 1.5e-4]), [0, 0, 4, 4, 0, 0], color="0.7", label="exact")
        axes.set(xlabel="t [us]")
        axes.legend()

    return Page(
        "bar_impact", "A bar strikes a rigid wall", [18],
        problem="An elastic bar of 0.2 m (E = 200 GPa, nu = 0, 8000 kg/m3) flies at 100 m/s towards a rigid wall 2 mm away. "
                f"{up} elements along, a step of half an element's wave time, no damping of any kind.",
        reference="Waves in a bar: contact from gap / V = 20 us on for 2 L / c = 80 us at rho c V = 4.0 GPa, then the whole bar "
                  "flies back at 100 m/s.",
        rows=rows, code=["src/physics/joint.rs", "src/solve/contact.rs", "src/solve/energy.rs"], plot=plot,
        tables=[("What is left of the energy after the impact, by the joint's normal stiffness [Pa/m]; 200 elements", ["stiffness", "steps", "kinetic + strain"], table)] if table else [],
        notes="The joint's normal stiffness is E over the length of an element, so that joint and mesh are refined together: contact begins "
              "late by h / c, the time a wave takes through one element (rows 1 and 2), and neither step nor mesh matters beside that. **A joint "
              "much stiffer than its mesh, hit without any damping, chatters from step to step**, and steps are cut so that it makes next to no energy (table): choose "
              "`thickness` no smaller than about an element, `time.hht`, `mass` = \"redistributed\", damping or a shorter step for impacts. The ledger's `contact` "
              "shows it. Begin and duration are read from the "
              "straight line on which the bar's momentum turns. The front is a jump, which no mesh carries: ripples trail it, and "
              "single frames of pressure swing about 4.0 GPa.",
    )


def mean_velocity(frame, bar):
    """Of the bar's momentum: trapezium rule over its height."""
    y, v = frame.points[bar, 1], frame.velocity[bar, 1]
    levels = np.unique(y.round(9))
    free = [v[abs(y - level) < 1e-9] for level in levels]
    # at the foot, the wall's own nodes lie at the bar's places and rest: the bar's are those of the larger |v|
    profile = np.array([values[np.argsort(-abs(values))][:3].mean() for values in free])
    return np.trapezoid(profile, levels) / (levels[-1] - levels[0])


def middle_stress(moments, times, first):
    """Mean axial stress over the middle fifth, when the front is at four fifths of the bar."""
    frame = moments[int(np.argmin(abs(times - first - 0.8 * LENGTH / WAVE)))]
    inside = (frame.centres[:, 1] > 0.4 * LENGTH) & (frame.centres[:, 1] < 0.6 * LENGTH)
    return frame.stress[inside, 1].mean()
