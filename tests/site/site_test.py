#!/usr/bin/env python3
"""Builds the site with all that its pages run, and checks it (docs/site/build.py). LEFT OUT where Sphinx cannot be fetched or doxygen is missing.

    site_test.py BUILD
"""
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "docs/site"))
import build  # noqa: E402

if __name__ == "__main__":
    try:
        build.environment(ROOT / "build/site/env")
    except subprocess.CalledProcessError as error:
        sys.exit(print(f"LEFT OUT the site: no Sphinx ({error})"))
    if not shutil.which("doxygen"):
        sys.exit(print("LEFT OUT the site: no doxygen"))
    sys.exit(subprocess.run([sys.executable, ROOT / "docs/site/build.py", "--build", sys.argv[1]], check=False).returncode)
