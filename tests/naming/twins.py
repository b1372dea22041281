"""What an effect really changes, beside what the model expects of it.

    twins.py OWN_TABLES:OWN_ANSWERS[,…] ENERGYPLUS_TABLES:ENERGYPLUS_ANSWERS[,…]

For each case that has a twin: the size of the true change in the metric of the null, the misfit with and without it, how
alike the best shape of its own kind is, and which kinds' shapes are most alike. 1 is the same direction.
"""
import pathlib
import sys

import numpy as np

import evidence as ev


def print_case(case, null):
    left, changes, times_inverse = null.whitener(case)
    true = (case.true_change / null.spread)[case.measured]
    white = times_inverse(true[None])[0]
    size, misfit = float(true @ white), float(left @ times_inverse(left[None])[0])
    rest = misfit - 2.0 * float(left @ white) + size
    across = np.einsum("ij,ij->i", changes, times_inverse(changes))
    alike = changes @ white / np.sqrt(across * size + 1e-9)
    best = {}
    for effect, value in zip(case.effects, np.where(np.isin(case.effects, list(ev.TWO_SIDED)), np.abs(alike), alike)):
        best[effect] = max(best.get(effect, -1.0), value)
    most = sorted(best, key=lambda effect: -best[effect])[:3]
    print(f"{case.hidden[0]:28s} {case.name:28s} share {case.share:.3f} size {size:8.1f} misfit {misfit / left.size:5.2f} "
          f"without it {rest / left.size:5.2f} own shape {best.get(case.hidden[0], np.nan):5.2f} most alike "
          + ", ".join(f"{effect} {best[effect]:.2f}" for effect in most))


def main():
    cases = [case for world, argument in zip(("own", "energyplus"), sys.argv[1:]) for pair in argument.split(",")
             for case in ev.load(pathlib.Path(pair.split(":")[0]), world, pair.split(":")[1])]
    cases = [case for case in cases if not case.answer["decoys"]]
    null = ev.Null([case for case in cases if not case.hidden])
    for case in sorted((case for case in cases if len(case.hidden) == 1 and case.true_change is not None),
                       key=lambda case: (case.hidden[0], case.name)):
        print_case(case, null)


if __name__ == "__main__":
    main()
