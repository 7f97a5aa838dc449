#!/usr/bin/env python3
"""Pictures by a Dask cluster on this machine: the bits of one run, workers that die, workers that are refused.

Usage: test_cluster.py MOTE SOURCE_DIR     (with a Python that has `distributed`; tests/cluster/run finds one)
"""
import json
import os
import signal
import stat
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path

MOTE, SOURCE = sys.argv[1], Path(sys.argv[2])
sys.path.insert(0, str(SOURCE / "python"))
os.environ["MOTE_COMMAND"] = MOTE
import dask  # noqa: E402
from distributed import Client, LocalCluster, Nanny  # noqa: E402
from mote import cluster  # noqa: E402

SCENE = """<scene version="3.0.0"><default name="grey" value="0.5"/>
    <sensor type="perspective"><film type="hdrfilm"><integer name="width" value="32"/>
    <integer name="height" value="24"/></film><transform name="to_world">
    <lookat origin="0, 0, 4" target="0, 0, 0" up="0, 1, 0"/></transform></sensor>
    <shape type="sphere"><bsdf type="diffuse"><rgb name="reflectance" value="$grey"/></bsdf></shape>
    <shape type="rectangle"><transform name="to_world"><scale value="4"/><rotate x="1" angle="-90"/>
    <translate y="-1"/></transform></shape><emitter type="constant"/><integrator type="mote_layers">
    <integrator type="path" name="emission, direct"/><integrator type="path" name="indirect"/></integrator></scene>"""
PATH = ["--integrator", "path"]
# Workers are forked off a process that has read distributed, which takes a second.
dask.config.set({"distributed.worker.multiprocessing-method": "forkserver"})


def setUpModule():
    global local, client, folder, temporary
    temporary = tempfile.TemporaryDirectory()
    folder = Path(temporary.name)
    (folder / "scene.xml").write_text(SCENE)
    local = LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None, silence_logs=50)
    client = Client(local, set_as_default=False)


def tearDownModule():
    client.close()
    local.close()
    temporary.cleanup()


def mote(*arguments):
    done = subprocess.run([MOTE, *arguments], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def one_machine(passes, *more):
    mote("render", "scene.xml", "--quiet", "--passes", str(passes), "-o", "one.exr", *PATH, *more)


def pixels(path):
    """An EXR file from its first chunk on: all channels, without the metadata."""
    data = path.read_bytes()
    at = 8
    names = []
    while data[at]:
        name, kind, rest = data[at:at + 2000].split(b"\0", 2)
        names.append(name)
        at += len(name) + len(kind) + 2
        at += 4 + int.from_bytes(data[at:at + 4], "little")
    assert b"channels" in names
    first = int.from_bytes(data[at + 1:at + 9], "little")
    assert at < first < len(data) - 100
    return data[first:]


def wrapper(name, text):
    """A command in place of mote."""
    path = folder / name
    path.write_text(f"#!/bin/bash\n{text}\n")
    path.chmod(path.stat().st_mode | stat.S_IXUSR)
    return str(path)


class Pictures(unittest.TestCase):
    def same_as_one(self, name):
        self.assertEqual(pixels(folder / name), pixels(folder / "one.exr"))

    def render(self, name, **how):
        how = {"options": PATH, "quiet": True, **how}
        return cluster.render(folder / "scene.xml", folder / name, None, client=client, **how)

    def test_two_workers_make_the_bits_of_one(self):
        one_machine(11)
        self.assertEqual(self.render("two.exr", passes=11, block=3), 11)
        self.same_as_one("two.exr")
        self.assertFalse(list(folder.glob("two.exr.*film")))
        one_machine(10)  # that a difference would be seen
        self.assertNotEqual(pixels(folder / "two.exr"), pixels(folder / "one.exr"))

    def test_noise_ends_at_a_block(self):
        passes = self.render("noise.exr", noise=0.15, block=4)
        self.assertEqual(passes % 4, 0)
        self.assertGreaterEqual(passes, cluster.NOISE_RULE_FROM)
        one_machine(passes)
        self.same_as_one("noise.exr")

    def test_what_was_not_named_is_left_alone(self):
        """Beside the output nothing is replaced or removed; what would be is refused before workers begin."""
        place = folder / "bystanders"
        place.mkdir()
        kept = {"c.film", "c.json", "c.csv", "c.part", "c.exr.part", "c.exr.sum.film", "sum.film", "sum.json", "0.film",
                "part.film", "pilot.exr", "pilot.json", "c.exr.film.part", "c.1.film"}
        for name in kept:
            (place / name).write_text(f"this is {name}")
        for _ in range(2):
            self.assertEqual(self.render("bystanders/c.exr", passes=4, block=2), 4)
        self.assertEqual({p.name for p in place.iterdir()}, kept | {"c.exr", "c.png"})
        for name in kept:
            self.assertEqual((place / name).read_text(), f"this is {name}")
        never = wrapper("never", f'[[ "$*" == *--pass-range* ]] && touch {folder}/begun; exec {MOTE} "$@"')
        for foreign in ("d.exr.film", "d.png"):
            (place / foreign).write_text("a diary")
            with self.assertRaisesRegex(cluster.ClusterError, foreign):
                self.render("bystanders/d.exr", passes=4, worker_mote=never)
            self.assertEqual((place / foreign).read_text(), "a diary")
            (place / foreign).unlink()
        mote("render", "scene.xml", "--quiet", "--pass-range", "0:1", "-o", "bystanders/d.exr.film", *PATH, "--seed", "7")
        for resume in (False, True):
            with self.assertRaisesRegex(cluster.ClusterError, "d.exr.film.*another render"):
                self.render("bystanders/d.exr", passes=4, worker_mote=never, resume=resume)
            self.assertTrue((place / "d.exr.film").exists())
        self.assertFalse((folder / "begun").exists())

    def test_a_third_worker_is_killed_in_the_middle(self):
        one_machine(12)
        slow = wrapper("slow", f'[[ "$*" == *--pass-range* ]] && sleep 0.5\nexec {MOTE} "$@"')
        local.scale(3)
        client.wait_for_workers(3, timeout=60)
        killed = []

        def kill():
            time.sleep(0.8)
            killed.append(local.workers[2].pid)
            os.kill(killed[0], signal.SIGKILL)
        killer = threading.Thread(target=kill)
        killer.start()
        self.assertEqual(self.render("killed.exr", passes=12, block=2, worker_mote=slow), 12)
        killer.join()
        self.assertTrue(killed)
        self.same_as_one("killed.exr")
        local.scale(2)

    def test_workers_with_another_build_or_other_files_are_refused(self):
        one_machine(12)
        (folder / "other.xml").write_text(SCENE.replace('"0.5"', '"0.6"'))
        build = wrapper("other_build", f'{MOTE} "$@" | sed -E \'s/"commit":"[^"]*"/"commit":"1234567"/\'')
        files = wrapper("other_files", f'exec {MOTE} "${{@//scene.xml/other.xml}}"')
        said = []
        say, cluster.say = cluster.say, said.append

        async def worker(command):
            return await Nanny(local.scheduler_address, nthreads=1, silence_logs=50,
                               env={"MOTE_COMMAND": command})
        nannies = [local.sync(worker, command) for command in (build, files)]
        try:
            client.wait_for_workers(4, timeout=60)
            self.assertEqual(self.render("refused.exr", passes=12, block=2), 12)
        finally:
            cluster.say = say
            for nanny in nannies:
                local.sync(nanny.close)
        self.same_as_one("refused.exr")
        self.assertEqual(len(said), 2)
        self.assertRegex("\n".join(said), "is refused: its build of mote: '1234567', ours '")
        self.assertRegex("\n".join(said), "its contents of the scene or of a file that it names: '")

    def test_what_goes_wrong_is_said(self):
        with self.assertRaisesRegex(cluster.ClusterError, "does not use .grey_"):
            self.render("x.exr", passes=4, defines=["grey_=1"])
        broken = wrapper("broken", f'[[ "$*" == *--pass-range* ]] && {{ echo "mote: no luck" >&2; exit 3; }}; '
                                   f'exec {MOTE} "$@"')
        with self.assertRaisesRegex(cluster.ClusterError, "passes 0 to 3: mote: no luck"):
            self.render("x.exr", passes=4, block=4, worker_mote=broken, retries=1)
        other = wrapper("other", f'{MOTE} "$@" | sed s/0.1.0/9.9.9/')
        with self.assertRaisesRegex(cluster.ClusterError, "no worker is left"):
            self.render("x.exr", passes=4, worker_mote=other)

    def test_without_workers_it_says_how_to_start_one_and_ends(self):
        with LocalCluster(n_workers=0, dashboard_address=None, silence_logs=50) as empty:
            begin = time.monotonic()
            done = subprocess.run([sys.executable, "-m", "mote.cluster", "scene.xml", "--scheduler",
                                   empty.scheduler_address, "-o", "none.exr", "--passes", "8", "--wait", "1",
                                   "--integrator", "path"], cwd=folder, capture_output=True, text=True, timeout=60,
                                  env={**os.environ, "PYTHONPATH": str(SOURCE / "python")})
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn(f"'dask worker {empty.scheduler_address}'", done.stderr)
        self.assertIn("within 1 s", done.stderr)
        self.assertGreater(time.monotonic() - begin, 1.0)
        self.assertFalse((folder / "none.exr").exists())

    def test_the_command_line(self):
        done = subprocess.run([sys.executable, "-m", "mote.cluster", "scene.xml", "--scheduler",
                               local.scheduler_address, "-o", "command.exr", "--passes", "8", "--block", "4"],
                              cwd=folder, capture_output=True, text=True, env={**os.environ,
                                                                               "PYTHONPATH": str(SOURCE / "python")})
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("integrator.shares=", done.stderr)  # a picture of two methods, after a pilot
        self.assertIn("pass 8/8", done.stderr)
        shares = done.stderr.split("integrator.shares=")[1].split("'")[0]
        mote("render", "scene.xml", "--quiet", "--passes", "8", "-D", f"integrator.shares={shares}", "-o", "one.exr")
        self.same_as_one("command.exr")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
