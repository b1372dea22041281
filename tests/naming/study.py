"""Names by signatures, learnt in one world and judged in the other.

    study.py OWN_TABLES:OWN_ANSWERS[,…] ENERGYPLUS_TABLES:ENERGYPLUS_ANSWERS[,…]

The tables hold the evidence for each possible effect (signature_table --null). A conditional logit over the possible
effects, none and unknown weighs it with a few weights that all effects share. P(none) is a half before any evidence. Printed
for each world: which of the effects comes first (none and unknown do not take part in that), and what is named at P >= 0.5,
by the strength of what is hidden.
"""
import collections
import pathlib
import sys

import numpy as np
from scipy.optimize import minimize

import cases as tables

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "long"))
from binomial import binomial  # noqa: E402

PENALTY = 1.0
BINS = ((0.1, "above 10 %"), (0.03, "3 to 10 %"), (0.01, "1 to 3 %"), (0.0, "below 1 %"))
# As core/diagnosis/naming/signature_names.hpp has them.
FEATURES = ["log gain", "its root", "root of share explained", "share explained", "wrong sign", "too much", "too little",
            "visibility", "behind the best"]


class Judged:
    """A case as the logit sees it: features of its possible effects and of itself, and which answer is right."""

    def __init__(self, case):
        self.case = case
        self.effects = [of["effect"] for of in case.table["effects"]]
        self.features = np.array([of["features"] for of in case.table["effects"]])
        self.itself = np.array(case.table["features"])
        hidden = case.hidden
        # Two at once, or one that nobody could name here, are unknown.
        self.right = "none" if not hidden else hidden[0] if len(hidden) == 1 and hidden[0] in self.effects else "unknown"

    @property
    def answers(self):
        return self.effects + ["none", "unknown"]


class Logit:
    def __init__(self, *worlds):
        """Learnt from lists of cases, each list counting alike."""
        judged, weight = [], []
        for cases in worlds:
            nothing = sum(j.right == "none" for j in cases)
            # Prior odds are stated, not learnt: as many with nothing hidden as with something.
            share = 0.5 * sum(map(len, worlds)) / len(worlds)
            weight += [share / max(nothing if j.right == "none" else len(cases) - nothing, 1) for j in cases]
            judged += cases
        shared, own = judged[0].features.shape[1], len(judged[0].itself)
        right = [j.answers.index(j.right) for j in judged]

        def loss(w):
            total, slope = 0.5 * PENALTY * w @ w, PENALTY * w
            for j, r, v in zip(judged, right, weight):
                p = self.of(w, j)
                total -= v * np.log(p[r] + 1e-12)
                p[r] -= 1.0
                p *= v
                slope[:shared] += p[:-2] @ j.features
                slope[shared:shared + own] += p[-2] * j.itself
                slope[shared + own:] += p[-1] * j.itself
            return total, slope

        self.weights = minimize(loss, np.zeros(shared + 2 * own), jac=True, method="L-BFGS-B").x

    @staticmethod
    def of(w, j):
        shared, own = j.features.shape[1], len(j.itself)
        z = np.concatenate([j.features @ w[:shared], [w[shared:shared + own] @ j.itself, w[shared + own:] @ j.itself]])
        p = np.exp(z - z.max())
        return p / p.sum()

    def probabilities(self, j):
        return dict(zip(j.answers, self.of(self.weights, j)))


def judged_of(world, folders):
    """Those whose meters signatures know."""
    return [Judged(case) for case in tables.load(world, folders) if case.table["effects"]]


def bin_of(j):
    effects = j.case.answer["effects"]
    if not effects:
        return "nothing hidden"
    if len(effects) > 1 or not effects[0]["in_catalogue"]:
        return "unknown"
    return next(name for least, name in BINS if j.case.share >= least)


def report(title, rows):
    """@param rows  (judged, probabilities)"""
    counts = collections.defaultdict(collections.Counter)
    for j, p in rows:
        effects = sorted(j.effects, key=lambda effect: -p[effect])
        of = counts[bin_of(j)]
        of["cases"] += 1
        of["first"] += effects[0] == j.right
        of["in three"] += j.right in effects[:3]
        named = p[effects[0]] >= 0.5
        of["right"] += named and effects[0] == j.right
        of["wrong"] += named and effects[0] != j.right
        of["loss"] -= np.log(p[j.right] + 1e-9)
    print(title)
    for name in [name for _, name in BINS] + ["unknown", "nothing hidden"]:
        of = counts[name]
        n = of["cases"]
        if n:
            print(f"  {name:15s} first {binomial(of['first'], n):24s} in three {binomial(of['in three'], n):24s} named right "
                  f"{binomial(of['right'], n):24s} wrong or false {binomial(of['wrong'], n):24s} log loss {of['loss'] / n:.2f}")


def main():
    worlds = {world: judged_of(world, folders) for world, folders in zip(("own", "energyplus"), sys.argv[1:])}
    for world, judged in worlds.items():
        # The null is of both worlds, without the case; the weights are the other world's alone.
        learnt = Logit(next(others for name, others in worlds.items() if name != world))
        for population in sorted({j.case.name.split("-")[0] for j in judged}):
            report(f"{world}, {population}, weights learnt in the other world",
                   [(j, learnt.probabilities(j)) for j in judged if j.case.name.startswith(population)])
        print("  weights: " + ", ".join(f"{name} {value:.2f}" for name, value in zip(FEATURES, learnt.weights)))


if __name__ == "__main__":
    main()
