#!/usr/bin/env python3
"""What make cannot do in a batch: read the list of variants, run one of them, and merge all results into one table.

    scripts/batch.py lines geo/batch.txt                        numbers of the lines that name a variant, for scripts/batch.mk
    scripts/batch.py run   geo/batch.txt 4                      the variant of line 4, unless its result is there
    scripts/batch.py table geo/batch.txt output/batch.csv       a row a variant, whatever became of it

A variant is called like the mesh that coralpipe makes of it: `twin_pipes crown=3.5` is twin_pipes_crown3.5.
"""

import csv
import decimal
import io
import json
import math
import os
import pathlib
import re
import subprocess
import sys

LONGEST_NAME = 230  # bytes; a file system takes 255 with the program's own endings
PROGRAM = pathlib.Path("target", "release", "coralpipe")
NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
NUMBER = re.compile(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?")


class BadLine(Exception):
    """A line of the list that names no variant; the other lines count."""


def number(text):
    value = float(text) if NUMBER.fullmatch(text) else math.nan
    if not math.isfinite(value):
        raise BadLine(f"{text!r} is no number; write NAME=NUMBER, as in spacing=1.8")
    return value


def written(value):
    """A number as coralpipe writes it: the shortest digits that give it back, no exponent, no trailing zero."""
    digits = format(decimal.Decimal(repr(value)), "f")
    return digits.rstrip("0").rstrip(".") if "." in digits else digits


class Variant:
    """One line of the list."""

    def __init__(self, text):
        self.case, *pairs = text.split()
        if "=" in self.case:
            raise BadLine(f"begin with the case, as in {'twin_pipes ' + text!r}")
        self.values = {}
        for pair in pairs:
            name, equals, value = pair.partition("=")
            if not equals:
                raise BadLine(f"{pair!r} is no value; write NAME=NUMBER, as in spacing=1.8")
            if not NAME.fullmatch(name):
                raise BadLine(f"{name!r} is no name of a constant; write NAME=NUMBER, as in spacing=1.8")
            if name in self.values:
                raise BadLine(f"{name} is given twice; one of the two would be lost: leave it out")
            self.values[name] = number(value)
        self.values = dict(sorted(self.values.items()))
        self.name = self.case + "".join(f"_{n}{written(v)}" for n, v in self.values.items())
        if len(os.fsencode(self.name)) > LONGEST_NAME:
            raise BadLine("too many values: no file can have so long a name")
        self.case_file = pathlib.Path("geo", f"{self.case}.json")
        self.folder = pathlib.Path("output", "batch", self.name)
        self.mesh_record = pathlib.Path("meshes", f"{self.name}.json")
        if not is_case_name(self.case) or not is_file(self.case_file):
            there = ", ".join(sorted(p.stem for p in pathlib.Path("geo").glob("*.json")))
            raise BadLine(f"there is no case {str(self.case_file)!r}; there are: {there}")

    def __eq__(self, other):
        return (self.case, self.values) == (other.case, other.values)


def is_case_name(text):
    return "/" not in text and text not in (".", "..")


def is_file(path):
    try:
        return path.is_file()
    except (OSError, ValueError):  # a name that is too long, or has a zero byte
        return False


def text_of(line):
    """The words of a line of bytes: without its comment, which may be in any encoding."""
    words = line.partition(b"#")[0].strip()
    try:
        return words.decode("utf-8")
    except UnicodeDecodeError as error:
        raise BadLine(f"byte {words[error.start]:#04x} is not UTF-8: save the list as UTF-8") from None


class List:
    """{number: variant} of the lines that name one, each variant once; and a sentence for each line that does not."""

    def __init__(self, path):
        try:
            lines = pathlib.Path(path).read_bytes().removeprefix(b"\xef\xbb\xbf").split(b"\n")
        except OSError as error:
            sys.exit(f"{path} cannot be read: {error.strerror}")
        self.variants, self.bad, self.repeated = {}, [], []
        names = {}
        for number, line in enumerate(lines, 1):
            try:
                text = text_of(line)
                if not text:
                    continue
                variant = Variant(text)
                first = names.setdefault(variant.name, number)
                if first == number:
                    self.variants[number] = variant
                elif self.variants[first] == variant:
                    self.repeated.append(f"{path}, line {number}: the same as line {first}, so it is not run again")
                else:
                    raise BadLine(f"its results would be called {variant.name!r}, as those of line {first}; rename the case")
            except BadLine as sentence:
                self.bad.append(f"{path}, line {number}: {sentence}")
        if not self.variants and not self.bad:
            self.bad = [f"{path} lists no variant; write lines such as: twin_pipes crown=3.5 spacing=1.8"]


def run(variant):
    """Lets coralpipe mesh and solve where needed; what it says is in the folder's batch.log. Returns its exit code."""
    print(f"run  {variant.name}", flush=True)
    variant.folder.mkdir(parents=True, exist_ok=True)
    geo = [word for name, value in variant.values.items() for word in ("--geo", f"{name}={written(value)}")]
    words = [PROGRAM, "run", variant.case_file, *geo, "--out", variant.folder, "--unless-done"]
    with open(variant.folder / "batch.log", "wb") as log:
        return subprocess.run(words, stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT).returncode


def json_of(path):
    """What a JSON file holds; {} if it is missing or cut off."""
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}


def last_words(folder):
    """The last line of the variant's log."""
    try:
        lines = (folder / "batch.log").read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        lines = []
    return lines[-1].removeprefix("coralpipe: ") if lines else "not run yet"


def outcome(variant):
    """Status, summary if it is done, and why it is not done."""
    summary, words = json_of(variant.folder / "summary.json"), last_words(variant.folder)
    status = summary.get("status", "not run")
    if status == "done" and words.startswith("results in "):
        return status, summary, ""
    # the results are of an earlier geometry or case, whatever their status: this one could not start
    return (status if status != "done" else "refused"), {}, words


def results(summary):
    """Frequencies, contact and the extremes of all histories, {column: value} in SI."""
    if not summary:
        return {}
    frequencies = dict(zip(("f1", "f2"), summary["frequencies_hz"]))
    contact = {key: summary["contact"][key] for key in ("max_open", "max_slip")}
    extremes = {
        f"{probe}.{component}.{extreme}": history[extreme]["value"]
        for probe, histories in summary["peaks"].items()
        for component, history in histories.items()
        for extreme in ("max", "min")
    }
    return {**frequencies, **contact, **extremes}


def table(variants):
    """The table's text: what went in, what came out, how it ended; and the rows that are not done."""
    constants = list(dict.fromkeys(name for variant in variants for name in variant.values))
    rows, missing = [], []
    for variant in variants:
        status, summary, reason = outcome(variant)
        in_force = json_of(variant.mesh_record).get("parameters", {})
        values = {name: variant.values.get(name, in_force.get(name)) for name in constants}
        ending = {"status": status, "warnings": len(summary["warnings"]) if summary else None, "reason": reason}
        rows.append(({"variant": variant.name, "case": variant.case, **values}, results(summary), ending))
        if status != "done":
            missing.append(f"{variant.name}: {reason}")
    columns = list(dict.fromkeys(column for part in range(3) for row in rows for column in row[part]))
    text = io.StringIO()
    writer = csv.DictWriter(text, columns, lineterminator="\n")
    writer.writeheader()
    writer.writerows({**inputs, **found, **ending} for inputs, found, ending in rows)
    return text.getvalue(), missing


def replace(path, text):
    """The old table or the new one is there at any moment."""
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(f".{path.name}.part")
    part.write_text(text, encoding="utf-8")
    os.replace(part, path)


def report(batch, missing, csv_file):
    """What did not become a row of results, and how many did; the exit code."""
    for sentence in [*batch.repeated, *missing, *batch.bad]:
        print(sentence, file=sys.stderr)
    print(f"{len(batch.variants) - len(missing)} of {len(batch.variants)} variants are in {csv_file}.")
    return 1 if missing or batch.bad else 0


def main():
    sys.stdout.reconfigure(errors="backslashreplace")
    command = sys.argv[1:]
    if len(command) == 2 and command[0] == "lines":
        print(*List(command[1]).variants)
    elif len(command) == 3 and command[0] == "run":
        sys.exit(run(List(command[1]).variants[int(command[2])]))
    elif len(command) == 3 and command[0] == "table":
        batch = List(command[1])
        text, missing = table(list(batch.variants.values()))
        replace(pathlib.Path(command[2]), text)
        sys.exit(report(batch, missing, command[2]))
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main()
