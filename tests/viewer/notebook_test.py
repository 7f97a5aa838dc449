"""The notebook of examples/ from top to bottom. Prints LEFT OUT without nbclient and anywidget.

Usage: notebook_test.py NOTEBOOK SCENES
"""
import json
import os
import sys

try:
    import anywidget  # noqa: F401
    import nbclient
    import nbformat
except ImportError as missing:
    print(f"LEFT OUT: {missing} (tools/python_packages.sh --notebook installs it)")
    sys.exit(0)

path, scenes = sys.argv[1:3]
os.environ["MOTE_SCENES"] = os.path.abspath(scenes)
notebook = nbformat.read(path, as_version=4)
# The kernel is this Python, whatever kernels the user has installed.
client = nbclient.NotebookClient(notebook, timeout=300, kernel_name="python3", resources={"metadata": {"path": os.path.dirname(path)}})
client.execute()
outputs = [output for cell in notebook.cells for output in cell.get("outputs", [])]
images = sum("image/png" in output.get("data", {}) for output in outputs)
widgets = [output["data"]["application/vnd.jupyter.widget-view+json"] for output in outputs
           if "application/vnd.jupyter.widget-view+json" in output.get("data", {})]
state = client.widget_state if hasattr(client, "widget_state") else {}
scripts = [json.dumps(s) for s in state.values() if "_esm" in json.dumps(s)]
print(f"{images} images, {len(widgets)} widgets, {len(scripts)} of them with the page")
if images < 4 or len(widgets) != 2 or len(scripts) != 2:
    print("FAILED")
    sys.exit(1)
print("passed")
