#!/usr/bin/env python3
"""Runs random small cases and the same problems written in another way, and compares: the answers must be the same.

    scripts/random_twins.py 1000 2026 [--binary target/release/coralpipe] [--jobs 2] [--keep DIR] [--first 0]

Twins of a case: nodes, elements and groups renumbered and renamed; the mirror image; the mesh in mm and in km; every load in
two or three parts. Histories of all probes, gap, slip, energies and frequencies must agree within 1e-6 of the peak of their
kind, and exit codes must be the same, or a warning must say why not. Where they do not agree, the case is run again with
load and places changed by 1e-14: if that changes the answer as much, the case is sensitive to round-off. A line names each
pair that differs, tables count all. Case NUMBER of a seed alone, with its files:

    scripts/random_twins.py 1 SEED --first NUMBER --keep DIR

In every tenth case a twin with 1 % more load must be found to differ, or the comparison itself is wrong. Exit 1 if a twin
differs and neither a warning nor growing round-off says why.
"""

import argparse
import collections
import concurrent.futures
import pathlib
import random
import re
import shutil
import sys
import tempfile

from twins import case as cases
from twins import twin
from twins.trial import FAILURES, OUTCOMES, Trial

ROOT = pathlib.Path(__file__).resolve().parent.parent
TWINS = {
    "renumbered": twin.renumbered,
    "mirrored": lambda case, rng: twin.mirrored(case),
    "mm": lambda case, rng: twin.in_unit(case, "mm"),
    "km": lambda case, rng: twin.in_unit(case, "km"),
    "split": twin.in_parts,
}
TELLING = FAILURES + ["warned", "chaos", "chaos, warned"]


class Row:
    """What one case came to."""

    def __init__(self, args, number):
        self.number = number
        rng = random.Random(f"{args.seed} {number}")
        self.case = cases.draw(rng)
        with tempfile.TemporaryDirectory() as folder:
            trial = Trial(args.binary.resolve(), pathlib.Path(folder), self.case)
            self.code, self.said = trial.as_drawn.code, trial.as_drawn.said
            self.twins = {name: trial.of(name, write(self.case, rng)) for name, write in TWINS.items()}
            self.wrong_found = trial.finds_one_per_cent() if number % 10 == 0 and self.code == 0 else None
            if args.keep and (args.count == 1 or any(outcome in TELLING for outcome, _ in self.twins.values())):
                shutil.copytree(folder, args.keep / f"{args.seed}-{number}", dirs_exist_ok=True)

    def kind(self):
        return f"{self.case.json['analysis']} {self.case.kind}"

    def report(self, seed):
        for name, (outcome, text) in self.twins.items():
            if outcome in TELLING:
                features = ", ".join(self.case.features)
                print(f"case {self.number} of seed {seed}, {self.kind()}, {name}: {outcome}: {text} [{features}]", flush=True)

    def sentence(self):
        """The reason of an exit code other than 0, without its numbers."""
        lines = self.said.strip().splitlines()
        return re.sub(r"[-+]?\d[\d.]*(e[-+]?\d+)?", "#", lines[-1])[:150] if self.code and lines else None


def table(title, rows, keys_of):
    """Outcomes of all twins, a line for each key of their row."""
    counts = collections.defaultdict(collections.Counter)
    for row in rows:
        for name, (outcome, _) in row.twins.items():
            for key in keys_of(row, name):
                counts[key][outcome] += 1
    shown = [outcome for outcome in OUTCOMES if any(count[outcome] for count in counts.values())]
    print(f"\n| {title} | " + " | ".join(shown) + " |\n|" + "---|" * (len(shown) + 1))
    for key in sorted(counts):
        print(f"| {key} | " + " | ".join(str(counts[key][outcome] or "") for outcome in shown) + " |")


def tables(rows):
    table("twin", rows, lambda row, name: [name, "all"])
    table("kind", rows, lambda row, name: [row.kind()])
    table("feature", rows, lambda row, name: row.case.features)
    table("as drawn", rows, lambda row, name: [f"exit code {row.code}"])
    sentences = collections.Counter(row.sentence() for row in rows if row.sentence())
    if sentences:
        print("\nwhy cases did not run to their end:")
    for sentence, count in sentences.most_common(20):
        print(f"{count:5}  {sentence}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("count", type=int)
    parser.add_argument("seed", type=int)
    parser.add_argument("--binary", type=pathlib.Path, default=ROOT / "target/release/coralpipe")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--keep", type=pathlib.Path, help="folder for the files of the cases whose twins differ")
    parser.add_argument("--first", type=int, default=0, help="number of the first case")
    args = parser.parse_args()
    rows = []
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        waiting = [pool.submit(Row, args, number) for number in range(args.first, args.first + args.count)]
        for done in concurrent.futures.as_completed(waiting):
            rows.append(done.result())
            rows[-1].report(args.seed)
    tables(rows)
    checked = [row for row in rows if row.wrong_found is not None]
    missed = [row.number for row in checked if not row.wrong_found]
    print(f"\n{len(checked) - len(missed)} of {len(checked)} twins with 1 % more load were found to differ")
    failures = sum(outcome in FAILURES for row in rows for outcome, _ in row.twins.values())
    if missed:
        sys.exit(f"Cases {missed} of seed {args.seed} do not notice 1 % more load: the comparison sees too little.")
    if failures:
        sys.exit(f"{failures} of {len(rows) * len(TWINS)} twins differ without a word.")
    if sum(row.code == 0 for row in rows) < args.count / 2:
        sys.exit("Fewer than half of the cases run to their end: the draw tests too little.")


if __name__ == "__main__":
    main()
