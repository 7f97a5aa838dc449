"""Renders in a process of its own, with limits on processor time and memory, and says how each ended."""
import json
import math
import os
import re
import resource
import selectors
import signal
import subprocess
import sys
import time
from dataclasses import dataclass, field
from pathlib import Path

HERE = Path(__file__).resolve().parent
SECONDS = 20.0   # of processor time for one picture: others may use this machine
WAIT = 1200.0    # by the clock, for a process that waits and does nothing
ADDRESS_SPACE = 8 << 30
MEMORY = 1 << 30  # of one picture of some hundred pixels; beyond this it is a finding
FAULT = re.compile(r"internal|bad_alloc|std::|assert|terminate called|Traceback|please report", re.IGNORECASE)


@dataclass
class Outcome:
    """How a request ended: "rendered", "refused", "signal", "time", "fault", or "unfinished" where the run gave it less than SECONDS; and what was
    wrong with pictures."""
    kind: str = "rendered"
    text: str = ""
    wrong: dict = field(default_factory=dict)     # "memory", "not_finite", "negative": a text
    pictures: list = field(default_factory=list)  # paths
    noises: list = field(default_factory=list)    # stated ones; None where not known
    seconds: float = 0.0                          # the longest
    processor: float = 0.0                        # seconds of the whole request
    memory: int = 0


def processor_seconds(pid):
    """Of a process, its threads and those of its children that have ended."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return 0.0
    return sum(int(f) for f in fields[11:15]) / os.sysconf("SC_CLK_TCK")


def limit():
    resource.setrlimit(resource.RLIMIT_AS, (ADDRESS_SPACE, ADDRESS_SPACE))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


class Runner:
    """One worker at a time; a new one after each that died."""

    def __init__(self, module, folder, worker=HERE / "worker.py"):
        self.module, self.folder, self.worker = module, Path(folder), worker
        self.process = None

    def start(self):
        self.log = open(self.folder / "stderr.txt", "w+b")
        self.process = subprocess.Popen([sys.executable, "-B", str(self.worker), str(self.module)], stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE, stderr=self.log, preexec_fn=limit)
        self.buffer = b""
        if self.answer(SECONDS) is None:  # the line that says that libraries are loaded
            raise SystemExit(f"the worker does not start: {self.last_words()}")

    def stop(self):
        if self.process:
            self.process.kill()
            self.process.wait()
            self.process.stdin.close()
            self.process.stdout.close()
            self.log.close()
            self.process = None

    def last_words(self):
        self.log.seek(0)
        lines = self.log.read()[-2000:].decode(errors="replace").strip().splitlines()
        return lines[-1][:300] if lines else ""

    def answer(self, seconds):
        """The next line, None where the worker ended; raises TimeoutError."""
        start, used = time.monotonic(), processor_seconds(self.process.pid)
        with selectors.DefaultSelector() as selector:
            selector.register(self.process.stdout, selectors.EVENT_READ)
            while b"\n" not in self.buffer:
                if selector.select(timeout=0.1):
                    block = os.read(self.process.stdout.fileno(), 1 << 16)
                    if not block:
                        return None
                    self.buffer += block
                elif processor_seconds(self.process.pid) - used > seconds:
                    raise TimeoutError(f"more than {seconds:.3g} s of processor time")
                elif time.monotonic() - start > WAIT:
                    raise TimeoutError(f"more than {WAIT:.0f} s by the clock")
        line, _, self.buffer = self.buffer.partition(b"\n")
        return json.loads(line)

    def render(self, scene, integrator, method, seeds, seconds=math.inf):
        """Renders the scene with each seed, in at most these seconds of the processor."""
        if self.process is None:
            self.start()
        request = {"scene": str(scene.path), "integrator": integrator, "passes": method.passes, "seeds": list(seeds), "cells": method.cells,
                   "define": scene.define, "folder": str(self.folder), "seconds": min(seconds, 1e9)}
        outcome, used = Outcome(), processor_seconds(self.process.pid)
        try:
            self.process.stdin.write(json.dumps(request).encode() + b"\n")
            self.process.stdin.flush()
            while True:
                outcome.processor = processor_seconds(self.process.pid) - used
                answer = self.answer(min(SECONDS, max(0.0, seconds - outcome.processor)))
                if answer is None:
                    code = self.process.wait()
                    outcome.kind, outcome.text = "signal", f"{signal_name(code)}: {self.last_words()}"
                    break
                if "done" in answer:
                    outcome.processor = processor_seconds(self.process.pid) - used
                    return outcome
                take(answer, outcome)
        except (TimeoutError, BrokenPipeError) as error:
            outcome.processor = processor_seconds(self.process.pid) - used
            outcome.kind, outcome.text = "time" if seconds > SECONDS else "unfinished", str(error)
        self.stop()
        return outcome


def take(answer, outcome):
    """Adds an answer of the worker to the outcome."""
    if "unfinished" in answer:
        outcome.kind, outcome.text = "unfinished", answer["unfinished"]
        return
    if "refused" in answer or "fault" in answer:
        text = answer.get("refused", answer.get("fault"))
        outcome.kind = "fault" if "fault" in answer or FAULT.search(text) or len(text) < 10 else "refused"
        outcome.text = text
        return
    outcome.pictures.append(answer["picture"])
    outcome.noises.append(answer["noise"])
    outcome.seconds, outcome.memory = max(outcome.seconds, answer["seconds"]), max(outcome.memory, answer["memory"])
    for kind, count in answer["wrong"].items():
        if count:
            outcome.wrong[kind] = f"{count} values"
    if outcome.memory > MEMORY:
        outcome.wrong["memory"] = f"{outcome.memory >> 20} MB"


def signal_name(code):
    return signal.Signals(-code).name if code < 0 else f"exit code {code}"
