#!/usr/bin/env python3
"""Passes a second by one process on all cores, and by as many workers of a cluster with one thread each.

Usage: cluster_throughput.py MOTE [--scene scenes/cornell_box.xml] [--passes N] [--block B] [--workers W] [--repeat R] [--quick]
With a Python that has `distributed` (tests/cluster/run makes one: build/release/python_cluster/bin/python). Times are of
the wall and of processors, from the first pass requested to the picture; both turns alternate, medians count. On a machine
that others use too, only processor seconds can be compared: workers, merging and what Dask itself does are in them.
"""
import argparse
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "python"))
from distributed import Client, LocalCluster  # noqa: E402
from mote import cluster  # noqa: E402


def processor_seconds():
    """Processor time [s] of this process and of the children it waited for; on a worker, that of the worker."""
    return sum(os.times()[:4])


def main():
    p = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    p.add_argument("mote")
    p.add_argument("--scene", default=str(SOURCE / "scenes/cornell_box.xml"))
    p.add_argument("--integrator", default="volpath")
    p.add_argument("--passes", type=int, default=256)
    p.add_argument("--block", type=int, default=64)
    p.add_argument("--workers", type=int, default=os.cpu_count())
    p.add_argument("--repeat", type=int, default=3)
    p.add_argument("--quick", action="store_true", help="tiny: numbers without a meaning")
    a = p.parse_args()
    if a.quick:
        a.passes, a.block, a.repeat = 8, 2, 1
    mote = str(Path(a.mote).resolve())
    options = ["--integrator", a.integrator]
    alone, together, processors = [], [], []
    with tempfile.TemporaryDirectory() as folder, \
            LocalCluster(n_workers=a.workers, threads_per_worker=1, dashboard_address=None) as local, \
            Client(local) as client:
        def processors_now():
            return processor_seconds() + sum(client.run(processor_seconds).values())

        for _ in range(a.repeat):
            begin, before = time.monotonic(), processors_now()
            subprocess.run([mote, "render", a.scene, *options, "--passes", str(a.passes), "-t", str(a.workers),
                            "--quiet", "-o", f"{folder}/one.exr"], check=True)
            alone.append(time.monotonic() - begin)
            begin, between = time.monotonic(), processors_now()
            cluster.render(a.scene, f"{folder}/two.exr", None, passes=a.passes, block=a.block, options=options,
                           mote=mote, worker_mote=mote, client=client, quiet=True)
            together.append(time.monotonic() - begin)
            processors.append((between - before) / (processors_now() - between))
            print(f"one process {alone[-1]:.1f} s, {a.workers} workers {together[-1]:.1f} s; processor seconds of the "
                  f"former {processors[-1]:.3f} of the latter's", flush=True)
    ratio = statistics.median(alone) / statistics.median(together)
    print(f"{Path(a.scene).stem}, {a.integrator}, {a.passes} passes in blocks of {a.block}: {a.workers} workers have "
          f"{ratio:.2f} of the throughput of one process with {a.workers} threads by the wall's clock, {statistics.median(processors):.3f} by processor seconds "
          f"(medians of {a.repeat})")


if __name__ == "__main__":
    main()
