"""Runs the notebook of notebook.md as it stands there, and holds what it has read against the daemon's JSON.

    run_readme_notebook.py notebook.md DAEMON RESULTS    the address and the folder that take the place of those in it

Exit 0, or a traceback.
"""
import contextlib
import io
import json
import re
import sys
import urllib.request
from pathlib import Path

import numpy as np


def notebook(readme):
    blocks = re.findall(r"^```python\n(.*?)^```", readme.read_text(), re.MULTILINE | re.DOTALL)
    found = [block for block in blocks if "read_csv" in block]
    assert len(found) == 1, f"{len(found)} python blocks read CSV"
    return found[0]


def with_values(block, **values):
    for name, value in values.items():
        block, count = re.subn(rf'^{name} = "[^"]*"', f'{name} = "{value}"', block, flags=re.MULTILINE)
        assert count == 1, f"{count} lines set {name}"
    return block


def listed(daemon, path):
    """All entries of a list of the API, page by page."""
    entries, cursor = [], None
    while True:
        more = f"&cursor={cursor}" if cursor else ""
        with urllib.request.urlopen(f"{daemon}/api/v1/{path}{more}") as response:
            answer = json.load(response)
        entries += next(value for value in answer.values() if isinstance(value, list))
        cursor = answer["next"]
        if cursor is None:
            return entries


def main(readme, daemon, results):
    names, said = {}, io.StringIO()
    with contextlib.redirect_stdout(said):
        exec(with_values(notebook(readme), daemon=daemon, results=results), names)
    print(said.getvalue())

    months = listed(daemon, "months?meter=main")
    usable = [month["daily_average_kWh"] for month in months if month["usable"]]
    assert len(usable) >= 2, months
    assert list(names["months"].index) == [month["month"] for month in months]
    assert np.isclose(names["months"].query("usable")["daily_average_kWh"].mean(), np.mean(usable))

    valid = {
        interval["start"]: interval["mean_kW"]
        for interval in listed(daemon, "intervals?meter=main&from=2026-01-01")
        if interval["validity"] == "ok"
    }
    read = names["valid_kW"]
    starts = read.index.tz_convert("UTC").strftime("%Y-%m-%dT%H:%M:%SZ")
    assert dict(zip(starts, read)) == valid
    assert str(read.index.tz) == "America/Chicago"

    report = json.loads((Path(results) / "calibration.json").read_text())
    posterior = names["draws"].posterior
    for parameter in report["parameters"]:
        mean = float(posterior[parameter["name"]].mean())
        assert np.isclose(mean, parameter["mean"], rtol=1e-6), parameter["name"]
        assert parameter["name"] in said.getvalue()
    for printed in ["daily_average_kWh", f"{np.mean(usable):.2f}"[:6], "r_hat"]:
        assert printed in said.getvalue(), printed


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2], sys.argv[3])
