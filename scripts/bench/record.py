"""Puts a table into docs/performance.md, between the comments that bear its name."""

import sys
from pathlib import Path

PAGE = Path(__file__).resolve().parents[2] / "docs" / "performance.md"


def record(name: str, text: str):
    page = PAGE.read_text()
    begin, end = f"<!-- {name} -->\n", f"<!-- end of {name} -->\n"
    before, rest = page.split(begin)
    _, after = rest.split(end)
    PAGE.write_text(before + begin + text.strip() + "\n" + end + after)


if __name__ == "__main__":
    record(sys.argv[1], sys.stdin.read())
