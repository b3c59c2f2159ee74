"""What every peer's script does alike: its arguments, the model, and the file it leaves."""

import argparse
import json
from pathlib import Path

import numpy as np

from .model import Model


def arguments():
    parser = argparse.ArgumentParser()
    parser.add_argument("--case", type=Path, required=True)
    parser.add_argument("--mesh", type=Path, required=True)
    parser.add_argument("--alpha", type=float, required=True)
    parser.add_argument("--beta", type=float, required=True)
    parser.add_argument("--dt", type=float, required=True)
    parser.add_argument("--steps", type=int, required=True)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--bonded", action="store_true")
    parser.add_argument("--lumped", action="store_true")
    parser.add_argument("--law", choices=["coulomb", "opensees"], default="coulomb")
    return parser.parse_args()


def model_of(a) -> Model:
    return Model(a.case, a.mesh, a.bonded, a.alpha, a.beta, a.dt, a.steps)


def leave(a, history, steps_s, version, **more):
    """`history`: displacements of the probes, a row a step from t = 0, columns A.ux, A.uy, C.ux, ..."""
    np.save(a.out.with_suffix(".npy"), history)
    a.out.write_text(json.dumps({"steps_s": steps_s, "version": version, **more}))
