"""What the signatures of a case say for each possible effect, beside buildings with nothing hidden.

A table (see signature_table_main.cpp) holds the signatures of the meters, of the fitted model, and how parameters and
effects change them. What the meters show beyond the drawings is r = J u + a e + n: parameters u move within their priors,
an effect e has an amount a, and n is what buildings with nothing hidden leave unexplained. So an effect is judged by how far
a e shortens r in the metric of n and of all that the parameters could do.
"""
import json
import pathlib
import warnings

import numpy as np
from scipy.linalg import cho_factor, cho_solve

# Of typical amounts, with a log-normal prior; both signs where an effect may add or take away and its table has only what
# it adds.
AMOUNTS = np.array([0.12, 0.25, 0.5, 0.8, 1.2, 1.8, 2.6, 4.0])
AMOUNT_PRIOR = -0.5 * (np.log(AMOUNTS) / 0.9) ** 2
AMOUNT_PRIOR -= np.log(np.exp(AMOUNT_PRIOR).sum())
TWO_SIDED = {"scale_fault", "plug_growth", "equipment_step", "outdoor_air_amount", "solar_gain_change", "thermal_mass",
             "hybrid_work"}
# Signatures repeat each other: so many are free.
FREE = 100.0
NU = 10.0
MOST = 15.0  # deviations; what is farther off says no more


class Case:
    """A table and, where known, its answer. Residuals are NaN where the site has no such signature."""

    def __init__(self, stem, world, answer=None):
        table = json.loads(pathlib.Path(f"{stem}.json").read_text())
        count, q, shapes = table["signatures"], len(table["parameters"]), len(table["shapes"])
        rows = np.fromfile(f"{stem}.f32", dtype="<f4").astype(float)
        twin = table.get("twin", False)
        if rows.size != count * (3 + q + shapes + twin):
            raise ValueError(f"{stem}.f32 is torn; delete it and its .json and make it again")
        rows = rows.reshape(-1, count)
        self.name, self.world, self.answer = pathlib.Path(stem).name, world, answer
        self.measured = np.isfinite(rows[0]) & np.isfinite(rows[2])
        self.residual = np.where(self.measured, rows[0] - rows[2], np.nan)
        self.scores = np.array([p["score"] for p in table["parameters"]])
        self.parameters = [p["name"] for p in table["parameters"]]
        self.effects = np.array([shape["effect"].replace("@", "").split(":")[0] for shape in table["shapes"]])
        self.jacobian = np.nan_to_num(rows[3:3 + q].T)
        self.change = np.where(self.measured, np.nan_to_num(rows[3 + q:3 + q + shapes]), 0.0).astype(np.float32)
        self.true_change = np.where(self.measured, np.nan_to_num(rows[0] - rows[-1]), 0.0) if twin else None

    @property
    def hidden(self):
        return [effect["effect"] for effect in self.answer["effects"]]

    @property
    def share(self):
        """Of the meter moved most, by the strongest effect."""
        return max((value for effect in self.answer["effects"] for value in effect["moved_share"].values() if value is not None),
                   default=0.0)


def load(folder, world, answers):
    """All cases of a folder of tables."""
    folder = pathlib.Path(folder)
    cases = []
    for file in sorted(folder.glob("*.json")):
        if file.stem == "names":
            continue
        answer = json.loads((pathlib.Path(answers) / f"{file.stem}.json").read_text())
        cases.append(Case(file.with_suffix(""), world, answer))
    return cases


class Null:
    """Mean squares and covariance of what buildings with nothing hidden leave, every world counting alike.

    K = w I + (1 - w) Z'Z / N + (J S)(J S)' in units of the mean squares; S: how far
    parameters go from their priors' middle where nothing is hidden, in scores; at least a half, one where that is unknown."""

    def __init__(self, cases, own_share=0.2):
        self.own_share = own_share
        worlds = sorted({case.world for case in cases})
        of_world = [[case for case in cases if case.world == world] for world in worlds]
        self.spread = np.sqrt(averaged([mean_squares([case.residual for case in group]) for group in of_world]) + 0.01**2)
        self.score_spread = self.spread_of_scores(of_world)
        self.rows = np.array([self.row(case) for case in cases])
        self.rows /= np.maximum([np.sqrt(np.mean(row[case.measured] ** 2)) for row, case in zip(self.rows, cases)], 0.3)[:, None]
        self.weight = np.array([1.0 / len(of_world[worlds.index(case.world)]) for case in cases])

    @staticmethod
    def spread_of_scores(of_world):
        names = sorted({name for group in of_world for case in group for name in case.parameters})
        spread = {}
        for name in names:
            of = [[case.scores[case.parameters.index(name)] for case in group if name in case.parameters] for group in of_world]
            squares = [np.mean(np.square(scores)) for scores in of if len(scores) >= 5]
            spread[name] = np.sqrt(np.mean(squares)) if squares else 1.0
        return spread

    def row(self, case):
        return np.nan_to_num(np.clip(case.residual / self.spread, -MOST, MOST))

    def whitener(self, case):
        """The case's r, its changes, and the product of K^-1 with rows of them (Woodbury)."""
        there = case.measured
        weight = self.weight / self.weight.sum()
        factor = (self.rows[:, there] * np.sqrt(weight * (1.0 - self.own_share))[:, None]).T
        slopes = (case.jacobian / self.spread[:, None])[there]
        reach = np.array([max(self.score_spread.get(name, 1.0), 0.5) for name in case.parameters])
        factor = np.hstack([factor, slopes * reach])
        inner = cho_factor(self.own_share * np.eye(factor.shape[1]) + factor.T @ factor)
        left = self.row(case)[there] + slopes @ case.scores
        changes = (case.change / self.spread)[:, there]
        return left, changes, lambda rows: (rows - cho_solve(inner, (rows @ factor).T).T @ factor.T) / self.own_share


def mean_squares(rows):
    """By column, outliers at three deviations; NaN where fewer than five buildings have it."""
    rows = np.array(rows)
    seen = np.isfinite(rows).sum(axis=0)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # where no building has it
        typical = 1.4826 * np.nanmedian(np.abs(rows), axis=0) + 1e-3
        squares = np.nanmean(np.clip(rows, -3.0 * typical, 3.0 * typical) ** 2, axis=0)
    return np.where(seen >= 5, squares, np.nan)


def averaged(of_worlds):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)
        mean = np.nanmean(np.array(of_worlds), axis=0)
        return np.where(np.isfinite(mean), mean, np.nanmedian(mean))


def evidence(case, null):
    """For each effect that the case could have: its features in order of FEATURES. Also the features of the case alone."""
    left, changes, times_inverse = null.whitener(case)
    white = times_inverse(left[None])[0]
    misfit = float(left @ white)
    count = left.size
    along = changes @ white
    across = np.einsum("ij,ij->i", changes, times_inverse(changes))
    amounts = AMOUNTS[:, None]

    def gain_of(sign):
        after = np.maximum(misfit - 2.0 * sign * amounts * along + amounts**2 * across, 1e-6)
        log_ratio = 0.5 * (FREE + NU) * (np.log(NU + FREE * misfit / count) - np.log(NU + FREE * after / count))
        return np.logaddexp.reduce(log_ratio + AMOUNT_PRIOR[:, None], axis=0)

    gains = gain_of(1.0)
    both = np.isin(case.effects, list(TWO_SIDED))
    gains = np.where(both, np.logaddexp(gains, gain_of(-1.0)) - np.log(2.0), gains)
    visible = across > 1e-3
    inflated = max(misfit / count, 0.2)
    features, strongest = {}, 0.1
    for effect in dict.fromkeys(case.effects):
        shapes = np.flatnonzero((case.effects == effect) & visible)
        if shapes.size == 0:
            continue
        best = shapes[np.argmax(gains[shapes])]
        # One that only adds must not be praised for what it would explain by taking away.
        seen = abs(along[best]) if effect in TWO_SIDED else max(along[best], 0.0)
        gain = 0.5 * seen**2 / max(across[best], 1e-9)
        strongest = max(strongest, gain / inflated)
        log_mean = np.logaddexp.reduce(gains[shapes]) - np.log(shapes.size)
        size = max(seen / max(across[best], 1e-9), 1e-3)
        features[effect] = np.array([
            np.clip(log_mean, -10.0, 150.0) / 20.0,
            np.sqrt(max(log_mean, 0.0)) / 3.0,
            seen / np.sqrt(max(across[best] * misfit, 1e-9)),
            2.0 * gain / max(misfit, 1e-9),
            float(along[best] < 0.0 and effect not in TWO_SIDED),
            max(np.log(size / 2.5), 0.0),
            max(np.log(0.3 / size), 0.0),
            0.5 * np.log1p(np.sqrt(across[best] / inflated)),
        ])
    return features, np.array([1.0, np.log(inflated), 0.5 * np.log(strongest) - 1.0])


FEATURES = ["log mean gain", "its root", "likeness", "share explained", "wrong sign", "too much", "too little", "visibility"]
