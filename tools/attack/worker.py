"""The process that renders: a line of JSON in, lines of JSON out; the first says that it is ready. When it crashes or stays, its parent continues without it.

Request: {"scene", "integrator", "passes", "seeds", "cells", "define", "folder", "seconds"}. Answers: {"refused"} or {"fault"} with a text, or for
each seed {"picture", "noise", "seconds", "memory", "wrong"}; {"unfinished"} where the next one would exceed the seconds; at the end {"done"}.
"""
import json
import math
import os
import sys
import time
from pathlib import Path


def peak_memory():
    """Largest resident set since forget_peak() [bytes]."""
    status = Path("/proc/self/status").read_text()
    return 1024 * int(status.split("VmHWM:")[1].split()[0])


def forget_peak():
    try:
        Path("/proc/self/clear_refs").write_text("5")
    except OSError:
        pass  # the peak is then that of all renders so far


def wrong_pixels(picture):
    """Counts of values that no radiance has, over all layers of light."""
    import numpy as np
    layers = [picture[name] for name in picture if not name.startswith(("Variance", "MarchedRays"))]
    return {"not_finite": int(sum(np.count_nonzero(~np.isfinite(v)) for v in layers)),
            "negative": int(sum(np.count_nonzero(v < 0.0) for v in layers))}


def light_of(picture, cells):
    """The beauty, or the sum of some layers."""
    import numpy as np
    if not cells:
        return np.array(picture["beauty"])
    return np.sum([picture[cell] for cell in cells if cell in picture], axis=0)


def render(mote, scene, request, seed):
    """One picture of one seed."""
    return mote.render(scene, passes=request["passes"], seed=seed, threads=1)


def answers(mote, request, draw=render):
    """The answers to a request; `draw` is render(), or in the test of the attack one with planted faults."""
    import numpy as np
    forget_peak()
    begin, longest = time.process_time(), 0.0
    try:
        scene = mote.load(request["scene"], integrator=request["integrator"], define=request["define"])
        for seed in request["seeds"]:
            start = time.process_time()
            if start - begin + longest > request["seconds"]:
                yield {"unfinished": f"{longest:.3g} s a picture"}
                break
            picture = draw(mote, scene, request, seed)
            path = os.path.join(request["folder"], f"{request['integrator']}_{request['passes']}_{seed}.npy")
            np.save(path, light_of(picture, request["cells"]))
            longest = max(longest, time.process_time() - start)
            yield {"picture": path, "noise": picture.noise if math.isfinite(picture.noise) else None,
                   "seconds": time.process_time() - start, "memory": peak_memory(), "wrong": wrong_pixels(picture)}
    except mote.Error as error:
        yield {"refused": str(error)}
    except Exception as error:  # whatever else comes out is a fault of the module
        yield {"fault": f"{type(error).__name__}: {error}"}
    yield {"done": True}


def main(draw=render):
    """Worker of the build whose Python module is in the folder sys.argv[1]."""
    sys.path.insert(0, sys.argv[1])
    out = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # what libraries print is no answer
    import mote
    print(json.dumps({"ready": True}), file=out, flush=True)
    for line in sys.stdin:
        for answer in answers(mote, json.loads(line), draw):
            print(json.dumps(answer), file=out, flush=True)


if __name__ == "__main__":
    main()
