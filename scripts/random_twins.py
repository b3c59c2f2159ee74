#!/usr/bin/env python3
"""Runs random small cases and the same problems written in another way, and compares: the answers must be the same.

    scripts/random_twins.py 1000 2026 [--binary target/release/coralpipe] [--jobs 2] [--keep DIR] [--first 0]

Twins of a case: nodes, elements and groups renumbered and renamed; the mirror image; the mesh in mm and in km; every load in
two or three parts. Histories of all probes, gap, slip, energies and frequencies must agree within 1e-6 of the peak of their
kind, and exit codes must be the same, or a warning must say why not. Where they do not agree, the case is run again with
its load changed by 1e-14: if that changes the answer as much, the case is sensitive to round-off. A line names each
pair that differs, a table counts all. Case NUMBER of a seed alone: `random_twins.py 1 SEED --first NUMBER --keep DIR`.
In every tenth case a twin with 1 % more load must be found to differ, or the comparison itself is wrong.
"""

import argparse
import collections
import concurrent.futures
import json
import pathlib
import random
import re
import subprocess
import sys
import tempfile

from twins import case as cases
from twins import compare, twin

ROOT = pathlib.Path(__file__).resolve().parent.parent
TWINS = ["renumbered", "mirrored", "mm", "km", "split"]
# warnings that say why two ways of writing the same problem may differ
WHY = re.compile(r"depends on (the )?(path|round-off|order)|not unique|round-off|sensitive")
OUTCOMES = ["agree", "refused", "stop alike", "sensitive", "warned", "differ", "exit code", "crash"]
FAILURES = ["differ", "exit code", "crash"]
PERTURBATIONS = [1 + 1e-14, 1 - 1e-14, 1 + 3e-14]


def run(binary, folder, written):
    """The result of one twin, whose files are left in `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "mesh.msh").write_text(written.mesh)
    (folder / "case.json").write_text(json.dumps({"geometry": {"mesh": "mesh.msh"}} | written.json, indent=1))
    words = [str(binary), "run", "case.json", "--out", "out", "--quiet"]
    try:
        done = subprocess.run(words, cwd=folder, capture_output=True, text=True, timeout=60)
    except subprocess.TimeoutExpired:
        return compare.Result(-1, "took more than 60 s")
    return compare.read(folder / "out", done.returncode, done.stderr, written.mirrored)


def write(case, name, rng):
    ways = {
        "renumbered": lambda: twin.renumbered(case, rng),
        "mirrored": lambda: twin.mirrored(case),
        "mm": lambda: twin.in_unit(case, "mm"),
        "km": lambda: twin.in_unit(case, "km"),
        "split": lambda: twin.in_parts(case, rng),
    }
    return ways[name]()


def judge(one, other, scale):
    """(outcome, largest difference, where) of a twin beside the case as drawn."""
    if not {one.code, other.code} <= {0, 1, 3}:
        return "crash", 1.0, f"exit codes {one.code} and {other.code}"
    if one.code != other.code:
        return "exit code", 1.0, f"exit codes {one.code} and {other.code}"
    if one.code == 1:
        return "refused", 0.0, ""
    if len(one.times) != len(other.times):
        return "exit code", 1.0, f"one stops after {len(one.times)} steps, the other after {len(other.times)}"
    found = compare.differences(one, other, scale)
    quantity = max(found, key=found.get, default="u")
    largest = found.get(quantity, 0.0)
    if largest <= compare.TOLERANCE:
        return ("agree" if one.code == 0 else "stop alike"), largest, quantity
    return "differ", largest, ", ".join(f"{name} {value:.1e}" for name, value in found.items() if value > compare.TOLERANCE)


def explained(one, other):
    return any(WHY.search(warning) for warning in one.warnings() + other.warnings())


def is_sensitive(binary, folder, case, one, largest):
    """Whether 1e-14 more or less load changes the answer by a tenth as much as the twin does, or the exit code."""
    said = []
    for number, factor in enumerate(PERTURBATIONS):
        other = run(binary, folder / f"perturbed_{number}", twin.loaded_times(case, factor))
        outcome, change, _ = judge(one, other, case.scale)
        if outcome in ("exit code", "crash") or change > max(largest / 10, compare.TOLERANCE):
            return True, onset(one, other, case)
        said.append(change)
    return False, f"1e-14 of the load changes {max(said):.0e}"


def onset(one, other, case):
    """How a difference came about: within a step or by growth over many."""
    if one.histories is None or other.histories is None:
        return "at once"
    path = compare.growth(one, other, case.scale)
    above = [k for k, value in enumerate(path) if value > compare.TOLERANCE]
    if not above:
        return "after what is common"
    before = [k for k, value in enumerate(path) if value > 1e-11]
    return f"from 1e-11 to 1e-6 in {above[0] - before[0]} of {len(path)} steps"


def try_case(binary, seed, number, folder):
    """[(twin, outcome, text)] of a case, the case itself, and the exit code as drawn."""
    rng = random.Random(f"{seed} {number}")
    case = cases.draw(rng)
    one = run(binary, folder / "as_drawn", twin.as_drawn(case))
    rows, sensitive = [], None
    for name in TWINS:
        other = run(binary, folder / name, write(case, name, rng))
        outcome, largest, text = judge(one, other, case.scale)
        if outcome in ("differ", "exit code"):
            if outcome == "differ" and explained(one, other):
                outcome = "warned"
            else:
                is_so, how = is_sensitive(binary, folder, case, one, largest)
                outcome, text = ("sensitive" if is_so and outcome == "differ" else outcome), f"{text}; {how}{', sensitive' if is_so else ''}"
        rows.append((name, outcome, text))
    if number % 10 == 0 and one.code == 0:
        wrong = run(binary, folder / "wrong", twin.loaded_times(case, 1.01))
        rows.append(("wrong", judge(one, wrong, case.scale)[0], ""))
    return case, one, rows


def report(seed, number, case, one, rows):
    for name, outcome, text in rows:
        if outcome in FAILURES + ["sensitive", "warned"] and name != "wrong":
            kind = f"{case.json['analysis']} {case.kind}"
            print(f"case {number} of seed {seed}, {kind}, {name}: {outcome}: {text} [{', '.join(case.features)}]", flush=True)


def table(title, counts):
    """Counts of outcomes by row."""
    print(f"\n| {title} | " + " | ".join(OUTCOMES) + " |\n|" + "---|" * (len(OUTCOMES) + 1))
    for key in sorted(counts):
        print(f"| {key} | " + " | ".join(str(counts[key][outcome] or "") for outcome in OUTCOMES) + " |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("count", type=int)
    parser.add_argument("seed", type=int)
    parser.add_argument("--binary", type=pathlib.Path, default=ROOT / "target/release/coralpipe")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--keep", type=pathlib.Path, help="folder for the files of the cases whose twins differ")
    parser.add_argument("--first", type=int, default=0, help="number of the first case")
    args = parser.parse_args()
    by_twin, by_kind, by_feature, by_code = (collections.defaultdict(collections.Counter) for _ in range(4))
    refusals, wrong = collections.Counter(), collections.Counter()

    def one_case(number):
        with tempfile.TemporaryDirectory() as temporary:
            folder = pathlib.Path(temporary)
            outcome = try_case(args.binary.resolve(), args.seed, number, folder)
            bad = [o for _, o, _ in outcome[2] if o in FAILURES + ["sensitive", "warned"]]
            if args.keep and (bad or args.count == 1):
                kept = args.keep / f"{args.seed}-{number}"
                subprocess.run(["rm", "-rf", str(kept)], check=True)
                kept.parent.mkdir(parents=True, exist_ok=True)
                subprocess.run(["cp", "-r", str(folder), str(kept)], check=True)
            return number, *outcome

    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        for number, case, one, rows in pool.map(one_case, range(args.first, args.first + args.count)):
            report(args.seed, number, case, one, rows)
            if one.code:
                refusals[re.sub(r"[-\d.e]+", "#", one.said.strip().splitlines()[-1])[:150] if one.said.strip() else "?"] += 1
            for name, outcome, _ in rows:
                if name == "wrong":
                    wrong[outcome] += 1
                    continue
                by_twin[name][outcome] += 1
                by_kind[f"{case.json['analysis']} {case.kind}"][outcome] += 1
                by_code[f"exit {one.code}"][outcome] += 1
                for feature in case.features:
                    by_feature[feature][outcome] += 1
    for title, counts in (("twin", by_twin), ("kind", by_kind), ("feature", by_feature), ("as drawn", by_code)):
        table(title, counts)
    print("\nsentences of cases that did not run to their end:")
    for sentence, count in refusals.most_common(25):
        print(f"{count:5}  {sentence}")
    found = sum(wrong[outcome] for outcome in ("differ", "exit code"))
    print(f"\n{found} of {sum(wrong.values())} twins with 1 % more load were found to differ")
    failures = sum(counts[outcome] for counts in by_twin.values() for outcome in FAILURES)
    if failures:
        sys.exit(f"{failures} twins differ without a word.")


if __name__ == "__main__":
    main()
