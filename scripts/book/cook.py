"""Item 5: Cook's membrane, skewed elements in bending and shear."""

from book.lib import Page, Row, order, say

REFERENCE = 23.9677  # v(48, 52), converged
CORNER = 25.19  # v(48, 60), converged
STANDARD = {2: 11.8452, 4: 18.2992, 8: 22.0792, 16: 23.4304, 32: 23.8176}  # full integration Q4
ELEMENTS = {"Q4, standard": (4, 1, "standard"), "Q4, B-bar": (4, 1, "b_bar"), "T3": (3, 1, "standard"),
            "T6": (3, 2, "standard"), "Q8": (4, 2, "standard")}


def page(book):
    divisions = [2, 4, 8, 16] if book.quick else [2, 4, 8, 16, 32, 64]
    found, rows, cells = {}, [], []
    for name, (corners, element_order, quad4) in ELEMENTS.items():
        used = divisions if name == "Q4, standard" or not book.quick else divisions[-2:]
        runs = [book.run("cook", geo={"n": n, "corners": corners, "order": element_order}, sets={"elements.quad4": quad4})
                for n in used]
        found[name] = [float(run.histories["C.uy"][-1]) for run in runs]
        slope = order([1 / n for n in used], [abs(v - REFERENCE) for v in found[name]])
        cells.append([name] + [say(round(v, 4)) for v in found[name]] + [f"{slope:.2f}"])
    corner = float(runs[-1].histories["D.uy"][-1])
    rows += [Row(f"standard Q4, {n} x {n}: v(48, 52)", STANDARD[n], v, 5e-6, why="six printed digits")
             for n, v in zip(divisions, found["Q4, standard"]) if n in STANDARD]
    finest = divisions[-1]
    why = "what the finest mesh leaves: the clamped corners are singular and hold the order to about 1.5"
    rows += [Row(f"{name}, {finest} x {finest}: v(48, 52)", REFERENCE, found[name][-1], 5e-3 if "4" in name else 3e-4, why=why,
                 quick=(0.03 if "4" in name else 2e-3, "16 x 16 elements"))
             for name in ["Q8", "T6", "Q4, B-bar"]]
    why = "four printed digits; shear that stops at the end's corner makes the order 1 there"
    rows.append(Row(f"Q8, {finest} x {finest}: v(48, 60)", CORNER, corner, 1.5e-3, why=why, quick=(6e-3, "16 x 16 elements")))

    def plot(axes):
        for (name, values), mark in zip(found.items(), "osv^D"):
            axes.semilogx(divisions, values, mark + "-", label=name, base=2)
        axes.axhline(REFERENCE, color="k", ls=":", label="reference")
        axes.set(xlabel="elements on a side", ylabel="v(48, 52)")
        axes.grid(alpha=0.3)
        axes.legend()

    return Page(
        "cook", "Cook's membrane", [5],
        problem="A tapered panel, (0,0) (48,44) (48,60) (0,44), clamped on the left, with a shear force F = 1 spread over its "
                "right end; plane stress, E = 1, nu = 1/3. The program solves plane strain: with E' = E(1 + 2 nu)/(1 + nu)^2 = "
                "0.9375 and nu' = nu/(1 + nu) = 0.25 the in-plane equations are the same.",
        reference="R. D. Cook, *J. Struct. Div. ASCE* 100 (1974); converged value 23.9677 at the middle of the end and 25.19 at its "
                  "corner. The values of the standard Q4 on N x N elements come from an independent program.",
        rows=rows, plot=plot, example=(runs[-1], "v(48, 52) and v(48, 60) of Q8 are the last `C.uy` and `D.uy` in histories.csv."),
        tables=[("v(48, 52)", ["element", *(f"{n} x {n}" for n in divisions), "order"], cells)],
        notes="B-bar in plane strain is no plane-stress element: out-of-plane strain is zero in both, so that it may be used here. "
              "The order is the slope between the two finest meshes.",
        code=["src/physics/element.rs::stiffness", "src/physics/element.rs::b_bar_stiffness", "src/physics/material.rs::plane_strain"],
    )
