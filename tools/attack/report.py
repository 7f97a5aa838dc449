"""What an attack found: a line for each finding, a summary, records that a later run continues, and known findings."""
import json
import re
import tomllib
from collections import Counter
from pathlib import Path

from attack import Finding


def read_known():
    """Entries of known.toml: `integrator` and `what` are patterns, `where` holds ranges or words of facts, `text` is a pattern
    within the finding's text, `reason` says why."""
    path = Path(__file__).with_name("known.toml")
    return tomllib.loads(path.read_text(encoding="utf-8")).get("known", []) if path.is_file() else []


def holds(facts, condition):
    """True where each fact lies in its range [low, high], or is one of the words."""
    for name, wanted in condition.items():
        fact = facts.get(name)
        if fact is None:
            return False
        if isinstance(fact, (int, float)) and not isinstance(fact, bool):
            if not wanted[0] <= abs(fact) <= wanted[1]:
                return False
        elif not any(word in str(fact) for word in wanted):
            return False
    return True


def mark_known(record, known):
    """Gives the findings that are listed their reason. The number of a random scene is a fact, too."""
    facts = record["facts"] | ({"scene": int(record["scene"])} if record["scene"].isdigit() else {})
    for finding in record["findings"]:
        for entry in known:
            if (re.fullmatch(entry["integrator"], finding["integrator"]) and re.fullmatch(entry["what"], finding["what"])
                    and re.search(entry.get("text", ""), finding["text"]) and holds(facts, entry.get("where", {}))):
                finding["known"] = entry["reason"]


def read_records(path):
    """Records of an earlier run, by scene."""
    if not path.is_file():
        return {}
    return {r["scene"]: r for r in map(json.loads, path.read_text(encoding="utf-8").splitlines())}


def keep(path, record):
    with path.open("a", encoding="utf-8") as file:
        file.write(json.dumps(record) + "\n")


def lines(record):
    return [Finding(**finding).line() for finding in record["findings"]]


def shape_of(message):
    """A message without its names and numbers, to count alike ones together."""
    message = re.sub(r"\S*/\S+?:?(\d+:)? ", "", message.splitlines()[0])
    return re.sub(r"-?\d[\d.e+-]*", "#", message)[:160]


def summary(records):
    """The page at the end of a run."""
    findings = [f for r in records for f in r["findings"]]
    new = [f for f in findings if not f["known"]]
    compared = sum(len(r["compared"]) for r in records)
    renders = sum(len(r["seconds"]) for r in records)
    unfinished = Counter(name.split()[0] for r in records for name in r["unfinished"] if " at " not in name)
    early = sum(" at " in name for r in records for name in r["unfinished"])
    page = [f"{len(records)} scenes, {renders} pairs of scene and integrator, {compared} means compared: {len(findings)} findings, "
            f"{len(findings) - len(new)} of them known; {sum(unfinished.values())} pairs not finished in their time, {early} comparisons ended early, "
            f"{sum(len(r['tails']) for r in records)} differences that did not stay, "
            f"{sum(len(r.get('blind', [])) for r in records)} where volpath is black and mote_bdpt agrees; {sum(r['processor'] or 0 for r in records) / 60:.1f} min of the processor"]
    for (what, integrator), count in sorted(Counter((f["what"], f["integrator"]) for f in new).items()):
        page.append(f"  {count:5}  {what:10} {integrator}")
    page.append("not finished: " + ", ".join(f"{name} {count}" for name, count in unfinished.most_common()))
    refusals = Counter((shape_of(text)) for r in records for text in r["refused"].values())
    page.append(f"refusals: {sum(refusals.values())}")
    page += [f"  {count:5}  {text}" for text, count in refusals.most_common(30)]
    return "\n".join(page)
