"""What signatures look like where nothing is hidden, from buildings of both worlds.

    null.py OUT OWN_TABLES:OWN_ANSWERS[:twins][,…] ENERGYPLUS_TABLES:ENERGYPLUS_ANSWERS[:twins][,…]

Every world counts alike. In units of the spread, rows R of what models leave have the covariance own I + R'R.
"""
import json
import pathlib
import sys
import warnings

import numpy as np

import cases as tables

OWN = 0.2  # Of each signature's variance: what it does not share with others.
LEAST_SPREAD = 0.01
MOST = 15.0  # Spreads; what is farther off says no more.
LEAST_SIZE = 0.3  # Root mean square of a row; others are divided by theirs, so that no building rules.
FEWEST = 5  # Buildings of a world that can tell of it.
# Of the mean scores of parameters: they are not known well.
OF_CENTRE = 0.8


def mean_squares(rows):
    """By column, outliers at three deviations; NaN where too few buildings have it."""
    seen = np.isfinite(rows).sum(axis=0)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # where no building has it
        typical = 1.4826 * np.nanmedian(np.abs(rows), axis=0) + 1e-3
        squares = np.nanmean(np.clip(rows, -3.0 * typical, 3.0 * typical) ** 2, axis=0)
    return np.where(seen >= FEWEST, squares, np.nan)


def averaged(of_worlds):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)
        mean = np.nanmean(np.array(of_worlds), axis=0)
        return np.where(np.isfinite(mean), mean, np.nanmedian(mean))


def scores_of(worlds):
    """Mean and standard deviation of the scores of each parameter."""
    names = sorted({name for cases in worlds for case in cases for name in case.table["scores"]})
    centre, reach = {}, {}
    for name in names:
        of = [[case.table["scores"][name] for case in cases if name in case.table["scores"]] for cases in worlds]
        of = [scores for scores in of if len(scores) >= FEWEST]
        if of:
            centre[name] = OF_CENTRE * float(np.mean([np.mean(scores) for scores in of]))
            squares = np.mean([np.mean(np.square(scores)) for scores in of])
            reach[name] = float(np.sqrt(max(squares - centre[name] ** 2, 0.01)))
    return centre, reach


def main():
    out, *arguments = sys.argv[1:]
    worlds = [[case for case in tables.load(world, folders) if not case.hidden]
              for world, folders in zip(("own", "energyplus"), arguments)]
    left = {case: np.array(case.table["left"], dtype=float) for cases in worlds for case in cases}
    spread = np.sqrt(averaged([mean_squares(np.array([left[case] for case in cases])) for cases in worlds]) + LEAST_SPREAD**2)
    rows = []
    for cases in worlds:
        for case in cases:
            row = np.clip(left[case] / spread, -MOST, MOST)
            size = max(np.sqrt(np.nanmean(row**2)), LEAST_SIZE)
            factor = np.sqrt((1.0 - OWN) / len(worlds) / len(cases)) / size
            rows.append({"name": case.name, "values": [float(f"{x:.4g}") for x in np.nan_to_num(factor * row)]})
    centre, reach = scores_of(worlds)
    null = {"spread": [float(f"{x:.4g}") for x in spread], "own": OWN, "centre": centre, "reach": reach, "rows": rows}
    pathlib.Path(out).write_text(json.dumps(null))
    print(f"{out}: " + " and ".join(f"{len(cases)} buildings" for cases in worlds))


if __name__ == "__main__":
    main()
