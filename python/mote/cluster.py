"""One picture by many workers of a Dask cluster: blocks of passes as tasks, merged to the bits of one machine.

    python -m mote.cluster scene.xml --scheduler tcp://host:8786 -o picture.exr --passes 256

Needs the `mote` command and the scene, under the same paths, here and where the workers run, and the PyPI package
`distributed`. Workers need nothing else of ours: what they run is sent to them. docs/cluster.md has recipes.
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

USUAL_BLOCK = 16  # passes of a task
NOISE_RULE_FROM = 8  # fewer passes say too little about their spread (core/render/stop_clock.h)
PILOT_PASSES = 16
FILM_MAGIC = b"motepart"  # of partial films (core/render/partial_film.cpp)


class ClusterError(Exception):
    """An error of the user, reported in one line."""


def run_mote(command, arguments):
    """Runs `mote`, returns its standard output. Raises ClusterError with its own words."""
    import subprocess as sub  # also where the function is sent to
    try:
        done = sub.run([command, *arguments], stdout=sub.PIPE, stderr=sub.PIPE, text=True)
    except OSError as error:
        raise ClusterError(f"'{command}' cannot be run: {error.strerror}") from None
    if done.returncode != 0:
        raise ClusterError(done.stderr.strip() or f"'{command}' ended with {done.returncode}")
    return done.stdout


def worker_command(job):
    """The `mote` of a worker: the job's, else MOTE_COMMAND of its environment, else the one on its path."""
    return job["mote"] or os.environ.get("MOTE_COMMAND") or "mote"


def identity(command, render):
    """What partial films must have in common, as `mote render --identity` says it: version, commit, content, ..."""
    return json.loads(run_mote(command, ["render", *render, "--identity"]))


NAMES = {"mote": "version of mote", "commit": "build of mote", "integrator": "integrator",
         "content": "contents of the scene or of a file that it names"}


def difference(theirs, ours):
    """Why a worker cannot take part; "" where it can."""
    for key, name in NAMES.items():
        if theirs.get(key) != ours.get(key):
            return f"its {name}: '{theirs.get(key)}', ours '{ours.get(key)}'"
    return ""


def render_block(job, first, end):
    """Runs on a worker. Returns (its address, reason why it is refused or "", bytes of the partial film)."""
    from distributed import get_worker
    worker = get_worker()
    command = worker_command(job)
    checked = worker.__dict__.setdefault("mote_checked", {})
    if job["id"] not in checked:  # the scene is loaded for it, so once a worker
        try:
            checked[job["id"]] = difference(identity(command, job["render"]), job["identity"])
        except ClusterError as error:
            checked[job["id"]] = str(error)
    if checked[job["id"]]:
        return worker.address, checked[job["id"]], b""
    with tempfile.TemporaryDirectory(prefix="mote_") as folder:
        film = Path(folder) / "part.film"
        run_mote(command, ["render", *job["render"], "--quiet", "--threads", str(job["threads"]),
                           "--pass-range", f"{first}:{end}", "-o", str(film)])
        return worker.address, "", film.read_bytes()


def blocks(first, end, size):
    """Passes first .. end - 1 in blocks that begin at multiples of `size`; end None: without end."""
    while end is None or first < end:
        last = (first // size + 1) * size
        last = last if end is None else min(last, end)
        yield first, last
        first = last


class Film:
    """The passes so far, in a file beside the picture; blocks wait in a folder of their own beside it."""

    def __init__(self, command, path):
        self.command, self.path = command, path
        self.scratch = tempfile.TemporaryDirectory(prefix=path.name + ".", dir=path.parent)
        self.folder = Path(self.scratch.name)
        self.passes, self.noise, self.content, self.seed = 0, None, None, None

    def add(self, parts):
        """Adds the films that follow; without any reads what is there."""
        stats, sum_ = self.folder / "sum.json", self.folder / "sum.film"
        all_parts = ([str(self.path)] if self.path.exists() else []) + [str(p) for p in parts]
        run_mote(self.command, ["merge", *all_parts, "-o", str(sum_), "--stats", str(stats), "--quiet"])
        os.replace(sum_, self.path)
        said = json.loads(stats.read_text())
        if said["first_pass"] != 0:
            raise ClusterError(f"'{self.path}' does not begin with pass 0")
        self.passes, self.noise, self.content, self.seed = said["passes"], said["noise"], said["content"], said["seed"]


def pilot_shares(command, render, parts):
    """Passes of each method of mote_layers in a round, from a short render here (docs/cluster.md)."""
    with tempfile.TemporaryDirectory(prefix="mote_") as folder:
        stats = Path(folder) / "pilot.json"
        run_mote(command, ["render", *render, "--quiet", "--passes", str(max(PILOT_PASSES, 4 * parts)), "-o",
                           str(Path(folder) / "pilot.exr"), "--stats", str(stats)])
        passes = [part["passes"] for part in json.loads(stats.read_text())["parts"]]
    return ", ".join(str(max(1, round(n / min(passes)))) for n in passes)


def say(text):
    print(f"mote: {text}", file=sys.stderr, flush=True)


class Cluster:
    """The blocks that are under way."""

    def __init__(self, client, job, film, options):
        self.client, self.job, self.film, self.options = client, job, film, options
        self.refused = {}  # address: reason
        self.done = {}  # first pass: end and path of a film that waits for those before it
        self.ends = {}  # future: block

    def workers(self):
        return [w for w in self.client.scheduler_info(n_workers=-1)["workers"] if w not in self.refused]

    def submit(self, block):
        workers = self.workers()
        if self.refused and not workers:
            raise ClusterError("no worker is left that could take part")
        future = self.client.submit(render_block, self.job, *block, pure=False, retries=self.options.retries,
                                    workers=workers if self.refused else None, priority=-block[0])
        self.ends[future] = block
        return future

    def take(self, future):
        """What a block has become. Returns False where it has to be rendered again."""
        first, end = self.ends.pop(future)
        try:
            address, reason, film = future.result()
        except Exception as error:  # after retries; or workers died of it again and again
            raise ClusterError(f"passes {first} to {end - 1}: {error}") from None
        if reason:
            if address not in self.refused:
                say(f"worker {address} is refused: {reason}")
            self.refused[address] = reason
            return False
        path = self.film.folder / f"{first}.film"
        path.write_bytes(film)
        self.done[first] = end, path
        return True

    def finished(self):
        o, film = self.options, self.film
        if o.noise and film.passes >= NOISE_RULE_FROM and film.noise is not None and film.noise <= o.noise:
            return True
        return film.passes >= o.passes

    def merge_ready(self):
        """In the order of passes. With --noise one block after the other: where a picture ends depends on no clock."""
        while not self.finished() and self.film.passes in self.done:
            first, parts = self.film.passes, []
            while first in self.done and not (parts and self.options.noise):
                end, path = self.done.pop(first)
                parts.append(path)
                first = end
            self.film.add(parts)
            for path in parts:
                path.unlink()
            noise = "" if self.film.noise is None else f", noise {100 * self.film.noise:.2g} %"
            if not self.options.quiet:
                say(f"pass {self.film.passes}" + ("" if self.options.noise else f"/{self.options.passes}") + noise +
                    f", {len(self.workers())} workers")

    def wait_for_workers(self, scheduler):
        """Raises ClusterError where none joins in time."""
        if self.workers():
            return
        start = f"'dask worker {scheduler}' on each machine starts one"
        if not self.options.quiet:
            say(f"no worker has joined yet: {start}; waiting {self.options.wait:g} s")
        try:
            self.client.wait_for_workers(1, timeout=self.options.wait)
        except TimeoutError:
            raise ClusterError(f"no worker has joined the scheduler at {scheduler} within {self.options.wait:g} s: "
                               f"{start}, and --wait gives it longer") from None

    def run(self):
        from distributed import as_completed
        o = self.options
        waiting = blocks(self.film.passes, o.passes, o.block)
        try:
            under_way = as_completed(loop=self.client.loop)
            ahead = lambda: 2 + 2 * sum(self.client.nthreads().values())  # noqa: E731: no worker waits for work
            def fill():
                while len(self.ends) < ahead():
                    block = next(waiting, None)
                    if block is None:
                        return
                    under_way.add(self.submit(block))
            self.merge_ready()
            if not self.finished():
                fill()
            for future in under_way:
                block = self.ends[future]
                if not self.take(future):
                    under_way.add(self.submit(block))
                self.merge_ready()
                if self.finished():
                    return
                fill()
        finally:
            self.client.cancel(list(self.ends))
            for _, path in self.done.values():
                path.unlink(missing_ok=True)


def render(scene, output, scheduler, *, passes=None, noise=None, block=USUAL_BLOCK, threads=1, options=(), defines=(),
           mote=None, worker_mote=None, resume=False, retries=3, max_passes=65536, quiet=False, client=None, wait=60.0):
    """Renders `scene` (a path) by the workers of a Dask cluster, into `output` (.exr or .png).

    scheduler: its address, or a distributed.Client as `client`. passes: how many; or noise: until it is that
    (of the passes, before filters of the whole picture), evaluated after every `block` passes, so the number of
    workers changes no bit. threads: of each task, 0 for all cores. options: further ones of `mote render`
    ("--seed", "7"). defines: those of -D. mote, worker_mote: the command here and there. wait: seconds until a first
    worker has joined. Returns the number of passes. Raises ClusterError.
    """
    from distributed import Client
    command = mote or os.environ.get("MOTE_COMMAND") or "mote"
    out = Path(output)
    arguments = [str(Path(scene).absolute()), *options]
    for define in defines:
        arguments += ["-D", define]
    ours = identity(command, [*arguments, "-o", str(out)])  # refuses to replace what mote did not write
    if ours["parts"] > 1 and not any(d.startswith("integrator.shares=") for d in defines):
        shares = pilot_shares(command, arguments, ours["parts"])
        if not quiet:
            say(f"-D 'integrator.shares={shares}', by a pilot of some passes here")
        arguments += ["-D", f"integrator.shares={shares}"]
        ours = identity(command, arguments)
    if passes is None and noise is None:
        passes = ours["sample_count"]
    film = Film(command, out.with_name(out.name + ".film"))
    if film.path.exists():
        if not film.path.is_file() or film.path.open("rb").read(len(FILM_MAGIC)) != FILM_MAGIC:
            raise ClusterError(f"'{film.path}' is no partial film of mote, and is not replaced")
        film.add([])
        if (film.content, film.seed) != (ours["content"], ours["seed"]):
            raise ClusterError(f"'{film.path}' is of another render, and is neither resumed nor replaced")
        if not resume:
            film.path.unlink()
            film.passes = 0
    job = {"id": f"{ours['content']}-{os.getpid()}-{os.urandom(4).hex()}", "mote": worker_mote, "render": arguments,
           "identity": ours, "threads": threads}
    settings = argparse.Namespace(passes=passes or max_passes, noise=noise, block=block, retries=retries, quiet=quiet,
                                  wait=wait)
    own = None
    if client is None:
        try:
            client = own = Client(scheduler, timeout=20, set_as_default=False)
        except (OSError, ValueError) as error:
            raise ClusterError(f"there is no scheduler at '{scheduler}': {error}") from None
    interrupted = False
    try:
        cluster = Cluster(client, job, film, settings)
        cluster.wait_for_workers(client.scheduler.address)
        cluster.run()
    except KeyboardInterrupt:
        interrupted = True
    finally:
        if own:
            own.close()
    if film.passes == 0:
        raise ClusterError("interrupted before the first block: there is nothing to write")
    run_mote(command, ["merge", str(film.path), "-o", str(out), "--quiet"])
    if interrupted:
        say(f"interrupted after {film.passes} passes: {out} holds the picture so far, --resume continues")
        raise KeyboardInterrupt
    film.path.unlink()
    return film.passes


def parser():
    p = argparse.ArgumentParser(prog="python -m mote.cluster", description=__doc__.split("\n")[0])
    p.add_argument("scene", help="the scene file, under this path for all workers too")
    p.add_argument("--scheduler", required=True, help="address of the Dask scheduler, tcp://host:8786")
    p.add_argument("-o", "--output", required=True, help="the EXR file to write, or the PNG beside it")
    p.add_argument("--passes", type=int, help="how many (default: the scene's sample_count)")
    p.add_argument("--noise", type=float, help="stop when the noise of the passes is this, such as 0.02")
    p.add_argument("--max-passes", type=int, default=65536, help="with --noise, no more than these (default: 65536)")
    p.add_argument("--block", type=int, default=USUAL_BLOCK, help=f"passes of a task (default: {USUAL_BLOCK})")
    p.add_argument("--integrator", help="render with this type instead of the scene's")
    p.add_argument("-D", "--define", action="append", default=[], help="as of mote render (repeatable)")
    p.add_argument("--seed", type=int, default=0)
    p.add_argument("--auxiliary", action="store_true", help="also write what is seen")
    p.add_argument("-t", "--threads", type=int, default=1, help="of each task; 0: all cores (default: 1)")
    p.add_argument("--mote", help="the command here (default: MOTE_COMMAND of the environment, or mote)")
    p.add_argument("--worker-mote", help="the command where the workers run (default: the same of theirs)")
    p.add_argument("--retries", type=int, default=3, help="of a task that failed (default: 3)")
    p.add_argument("--wait", type=float, default=60.0, help="seconds until a first worker has joined (default: 60)")
    p.add_argument("--resume", action="store_true", help="continue an interrupted render")
    p.add_argument("--quiet", action="store_true")
    return p


def main(arguments=None):
    a = parser().parse_args(arguments)
    options = ["--seed", str(a.seed)] + (["--auxiliary"] if a.auxiliary else [])
    options += ["--integrator", a.integrator] if a.integrator else []
    for name, value in (("--passes", a.passes), ("--block", a.block), ("--max-passes", a.max_passes)):
        if value is not None and value < 1:
            parser().error(f"{name} {value}: expected a whole number from 1 on")
    if a.passes and a.noise:
        parser().error("--passes or --noise, not both (--max-passes goes with --noise)")
    try:
        import distributed  # noqa: F401
    except ImportError:
        say("the Python package 'distributed' is missing (pip install distributed)")
        return 1
    try:
        render(a.scene, a.output, a.scheduler, passes=a.passes, noise=a.noise, block=a.block, threads=a.threads,
               options=options, defines=a.define, mote=a.mote, worker_mote=a.worker_mote, resume=a.resume,
               retries=a.retries, max_passes=a.max_passes, quiet=a.quiet, wait=a.wait)
    except ClusterError as error:
        for line in str(error).splitlines():
            say(line.removeprefix("mote: "))
        return 1
    except KeyboardInterrupt:
        return 130
    if not a.quiet:
        print(a.output)
    return 0


if __name__ == "__main__":
    sys.exit(main())
else:
    # Workers need not have this module: what is sent to them is sent whole, as that of a script is.
    try:
        import cloudpickle
        cloudpickle.register_pickle_by_value(sys.modules[__name__])
    except ImportError:
        pass
