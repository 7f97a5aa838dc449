"""Runs the command and says how far it is; a cancelled run leaves the picture so far."""
import os
import re
import signal
import subprocess
import time

PASS = re.compile(r"pass (\d+)(?:/(\d+))?[^\r\n]*")
NOISE = re.compile(r"\x1b\[[0-9;]*[A-Za-z]")
PATIENCE = 10.0  # seconds after SIGINT until the process is ended


def run(arguments, progress, stopped):
    """Runs until the end, or until stopped() says so. progress(text, share). Returns (its code, its words, cancelled).

    Its stderr is a terminal of its own where there is such a thing: there it reports every pass. Ctrl-C stops it too where
    Python has it and not Blender (the module bpy): it must not leave a callback of Blender as an exception.
    """
    ours, theirs = terminal()
    with subprocess.Popen(arguments, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=theirs,
                          start_new_session=True) as process:
        os.close(theirs)
        os.set_blocking(ours, False)
        words, requested, interrupted = "", None, False
        while process.poll() is None:
            try:
                words += read(ours)
                report(words, progress)
                time.sleep(0.02)
            except KeyboardInterrupt:
                interrupted = True
            if requested is None and (interrupted or stopped()):
                requested = time.monotonic()
                process.send_signal(signal.SIGINT)
            if requested is not None and time.monotonic() - requested > PATIENCE:
                process.kill()
        words += read(ours)
        os.close(ours)
    return process.returncode, said(words), requested is not None


def terminal():
    try:
        import pty
        return pty.openpty()
    except (ImportError, OSError):
        return os.pipe()


def read(descriptor):
    try:
        return os.read(descriptor, 1 << 16).decode("utf-8", "replace")
    except (BlockingIOError, OSError):  # nothing new; a terminal that is open no more
        return ""


def report(words, progress):
    found = None
    for found in PASS.finditer(words[-400:]):
        pass
    if found:
        progress(NOISE.sub("", found.group(0)), int(found.group(1)) / int(found.group(2)) if found.group(2) else 0.0)


def said(words):
    """Its messages without the lines of progress."""
    lines = [NOISE.sub("", line).strip() for line in re.split(r"[\r\n]+", words)]
    return "\n".join(line for line in lines if line and not PASS.match(line))
