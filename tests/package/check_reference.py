"""Makes the reference of the public headers; shows that a name without docs would be found."""
import argparse
import subprocess
import sys
from pathlib import Path

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--source", type=Path, required=True)
parser.add_argument("--build", type=Path, required=True)
parser.add_argument("--doxygen", required=True)
arguments = parser.parse_args()
folder = arguments.build / "reference"
headers = folder / "headers"


def doxygen():
    done = subprocess.run([arguments.doxygen, folder / "Doxyfile"], text=True, capture_output=True)
    warnings = (folder / "warnings.txt").read_text() if (folder / "warnings.txt").exists() else ""
    return done.returncode, warnings.replace(str(headers), str(arguments.source)) + done.stderr


subprocess.run([sys.executable, arguments.source / "docs/reference/house_style.py", arguments.source, headers], check=True)
code, warnings = doxygen()
if code != 0 or warnings.strip():
    sys.exit(f"{warnings}\nA public name needs a comment that says what it is, with its unit (cmake/public_headers.txt)")
pages = len(list((folder / "html").glob("*.html")))

planted = headers / "core/math/ray.h"
whole = planted.read_text()
planted.write_text(whole.replace("struct Ray {", "struct Ray {\n    float undocumented = 0.0f;\n"))
code, warnings = doxygen()
planted.write_text(whole)
if code == 0 or "undocumented" not in warnings:
    sys.exit("a name without docs is not found")
print(f"{pages} pages, no warning; a planted name without docs is found")
