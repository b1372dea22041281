"""Runs `recald init` and `recald replay` on an export and compares what comes out with the truth.

An outcome is one of CLASSES. What an export does not settle has to be refused with the true reason; everything else has to come out
right. Reasons and warnings are recognised by words, so their wording is free as long as it names the thing.
"""
import calendar
import csv
import dataclasses
import pathlib
import re
import subprocess
import tomllib

from generate import write_files

CLASSES = ["right", "refused, true reason", "refused, false reason", "refused though settled", "wrong but told",
           "wrong without a word"]
UNUSABLE = ", marked as not to be used"
OTHER_CLOCK = ", by another clock"
NO_METER = ": is no meter of the export"

# What a refusal must speak of.
TRUE_REASONS = {
    "unit": r"--unit|\b(which|what|no|the|its|a) unit\b|kWh or ",
    "date order": r"dd/mm|mm/dd|day first|month first|days? (or|and|before) (the )?months?|order of (day|date)",
    "rows": r"twice|tells? .*apart|which meter|same (time|stamp)|more than once|duplicate",
    "clock": r"\bclock\b|time ?zone|\bzone\b",
}
# What a warning must speak of to tell of what is wrong in an export with this trait.
WARNINGS = {
    "register exchanged": r"exchang|replace|new meter|jump",
    "register wraps": r"wrap|overflow|modulus|roll",
    "register zeroed daily": r"set to zero|reset|zeroed|midnight",
    "register zeroed monthly": r"set to zero|reset|zeroed|each month",
    "at rest for hours": r"exactly zero",
    "quality flags": r"flag|status|quality",
    "zero flagged as missing": r"flag|status|quality|exactly zero",
    "downloads overlap": r"overlap|twice",
    "later file corrects": r"overlap|correct|differ",
    "interval changes": r"interval (changes|of)|intervals? differ",
    "days before hours": r"daily|a day each|interval (changes|of)",
    "skipped hour written": r"clock|time ?zone|skipped hour",
    "doubled hour summed": r"clock|doubled hour|twice",
    "winter time all year": r"clock|time ?zone",
    "a car is charged": r"beyond|above|rated|peak",
    "gas": r"calorific|volume of gas",
}


@dataclasses.dataclass
class Outcome:
    kind: str
    result: str             # one of CLASSES
    problems: list
    answered: str = ""      # of a refusal that named an option: what came of it


def run(command):
    try:
        done = subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=300)
    except subprocess.TimeoutExpired:
        return 1, "", "no answer in 300 s"
    return done.returncode, done.stdout, done.stderr


def words_of(text):
    plain = text.lower()
    for umlaut, letters in (("ä", "ae"), ("ö", "oe"), ("ü", "ue"), ("ß", "ss"), ("å", "aa"), ("ø", "oe"), ("æ", "ae"),
                            ("é", "e"), ("è", "e"), ("í", "i"), ("ó", "o"), ("ã", "a"), ("ç", "c"), ("ł", "l"), ("ż", "z")):
        plain = plain.replace(umlaut, letters)
    return set(re.findall(r"[a-z0-9]+", plain)) - {"kwh", "kw", "wh", "w", "mwh", "mw"}


def likeness(labels, meter):
    texts = [str(meter.get(key, "")) for key in ("column", "name_in_file")]
    if isinstance(meter.get("file"), str):
        texts.append(pathlib.PurePath(meter["file"]).stem)
    found = words_of(" ".join([re.sub(r"-\d+$", "", meter["id"]), *texts]))  # main-2 is the second that is called so
    return max(len(words_of(label) & found) / max(1, len(words_of(label))) for label in labels)


def read_months(file):
    """meter -> month -> row, its value as an energy of the month."""
    months = {}
    with open(file, encoding="utf-8") as lines:
        for row in csv.DictReader(lines):
            year, month = map(int, row["month"].split("-"))
            row["energy"] = float(row["value"]) * calendar.monthrange(year, month)[1] if row["value"] else None
            months.setdefault(row["meter"], {})[row["month"]] = row
    return months


def peak_problem(month, load, row, factor):
    """A peak that the load has not, or not then: a clock beside the truth, or two hours in one."""
    block = re.fullmatch(r"block-(\d+)s", row["method"] or "")
    if not block or not row["peak_kW"]:
        return None
    seconds, claimed = int(block[1]), float(row["peak_kW"])
    at = calendar.timegm(tuple(map(int, re.findall(r"\d+", row["peak_at"])[:6])) + (0, 0, 0))
    then = load.block(at, seconds) if seconds % load.step == 0 else None
    if then is None or claimed == 0:
        return None
    then, highest = then * factor, load.peak(month.begin, month.end, seconds) * factor
    # An export that estimates an interval need not have what it drew; the share that it estimates is told.
    is_estimated = float(row.get("estimated_share") or 0) > 0 and claimed < highest
    if abs(claimed - highest) > 0.02 * highest + 0.02 and not is_estimated:
        return f"{month.name}: peak {claimed:.2f} kW, truth {highest:.2f}"
    if abs(then - claimed) > 0.03 * claimed + 0.02:
        return f"{month.name}: peak at {row['peak_at']}, when the truth is {then:.2f} of {claimed:.2f} kW" + OTHER_CLOCK
    return None


def month_problem(truth, month, row, factor):
    # A month that lies half in a gap need not be filled.
    if row is None or row["energy"] is None:
        return f"{month.name}: no figure" if month.is_asked_for and month.missing_share < 0.1 else None
    expected = month.energy * factor
    allowed = 0.001 * abs(expected) + truth.slack_kWh + 0.02
    allowed += max(month.missing_energy, month.missing_share * month.energy) * factor
    if month.missing_share:  # what is filled says how far off it may be
        allowed += 2 * float(row.get("value_sd") or 0) * calendar.monthrange(*map(int, month.name.split("-")))[1]
    if abs(row["energy"] - expected) > allowed:
        return f"{month.name}: {row['energy']:.2f} kWh, truth {expected:.2f}" + (UNUSABLE if row["usable"] == "no" else "")
    if month.missing_share < 0.02 and row["usable"] == "no" and month.is_asked_for:
        return f"{month.name}: right" + UNUSABLE
    if month.missing_share and float(row["coverage"]) > 1 - 0.5 * month.missing_share:
        return f"{month.name}: measured {float(row['coverage']):.2%}, truth {1 - month.missing_share:.2%}"
    if truth.has_shape and not month.missing_share:
        return peak_problem(month, truth.load, row, factor)
    return None


def meter_problems(truth, zone, meter, rows):
    factor = 1.0
    if truth.is_volume:
        factor = meter.get("gas_kWh_per_m3", 0)
        if not 8 <= factor <= 13:
            return [f"{meter['id']}: {factor} kWh per m3 of gas"]
    problems = [f"{meter['id']}: {problem}" for month in truth.months(zone)
                if (problem := month_problem(truth, month, rows.get(month.name), factor))]
    if meter.get("utility") not in truth.utilities:
        problems.append(f"{meter['id']}: utility {meter.get('utility')}, truth {'/'.join(truth.utilities)}")
    return problems


def compare(truths, zone, meters, months):
    """Pairs meters with truths, the most alike by name first, among equals by figures; what is wrong then."""
    pairs = []
    for truth in truths:
        for meter in meters:
            problems = meter_problems(truth, zone, meter, months.get(meter["id"], {}))
            pairs.append((-likeness(truth.labels, meter), len(problems), len(pairs), truth, meter, problems))
    problems, found, taken = [], [], []
    for _, _, _, truth, meter, wrong in sorted(pairs, key=lambda pair: pair[:3]):
        if any(truth is other for other in found) or any(meter is other for other in taken):
            continue
        if not truth.required and wrong:
            continue
        found.append(truth)
        taken.append(meter)
        problems += wrong
    for truth in truths:
        if truth.required and not any(truth is other for other in found):
            problems.append(f"{truth.labels[0]}: no such meter")
    for meter in meters:
        # Volumes of water have no energy; one that is named so takes nothing from the others.
        if not any(meter is other for other in taken) and meter.get("utility") != "water":
            problems.append(meter["id"] + NO_METER)
    return problems


def judge(export, folder, recald):
    """Writes the export to the folder, runs recald there, and says what came of it."""
    write_files(export, folder)
    code, spoken, refusal = init(export, folder, recald, [])
    if code:
        return judge_refusal(export, folder, recald, refusal.strip().replace(str(folder) + "/", ""))
    problems, warnings = figures(export, folder, recald)
    warnings += refusal + spoken.partition("Look at these")[2].partition("Wrote ")[0]
    (folder / "warnings.txt").write_text(warnings)
    if export.undecided:
        told = re.search(TRUE_REASONS[export.undecided] + "|taken to be in", warnings, re.IGNORECASE)
        return Outcome(export.kind, "wrong but told" if told else "wrong without a word", [f"nothing settles: {export.undecided}"])
    if not problems:
        return Outcome(export.kind, "right", [])
    told = all(is_told(problem, export.traits, warnings) for problem in problems)
    return Outcome(export.kind, "wrong but told" if told else "wrong without a word", problems)


def is_told(problem, traits, warnings):
    """A warning names the meter and the thing, or the month is marked as not to be used."""
    subject = problem.partition(":")[0]
    about = "\n".join(line.replace(subject, "") for line in warnings.splitlines() if subject in line)
    if problem.endswith(NO_METER):
        words = [r"no meter\b|no energy|\bcost\b|\bprice\b|same load"]
    elif ": utility" in problem:
        words = [r"utility|taken for"]
    elif problem.endswith(OTHER_CLOCK):
        words = [r"\bclock\b|time ?zone|stamps are taken"]
    elif ": peak " in problem and re.search("than the peak|peak may be", about):
        return True
    else:
        words = [r"taken to be in|\bunit\b"] + [WARNINGS[trait] for trait in traits if trait in WARNINGS]
    return problem.endswith(UNUSABLE) or any(re.search(word, about, re.IGNORECASE) for word in words)


def init(export, folder, recald, options):
    return run([recald, "init", *[str(folder / name) for name in export.files], "--timezone", export.zone, *options, "--out",
                str(folder / "site")])


def figures(export, folder, recald):
    """What is wrong with them, and the warnings of replay."""
    code, spoken, errors = run([recald, "replay", str(folder / "site/site.toml"), "--out", str(folder / "results")])
    warnings = "\n".join(line for line in errors.splitlines() if line.startswith("!")) + "\n"
    if code:
        return [f"replay: {errors.strip()[-300:]}"], warnings
    meters = tomllib.loads((folder / "site/site.toml").read_text())["meter"]
    months = read_months(folder / "results/months.csv")
    return min((compare(truths, export.zone, meters, months) for truths in export.truths), key=len), warnings


def judge_refusal(export, folder, recald, refusal):
    if not export.undecided:
        return Outcome(export.kind, "refused though settled", [refusal])
    if not re.search(TRUE_REASONS[export.undecided], refusal, re.IGNORECASE):
        return Outcome(export.kind, "refused, false reason", [refusal])
    named = [option for option in export.answers if option in refusal]
    answered = ""
    if named:
        options = [part for option in named for part in (option, export.answers[option])]
        code, _, errors = init(export, folder, recald, options)
        problems = [errors.strip()] if code else figures(export, folder, recald)[0]
        answered = "; ".join(problems) or "right"
    return Outcome(export.kind, "refused, true reason", [refusal], answered)
