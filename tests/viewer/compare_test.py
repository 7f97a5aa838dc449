"""Two methods against a reference in the viewer, saved as the page of a trade, whose records are those of the frames.

Usage: compare_test.py MOTE SCENE
"""
import csv
import io
import os
import subprocess
import sys
import tempfile

from view_program import Program

mote, scene = (os.path.abspath(path) for path in sys.argv[1:3])
SIZE = ["-D", "film.width=40", "-D", "film.height=40"]


def check(holds, what):
    print(("ok      " if holds else "FAILED  ") + what, flush=True)
    if not holds:
        sys.exit(1)


def files(client):
    client.send({"type": "compare"})
    found = {}
    while len(found) < 2:
        header, payload = client.wait_for(lambda h: h["type"] in ("file", "refused"))
        if header["type"] == "refused":
            return header["text"]
        found[header["name"]] = payload.decode()
    return found


def main():
    with tempfile.TemporaryDirectory() as folder:
        reference = os.path.join(folder, "reference.exr")
        subprocess.run([mote, "render", scene, *SIZE, "--integrator", "path", "--passes", "400", "--seed", "7", "-o", reference,
                        "--quiet"], check=True)
        with Program(mote, scene, *SIZE, "--integrator", "path", "--passes", "30") as program:
            client = program.connect()
            client.frame(lambda h: h["finished"])
            check("--reference" in files(client), "without a reference it is refused")
        with Program(mote, scene, *SIZE, "--integrator", "path", "--passes", "30", "--reference", reference) as program:
            client = program.connect()
            client.send({"type": "second", "integrator": "mote_vpl"})
            last = {}
            while len(last) < 2:  # in any order, each with half of the threads
                frame, _ = client.frame(lambda h: h["finished"] and h["passes"] == 30)
                if frame["picture"] == "B" or frame["change"] > 1:
                    last[frame["picture"]] = frame
            found = files(client)
            check(isinstance(found, dict), f"page and records arrive: {found if isinstance(found, str) else list(found)}")
            records = list(csv.DictReader(io.StringIO(found["trade.csv"])))
            for name, method in (("A", "A: path"), ("B", "B: mote_vpl")):
                own = [r for r in records if r["method"] == method]
                check(own and int(own[-1]["passes"]) == 30 and abs(float(own[-1]["error"]) - last[name]["error"]) < 1e-9,
                      f"{method}: {len(own)} records, the last error {own[-1]['error']}")
            page = found["trade.html"]
            check("Error against time" in page and "B: mote_vpl" in page and "beside each other" in page, "the page")
            check(page.count("data:image/png") >= 3, "with the pictures of both and the reference")
            check("mote render" in page and "--integrator mote_vpl" in page, "and the commands")
    print("passed")


main()
