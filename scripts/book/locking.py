"""Item 4: volumetric locking of the elements as Poisson's ratio nears 1/2."""

from book.lib import Page, Row, say

RATIOS = [0.3, 0.49, 0.499, 0.4999]
ELEMENTS = {"Q4, standard": (4, 1, "standard"), "Q4, B-bar": (4, 1, "b_bar"), "T3": (3, 1, "standard"),
            "T6": (3, 2, "standard"), "Q8": (4, 2, "standard")}
HELD = {"Q4, B-bar": 0.003, "Q8": 0.008}  # tolerance of u(a)
WHY = {"Q4, B-bar": "0.3 %, twice the error of the division at nu = 0.3, where nothing locks: it must not grow with nu",
       "Q8": "0.8 %, below the book's aim of 1 %: at nu = 0.4999 its nine points begin to hold the volume"}


def exact(nu):
    """u(a) = (1 + nu)/E [(1 - 2 nu) C a + D/a] for a = 1, b = 2, E = 1000, p_i = 1: C = 1/3, D = 4/3."""
    return (1 + nu) / 1000 * ((1 - 2 * nu) / 3 + 4 / 3)


def page(book):
    rows, ratio, cells, example = [], {}, [], None
    for name, (corners, order, quad4) in ELEMENTS.items():
        found = []
        for nu in RATIOS:
            run = book.run("locking", geo={"corners": corners, "order": order},
                           sets={"materials.pipe.poisson": nu, "elements.quad4": quad4})
            found.append(float(run.histories["B.ux"][-1]))
            example = run if (name, nu) == ("Q4, B-bar", 0.4999) else example
        ratio[name] = [u / exact(nu) for u, nu in zip(found, RATIOS)]
        cells.append([name] + [f"{say(u)} ({100 * (r - 1):+.2f} %)" for u, r in zip(found, ratio[name])])
        if name in HELD:
            rows += [Row(f"{name}: u(a) at nu = {nu}", exact(nu), u, HELD[name], "m",
                         why=f"{name}: {WHY[name]}")
                     for nu, u in zip(RATIOS, found)]
    rows.append(Row("standard Q4 at nu = 0.4999, part of u(a) it reaches (it locks)", 0.8, ratio["Q4, standard"][-1], 0.0,
                    bound="most", why="the standard element must show what B-bar cures"))

    def plot(axes):
        for (name, values), mark in zip(ratio.items(), "osv^D"):
            axes.semilogx([1 - 2 * nu for nu in RATIOS], values, mark + "-", label=name)
        axes.invert_xaxis()
        axes.set(xlabel="1 - 2 nu", ylabel="u(a) / exact")
        axes.grid(alpha=0.3)
        axes.legend()

    return Page(
        "locking", "Volumetric locking", [4],
        problem="Thick cylinder, a = 1, b = 2, E = 1000, inner pressure 1, plane strain, 8 elements through the wall and 24 "
                "round a quarter, with nu = 0.3 to 0.4999. The paper's first layer has nu = 0.46.",
        reference="Lame: u(a) = (1 + nu)/E [(1 - 2 nu) a/3 + 4/(3a)] (Timoshenko and Goodier, *Theory of Elasticity*, art. 28).",
        rows=rows, plot=plot, example=(example, "u(a) of B-bar Q4 at nu = 0.4999 is the last `B.ux` in histories.csv."),
        tables=[("Displacement u(a) [m] on the same divisions", ["element", *(f"nu = {nu}" for nu in RATIOS)], cells)],
        notes="Only B-bar Q4 (`\"elements\": {\"quad4\": \"b_bar\"}`) and Q8 are meant for such ground; the others are shown. The "
              "T3 lie in crossed pairs, which lock little; T3 in general lock as standard Q4 do.",
        code=["src/physics/element.rs::b_bar_stiffness", "src/physics/element.rs::mean_dilatation", "src/solve/assembly.rs::stiffness_of_face", "geo/verification/lame.geo"],
    )
