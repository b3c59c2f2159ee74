#!/usr/bin/env python3
"""How large the ground of the paper's example must be: `coralpipe domain` on the default case, in several windows.

    .venv/bin/python scripts/domain.py        writes docs/domain.md and docs/domain.svg; a few minutes
"""

import json
import os
import pathlib
import shutil
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent
DOCS = ROOT / "docs"
PROGRAM = os.environ.get("CORALPIPE") or ROOT / "target/release/coralpipe"
OUT = ROOT / "output" / "domain_page"
DAMPING = 'damping={"alpha": 3.30204, "beta": 7.56178e-4}'
VISCOUS = ['supports={"side_left": ["x"], "side_right": ["x"]}', 'boundaries={"base": "viscous"}', DAMPING]


def study(name, *options, sets=()):
    """Runs the command; its table's rows and whether it settled. Exit code 3 says that no size was large enough."""
    command = [PROGRAM, "domain", "geo/twin_pipes.json", "--out", OUT / name, *options]
    for setting in sets:
        command += ["--set", setting]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    if done.returncode not in (0, 3):
        raise SystemExit(done.stderr)
    found = json.loads((OUT / name / "domain" / "domain.json").read_text())
    return found, done.stdout


def worst(row, key):
    values = {name: q[key] for name, q in row["quantities"].items() if q[key] is not None}
    name = max(values, key=values.get)
    value = 100 * values[name]
    return f"{value:.0f} % ({name})" if value >= 100 else f"{value:.2g} % ({name})"


def peak(row, name):
    return f"{1e3 * row['quantities'][name]['peak']['value']:.4f}"


def table(found):
    text = "| B0 [m] | H0 [m] | grown from | unknowns | peak of A, C [mm] | change before the return | change in the window | run [s] |\n"
    text += "|---|---|---|---|---|---|---|---|\n"
    for row in found["sizes"]:
        before = whole = origin = "-"
        if row["from"]:
            origin = "{:g} x {:g}".format(*row["from"])
            whole = worst(row, "change")
            felt = row["first_return_s"] is not None and row["first_return_s"] < found["until_s"]
            before = f"{worst(row, 'change_before_return')} to {1e3 * row['first_return_s']:.1f} ms" if felt else "no return"
        width, height = row["size"]
        text += f"| {width:g} | {height:g} | {origin} | {row['unknowns']} | {peak(row, 'A.u')}, {peak(row, 'C.u')} "
        text += f"| {before} | {whole} | {row['seconds']:.1f} |\n"
    return text


def windows():
    """Growing the paper's box once, judged in windows of different length."""
    text = "| window ends [ms] | change by 25 -> 37.5 m of width | change by 15 -> 22.5 m of height | within 1.74 % |\n|---|---|---|---|\n"
    for end in (20, 28.7, 32, 35, 36, 39.64, 45, 60, 100):
        found, _ = study("fixed", "--until", f"{end} ms", "--sizes", "1")
        rows = {tuple(row["size"]): row for row in found["sizes"]}
        wider, deeper = rows[(37.5, 15)], rows[(25, 22.5)]
        most = max(q["change"] for row in (wider, deeper) for q in row["quantities"].values())
        text += f"| {end:g} | {worst(wider, 'change')} | {worst(deeper, 'change')} | {'yes' if most <= 0.0174 else 'no'} |\n"
    return text


FORCES = ("pipe_left.M", "pipe_left.N", "pipe_left.hoop_inner", "A.u", "A.v")


def forces():
    """The same for section forces and a velocity: the largest change of each by 15 -> 22.5 m of height."""
    text = "| window ends [ms] | " + " | ".join(FORCES) + " |\n|" + "---|" * (len(FORCES) + 1) + "\n"
    for end in (28.7, 32, 35):
        found, _ = study("forces", "--until", f"{end} ms", "--sizes", "1", "--compare", ",".join(FORCES))
        deeper = next(row for row in found["sizes"] if row["size"] == [25, 22.5])["quantities"]
        text += f"| {end:g} | " + " | ".join(f"{100 * deeper[name]['change']:.2g} %" for name in FORCES) + " |\n"
    return text


PAGE = """# How large the ground must be

The paper sizes its ground by iteration: B0 and H0 grow until the displacements change by less than 1.74 %, and 25 x 15 m is what
it ends with. It does not say at which points, nor over which time. `coralpipe domain` does that iteration on this program's default
case; all figures below are ours, and so are p_max, tau = 50 ms, the pipes' spacing and the boundaries (held base, sides with
u_x = 0). Compared are the displacements of A, C, H, K, L, I: max |u_new(t) - u_old(t)| / max |u_new(t)|. Made by
`scripts/domain.py`; run times are of a busy machine with 2 cores.

**In short.** 25 m of width is enough in every window looked at. 15 m of height is enough, to 1.74 %, for windows that end
at about 35 ms or before if displacements are asked for, at about 29 ms if the pipes' forces are. The base at 15 m returns the front to the invert at 39.6 ms, and a uniform load's plane wave comes
back whole: for 100 ms the iteration, growing by half each time, stops at 50.6 m. With a viscous base 25 x 15 m is enough
for 100 ms.

## When a boundary is first felt
```
@bound@
```
With sides that carry the plane wave exactly, only what the pipes scatter comes back from them, and that is little. The bound is for
the ground itself: damping in proportion to stiffness has no finite speed (docs/theory.md, section 11).

## The same two steps in windows of different length
@windows@

Until 28.7 ms = T - 2 sqrt(beta T) a deeper ground changes 0.06 %; at T = 39.6 ms half of the spread front is there.

These are displacements. Section forces and velocities follow the front itself, and feel it sooner (change by 15 -> 22.5 m of
height; forces ray by ray, over the largest round the wall):

@forces@

For forces the limit lies between 28.7 and 32 ms.

## 100 ms, grown until it settles
@fixed@

![C's or another probe's displacement for each size, and the changes](domain.svg)

"Before the return" ends when the front first comes back through the ground of the smaller size. The height settles only when
the return has left the window: 34.1 m by time of flight, more because the front is spread. All sizes have alpha and beta of
the first.

## The same, with alpha and beta found anew for each size
@own@

A wider or deeper ground has lower first modes, so 5 % in the first two of them is another material in every size: the iteration
then compares two things at once. Whether the paper did so is not known.

## Without damping, until nothing can have come back (37.68 ms)
@undamped@

No wave can have come back, and yet the sizes differ. Not by their boundaries: until 8 ms the difference of the displacements
is below 1e-12 of their peak, then it grows a hundredfold about every 3 ms. Undamped contact chatters, and makes much of little
(docs/theory.md, section 8); compare without damping in short windows only.

## With a viscous base, 100 ms
@viscous@

The base absorbs the plane wave, damped as the ground is; what is left comes from the sides, as with a held base. alpha and beta are the held base's, as numbers. A ratio would give the same in the first
size: natural modes are those of the ground as its boundaries hold it (docs/theory.md, section 7).
"""


def main():
    small = windows()
    fixed, told = study("fixed")
    shutil.copy(OUT / "fixed" / "domain" / "domain.svg", DOCS / "domain.svg")
    own, _ = study("own", "--own-damping", "--sizes", "3")
    undamped, _ = study("undamped", "--until", "37.68 ms", "--sizes", "1", sets=["damping=null"])
    viscous, _ = study("viscous", sets=VISCOUS)
    texts = {
        "bound": told.split("\nchange = ")[0],
        "windows": small,
        "forces": forces(),
        "fixed": table(fixed),
        "own": table(own),
        "undamped": table(undamped),
        "viscous": table(viscous),
    }
    page = PAGE
    for name, text in texts.items():
        page = page.replace(f"@{name}@", text.strip())
    (DOCS / "domain.md").write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main()
