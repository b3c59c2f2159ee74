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


def differences(one, other, scale):
    """{quantity: difference over its peak}; steps that only one of them reached are left out."""
    found = {}
    rows = min(len(one.times), len(other.times))
    if rows and one.histories is not None and other.histories is not None:
        of_each = {family: [of_family(result, family)[:rows] for result in (one, other)] for family in FAMILIES}
        peaks = {family: max(np.abs(a).max(), np.abs(b).max(), scale[family]) for family, (a, b) in of_each.items() if a.size}
        # Newmark's rule makes v and a from differences of u, 2/dt and 4/dt^2 of them: of u to 9 digits no more can be asked
        step = scale["step"]
        floor = {"u": 0.0, "v": 2e-3 / step * peaks["u"], "a": 4e-3 / step**2 * peaks["u"]}
        for family, peak in peaks.items():
            a, b = of_each[family]
            found[family] = float(np.abs(a - b).max() / max(peak, floor[family]))
    if one.code == other.code == 0:
        found |= of_summaries(one, other, scale)
    return found


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
    """Largest difference of u over its peak so far, step by step."""
    rows = min(len(one.times), len(other.times))
    a, b = (of_family(result, "u")[:rows] for result in (one, other))
    peak = max(np.abs(a).max(), np.abs(b).max(), scale["u"])
    return np.maximum.accumulate(np.abs(a - b).max(axis=1) / peak)
