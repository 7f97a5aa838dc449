#!/usr/bin/env python3
"""Builds the documentation site: pages of docs/ with executed tutorials, the reference of Python and, by Doxygen, of C++ and C.

    docs/site/build.py [--build FOLDER] [--out FOLDER] [--no-execute]

FOLDER of --build (build/release) holds the compiled command and the Python module, which the pages run; --out (build/site) gets an environment
of Sphinx from PyPI, the sources as Sphinx reads them, and html/, which is read from there without a network. A warning of Sphinx or Doxygen, a
cell that raises, a dead link, a picture without a text and anything loaded from elsewhere fail.
"""
import argparse
import os
import re
import shutil
import subprocess
import sys
import venv
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent


def environment(folder):
    """Python with Sphinx: made once, and again when requirements.txt changes."""
    python, made = folder / "bin/python", folder / "requirements.txt"
    wanted = (HERE / "requirements.txt").read_text(encoding="utf-8")
    if not made.is_file() or made.read_text(encoding="utf-8") != wanted:
        venv.create(folder, with_pip=True, clear=True)
        subprocess.run([python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "-r", HERE / "requirements.txt"], check=True)
        made.write_text(wanted, encoding="utf-8")
    return python


def version():
    return re.search(r"project\(mote VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")).group(1)


def doxygen(out):
    """The reference of the public headers, into html/reference."""
    if not shutil.which("doxygen"):
        sys.exit("site: doxygen is not installed (tools/install_packages.sh)")
    folder = out / "doxygen"
    shutil.rmtree(folder, ignore_errors=True)
    (folder / "reference/headers").mkdir(parents=True)
    subprocess.run([sys.executable, ROOT / "docs/reference/house_style.py", ROOT, folder / "reference/headers"], check=True)
    text = (ROOT / "docs/reference/Doxyfile.in").read_text(encoding="utf-8")
    for name, value in (("PROJECT_VERSION", version()), ("PROJECT_DESCRIPTION", "many-light rendering"), ("PROJECT_BINARY_DIR", folder),
                        ("PROJECT_SOURCE_DIR", ROOT)):
        text = text.replace(f"@{name}@", str(value))
    (folder / "Doxyfile").write_text(text, encoding="utf-8")
    if subprocess.run(["doxygen", folder / "Doxyfile"], cwd=folder, check=False).returncode:
        sys.exit((folder / "reference/warnings.txt").read_text(encoding="utf-8"))
    shutil.copytree(folder / "reference/html", out / "html/reference", dirs_exist_ok=True)


def sphinx(python, build, out, execute):
    profile = out / "ipython/profile_default"
    profile.mkdir(parents=True, exist_ok=True)
    # Pages run beside their kernels: that these listen without encryption is no warning of this build.
    (profile / "ipython_kernel_config.py").write_text("c.IPKernelApp.log_level = 'ERROR'\n", encoding="utf-8")
    variables = os.environ | {"MOTE_SITE_VERSION": version(), "MOTE_SITE_EXECUTE": "cache" if execute else "off", "MOTE_SITE_ROOT": str(ROOT),
                              "MOTE_SITE_STATIC": str(out / "source/_static"), "IPYTHONDIR": str(profile.parent),
                              "PYTHONPATH": f"{build / 'python'}:{HERE}", "PATH": f"{build / 'bin'}:{os.environ['PATH']}",
                              "MPLBACKEND": "module://matplotlib_inline.backend_inline", "PYDEVD_DISABLE_FILE_VALIDATION": "1"}
    done = subprocess.run([python, "-m", "sphinx", "-b", "html", "-W", "--keep-going", "-q", "-c", HERE, "-d", out / "doctrees", out / "source",
                    out / "html"], env=variables, check=False)
    if done.returncode:
        sys.exit("site: Sphinx has warnings")


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--build", type=Path, default=ROOT / "build/release")
    options.add_argument("--out", type=Path, default=ROOT / "build/site")
    options.add_argument("--no-execute", action="store_true", help="leave the pages' code unexecuted")
    chosen = options.parse_args()
    build, out = chosen.build.resolve(), chosen.out.resolve()
    if not chosen.no_execute and not list((build / "python/mote").glob("_mote*.so")):
        sys.exit(f"site: {build}/python has no module mote: build everything first (./quickstart)")
    if not chosen.no_execute and not (ROOT / "scenes/generated/smoke.vdb").is_file():
        subprocess.run([ROOT / "scenes/generate"], check=True)
    python = environment(out / "env")
    shutil.rmtree(out / "html", ignore_errors=True)
    subprocess.run([python, HERE / "sources.py", out / "source"], check=True)
    sphinx(python, build, out, not chosen.no_execute)
    doxygen(out)
    sys.exit(subprocess.run([python, HERE / "check_html.py", out / "html"], check=False).returncode)


if __name__ == "__main__":
    main()
