#!/usr/bin/env python3
"""Plants faults, one after the other, and runs the tests of their own folder.

Usage: tools/mutants/mutants.py [--only NAME,...] [--again] [--trust] [--filters] [--at COMMIT] | --list | --quick | --table

Every fault of faults.toml is an exact text and what takes its place, so that it survives edits elsewhere in its file;
where the text is gone, the script says so. Faults are planted in a clone of the last commit, build/mutants/tree, never
in the tree where you work. There the test program of the fault's folder is built and run up to its first failure.
A program that fails without a fault, or takes ten times as long as without, shows nothing: both are tested first.
Results are kept in build/mutants/results.jsonl: what has one is not run again, unless --again requests it.

--only NAME,...  these faults, or all whose name begins so
--again          faults that have a result, too
--trust          the programs are known to pass without a fault: they are not run without one first
--filters        stops after a fault's filter; what survives that is tried again without this switch
--at COMMIT      plants them there, not in the last commit
--list           the faults and their last results
--quick          nothing is built: does every text still stand in its file exactly once?
--table          the results as a table in Markdown (tools/mutants/found.csv has those of the faults chosen so far)
"""
import argparse
import json
import os
import re
import subprocess
import sys
import time
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FAULTS = Path(__file__).resolve().with_name("faults.toml")
WORK = ROOT / "build" / "mutants"
TREE = WORK / "tree"
RESULTS = WORK / "results.jsonl"
LATER = "survived its filter"
MIN_SECONDS = 120.0  # granted to every run of a program
REPORT = WORK / "report.xml"


def read_faults():
    faults = tomllib.loads(FAULTS.read_text(encoding="utf-8"))["fault"]
    for fault in faults:
        fault["edits"] = fault.get("edits") or [[fault["old"], fault["new"]]]
    return faults


def missing_texts(fault, root):
    """Why the fault cannot be planted in this tree; empty where it can."""
    path = root / fault["file"]
    if not path.is_file():
        return [f"{fault['name']}: there is no {fault['file']}"]
    text = path.read_text(encoding="utf-8")
    return [f"{fault['name']}: {fault['file']} holds {text.count(old)} times (not once): {old.strip()}"
            for old, new in fault["edits"] if text.count(old) != 1 or old == new]


def quick(faults):
    """The faults as they stand: all can be planted, none twice, all folders have a program."""
    wrong = [line for fault in faults for line in missing_texts(fault, ROOT)]
    names = [fault["name"] for fault in faults]
    wrong += [f"{name}: two faults have this name" for name in set(names) if names.count(name) > 1]
    wrong += [f"{f['name']}: there is no folder tests/{f['tests']}" for f in faults
              if not (ROOT / "tests" / f["tests"]).is_dir()]
    print("\n".join(wrong) if wrong else f"{len(faults)} faults can be planted")
    return 1 if wrong else 0


def results():
    """The last result of every fault, by name; and of programs without a fault, by commit and program."""
    last = {}
    if RESULTS.is_file():
        for line in RESULTS.read_text(encoding="utf-8").splitlines():
            entry = json.loads(line)
            last[entry["name"]] = entry
    return last


def keep(entry):
    with RESULTS.open("a", encoding="utf-8") as file:
        file.write(json.dumps(entry) + "\n")


def git(*arguments, at=TREE):
    return subprocess.run(["git", "-C", str(at), *arguments], check=True, capture_output=True, text=True).stdout.strip()


def prepare_tree(revision):
    """The clone at a commit, configured. Returns that commit."""
    commit = git("rev-parse", revision, at=ROOT)
    WORK.mkdir(parents=True, exist_ok=True)
    if not TREE.is_dir():
        subprocess.run(["git", "clone", "--quiet", "--shared", str(ROOT), str(TREE)], check=True)
    git("checkout", "--quiet", "--", ".")  # a fault that an interrupted run left
    if git("rev-parse", "HEAD") != commit:
        git("fetch", "--quiet", str(ROOT), commit)
        git("checkout", "--quiet", "--detach", commit)
    subprocess.run(["cmake", "--preset", "release"], cwd=TREE, check=True, stdout=subprocess.DEVNULL)
    if revision == "HEAD" and git("status", "--porcelain", at=ROOT):
        print("note: what is not committed takes no part")
    return commit


def build(folder):
    """Builds one test program. Returns whether it could be."""
    with (WORK / "build.log").open("w") as log:
        return subprocess.run(["ninja", "-C", "build/release", f"mote_tests_{folder}"], cwd=TREE, stdout=log,
                              stderr=subprocess.STDOUT, check=False).returncode == 0


def failed_test():
    """The name of the test at which the report breaks off."""
    names = re.findall(r'<TestCase name="([^"]*)"', REPORT.read_text(encoding="utf-8", errors="replace"))
    unescape = {"&quot;": '"', "&lt;": "<", "&gt;": ">", "&amp;": "&"}
    name = names[-1] if names else "(before the first)"
    for escaped, plain in unescape.items():
        name = name.replace(escaped, plain)
    return name


def run(folder, words, limit):
    """Runs a test program up to its first failure. Returns the test that failed, or nothing; and the seconds."""
    REPORT.unlink(missing_ok=True)
    environment = {"MOTE_TEST_DATA": str(ROOT.parent / "shared" / "data"), **os.environ,
                   "MOTE_TEST_FAILURES": str(WORK / "failures")}
    start = time.monotonic()
    program = [str(TREE / "build" / "release" / "bin" / f"mote_tests_{folder}"), *words, "--abort", "-r", "xml"]
    try:
        with REPORT.open("w") as report:
            status = subprocess.run(program, cwd=TREE, env=environment, timeout=limit, stdout=report,
                                    stderr=subprocess.DEVNULL, check=False).returncode
    except subprocess.TimeoutExpired:
        return f"{failed_test()} (hangs)", time.monotonic() - start
    return failed_test() if status else None, time.monotonic() - start


def limit(folder, commit, trusted):
    """Seconds granted to a run: ten times what the program takes without a fault. Stops where it fails without one."""
    if trusted:
        return 5.0 * MIN_SECONDS
    name = f"{folder} without a fault"
    known = results().get(name)
    if not known or known["commit"] != commit:
        if not build(folder):
            sys.exit(f"mote_tests_{folder} cannot be built without a fault: see {WORK / 'build.log'}")
        failed, seconds = run(folder, [], 3600.0)
        if failed:
            sys.exit(f"{name} fails: {failed}")
        known = {"name": name, "commit": commit, "seconds": seconds}
        keep(known)
    return max(MIN_SECONDS, 10.0 * known["seconds"])


def try_fault(fault, commit, trusted, filters_only):
    """Plants one fault, builds, runs, and takes it out again; first with the filter, if there is one, then all."""
    entry = {"name": fault["name"], "commit": commit[:12], "edits": fault["edits"], "seconds": 0.0}
    if missing := missing_texts(fault, TREE):
        return {**entry, "outcome": "text is gone", "test": missing[0]}
    granted = limit(fault["tests"], commit, trusted)
    path = TREE / fault["file"]
    right = wrong = path.read_text(encoding="utf-8")
    for old, new in fault["edits"]:
        wrong = wrong.replace(old, new)
    path.write_text(wrong, encoding="utf-8")
    try:
        if not build(fault["tests"]):
            return {**entry, "outcome": "not built", "test": ""}
        for words in ([[fault["first"]]] if "first" in fault else []) + [[]]:
            if filters_only and "first" in fault and not words:
                return {**entry, "outcome": LATER, "test": ""}
            failed, took = run(fault["tests"], words, granted)
            entry["seconds"] += took
            if failed:
                return {**entry, "outcome": "found", "test": failed}
    finally:
        path.write_text(right, encoding="utf-8")
    return {**entry, "outcome": "survived", "test": ""}


def table(faults):
    """Markdown: every fault, and who found it. What survived at first names the test that was written for it."""
    known = results()
    for group in ("", "earlier", "later"):
        print("| fault | file | found by |\n|---|---|---|")
        for fault in [f for f in faults if group == next((g for g in ("earlier", "later") if f.get(g)), "")]:
            entry = known.get(fault["name"], {"outcome": "not tried", "test": ""})
            found = entry["test"] if entry["outcome"] == "found" else f"**{entry['outcome']}**"
            if "mended" in fault:
                found = "survived at first; then: " + fault["mended"]
            print(f"| {fault['what']} | `{fault['file']}` | {found} |")
        print()


def chosen(faults, only):
    names = [n for n in only.split(",") if n]
    picked = [f for f in faults if not names or any(f["name"].startswith(n) for n in names)]
    return picked or sys.exit(f"no fault's name begins with {only}")


def main():
    parser = argparse.ArgumentParser(description="plants faults; see the head of this file")
    parser.add_argument("--only", default="")
    parser.add_argument("--at", default="HEAD")
    for switch in ("--again", "--trust", "--filters", "--list", "--quick", "--table"):
        parser.add_argument(switch, action="store_true")
    options = parser.parse_args()
    faults = chosen(read_faults(), options.only)
    if options.quick:
        return quick(faults)
    if options.table:
        table(faults)
        return 0
    if options.list:
        for fault in faults:
            entry = results().get(fault["name"], {"outcome": "not tried", "test": ""})
            print(f"{fault['name']:32} {entry['outcome']:12} {entry['test']}")
        return 0
    commit = prepare_tree(options.at)
    for number, fault in enumerate(faults):
        known = results().get(fault["name"])
        tried = known and known["edits"] == fault["edits"] and (options.filters or known["outcome"] != LATER)
        if tried and not options.again:
            continue
        entry = try_fault(fault, commit, options.trust, options.filters)
        keep(entry)
        print(f"{number + 1}/{len(faults)} {fault['name']}: {entry['outcome']} {entry['test']}", flush=True)
    last = [results().get(f["name"], {}).get("outcome") for f in faults]
    print(f"{last.count('found')} of {len(faults)} found")
    return 0 if last.count("found") == len(faults) else 1


if __name__ == "__main__":
    sys.exit(main())
