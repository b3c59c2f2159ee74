"""The book as Markdown: a page with a picture a case, and the summary that heads them."""

import importlib
import io
import json
import re

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from book.lib import CASES, ROOT, Failed, Page, Row, say

DOCS = ROOT / "docs" / "verification"
MODULES = "scripts/book"
ROUND_OFF = 1e-7  # rows with such a tolerance are right to round-off, and tell only its decade
LONGEST = 300  # characters of a command that is printed whole


def link(code: str) -> str:
    """Markdown of "path" or "path::function"; `Failed` where there is no such place."""
    path, _, name = code.partition("::")
    if not (ROOT / path).is_file():
        raise Failed(f"the page links {path}, which is not there")
    if not name:
        return f"[`{path}`](../../{path})"
    lines = (ROOT / path).read_text(encoding="utf-8").splitlines()
    places = [i for i, line in enumerate(lines, 1) if re.search(rf"\b(fn|def|struct|enum|const) {re.escape(name)}\b", line)]
    if not places:
        raise Failed(f"the page links `{name}` in {path}, which has no function of this name")
    return f"[`{path}`, `{name}`](../../{path}#L{places[0]})"


def bound_text(row: Row) -> str:
    return {"": "", "least": "at least ", "most": "at most "}[row.bound]


def amount(value: float, row: Row) -> str:
    """An error or a tolerance."""
    if value == 0:
        return "0"
    if row.relative and value >= 1e-6:
        return f"{100 * value:.3g} %"
    return f"{value:.1e}" + ("" if row.relative or not row.unit else f" {row.unit}")


def rounded_up(row: Row) -> float:
    """The error; of a row that is right to round-off its decade, since the digits differ from machine to machine."""
    if row.tolerance > ROUND_OFF or not 0 < row.error < np.inf:
        return row.error
    decade = max(1e-12, float(f"1e{np.ceil(np.log10(row.error)):.0f}"))
    return decade if decade <= row.tolerance else row.error


def error_text(row: Row) -> str:
    unit = "" if row.relative or not row.unit else f" {row.unit}"
    is_told_by_decade = 0 < row.tolerance <= ROUND_OFF and rounded_up(row) != row.error
    return f"< {rounded_up(row):.0e}{unit}" if is_told_by_decade else amount(row.error, row)


def value_text(row: Row) -> str:
    is_round_off = row.reference == 0 and 0 < row.tolerance <= ROUND_OFF and rounded_up(row) != row.error
    return f"< {rounded_up(row):.0e}" if is_round_off else say(row.value)


def markdown_table(columns: list, rows: list) -> str:
    line = lambda cells: "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"
    return "\n".join([line(columns), "|" + "---|" * len(columns), *map(line, rows)]) + "\n"


def comparison(rows: list) -> str:
    """The table of rows, with the reasons of their tolerances numbered below it."""
    reason = lambda row: row.why + (f"; quick form {amount(row.quick[0], row)}: {row.quick[1]}" if row.quick else "")
    reasons = list(dict.fromkeys(reason(row) for row in rows if reason(row)))
    mark = lambda row: f" ({reasons.index(reason(row)) + 1})" if reason(row) else ""
    cells = [[row.quantity, bound_text(row) + say(row.reference), value_text(row), row.unit, error_text(row),
              amount(row.tolerance, row) + mark(row), "" if row.holds(False) else "**misses**"]
             for row in rows]
    text = markdown_table(["quantity", "reference", "program", "unit", "error", "tolerance (reason)", ""], cells)
    return text + "\nReasons of the tolerances; `make test` runs the quick form on coarser meshes, with the same tolerance where none stands:\n\n" \
        + "".join(f"{i}. {text}\n" for i, text in enumerate(reasons, 1))


def files_of(commands: list) -> list:
    """The case files of commands, each with its geometry script where it has one."""
    cases = dict.fromkeys(re.search(r" '?(\S+\.json)", command).group(1) for command in commands if ".json" in command)
    files = []
    for case in cases:
        path = ROOT / case
        if not path.is_file() or case.startswith("output/"):
            continue
        script = json.loads(path.read_text(encoding="utf-8")).get("geometry", {}).get("script")
        files += [case] + ([f"{case.rsplit('/', 1)[0]}/{script}"] if script else [])
    return list(dict.fromkeys(files))


def to_run(page: Page) -> str:
    """The case files, one command in full, and the others."""
    if not page.commands:
        return ""
    short = lambda text: text if len(text) <= LONGEST else text[:LONGEST] + f" ... ({len(text)} characters)"
    result, number = page.example or (None, "")
    example = result.command if result else min(page.commands, key=len)
    text = "Case files: " + (", ".join(link(path) for path in files_of(page.commands)) or "written by the page's script") + ".\n\n"
    number = number or f"The numbers are taken from its results by [`{MODULES}/{page.name}.py`](../../{MODULES}/{page.name}.py)."
    text += f"```sh\n{short(example)}\n```\n\n{number}\n"
    others = [short(command) for command in page.commands if command != example]
    if others:
        listed = "\n".join(dict.fromkeys(others))
        text += f"\n<details><summary>The other {len(others)} calls behind this page</summary>\n\n```sh\n{listed}\n```\n\n</details>\n"
    return "## To run it\n\n" + text


def write_page(page: Page) -> None:
    DOCS.mkdir(parents=True, exist_ok=True)
    picture = draw(page)
    parts = [f"# {page.title}\n", f"{page.problem.strip()}\n"]
    parts += [f"![{page.title}]({picture})\n"] if picture else []
    parts += ["## Reference\n", f"{page.reference.strip()}\n", "## Program and reference\n", comparison(page.rows)]
    for heading, columns, cells in page.tables:
        parts += [f"### {heading}\n", markdown_table(columns, cells)]
    parts += ["## Assumed, and what misses\n", f"{page.notes.strip()}\n"] if page.notes else []
    parts += [to_run(page)] if page.commands else []
    parts += ["## Code\n", code_links(page)]
    (DOCS / f"{page.name}.md").write_text("\n".join(parts), encoding="utf-8")


def code_links(page: Page) -> str:
    return ", ".join(link(place) for place in [f"{MODULES}/{page.name}.py", *page.code]) + "\n"


def mark_stale(name: str, why: str) -> None:
    """Says on a page that its case gave no result."""
    DOCS.mkdir(parents=True, exist_ok=True)
    path = DOCS / f"{name}.md"
    title, _, rest = (path.read_text(encoding="utf-8") if path.is_file() else f"# {name}\n").partition("\n")
    rest = "\n".join(line for line in rest.split("\n") if not line.startswith("> **Stale.**"))
    reason = " ".join(why.split()).replace(str(ROOT), ".")
    path.write_text(f"{title}\n\n> **Stale.** The last run of this case gave no result: {reason}\n\n{rest.lstrip()}", encoding="utf-8")


def draw(page: Page) -> str:
    """Name of the picture beside the page; none where the case draws none."""
    if page.plot is None:
        return ""
    figure, axes = plt.subplots(figsize=(6.4, 3.8), dpi=90, layout="constrained")
    page.plot(axes)
    memory = io.BytesIO()
    figure.savefig(memory, format="png", metadata={"Software": None})
    plt.close(figure)
    (DOCS / f"{page.name}.png").write_bytes(memory.getvalue())
    return f"{page.name}.png"


HEADING = ["item", "case", "numbers", "nearest to its tolerance", ""]


def summary_row(page: Page) -> list:
    used = lambda row: rounded_up(row) / row.tolerance if row.tolerance else float(row.error > 0)
    worst = max(page.rows, key=used)
    near = f"{worst.quantity}: {error_text(worst)} (tolerance {amount(worst.tolerance, worst)})"
    return [", ".join(str(i) for i in page.items), f"[{page.title}]({page.name}.md)", str(len(page.rows)), near,
            "holds" if page.holds(False) else "**misses**"]


def written_rows() -> dict:
    """The rows of the summary as it stands: name of the case -> cells."""
    path = DOCS / "README.md"
    lines = path.read_text(encoding="utf-8").splitlines() if path.is_file() else []
    rows = [[cell.strip().replace("\\|", "|") for cell in re.split(r"(?<!\\)\|", line)[1:-1]] for line in lines if line.startswith("|")]
    named = ((re.search(r"\((\w+)\.md\)", row[1]), row) for row in rows if len(row) == len(HEADING))
    return {match.group(1): row for match, row in named if match}


def write_summary(pages: list, failed: list, known: list) -> None:
    """docs/verification/README.md: the rows of these pages anew, those of the other known cases as they stand."""
    old = written_rows()
    rows = {name: row for name, row in old.items() if name in known}
    rows.update((page.name, summary_row(page)) for page in pages)
    for name in failed:
        item = re.search(r"Items? ([\d, ]+)", importlib.import_module(f"book.{name}").__doc__ or "")
        new = [item.group(1).strip() if item else "", f"[{name}]({name}.md)"]
        rows[name] = [*rows.get(name, new)[:2], "0", "", "**no result**"]
    first = lambda name: (int(rows[name][0].split(",")[0]) if rows[name][0] else 999, name)
    ordered = [rows[name] for name in sorted(rows, key=first)]
    held = sum(row[4] == "holds" for row in ordered)
    text = f"""# Verification

`make book` runs every case below through the command line users have, compares with exact or independently computed
references and writes these pages; `make test` runs a quick form of them on coarser meshes, with the same tolerances or
those a page states for it, and their reason. Each page names the files it runs and the commands, with every `--set`. Most have
a case of their own in [`{CASES}`](../../{CASES}); `energy`, `scaling`, `symmetry` and `convergence` run the default case
[`geo/twin_pipes.json`](../../geo/twin_pipes.json), some share a case, and `condensed` is a Rust test, since the program has no
second solver to compare with. {held} of {len(ordered)} cases hold, {sum(int(row[2]) for row in ordered)} numbers. The column "nearest to its tolerance" shows
the number that uses most of what it is allowed; errors at round-off are told by their decade.

"""
    DOCS.mkdir(parents=True, exist_ok=True)
    (DOCS / "README.md").write_text(text + markdown_table(HEADING, ordered), encoding="utf-8")
