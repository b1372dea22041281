"""Reads the results of `recald calibrate --predictive` as a researcher does, with ArviZ.

    read_by_arviz.py files RESULTS            what every such result has to hold
    read_by_arviz.py given RESULTS DESIGN     the densities, computed once more from the draws
    read_by_arviz.py forecasts RESULTS DESIGN leave-one-out, held against calibration.json
    read_by_arviz.py scatter RESULTS          the same where the range of the output is not known

Exit 0, or a traceback of the assertion that failed.
"""
import json
import sys
from pathlib import Path

import arviz as az
import numpy as np
import pandas as pd


def read(results):
    return az.from_cmdstan(
        sorted(str(file) for file in results.glob("draws_*.csv")),
        posterior_predictive="y_rep",
        log_likelihood="log_lik",
        observed_data=str(results / "points.json"),
        observed_data_var="y",
    )


def flat(values):
    """(chains, draws, points) -> (samples, points)"""
    return values.reshape(-1, values.shape[-1])


def report_of(results):
    report = json.loads((results / "calibration.json").read_text())
    points = json.loads((results / "points.json").read_text())
    by_place = {(p["output"], p["month"]): p for p in report["predictions"]}
    return report, [by_place[place] for place in zip(points["output"], points["month"])]


def check_files(results):
    idata = read(results)
    report, predictions = report_of(results)
    shape = (report["chains"], report["sampling"]["draws"], len(predictions))
    assert idata.posterior_predictive["y_rep"].shape == shape
    assert idata.log_likelihood["log_lik"].shape == shape
    names = [p["name"] for p in report["parameters"] + report["hyperparameters"]]
    assert sorted(idata.posterior.data_vars) == sorted(names)
    for parameter in report["parameters"]:
        mean = float(idata.posterior[parameter["name"]].mean())
        assert np.isclose(mean, parameter["mean"], rtol=1e-6), parameter["name"]
    measured = np.array([p["measured"] for p in predictions])
    assert np.allclose(idata.observed_data["y"], measured)
    assert all(p["role"] == "calibration" for p in predictions)
    fitted = {o["name"] for o in report["outputs"] if o["calibrated"]}
    assert {p["output"] for p in predictions} == fitted
    loo = az.loo(idata, pointwise=True)
    assert np.isfinite(loo.elpd_loo)
    return idata, report, predictions, loo


def check_given(results, design):
    """Sigma and f of tests/daemon/arviz_test.cpp's regression, from the files alone."""
    idata, _, _, _ = check_files(results)
    points = json.loads((results / "points.json").read_text())
    runs = pd.read_csv(design / "doe_outputs.csv")
    priors = pd.read_csv(design / "priors.csv").set_index("parameter")
    months = runs["month"].unique()
    inputs = pd.read_csv(design / "inputs.csv").set_index("month").loc[months]
    inputs = (inputs - inputs.min()) / (inputs.max() - inputs.min())
    x = inputs.loc[points["month"]].to_numpy()
    low = runs[points["output"]].min().to_numpy()
    size = runs[points["output"]].max().to_numpy() - low
    y = (np.array(points["y"]) - low) / size
    out = np.array([name.endswith("peak_kw") for name in points["output"]], dtype=float)
    distances = (x[:, None, :] - x[None, :, :]) ** 2
    other = (out[:, None] != out[None, :]).astype(float)

    def draws(name):
        return idata.posterior[name].to_numpy().ravel()

    def scaled(name):
        ends = priors.loc[name]
        return (draws(name) - ends["min"]) / (ends["max"] - ends["min"])

    air, set_point = scaled("air"), scaled("set_point")
    beta = np.stack([draws(f"beta_{name}") for name in inputs.columns], axis=1)
    beta_out = draws("beta_out")
    log_lik = flat(idata.log_likelihood["log_lik"].to_numpy())
    y_rep = flat(idata.posterior_predictive["y_rep"].to_numpy())
    z = np.empty_like(y_rep)
    dry_bulb = x[:, list(inputs.columns).index("drybulb")]
    for s in range(len(air)):
        f = 0.1 + 0.5 * dry_bulb + 0.05 * out + 0.2 * air[s] + 0.3 * air[s] * dry_bulb
        residual = y - f + 0.1 * set_point[s]
        sigma = np.exp(-distances @ beta[s] - beta_out[s] * other) / draws("lambda_delta")[s]
        precision = np.linalg.inv(sigma + np.eye(len(y)) / draws("lambda_eps")[s])
        sd = 1.0 / np.sqrt(np.diag(precision))
        surprise = (precision @ residual) * sd
        expected = -0.5 * surprise**2 - np.log(sd * size) - 0.5 * np.log(2.0 * np.pi)
        assert np.allclose(log_lik[s], expected, atol=1e-4), (s, log_lik[s] - expected)
        z[s] = ((y_rep[s] - low) / size - (y - surprise * sd)) / sd
    assert abs(z.mean()) < 4.0 / np.sqrt(z.size), z.mean()
    assert abs(z.std() - 1.0) < 4.0 / np.sqrt(2.0 * z.size), z.std()


def check_forecasts(results, design):
    """One output: leaving out a point is leaving out its month."""
    idata, report, predictions, loo = check_files(results)
    runs = pd.read_csv(design / "doe_outputs.csv")[predictions[0]["output"]]
    own = next(s for s in report["leave_out"] if s["months_left_out_together"] == 1)
    per_unit = own["elpd"] - len(predictions) * np.log(runs.max() - runs.min())
    print(f"elpd {loo.elpd_loo:.3f} of ArviZ, {per_unit:.3f} of recald; se {loo.se:.3f}")
    assert abs(loo.elpd_loo - per_unit) < 0.3
    log_lik = idata.log_likelihood["log_lik"].stack(sample=("chain", "draw"))
    y_rep = flat(idata.posterior_predictive["y_rep"].to_numpy())
    log_weights, _ = az.psislw(-log_lik.to_numpy())
    for p, month in enumerate(predictions):
        weights = np.exp(log_weights[p])
        mean = weights @ y_rep[:, p]
        sd = np.sqrt(weights @ (y_rep[:, p] - mean) ** 2)
        inside = weights @ ((month["q05"] <= y_rep[:, p]) & (y_rep[:, p] <= month["q95"]))
        print(f"{month['month']}: mean {mean:.1f}, {month['mean']:.1f}; sd {sd:.1f}; {inside:.3f}")
        assert abs(mean - month["mean"]) < 0.15 * sd, month["month"]
        # recald widens or narrows its bands by what the other months have shown.
        assert 0.75 < inside < 0.98, month["month"]


def check_scatter(results):
    """The range of the output shifts all points alike, so their scatter tells as much."""
    _, report, _, loo = check_files(results)
    own = next(s for s in report["leave_out"] if s["months_left_out_together"] == 1)
    print(f"se {loo.se:.3f} of ArviZ, {own['se']:.3f} of recald")
    assert abs(loo.se - own["se"]) < 0.1 * own["se"]


if __name__ == "__main__":
    checks = {
        "files": check_files,
        "given": check_given,
        "forecasts": check_forecasts,
        "scatter": check_scatter,
    }
    checks[sys.argv[1]](*[Path(argument) for argument in sys.argv[2:]])
