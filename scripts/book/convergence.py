"""Hard cases for the contact iteration: no step is lost, or the run ends with exit code 3 and says where."""

from book.energy import MESH, TWIN
from book.lib import Failed, Page, Row

SIDES = ("interface_left", "interface_right")
SUSPICIOUS = 0.02  # share of contact's energy from which the program warns


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
        cases = {name: cases[name] for name in ["joints of 1 mm, damped", "joints of 1 mm, undamped", "joints of 1 cm, undamped, HHT alpha = -0.1"]}
    rows, table, shares = [], [], {}
    for i, (name, sets) in enumerate(cases.items()):
        try:
            run = book.run(TWIN, mesh=MESH, sets={**sets, "time.end": end, "output.every": end}, tag=f"convergence_{i}")
        except Failed as why:
            named = "exit code 3" in str(why) and "interface_" in str(why)
            rows.append(Row(f"{name}: ends with exit code 3 and names joints", 1, float(named), 0, relative=False, why="a refusal"))
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
        share = energy["last"]["contact"] / energy["peak"]
        warned = float(any("within steps have" in warning for warning in run.summary["warnings"]))
        if "undamped" not in name or "HHT" in name:
            rows.append(Row(f"{name}: energy that contact makes or takes, over the peak", 0, share,
                            0.01, relative=False, why="1 %: statuses change inside steps"))
        rows.append(Row(f"{name}: the run warns of its energy ({100 * share:.2g} %: it {'must' if abs(share) > SUSPICIOUS else 'must not'})",
                        float(abs(share) > SUSPICIOUS), warned, 0, relative=False,
                        why="a run whose joints make or lose more than 2 % of the largest energy is no result, and must say so"))
        shares[name] = share
        table.append([name, f"{done} of {steps}", str(contact["cut_steps"]), f"{run.summary['iterations'] / all_steps:.2f}",
                      f"{100 * run.summary['energy']['last']['contact'] / run.summary['energy']['peak']:.2g} %"])
    try:
        book.run("pulled_block", sets={"analysis": "static", "loads.block.body_force.values": [0, 505.0]}, tag="static_pulled")
        refused = 0
    except Failed as why:
        refused = float("exit code 3" in str(why) and "after t = 0.99 s" in str(why))
    rows.append(Row("static, block pulled beyond mu N, which has no equilibrium from t = 1 / 1.01 s on: exit code 3 at t = 0.99 s", 1, refused, 0,
                    relative=False, why="a refusal"))

    def plot(axes):
        names = list(shares)[::-1]
        axes.barh(names, [max(abs(shares[name]), 1e-7) for name in names],
                  color=["C3" if abs(shares[name]) > SUSPICIOUS else "C0" for name in names])
        axes.axvline(SUSPICIOUS, color="k", linewidth=0.8)
        axes.set(xscale="log", xlabel="|contact energy| / largest stored (red: no result)")
        axes.tick_params(axis="y", labelsize=7)

    return Page(
        "convergence", "Hard cases of contact", [],
        problem="The default twin pipes with thin joints, without damping, with more friction: cases in which a plain Newton loses steps; "
                "and a block that cannot be in equilibrium.",
        reference="A step is accepted only if its residual is below `newton.tolerance` with statuses that agree; else Newton gives over to a "
                  "fixed point on Tresca's bound, then the step is cut in half up to five times, then the run ends with exit code 3.",
        rows=rows, code=["src/solve/contact.rs::newton", "src/solve/tresca.rs", "src/solve/march.rs::advance", "src/solve/energy.rs::warning"], plot=plot,
        tables=[("How the steps went; contact's energy over the peak: below zero it was made",
                 ["case", "steps done", "cut", "iterations a step", "contact's energy"], table)],
        notes="\"Holds\" on this page means that every step converged and that a run which is no result says so; it does not mean that the "
              "undamped runs are right. **What misses:** with no damping of any kind and a step of 0.1 ms every step converges, but joints chatter from step to step "
              "and make energy (`contact`, negative), over 0.1 s as much as half the peak energy or more, so these runs are no results. The "
              "average acceleration has nothing against it. HHT with alpha = -0.1 or a step of a quarter bring it below 1 %; the Rayleigh "
              "damping of the default case keeps it near 1e-5. Above 2 % the run warns, on the screen and in "
              "`warnings` of summary.json, and the rows above fail if it does not.",
    )
