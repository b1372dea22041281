"""Files of the blind test: answers and their seal, results, cases. What is read is checked; a mistake is one sentence."""

import datetime
import fcntl
import hashlib
import json
import math
import os
import pathlib
import re

import jsonschema

NONE, UNKNOWN = "none", "unknown"
# Methods that do not answer for themselves: the refit with the true effect, a calibration, months followed.
ORACLE, CALIBRATE, DRIFT = "oracle", "calibrate", "drift"
SUM_TOLERANCE = 0.002  # Four written digits of forty probabilities.


class Refused(Exception):
    """What cannot be used, as a sentence."""


def competes(method):
    return method not in (ORACLE, CALIBRATE, DRIFT)


# Schemas. A name goes into tables and file names as it is.
NAME = {"type": "string", "pattern": r"^[A-Za-z0-9._-]+$"}
NAMES = {"type": "array", "items": NAME, "uniqueItems": True}
NUMBER = {"type": "number"}
POSITIVE = {"type": "number", "minimum": 0}
SHARE = {"type": "number", "minimum": 0, "maximum": 1}
TEXT = {"type": "string"}


def record(required, optional=None, others=True):
    return {
        "type": "object",
        "properties": required | (optional or {}),
        "required": list(required),
        "additionalProperties": others,
    }


def by_name(values):
    return {"type": "object", "propertyNames": NAME, "additionalProperties": values}


def or_null(schema):
    return {"anyOf": [schema, {"type": "null"}]}


DAY = or_null({"type": "string", "pattern": r"^\d{4}-\d{2}-\d{2}$"})
MONTH = {"type": "string", "pattern": r"^\d{4}-\d{2}$"}
SHARES = by_name(NUMBER)
ANSWER = record(
    {
        "case": NAME,
        "block": {"enum": ["no_effect", "single", "out_of_catalogue", "pair"]},
        "effects": {
            "type": "array",
            "items": record(
                {
                    "effect": NAME,
                    "class": NAME,
                    "in_catalogue": {"type": "boolean"},
                    "strength": NUMBER,
                    "unit": TEXT,
                    "from": DAY,
                    "to": DAY,
                    "share_of_meter": SHARES,
                },
                {"moved_share": or_null(SHARES)},
            ),
        },
        "decoys": NAMES,
        "climate": NAME,
        "use": NAME,
        "gaps": {"type": "boolean"},
        "true_parameters": SHARES,
        "prior_sd": SHARES,
    },
    {"world": {"enum": ["own", "energyplus"]}},
)
FITS = by_name(record({"log_score": NUMBER, "cvrmse": POSITIVE}))
POSTERIORS = by_name(record({"mean": NUMBER, "q05": NUMBER, "q95": NUMBER}))
ALARM = record(
    {"month": MONTH, "kind": {"enum": ["meter", "parameter", "use", "effect", "unknown", "nothing"]}, "subject": TEXT, "probability": SHARE}
)
EFFECTS = NAMES | {"items": NAME | {"not": {"enum": [NONE, UNKNOWN]}}}
RESULT = record(
    {"case": NAME, "method": NAME, "outcome": {"enum": ["named", "confusable", UNKNOWN, NONE]}, "named": EFFECTS},
    {
        key: or_null(schema)
        for key, schema in {
            "confusable": EFFECTS,
            "probabilities": by_name(SHARE),
            "gap": record({"before": FITS | {"minProperties": 1}, "after": FITS}, {"oracle": or_null(FITS)}),
            "other_meters_log_score_change": by_name(record({"mean": NUMBER, "se": POSITIVE})),
            "parameters_before": POSTERIORS,
            "parameters_after": POSTERIORS,
            "effect_parameter": record({"q05": NUMBER, "q95": NUMBER}, {"unit": or_null(TEXT)}),
            "calibration": by_name(record(dict.fromkeys(("before", "after", "forecast", "yardstick"), POSITIVE))),
            "drift": record({"from": MONTH, "to": MONTH, "alarms": {"type": "array", "items": ALARM}}),
            "located": {"type": "array", "items": record({"meter": NAME})},
            "wall_s": POSITIVE,
            "peak_rss_MB": POSITIVE,
            "version": TEXT,
            "extra": {"type": "object"},  # Free for whatever else a method wants to keep; never scored.
        }.items()
    },
    others=False,  # A misspelt key would be lost without a word.
)
CHECK_OF = {id(schema): jsonschema.Draft202012Validator(schema) for schema in (ANSWER, RESULT)}


def finite(text):
    if not math.isfinite(float(text)):  # NaN, Infinity, or beyond a double
        raise ValueError(text)
    return float(text)


def parsed(text, where):
    try:
        return json.loads(text, parse_constant=finite, parse_float=finite)
    except ValueError:
        raise Refused(f"{where}: not valid JSON") from None


def checked(value, schema, where):
    error = jsonschema.exceptions.best_match(CHECK_OF[id(schema)].iter_errors(value))
    if error is None:
        return value
    path = ".".join(str(step) for step in error.absolute_path)
    said = error.message if len(error.message) < 200 else error.message[:200] + "..."
    raise Refused(f"{where}: {path + ': ' if path else ''}{said}")


def read_text(file):
    try:
        return pathlib.Path(file).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise Refused(f"cannot read '{file}': {error}") from None


def write_text(file, text):
    """Whole or not at all, and on the disk."""
    part = pathlib.Path(f"{file}.part")
    try:
        with open(part, "w", encoding="utf-8") as stream:
            stream.write(text)
            stream.flush()
            os.fsync(stream.fileno())
        part.replace(file)
    except OSError as error:
        raise Refused(f"cannot write '{file}': {error.strerror}") from None


def names_in(folder):
    try:
        return sorted(entry.name for entry in pathlib.Path(folder).iterdir())
    except OSError as error:
        raise Refused(f"cannot list the folder '{folder}': {error.strerror}") from None


# Answers.


def broken_promise(answer):
    """What a block promises of its effects; empty where it is kept."""
    effects = answer["effects"]
    known = sum(effect["in_catalogue"] for effect in effects)
    differ = len({effect["effect"] for effect in effects}) == len(effects)
    kept, promise = {
        "no_effect": (not effects, "it must hide none"),
        "single": (len(effects) == 1 == known, "it must hide one of the catalogue"),
        "pair": (len(effects) == 2 == known and differ, "it must hide two different ones of the catalogue"),
        "out_of_catalogue": (known == 0 and bool(effects or answer["decoys"]), "it must hide none of the catalogue, and one or a decoy"),
    }[answer["block"]]
    return "" if kept else f"block '{answer['block']}' with {len(effects)} effects, {known} of them in the catalogue; {promise}"


def parse_answer(text, name):
    """The answer of the case of that name."""
    where = f"answer {name}"
    answer = checked(parsed(text, where), ANSWER, where)
    if answer["case"] != name:
        raise Refused(f"{where}: 'case' is '{answer['case']}', must be the file's name")
    answer.setdefault("world", "own")
    truths, sds = answer["true_parameters"], answer["prior_sd"]
    # What a building has none of, and whose drawings say so, is nothing to find: a house without ventilation.
    for absent in [p for p in sds if sds[p] == 0 and truths.get(p) == 0]:
        del truths[absent], sds[absent]
    if truths.keys() != sds.keys():
        raise Refused(f"{where}: 'true_parameters' and 'prior_sd' differ in {', '.join(sorted(truths.keys() ^ sds.keys()))}")
    for parameter, sd in sds.items():
        if not sd > 0:
            raise Refused(f"{where}: 'prior_sd.{parameter}' is {sd:g}, must be positive")
    if broken := broken_promise(answer):
        raise Refused(f"{where}: {broken}")
    return answer


def answer_files(folder):
    names = [name for name in names_in(folder) if name.endswith(".json") and name != "opened.json"]
    if not names:
        raise Refused(f"no answers (<case>.json) in '{folder}'")
    return names


def read_answers(folder):
    """By case, in the order of their names."""
    files = [pathlib.Path(folder) / name for name in answer_files(folder)]
    return {file.stem: parse_answer(read_text(file), file.stem) for file in files}


def moved(effect):
    """Meter -> what is moved of it. What takes and gives back within the day has no net share to judge it by."""
    return {meter: abs(share) for meter, share in (effect.get("moved_share") or effect["share_of_meter"]).items()}


def most_affected_meter(effects):
    total = {}
    for effect in effects:
        for meter, share in moved(effect).items():
            total[meter] = total.get(meter, 0.0) + share
    most = max(sorted(total), key=total.get, default="")
    return most if total.get(most, 0.0) > 0 else ""


def largest_share(effects):
    """What is moved of the meter that is moved most; of two effects, by the weaker one."""
    return min((max(moved(effect).values(), default=0.0) for effect in effects), default=0.0)


def write_handed_in(truth, world, catalogue, folder):
    """Answers of cases that others wrote, from one truth.json for all. @return how many."""
    cases = parsed(read_text(truth), truth)
    if not isinstance(cases, dict) or not cases:
        raise Refused(f"{truth} names no case")
    answers = {}
    for name, case in cases.items():
        where = f"{truth}, case {name}"
        try:
            effects = [
                {"effect": effect, "class": catalogue.get(effect, "outside_catalogue"), "in_catalogue": effect in catalogue,
                 "strength": of["strength"], "unit": of["unit"], "from": of.get("from"), "to": of.get("to"),
                 "share_of_meter": of.get("share_of_meter") or {}} | ({"moved_share": of["moved_share"]} if of.get("moved_share") else {})
                for effect, of in case["effects"].items()
            ]  # fmt: skip
            place, use = case["weather"], case["archetype"]
        except (KeyError, TypeError, AttributeError) as error:
            raise Refused(f"{where}: lacks {error}") from None
        known = sum(effect["in_catalogue"] for effect in effects)
        block = "no_effect" if not effects else "out_of_catalogue" if known == 0 else "single" if len(effects) == 1 else "pair"
        answer = {"case": name, "world": world, "block": block, "effects": effects, "decoys": [], "climate": place, "use": use,
                  "gaps": False, "true_parameters": {}, "prior_sd": {}}  # fmt: skip
        answers[name] = json.dumps(answer, indent=1) + "\n"
        parse_answer(answers[name], name)  # What the scorer would not read is not written.
    pathlib.Path(folder).mkdir(parents=True, exist_ok=True)
    for name, text in answers.items():
        write_text(pathlib.Path(folder) / f"{name}.json", text)
    return len(answers)


# The seal: answers are hashed and the hash is published before anything runs on the cases.


def hash_of(content):
    return hashlib.sha256(content.encode() if isinstance(content, str) else content).hexdigest()


def seal_lines(folder):
    return "".join(f"{hash_of(pathlib.Path(folder, name).read_bytes())}  {name}\n" for name in answer_files(folder))


def seal_answers(folder):
    """Writes what `sha256sum` prints for the answers, and the hash of that. @return the latter."""
    file = pathlib.Path(folder) / "answers.sha256"
    if file.exists():
        raise Refused(f"{file}: sealed already; a second seal would hide a change")
    lines = seal_lines(folder)
    write_text(file, f"{lines}# whole {hash_of(lines)}\n")
    return hash_of(lines)


def verify_seal(folder, published=None):
    """@return the hash of the whole; refuses whatever is not as it was sealed."""
    file = pathlib.Path(folder) / "answers.sha256"
    lines, mark, whole = read_text(file).rpartition("# whole ")
    whole = whole.removesuffix("\n")
    if not mark or not re.fullmatch("[0-9a-f]{64}", whole):
        raise Refused(f"{file}: the last line must be '# whole <64 hex digits>'")
    if hash_of(lines) != whole:
        raise Refused(f"{file}: its last line is not the hash of the others; not opened")
    if published is not None and published != whole:
        raise Refused(f"{file}: the whole is {whole}, but {published} was published; not opened")
    sealed, found = (dict(reversed(line.split("  ", 1)) for line in text.splitlines()) for text in (lines, seal_lines(folder)))
    for name in sorted(sealed.keys() | found.keys()):
        what = "added" if name not in sealed else "removed" if name not in found else "changed"
        if sealed.get(name) != found.get(name):
            raise Refused(f"{file.parent / name}: the answer was {what} after the seal; not opened")
    return whole


def openings(folder):
    """When the answers were opened before, oldest first."""
    file = pathlib.Path(folder) / "opened.json"
    if not file.exists():
        return []
    found = parsed(read_text(file), file)
    if not isinstance(found, list) or not all(isinstance(one, dict) and isinstance(one.get("opened_at"), str) for one in found):
        raise Refused(f"{file}: must be a list of openings, each with 'opened_at'")
    return found


def record_opening(folder, **facts):
    now = datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ")
    write_text(pathlib.Path(folder) / "opened.json", json.dumps(openings(folder) + [{"opened_at": now} | facts], indent=2) + "\n")


# Results: JSON lines, one a case and method, appended as cases are done. What follows the last line feed is a line that
# a power cut tore.


def parse_result(line, where):
    result = parsed(line, where)
    if isinstance(result, dict) and isinstance(result.get("case"), str):
        where = f"{where}, case {result['case']}"
    result = {key: value for key, value in checked(result, RESULT, where).items() if value is not None}
    probabilities, named = result.get("probabilities", {}), result["named"]
    if (result["outcome"] == "named") != bool(named):
        raise Refused(
            f"{where}: 'outcome' is '{result['outcome']}' with {len(named)} effects in 'named'; it is 'named' exactly if an effect was added"
        )
    if "probabilities" in result:
        if abs(sum(probabilities.values()) - 1) > SUM_TOLERANCE:
            raise Refused(f"{where}: 'probabilities' sum to {sum(probabilities.values()):.6g}, must sum to 1")
        for name in named:
            if name not in probabilities:
                raise Refused(f"{where}: 'named' has '{name}', to which 'probabilities' gives none")
    gap = {when: fits for when, fits in result.get("gap", {}).items() if fits is not None}
    if len({frozenset(fits) for fits in gap.values()}) > 1:
        raise Refused(f"{where}: 'gap' has different meters before, after and for the oracle")
    for key in ("parameters_before", "parameters_after"):
        for name, posterior in result.get(key, {}).items():
            if posterior["q05"] > posterior["q95"]:
                raise Refused(f"{where}: '{key}.{name}' has q05 above q95")
    interval = result.get("effect_parameter", {"q05": 0, "q95": 0})
    if interval["q05"] > interval["q95"]:
        raise Refused(f"{where}: 'effect_parameter' has q05 above q95")
    return result


class Log:
    """Results of several files, read as one. A later line of a case and method counts only with `allow_rerun`."""

    def __init__(self, files=(), allow_rerun=False):
        self.torn, self.replaced, self.allow_rerun = [], 0, allow_rerun
        self._places, self._lines = {}, []
        for file in files:
            self.add(read_text(file), file)

    def add(self, text, name):
        *lines, rest = text.split("\n")
        for number, line in enumerate(lines, 1):
            where = f"{name} line {number}"
            result = parse_result(line, where)
            key = (result["case"], result["method"])
            if key in self._places and not self.allow_rerun:
                raise Refused(
                    f"case {key[0]} has two results of method {key[1]}: {self._places[key][1]} and {where}; give --allow-rerun to let the later one count"
                )
            self.replaced += key in self._places
            self._places[key] = (result, where)
            self._lines.append(line + "\n")
        if rest:
            self.torn.append(f"{name} line {len(lines) + 1}: torn after {len(rest.encode())} bytes, ignored; the case runs again")

    @property
    def results(self):
        return [result for result, _ in self._places.values()]

    @property
    def hash(self):
        return hash_of("".join(self._lines))


def append_result(file, line, allow_rerun=False):
    """Checks the line, cuts a torn tail off, appends and waits for the disk; several runners may append to one file."""
    line = line.rstrip("\r\n")
    if "\n" in line:
        raise Refused("the result to append: more than one line")
    parse_result(line, "the result to append")
    try:
        with open(os.open(file, os.O_RDWR | os.O_CREAT, 0o644), "r+b") as stream:
            fcntl.flock(stream, fcntl.LOCK_EX)
            old = stream.read()
            whole = old[: old.rfind(b"\n") + 1]
            Log(allow_rerun=allow_rerun).add(whole.decode() + line + "\n", file)
            stream.seek(len(whole))
            stream.truncate()
            stream.write(line.encode() + b"\n")
            stream.flush()
            os.fsync(stream.fileno())
    except OSError as error:
        raise Refused(f"cannot append to '{file}': {error.strerror}") from None


def cases_in(population):
    """Folders that hold a site.toml, sorted."""
    cases = [name for name in names_in(population) if pathlib.Path(population, name, "site.toml").exists()]
    if not cases:
        raise Refused(f"no case (a folder with a site.toml) in '{population}'")
    return cases


def pending_cases(population, results, method):
    """Cases without a line of the method, and a sentence for each torn line."""
    log = Log([results] if pathlib.Path(results).exists() else [], allow_rerun=True)
    done = {result["case"] for result in log.results if result["method"] == method}
    return [case for case in cases_in(population) if case not in done], log.torn
