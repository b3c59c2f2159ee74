"""Hard cases for the contact iteration: no step is lost, or the run ends with exit code 3 and says where."""

from book.energy import MESH, TWIN
from book.lib import Failed, Page, Row

SIDES = ("interface_left", "interface_right")
TOLERATED = 0.02  # share of the energy supplied that joints may make in a run that is done


def page(book):
    end = 0.02 if book.quick else 0.05
    both = lambda key, value: {f"interfaces.{side}.{key}": value for side in SIDES}
    cases = {
        "joints of 1 mm, damped": both("thickness", 1e-3),
        "joints of 1 mm, undamped": {**both("thickness", 1e-3), "damping": None},
        "joints of 1 cm, undamped": {"damping": None},
        "short blast of 5 ms, undamped": {"damping": None, "loads.surface.pressure.duration": 5e-3},
        "friction 0.8, short blast, undamped": {**both("friction", 0.8), "damping": None, "loads.surface.pressure.duration": 5e-3},
        "friction 1.5, joints of 1 mm, undamped": {**both("friction", 1.5), **both("thickness", 1e-3), "damping": None},
        "joints of 1 cm, undamped, HHT alpha = -0.1": {"damping": None, "time.hht": -0.1},
        "joints of 1 mm, undamped, HHT alpha = -0.1": {**both("thickness", 1e-3), "damping": None, "time.hht": -0.1},
        "joints damped too, C(U)": {"damping": {"ratio": 0.05, "modes": [1, 2], "interfaces": True}},
    }
    if book.quick:
        cases = {name: cases[name] for name in ["joints of 1 mm, damped", "joints of 1 cm, undamped", "joints of 1 cm, undamped, HHT alpha = -0.1"]}
    rows, table, shares = [], [], {}
    for i, (name, sets) in enumerate(cases.items()):
        try:
            run = book.run(TWIN, mesh=MESH, sets={**sets, "time.end": end, "output.every": end}, tag=f"convergence_{i}")
        except Failed as why:
            named = "exit code 3" in str(why) and ("interface_" in str(why) or "of the energy supplied" in str(why))
            rows.append(Row(f"{name}: ends with exit code 3 and names joints or their energy", 1, float(named), 0, relative=False, why="a refusal"))
            table.append([name, "stopped, exit 3", "", "", ""])
            continue
        steps = round(end / 1e-4)
        done = len(run.histories["t"]) - 1
        contact, all_steps = run.summary["contact"], run.summary["steps"]
        rows.append(Row(f"{name}: steps lost", 0, steps - done, 0, relative=False, why="a count"))
        energy = run.summary["energy"]
        if "HHT" not in name:  # its numerical damping is the residual
            rows.append(Row(f"{name}: energy not accounted for, over the peak", 0, energy["max_relative_error"], 1e-6,
                            relative=False, why="every accepted step satisfies its equations to newton.tolerance"))
        share = energy["made"] / energy["supplied"]
        rows.append(Row(f"{name}: energy that joints make, over the energy supplied", 0, share, TOLERATED, relative=False,
                        why="time.energy_tolerance: a run that makes more is not done"))
        if "undamped" not in name or "HHT" in name:
            rows.append(Row(f"{name}: energy that contact makes or takes, over the peak", 0, energy["last"]["contact"] / energy["peak"],
                            0.01, relative=False, why="1 %: statuses change inside steps"))
        shares[name] = share
        table.append([name, f"{done} of {steps}", str(contact["cut_steps"]), f"{run.summary['iterations'] / all_steps:.2f}",
                      f"{100 * share:.2g} %"])
    try:
        book.run("pulled_block", sets={"analysis": "static", "loads.block.body_force.values": [0, 505.0]}, tag="static_pulled")
        refused = 0
    except Failed as why:
        refused = float("exit code 3" in str(why) and "after t = 0.99 s" in str(why))
    rows.append(Row("static, block pulled beyond mu N, which has no equilibrium from t = 1 / 1.01 s on: exit code 3 at t = 0.99 s", 1, refused, 0,
                    relative=False, why="a refusal"))

    def plot(axes):
        names = list(shares)[::-1]
        axes.barh(names, [max(shares[name], 1e-7) for name in names])
        axes.axvline(TOLERATED, color="k", linewidth=0.8)
        axes.set(xscale="log", xlabel="energy made by joints / energy supplied (line: limit)")
        axes.tick_params(axis="y", labelsize=7)

    return Page(
        "convergence", "Hard cases of contact", [],
        problem="The default twin pipes with thin joints, without damping, with more friction: cases in which a plain Newton loses steps; "
                "and a block that cannot be in equilibrium.",
        reference="A step is accepted only if its residual is below `newton.tolerance` with statuses that agree; else Newton gives over to a "
                  "fixed point on Tresca's bound, then the step is cut in half up to five times, then the run ends with exit code 3.",
        rows=rows, code=["src/solve/contact.rs::newton", "src/solve/tresca.rs", "src/solve/march.rs::advance", "src/solve/energy.rs::has_made_more_than"], plot=plot,
        tables=[("Steps done, steps cut, iterations, and the energy that joints made over the energy supplied",
                 ["case", "steps done", "cut", "iterations a step", "made by joints"], table)],
        notes="With no damping of any kind and a step of 0.1 ms joints chatter from step to step, and Newmark's average acceleration, uncut, makes "
              "energy: half the peak energy and more over 0.1 s. From 1 % of the energy supplied on, steps are cut where that happens, which is "
              "slow for joints of 1 mm; a run that makes more than 2 % would end with exit code 3. HHT with alpha = -0.1, `mass` = \"redistributed\" or damping end the "
              "chatter itself: section 8 of the theory compares them.",
    )
