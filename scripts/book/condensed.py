"""Item 27: the condensed contact step equals full Newton on the whole system; the figure of the Rust test."""

import re
import subprocess

from book.lib import ROOT, Failed, Page, Row


TEST = "the_condensed_step_is_full_newton_on_the_whole_system"  # the other test of that file is of interfaces that meet


def page(book):
    run = subprocess.run(["cargo", "test", "--release", "--test", "contact_condensed", TEST, "--", "--nocapture"], cwd=ROOT,
                         capture_output=True, text=True)
    found = re.findall(r"(lobatto|gauss_1), ([\d.]+), ([\d.]+): (\S+); at most (\d+) points open, (\d+) slipping", run.stdout)
    if run.returncode != 0 or not found:
        raise Failed(f"cargo test --test contact_condensed: {run.stdout[-1000:]}{run.stderr[-1000:]}")
    rows = []
    for rule, alpha, delta, difference, opened, slipping in found:
        rows.append(Row(f"{rule}, Newmark {alpha}, {delta}: largest difference at any node and step over the peak ({opened} points "
                        f"open, {slipping} slipping)", 0, float(difference), 1e-9, relative=False, why="the tolerance of both Newtons"))

    def plot(axes):
        names = [f"{rule}, Newmark {alpha}, {delta}" for rule, alpha, delta, *_ in found]
        axes.barh(names, [float(f[3]) for f in found])
        axes.axvline(1e-9, color="k", linewidth=0.8)
        axes.set(xscale="log", xlim=(1e-15, 1e-8), xlabel="largest difference over the peak displacement (line: tolerance)")
        axes.tick_params(axis="y", labelsize=7)

    return Page(
        "condensed", "Condensed contact = full Newton", [27],
        problem="400 steps of a small layered ground with one pipe that comes off and slips. The program factors everything linear once "
                "and iterates on the jumps alone; the test beside it assembles the whole tangent in nodal displacements and factors it "
                "in every iteration, with a time integration of its own.",
        reference="The same equations: the difference is round-off and the tolerance of the iteration.",
        plot=plot, rows=rows, code=["tests/contact_condensed.rs", "src/solve/condensed.rs", "src/solve/contact.rs"],
        notes="The command line has no second solver, so these figures are those of a Rust test, `cargo test --release --test "
              "contact_condensed -- --nocapture`, on `tests/meshes/one_ring.msh`; there is no case file. Both share the law of the joint and the element "
              "matrices, which other pages prove; what is compared is the elimination and the iteration.",
    )
