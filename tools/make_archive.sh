#!/bin/bash
# The archive of a commit as Zenodo takes it: build/archive/mote-VERSION.zip and .zenodo.json beside it, from CITATION.cff.
#
#   tools/make_archive.sh [COMMIT]     default: HEAD
#
# The same commit gives the same bytes. Upload both by hand, or by Zenodo's hook on releases, which reads CITATION.cff itself.
set -euo pipefail
cd "$(dirname "$0")/.."
commit=$(git rev-parse --verify "${1:-HEAD}^{commit}")
mkdir -p build/archive
python3 - "$commit" <<'PYTHON'
import json
import re
import subprocess
import sys

commit = sys.argv[1]
text = subprocess.run(["git", "show", f"{commit}:CITATION.cff"], check=True, capture_output=True, text=True).stdout


def value(name):
    found = re.search(rf'^{name}: *"?(.*?)"?$', text, re.M)
    if not found:
        sys.exit(f"CITATION.cff says no '{name}'")
    return found[1]


def items(name):
    block = re.search(rf"^{name}:\n((?:  .*\n)+)", text, re.M)
    return re.findall(r"^  - (?:name: )?\"?(.*?)\"?$", block[1], re.M) if block else []


version, title = value("version"), value("title")
cmake = subprocess.run(["git", "show", f"{commit}:CMakeLists.txt"], check=True, capture_output=True, text=True).stdout
if f"VERSION {version} " not in cmake:
    sys.exit(f"CITATION.cff says version {version}, CMakeLists.txt another one")
name = f"mote-{version}"
subprocess.run(["git", "archive", f"--prefix={name}/", "-o", f"build/archive/{name}.zip", commit], check=True)
date = subprocess.run(["git", "show", "-s", "--format=%cs", commit], check=True, capture_output=True, text=True).stdout.strip()
record = {"title": title, "version": version, "upload_type": "software", "publication_date": date,
          "description": value("abstract") if re.search("^abstract:", text, re.M) else title,
          "creators": [{"name": author} for author in items("authors")], "license": value("license"),
          "keywords": items("keywords"), "notes": f"commit {commit}"}
with open("build/archive/.zenodo.json", "w", encoding="utf-8") as file:
    json.dump(record, file, indent=2)
    file.write("\n")
print(f"build/archive/{name}.zip, build/archive/.zenodo.json: {title}, {date}, {record['license']}, {', '.join(items('authors'))}")
PYTHON
