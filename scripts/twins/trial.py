"""A case beside one of its twins: are the answers the same, and if not, of what kind is the difference?"""

import dataclasses
import functools
import json
import pathlib
import random
import re
import subprocess

from twins import compare, twin
from twins.case import Case

# warnings that say why two ways of writing the same problem may differ
WHY = re.compile(r"nothing says where it is|depends on the size of the load step")
# the warning of joints that chatter, whose motion is no converged one
CHATTER = re.compile(r"within steps have made|vibrates on its joints|time steps were cut into")
PERTURBATIONS = [1 + 1e-14, 1 - 1e-14, 1 + 3e-14]
# steps that a difference takes from 1e-9 to 1e-6 of the peak at least where it grows and does not jump
GRADUAL = 4

OUTCOMES = {
    "agree": "within 1e-6 of the peak",
    "refused": "both end with exit code 1",
    "stop alike": "both end with exit code 3 at the same step, and agree up to it",
    "warned": "differ, and a warning says why",
    "chaos, warned": "as chaos, and a warning says that joints chatter",
    "chaos": "differ; a difference of 1e-14 in the load grows from step to step to as much: impacts amplify round-off",
    "newton": "differ, and agree once newton.tolerance is 1e-11",
    "round-off": "differ, and so does the case itself with 1e-14 more load, at once: round-off decides",
    "differ": "differ, although 1e-14 of the load changes little",
    "exit code": "exit codes, or the steps at which they stop, differ",
    "crash": "a signal, another exit code than 0, 1 and 3, or more than 60 s",
}
FAILURES = ["newton", "round-off", "differ", "exit code", "crash"]


def run(binary, folder, written, seconds=60):
    """The result of one twin, whose files are left in `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "mesh.msh").write_text(written.mesh)
    (folder / "case.json").write_text(json.dumps({"geometry": {"mesh": "mesh.msh"}} | written.json, indent=1))
    words = [str(binary), "run", "case.json", "--out", "out", "--quiet"]
    try:
        done = subprocess.run(words, cwd=folder, capture_output=True, text=True, timeout=seconds)
    except subprocess.TimeoutExpired:
        return compare.Result(-1, f"took more than {seconds} s")
    return compare.read(folder / "out", done.returncode, done.stderr, written.mirrored)


def judge(one, other, scale):
    """(outcome, largest difference over its peak, where) of two results."""
    if not {one.code, other.code} <= {0, 1, 3}:
        return "crash", 1.0, f"exit codes {one.code} and {other.code}"
    if one.code != other.code:
        return "exit code", 1.0, f"exit codes {one.code} and {other.code}"
    if one.code == 1:
        return "refused", 0.0, ""
    if len(one.times) != len(other.times):
        return "exit code", 1.0, f"one stops after {len(one.times)} steps, the other after {len(other.times)}"
    found = compare.differences(one, other, scale)
    largest = max(found.values(), default=0.0)
    if largest <= compare.TOLERANCE:
        return ("agree" if one.code == 0 else "stop alike"), largest, ""
    return "differ", largest, ", ".join(f"{name} {value:.1e}" for name, value in found.items() if value > compare.TOLERANCE)


@dataclasses.dataclass(frozen=True, eq=False)
class Trial:
    binary: pathlib.Path
    folder: pathlib.Path
    case: Case

    @functools.cached_property
    def as_drawn(self):
        return run(self.binary, self.folder / "as_drawn", twin.as_drawn(self.case))

    @functools.lru_cache
    def perturbed(self, number):
        written = twin.perturbed(self.case, PERTURBATIONS[number], random.Random(number))
        return run(self.binary, self.folder / f"perturbed_{number}", written)

    def of(self, name, written):
        """(outcome, text) of the twin `name`."""
        other = run(self.binary, self.folder / name, written)
        judged = judge(self.as_drawn, other, self.case.scale)
        if judged[0] not in ("differ", "exit code"):
            return judged[0], judged[2]
        return self.classified(name, written, other, *judged)

    def classified(self, name, written, other, outcome, largest, text):
        warnings = self.as_drawn.warnings() + other.warnings()
        if outcome == "differ" and any(WHY.search(warning) for warning in warnings):
            return "warned", text
        sensitive = self.is_sensitive(largest)
        text += "; sensitive" if sensitive else "; not sensitive"
        if outcome == "exit code":
            return outcome, text
        if sensitive and self.is_gradual(other):
            return ("chaos, warned" if any(CHATTER.search(warning) for warning in warnings) else "chaos"), text
        if largest < 1e-4 and self.agrees_with_tight_newton(name, written):
            return "newton", text
        return ("round-off" if sensitive else outcome), text

    def is_sensitive(self, largest):
        """Whether 1e-14 of the load changes the answer by 1e-6, or by a tenth as much as the twin does, or the exit code."""
        for number in range(len(PERTURBATIONS)):
            outcome, change, _ = judge(self.as_drawn, self.perturbed(number), self.case.scale)
            if outcome in ("exit code", "crash") or change > min(largest / 10, compare.TOLERANCE):
                return True
        return False

    def is_gradual(self, other):
        """Whether a difference grew from step to step, as that of two motions with impacts does, and did not jump."""
        one = self.as_drawn
        if self.case.json["analysis"] == "static" or not (one.times and other.times):
            return False
        path = list(compare.growth(one, other, self.case.scale))
        noise = [t for t, value in zip(one.times, path) if value < 1e-9]
        small = [t for t, value in zip(one.times, path) if value < compare.TOLERANCE]
        begin, end = max(noise, default=0), max(small, default=0)
        return sum(begin < t <= end * (1 + 1e-9) for t in one.substeps) >= GRADUAL

    def agrees_with_tight_newton(self, name, written):
        """Whether the difference is what `newton.tolerance` leaves."""
        tight = {"newton": {"tolerance": 1e-11}}
        ways = {"as_drawn": twin.as_drawn(self.case), name: written}
        results = [run(self.binary, self.folder / f"{way}_tight", dataclasses.replace(its, json=its.json | tight), 10)
                   for way, its in ways.items()]
        return judge(*results, self.case.scale)[0] == "agree"

    def finds_one_per_cent(self):
        """Whether a twin with 1 % more load, which must differ, is found to."""
        wrong = run(self.binary, self.folder / "wrong", twin.loaded_times(self.case, 1.01))
        return judge(self.as_drawn, wrong, self.case.scale)[0] in ("differ", "exit code")
