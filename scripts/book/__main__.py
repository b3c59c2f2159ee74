"""`python -m book`: writes docs/verification/; `--quick`: the same comparisons on coarser variants, nothing written.

Exit code 1, with a sentence each, where a number misses its tolerance.
"""

import argparse
import importlib
import pkgutil
import shutil
import sys
import time
from concurrent.futures import ThreadPoolExecutor

import book
from book.lib import ROOT, Book, Failed, Page
from book.pages import code_links, mark_stale, write_page, write_summary

FULL_ONLY = {"condensed"}  # quick: `make test` runs its Rust test anyway
NO_CASES = {"lib", "pages", "__main__", "ring_theory", "element_forces"}


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m book", description=__doc__)
    parser.add_argument("cases", nargs="*", help="names of cases; default: all")
    parser.add_argument("--quick", action="store_true", help="coarser and shorter, no files in docs/")
    parser.add_argument("--jobs", type=int, default=2, help="cases at a time (default 2)")
    parser.add_argument("--list", action="store_true", help="print the names of the cases")
    arguments = parser.parse_args()

    known = [m.name for m in pkgutil.iter_modules(book.__path__) if m.name not in NO_CASES]
    if arguments.list:
        print("\n".join(known))
        return 0
    strange = [name for name in arguments.cases if name not in known]
    if strange:
        print(f"book: there is no case {', '.join(strange)}; there are: {', '.join(known)}", file=sys.stderr)
        return 1
    wanted = arguments.cases or [name for name in known if not (arguments.quick and name in FULL_ONLY)]

    started = time.monotonic()
    if not arguments.cases:
        shutil.rmtree(ROOT / "output" / "book" / ("quick" if arguments.quick else "full"), ignore_errors=True)
    with ThreadPoolExecutor(arguments.jobs) as pool:
        found = dict(zip(wanted, pool.map(lambda name: calculate(name, arguments.quick), wanted)))
    pages = [page for page in found.values() if isinstance(page, Page)]
    if not arguments.quick:
        for page in pages:
            write_page(page)
        failed = {name: why for name, why in found.items() if isinstance(why, str)}
        for name, why in failed.items():
            mark_stale(name, why)
        write_summary(pages, list(failed), known)
    bad = [name for name in wanted if name not in {p.name for p in pages if p.holds(arguments.quick)}]
    rows = sum(len(page.rows) for page in pages)
    print(f"{len(wanted) - len(bad)} of {len(wanted)} cases hold, {rows} numbers, {time.monotonic() - started:.0f} s")
    return 1 if bad else 0


def calculate(name: str, quick: bool) -> Page | str:
    """The page of a case; what misses is said at once. Where a run fails, why."""
    started = time.monotonic()
    try:
        runs = Book(quick)
        page = importlib.import_module(f"book.{name}").page(runs)
        page.name, page.commands = name, runs.commands
        code_links(page)
    except (Failed, KeyError, IndexError, ValueError, OSError) as error:
        why = sentence(error)
        print(f"book: {name} gives no result: {why}", file=sys.stderr)
        return why
    for row in page.rows:
        if not row.holds(quick):
            print(f"book: {name}: {row.quantity} is {row.value:.8g} {row.unit} and should be {row.reference:.8g}: the "
                  f"error {row.error:.3g} is above its tolerance {row.allowed(quick):.3g}", file=sys.stderr)
    print(f"{name:28} {len(page.rows):4} numbers {'hold' if page.holds(quick) else 'MISS'} {time.monotonic() - started:6.1f} s",
          flush=True)
    return page


def sentence(error: Exception) -> str:
    if isinstance(error, Failed):
        return str(error)
    if isinstance(error, KeyError):
        return f"the results have no {error}; the program is older or newer than the book (`make book` builds it first)"
    return f"{type(error).__name__}: {error}"


if __name__ == "__main__":
    sys.exit(main())
