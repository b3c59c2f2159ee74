"""The book as Markdown: a page with a picture a case, and the summary that heads them."""

import io

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

from book.lib import ROOT, Page, Row, say

DOCS = ROOT / "docs" / "verification"
MODULES = "scripts/book"


def link(path: str) -> str:
    return f"[`{path}`](../../{path})"


def bound_text(row: Row) -> str:
    return {"": "", "least": "at least ", "most": "at most "}[row.bound]


def error_text(row: Row) -> str:
    percent = row.relative and row.error >= 1e-6
    return f"{100 * row.error:.3g} %" if percent else (f"{row.error:.1e}" + ("" if row.relative else f" {row.unit}")).strip()


def tolerance_text(row: Row) -> str:
    percent = row.relative and row.tolerance >= 1e-6
    return f"{100 * row.tolerance:.3g} %" if percent else (f"{row.tolerance:.1e}" + ("" if row.relative else f" {row.unit}")).strip()


def markdown_table(columns: list, rows: list) -> str:
    line = lambda cells: "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"
    return "\n".join([line(columns), "|" + "---|" * len(columns), *map(line, rows)]) + "\n"


def write_page(page: Page) -> None:
    DOCS.mkdir(parents=True, exist_ok=True)
    picture = draw(page)
    rows = [[row.quantity, bound_text(row) + say(row.reference), say(row.value), row.unit, error_text(row), tolerance_text(row),
             "" if row.passes else "**misses**"] for row in page.rows]
    parts = [f"# {page.title}\n", f"{page.problem.strip()}\n"]
    parts += [f"![{page.title}]({picture})\n"] if picture else []
    parts += ["## Reference\n", f"{page.reference.strip()}\n", "## Program and reference\n"]
    parts += [markdown_table(["quantity", "reference", "program", "unit", "error", "tolerance", ""], rows)]
    whys = list(dict.fromkeys(row.why for row in page.rows if row.why))
    parts += ["Tolerances: " + "; ".join(whys) + ".\n"] if whys else []
    for heading, columns, cells in page.tables:
        parts += [f"### {heading}\n", markdown_table(columns, cells)]
    parts += ["## Assumed, and what misses\n", f"{page.notes.strip()}\n"] if page.notes else []
    code = [f"{MODULES}/{page.name}.py", *page.code]
    parts += ["## Code\n", ", ".join(link(path) for path in code) + "\n"]
    (DOCS / f"{page.name}.md").write_text("\n".join(parts), encoding="utf-8")


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


def write_summary(pages: list, seconds: float) -> None:
    """docs/verification/README.md."""
    first = lambda page: (min(page.items), page.name) if page.items else (999, page.name)
    rows = []
    for page in sorted(pages, key=first):
        worst = max(page.rows, key=lambda row: row.error / row.tolerance if row.tolerance else float(row.error > 0))
        rows.append([", ".join(str(i) for i in page.items), f"[{page.title}]({page.name}.md)", str(len(page.rows)),
                     f"{worst.quantity}: {error_text(worst)} (tolerance {tolerance_text(worst)})",
                     "holds" if page.passes else "**misses**"])
    held = sum(page.passes for page in pages)
    text = f"""# Verification

Every case below is a pair of files a user can run, `coralpipe run geo/verification/NAME.json`. `make book` runs them all
through the same command line, compares with exact or independently computed references and writes these pages;
`make test` does so on coarser meshes with the same tolerances or wider ones that are stated. {held} of {len(pages)} cases hold
({sum(len(p.rows) for p in pages)} numbers, {seconds:.0f} s). The column "nearest to its tolerance" shows the number that uses most of what it is allowed.

"""
    text += markdown_table(["item", "case", "numbers", "nearest to its tolerance", ""], rows)
    DOCS.mkdir(parents=True, exist_ok=True)
    (DOCS / "README.md").write_text(text, encoding="utf-8")
