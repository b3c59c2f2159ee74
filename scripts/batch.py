#!/usr/bin/env python3
"""What make cannot do in a batch: read the list of variants, and merge their results into one table.

    scripts/batch.py rules geo/batch.txt > output/batch.mk      what each variant is made from, for scripts/batch.mk
    scripts/batch.py table geo/batch.txt output/batch.csv       a row a variant, whatever became of it

A variant is called like the mesh that coralpipe makes of it: `twin_pipes crown=3.5` is twin_pipes_crown3.5.
"""

import csv
import io
import json
import pathlib
import sys

DONE = '"status": "done"'


class BadLine(Exception):
    """A line of the list that says nothing; the others count."""


def number(text, line):
    try:
        return float(text)
    except ValueError:
        raise BadLine(f"{line}: {text!r} is no number; write NAME=NUMBER, as in spacing=1.8") from None


def written(value):
    """A number as coralpipe writes it: the shortest digits that give it back, no exponent, no trailing zero."""
    digits = f"{value:.20f}" if "e" in repr(value) else repr(value)
    return digits.rstrip("0").rstrip(".")


class Variant:
    """One line of the list."""

    def __init__(self, text, line):
        self.case, *pairs = text.split()
        if "=" in self.case:
            raise BadLine(f"{line}: begin with the case, as in twin_pipes {text}")
        for pair in pairs:
            if "=" not in pair:
                raise BadLine(f"{line}: {pair!r} is no value; write NAME=NUMBER, as in spacing=1.8")
        split = (pair.split("=", 1) for pair in pairs)
        self.values = {name: number(value, line) for name, value in sorted(split)}
        self.name = self.case + "".join(f"_{n}{written(v)}" for n, v in self.values.items())
        self.case_file = pathlib.Path("geo", f"{self.case}.json")
        if not self.case_file.exists():
            there = ", ".join(sorted(p.stem for p in pathlib.Path("geo").glob("*.json")))
            raise BadLine(f"{line}: there is no case {self.case_file}; there are: {there}")
        self.script = self.case_file.parent / self.script_name(line)
        if not self.script.exists():
            raise BadLine(f"{line}: there is no script {self.script}, which {self.case_file} names")

    def script_name(self, line):
        """What the case calls its .geo."""
        try:
            return json.loads(self.case_file.read_text())["geometry"]["script"]
        except (ValueError, KeyError, TypeError):
            raise BadLine(
                f'{line}: {self.case_file} needs its "geometry": {{ "script": "NAME.geo" }} for a batch'
            ) from None


def read(list_file):
    """The variants, each once, in the order of the list; and a sentence for each line that is none."""
    lines = enumerate(pathlib.Path(list_file).read_text().splitlines(), 1)
    texts = ((number, line.split("#")[0].strip()) for number, line in lines)
    variants, bad = {}, []
    for number, text in texts:
        try:
            if text:
                variant = Variant(text, f"{list_file}, line {number}")
                variants[variant.name] = variant
        except BadLine as sentence:
            bad.append(str(sentence))
    if not variants:
        sentences = bad or [f"{list_file} lists no variant; write lines such as: twin_pipes crown=3.5 spacing=1.8"]
        sys.exit("\n".join(sentences))
    return list(variants.values()), bad


def rules(variants):
    text = "variants := " + " ".join(v.name for v in variants) + "\n"
    for v in variants:
        mesh, summary = f"meshes/{v.name}.msh", f"output/batch/{v.name}/summary.json"
        geo = " ".join(f"--geo {name}={written(value)}" for name, value in v.values.items())
        text += f"{mesh} {summary}: geo := {geo}\n"
        text += f"{mesh} {summary}: case := {v.case_file}\n"
        text += f"{mesh}: {v.script} {v.case_file}\n{summary}: {v.case_file}\n"
    return text


def last_words(folder):
    """The last line of the variant's log."""
    log = folder / "batch.log"
    lines = log.read_text().splitlines() if log.exists() else []
    return lines[-1].removeprefix("coralpipe: ") if lines else "not made yet"


def is_done(folder):
    """Whether the result is there, and is not what an earlier geometry gave before this one failed to mesh."""
    summary, log = folder / "summary.json", folder / "batch.log"
    if not summary.exists() or DONE not in summary.read_text():
        return False
    failed_since = log.exists() and log.stat().st_mtime > summary.stat().st_mtime
    return not failed_since or last_words(folder).startswith("results in")


def row(variant):
    """{column: value}; without a result only what was asked for, and why."""
    folder = pathlib.Path("output", "batch", variant.name)
    asked = {"variant": variant.name, "status": "done", "case": variant.case, **variant.values}
    if not is_done(folder):
        return {**asked, "status": last_words(folder)}
    summary = json.loads((folder / "summary.json").read_text())
    contact = summary["contact"]
    frequencies = dict(zip(("f1", "f2"), summary["frequencies_hz"]))
    peaks = {f"{probe}.{c}": of[c]["value"] for probe, of in summary["peaks"].items() for c in of}
    return {**asked, **frequencies, "max_open": contact["max_open"], "max_slip": contact["max_slip"], **peaks}


def table(variants):
    rows = [row(v) for v in variants]
    columns = list(dict.fromkeys(column for r in rows for column in r))
    text = io.StringIO()
    writer = csv.DictWriter(text, columns, lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue(), [r for r in rows if r["status"] != "done"]


def main():
    if len(sys.argv) == 3 and sys.argv[1] == "rules":
        print(rules(read(sys.argv[2])[0]), end="")
    elif len(sys.argv) == 4 and sys.argv[1] == "table":
        variants, bad = read(sys.argv[2])
        text, missing = table(variants)
        pathlib.Path(sys.argv[3]).parent.mkdir(exist_ok=True)
        pathlib.Path(sys.argv[3]).write_text(text)
        for r in missing:
            print(f"{r['variant']}: {r['status']}", file=sys.stderr)
        print(f"{len(variants) - len(missing)} of {len(variants)} variants are in {sys.argv[3]}.")
        if bad:
            sys.exit("\n".join(bad))
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main()
