"""Does a blind population's case tell what is hidden in it? See leak.sh."""

import collections
import json
import math
import pathlib
import random
import sys
import tomllib

FOLDS = 5
STUMPS = 40
PERMUTATIONS = 500


def flattened(value, path, features):
    """Numbers by their path; a list by its length and sum; words as flags."""
    if isinstance(value, bool):
        features[path] = float(value)
    elif isinstance(value, (int, float)):
        features[path] = float(value)
    elif isinstance(value, str):
        features[f"{path}={value}"] = 1.0
    elif isinstance(value, dict):
        for key, part in value.items():
            flattened(part, f"{path}.{key}", features)
    elif isinstance(value, list):
        features[f"{path}#"] = float(len(value))
        numbers = [part for part in value if isinstance(part, (int, float))]
        features[f"{path}+"] = float(sum(numbers))
        if not numbers:
            for part in value[:20]:
                name = part.get("name", part.get("id", "")) if isinstance(part, dict) else ""
                flattened(part, f"{path}[{name}]", features)


def features_of(case):
    """What can be seen of a case without opening its readings."""
    features = {}
    site = tomllib.loads((case / "site.toml").read_text())
    site["site"].pop("id", None)  # its number is its place in a shuffled order
    flattened(site, "site", features)
    for file in sorted(case.iterdir()):
        features[f"bytes {file.name}"] = float(file.stat().st_size)
        features[f"time {file.name}"] = file.stat().st_mtime
    return features


def best_stump(columns, labels, weights):
    """(error, feature, threshold, sign) of the best split."""
    best = (0.5, None, 0.0, 1)
    total = sum(weight for weight, label in zip(weights, labels) if label > 0)
    for feature, column in columns.items():
        order = sorted(range(len(labels)), key=column.__getitem__)
        error = total  # all said to be negative
        for k, i in enumerate(order):
            error += -weights[i] if labels[i] > 0 else weights[i]
            if k + 1 == len(order) or column[order[k + 1]] == column[i]:
                continue
            # The upper part is said to be negative, the lower positive, as `error` now counts; or the other way round.
            for sign, wrong in ((-1, error), (1, 1.0 - error)):
                if wrong < best[0] - 1e-12:
                    best = (wrong, feature, 0.5 * (column[i] + column[order[k + 1]]), sign)
    return best


def boosted(rows, labels, names):
    """Stumps by AdaBoost. @see Freund, Schapire (1997), J. Comput. Syst. Sci. 55(1)."""
    weights = [1.0 / len(rows)] * len(rows)
    columns = {name: [row.get(name, 0.0) for row in rows] for name in names}
    columns = {name: column for name, column in columns.items() if min(column) < max(column)}
    stumps = []
    for _ in range(STUMPS):
        error, feature, threshold, sign = best_stump(columns, labels, weights)
        if feature is None:
            break
        error = max(error, 1e-6)
        vote = 0.5 * math.log((1.0 - error) / error)
        stumps.append((feature, threshold, sign, vote))
        for i, row in enumerate(rows):
            says = sign if columns[feature][i] > threshold else -sign
            weights[i] *= math.exp(-vote * labels[i] * says)
        total = sum(weights)
        weights = [weight / total for weight in weights]
    return stumps


def score(stumps, row):
    return sum(vote * (sign if row.get(feature, 0.0) > threshold else -sign) for feature, threshold, sign, vote in stumps)


def area_under_curve(scores, labels):
    pairs = [(a, b) for a, la in zip(scores, labels) if la > 0 for b, lb in zip(scores, labels) if lb < 0]
    return sum(1.0 if a > b else 0.5 if a == b else 0.0 for a, b in pairs) / len(pairs)


def cross_validated(rows, labels):
    """Area under the curve of left-out folds, and its standard error (Hanley, McNeil 1982)."""
    names = sorted({name for row in rows for name in row})
    order = list(range(len(rows)))
    random.Random(1).shuffle(order)
    scores = [0.0] * len(rows)
    for fold in range(FOLDS):
        held = set(order[fold::FOLDS])
        stumps = boosted([row for i, row in enumerate(rows) if i not in held],
                         [label for i, label in enumerate(labels) if i not in held], names)
        for i in held:
            scores[i] = score(stumps, rows[i])
    area = area_under_curve(scores, labels)
    positive = sum(1 for label in labels if label > 0)
    negative = len(labels) - positive
    one, two = area / (2 - area), 2 * area * area / (1 + area)
    variance = (area * (1 - area) + (positive - 1) * (one - area**2) + (negative - 1) * (two - area**2)) / (positive * negative)
    return area, math.sqrt(max(variance, 1e-12))


def distance(a, b, spread):
    return sum(abs(a.get(name, 0.0) - b.get(name, 0.0)) / width for name, width in spread.items())


def neighbours_alike(rows, classes, strata):
    """How often the nearest case of the same use and plant hides the same class, and what chance gives."""
    names = {name for row in rows for name in row}
    spread = {}
    for name in names:
        column = [row.get(name, 0.0) for row in rows]
        mean = sum(column) / len(column)
        deviation = math.sqrt(sum((value - mean) ** 2 for value in column) / len(column))
        if deviation > 0.0:
            spread[name] = deviation
    groups = collections.defaultdict(list)
    for i, stratum in enumerate(strata):
        groups[stratum].append(i)
    nearest = {}
    for members in groups.values():
        for i in members:
            others = [j for j in members if j != i]
            if others:
                nearest[i] = min(others, key=lambda j: distance(rows[i], rows[j], spread))
    if not nearest:
        return None

    def share(labels):
        return sum(labels[i] == labels[j] for i, j in nearest.items()) / len(nearest)

    rng = random.Random(2)
    by_chance = []
    for _ in range(PERMUTATIONS):
        shuffled = list(classes)
        for members in groups.values():
            labels = [classes[i] for i in members]
            rng.shuffle(labels)
            for i, label in zip(members, labels):
                shuffled[i] = label
        by_chance.append(share(shuffled))
    by_chance.sort()
    seen = share(classes)
    above = sum(1 for value in by_chance if value >= seen)
    return seen, by_chance[len(by_chance) // 20], by_chance[-len(by_chance) // 20], (above + 1) / (PERMUTATIONS + 1), len(nearest)


def plant_of(answer, site):
    return (answer["use"], answer.get("shape", ""), answer.get("system", ""),
            "chiller_cop" in site.get("building", {}).get("cooling", {}), tuple(meter["utility"] for meter in site["meter"]))


def told_by_twins(population):
    """Whatever is written beside the readings must be what it is without the effect.

    The readings themselves may differ, and do."""
    twins = [twin for twin in sorted((population / "twins").glob("*")) if (population / "cases" / twin.name).is_dir()]

    def beside(folder):
        return {file.name: file.read_bytes() for file in folder.iterdir() if file.name != "readings.csv"}

    differ = [twin.name for twin in twins if beside(twin) != beside(population / "cases" / twin.name)]
    if twins:
        print(f"files beside the readings of {len(twins)} cases and their twins: "
              f"{f'LEAKS, {differ[0]} differs' if differ else 'the same, byte for byte'}")


def main():
    population = pathlib.Path(sys.argv[1])
    told_by_twins(population)
    answers = {}
    for file in sorted((population / "answers").glob("*.json")):
        answer = json.loads(file.read_text())
        if "case" in answer:
            answers[answer["case"]] = answer
    rows = {case: features_of(population / "cases" / case) for case in answers}
    cases = [case for case in answers if not answers[case]["decoys"]]
    labels = [1 if answers[case]["effects"] else -1 for case in cases]
    area, error = cross_validated([rows[case] for case in cases], labels)
    print(f"{len(cases)} cases, {sum(label > 0 for label in labels)} with something hidden")
    print(f"something or nothing: area under the curve {area:.3f}, 95 % {area - 1.96 * error:.3f} to {min(area + 1.96 * error, 1.0):.3f}; "
          f"chance 0.5: {'LEAKS' if area - 1.96 * error > 0.5 else 'no better than chance'}")
    single = [case for case in cases if len(answers[case]["effects"]) == 1]
    strata = [plant_of(answers[case], tomllib.loads((population / "cases" / case / "site.toml").read_text())) for case in single]
    found = neighbours_alike([rows[case] for case in single], [answers[case]["effects"][0]["class"] for case in single], strata)
    if found is None:
        print("kinds: no two cases of the same use and plant")
        return
    seen, low, high, p, count = found
    print(f"kinds, same use and plant: the nearest case hides the same class in {100 * seen:.0f} % of {count}, by chance "
          f"{100 * low:.0f} to {100 * high:.0f} % (p = {p:.2f}): {'LEAKS' if p < 0.05 else 'no better than chance'}")


if __name__ == "__main__":
    main()
