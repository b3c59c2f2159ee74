"""Results of a run as numbers, and how far two runs are apart."""

import csv
import dataclasses
import json

import numpy as np

TOLERANCE = 1e-6
FAMILIES = ["u", "v", "a"]


@dataclasses.dataclass
class Result:
    """What a run left: `histories` are times x columns, `names` those of the columns."""

    code: int
    said: str
    times: list = dataclasses.field(default_factory=list)
    names: list = dataclasses.field(default_factory=list)
    histories: np.ndarray = None
    summary: dict = dataclasses.field(default_factory=dict)
    substeps: list = dataclasses.field(default_factory=list)  # times of all steps, the shorter ones of a cut step included

    def warnings(self):
        return self.summary.get("warnings", [])


def read(folder, code, said, mirrored):
    result = Result(code, said)
    if (folder / "histories.csv").exists():
        with open(folder / "histories.csv", newline="") as file:
            rows = list(csv.reader(file))
        result.names = rows[0][1:]
        result.times = [float(row[0]) for row in rows[1:]]
        result.histories = np.array([[float(x) for x in row[1:]] for row in rows[1:]]).reshape(-1, len(result.names))
        if mirrored:
            result.histories[:, [name.endswith("x") for name in result.names]] *= -1
    if (folder / "run.sta").exists():
        lines = (folder / "run.sta").read_text().splitlines()
        result.substeps = [float(line.split()[1]) for line in lines if not line.startswith("#")]
    if (folder / "summary.json").exists():
        result.summary = json.loads((folder / "summary.json").read_text())
    return result


def of_family(result, family):
    return result.histories[:, [name.split(".")[-1][0] == family for name in result.names]]


def apart(one, other, scale):
    """{family: |difference| / peak, rows x columns} over the steps that both reached.

    Newmark's rule makes v and a from differences of u, 2/dt and 4/dt^2 of them: u that is right to 1e-9 of its peak leaves
    errors of 2e-9 peak/dt and 4e-9 peak/dt^2, so these count as 1e-6 at most."""
    rows = min(len(one.times), len(other.times))
    if not rows or one.histories is None or other.histories is None:
        return {}
    of_each = {family: [of_family(result, family)[:rows] for result in (one, other)] for family in FAMILIES}
    peaks = {family: max(np.abs(a).max(), np.abs(b).max(), scale[family]) for family, (a, b) in of_each.items()}
    floor = {"u": 0.0, "v": 2e-3 / scale["step"] * peaks["u"], "a": 4e-3 / scale["step"] ** 2 * peaks["u"]}
    return {family: np.abs(a - b) / max(peaks[family], floor[family]) for family, (a, b) in of_each.items()}


def differences(one, other, scale):
    """{quantity: difference over its peak}; steps that only one of them reached are left out."""
    found = {family: float(values.max()) for family, values in apart(one, other, scale).items()}
    return found | (of_summaries(one, other, scale) if one.code == other.code == 0 else {})


def of_summaries(one, other, scale):
    """Gap and slip over the largest displacement, energies over their peak, frequencies each over itself."""
    largest = max(np.abs(of_family(one, "u")).max(), scale["u"])
    found = {}
    for key, name in (("max_open", "gap"), ("max_slip", "slip")):
        values = [result.summary["contact"][key] or 0 for result in (one, other)]
        found[name] = abs(values[0] - values[1]) / max(largest, *values)
    peak = max(one.summary["energy"]["peak"], other.summary["energy"]["peak"], scale["energy"])
    last = [result.summary["energy"]["last"] for result in (one, other)]
    found["energy"] = max([abs(last[0][key] - last[1][key]) / peak for key in last[0]])
    frequencies = [result.summary.get("frequencies_hz") or [] for result in (one, other)]
    largest = max([*frequencies[0], 0])
    if len(frequencies[0]) == len(frequencies[1]):
        found["frequency"] = max([abs(a - b) / largest for a, b in zip(*frequencies) if a != b] or [0.0])
    else:
        found["frequency"] = 1.0
    return found


def growth(one, other, scale):
    """Largest difference over its peak so far, step by step."""
    return np.maximum.accumulate(np.max([values.max(axis=1) for values in apart(one, other, scale).values()], axis=0))
