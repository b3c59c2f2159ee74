"""Item 27: the condensed contact step equals full Newton on the whole system; the figure of the Rust test."""

import re
import subprocess

from book.lib import ROOT, Failed, Page, Row


def page(book):
    run = subprocess.run(["cargo", "test", "--release", "--test", "contact_condensed", "--", "--nocapture"], cwd=ROOT,
                         capture_output=True, text=True)
    found = re.findall(r"(lobatto|gauss_1), ([\d.]+), ([\d.]+): (\S+); at most (\d+) points open, (\d+) slipping", run.stdout)
    if run.returncode != 0 or not found:
        raise Failed(f"cargo test --test contact_condensed: {run.stdout[-1000:]}{run.stderr[-1000:]}")
    rows = []
    for rule, alpha, delta, difference, opened, slipping in found:
        rows.append(Row(f"{rule}, Newmark {alpha}, {delta}: largest difference at any node and step over the peak ({opened} points "
                        f"open, {slipping} slipping)", 0, float(difference), 1e-9, relative=False, why="the tolerance of both Newtons"))
    return Page(
        "condensed", "Condensed contact = full Newton", [27],
        problem="400 steps of a small layered ground with one pipe that comes off and slips. The program factors everything linear once "
                "and iterates on the jumps alone; the test beside it assembles the whole tangent in nodal displacements and factors it "
                "in every iteration, with a time integration of its own.",
        reference="The same equations: the difference is round-off and the tolerance of the iteration.",
        rows=rows, code=["tests/contact_condensed.rs", "src/solve/condensed.rs", "src/solve/contact.rs"],
        notes="The command line has no second solver, so this figure is that of the Rust test.",
    )
