"""`python -m bench`: coralpipe beside its peers on one mesh, one law, the same steps.

Every program runs once a round, the rounds one after the other, and the table gives medians. Agreement first: where two
programs should agree after the first round and do not, no time is printed and the exit code is 1.
"""

import argparse
import json
import sys
from statistics import median

from .contenders import CASE, MESH, OUTPUT, Failed, Setting, coralpipe, difference, peer, watch, PROGRAM
from .model import processor
from .record import record

BONDED_TOLERANCE = 1e-8
"""The same discrete equations: what differs is round-off, which the smallest pivots of three factorisations magnify."""
CONTACT_TOLERANCE = 1e-7
"""The same, with statuses that round-off may decide a step apart."""
KRATOS_STEPS = 40
PEERS = {
    (True, "SciPy"): "SciPy, one SuperLU factor",
    (False, "SciPy"): "condensed SciPy, one SuperLU factor",
    (True, "OpenSees"): "OpenSeesPy, one SuperLU factor",
    (False, "OpenSees"): "OpenSeesPy, `zeroLengthContact2D`",
    (False, "Kratos"): "Kratos, line interface with Coulomb's law",
}


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m bench", description=__doc__)
    parser.add_argument("--rounds", type=int, default=3, help="default 3")
    parser.add_argument("--without", nargs="*", default=[], choices=["opensees", "kratos"], help="leave these out")
    parser.add_argument("--record", action="store_true", help="write the section of docs/performance.md")
    arguments = parser.parse_args()
    OUTPUT.mkdir(parents=True, exist_ok=True)
    try:
        setting = rayleigh()
        rounds = [race(setting, arguments.without, 1)]
        checks = agreement(setting, rounds[0])
        print(checks.table())
        if checks.failed:
            print(f"bench: no times, since this does not agree: {'; '.join(checks.failed)}", file=sys.stderr)
            return 1
        rounds += [race(setting, arguments.without, n) for n in range(2, arguments.rounds + 1)]
    except Failed as why:
        print(f"bench: {why}", file=sys.stderr)
        return 1
    times = table(["", "program", "unknowns", "steps", "median step", "whole process", "times coralpipe's step"],
                  [row for bonded in (True, False) for row in ratios(rounds, bonded)])
    print(times)
    if arguments.record:
        record("peers", "\n".join([machine(rounds[0]), "", checks.table(), times]))
    return 0


def rayleigh() -> Setting:
    """alpha and beta of the default case with its joints, for all runs."""
    watch([PROGRAM, "run", CASE, "--mesh", MESH, "--quiet", "--out", OUTPUT / "default", "--set", "time.end=0.1 ms"])
    found = json.loads((OUTPUT / "default" / "summary.json").read_text())["rayleigh"]
    return Setting(found["alpha"], found["beta"])


class Checks:
    """Rows of the table of agreement; what misses its tolerance is in `failed`."""

    def __init__(self):
        self.rows, self.failed = [], []

    def add(self, what, a, b, tolerance=None):
        d = difference(a, b)
        self.rows.append([what, f"{d:.1e}", f"<= {tolerance:.0e}" if tolerance else "told only"])
        if tolerance and not d <= tolerance:
            self.failed.append(f"{what}: {d:.1e} > {tolerance:.0e}")

    def table(self):
        return table(["what is compared", "difference", "should be"], self.rows)


def race(setting, without, number):
    """One run of everything: {(bonded, name): Run}."""
    say(f"round {number}" + ("" if "opensees" in without else "; OpenSees' contact takes a minute or more"))
    runs = {}
    for bonded in (True, False):
        runs[bonded, "coralpipe"] = coralpipe(setting, bonded=bonded)
        runs[bonded, "SciPy"] = peer("scipy_bonded" if bonded else "scipy_condensed", setting, bonded=bonded)
        if "opensees" not in without:
            runs[bonded, "OpenSees"] = peer("opensees", setting, bonded=bonded)
        if "kratos" not in without:
            runs[bonded, "Kratos"] = peer("kratos", setting, bonded=bonded, steps=KRATOS_STEPS)
    return runs


def agreement(setting, runs) -> Checks:
    """Every peer against coralpipe on the same equations; where a peer's law is another one, the difference is told."""
    checks = Checks()
    bonded, contact = runs[True, "coralpipe"], runs[False, "coralpipe"]
    checks.add("bonded: SciPy - coralpipe", runs[True, "SciPy"], bonded, BONDED_TOLERANCE)
    checks.add("contact: SciPy - coralpipe", runs[False, "SciPy"], contact, CONTACT_TOLERANCE)
    if (True, "OpenSees") in runs:
        lumped = {b: coralpipe(setting, bonded=b, lumped=True) for b in (True, False)}
        their_law = peer("scipy_condensed", setting, lumped=True, law="opensees")
        theirs = runs[False, "OpenSees"]
        rigid = runs[True, "OpenSees"]
        checks.add("bonded, diagonal mass: OpenSees - coralpipe", rigid, lumped[True], BONDED_TOLERANCE)
        checks.add("contact, diagonal mass: OpenSees - SciPy with OpenSees' law", theirs, their_law, CONTACT_TOLERANCE)
        checks.add("contact, diagonal mass: OpenSees - coralpipe, each with its law", theirs, lumped[False])
        checks.add("contact: coralpipe with diagonal mass - with consistent mass", lumped[False], contact)
    if (True, "Kratos") in runs:
        checks.add("bonded: Kratos - coralpipe", runs[True, "Kratos"], bonded, BONDED_TOLERANCE)
        checks.add("contact: Kratos - coralpipe, each with its law", runs[False, "Kratos"], contact)
    checks.add("coralpipe: contact - bonded", contact, bonded)
    return checks


def ratios(rounds, bonded):
    """Rows of one case; the ratio is the median of the rounds' ratios of time a step."""
    for kind, name in rounds[0]:
        if kind != bonded:
            continue
        runs = [round_[bonded, name] for round_ in rounds]
        step = median(run.step_s for run in runs)
        ratio = median(run.step_s / round_[bonded, "coralpipe"].step_s for run, round_ in zip(runs, rounds))
        wall = median(run.wall_s for run in runs)
        how = PEERS.get((bonded, name), name)
        yield ["bonded" if bonded else "contact", how, str(runs[0].unknowns), str(runs[0].steps),
               seconds(step), seconds(wall), f"{ratio:.3g}"]


def machine(runs):
    versions = sorted({run.version for run in runs.values()})
    return f"{processor()}; {'; '.join(versions)}; Python {sys.version.split()[0]}"


def seconds(s):
    return f"{1e3 * s:.3g} ms" if s < 1 else f"{s:.4g} s"


def table(head, rows):
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"


def say(what):
    print(f"bench: {what}", file=sys.stderr)


if __name__ == "__main__":
    sys.exit(main())
