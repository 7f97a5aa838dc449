"""Sphinx's configuration of the site. build.py writes the sources that it reads, and sets the environment."""
import os

project = "mote"
author = "The mote authors"
copyright = "the mote authors"
version = release = os.environ["MOTE_SITE_VERSION"]
extensions = ["myst_nb", "sphinx.ext.mathjax", "sphinx.ext.autodoc"]
master_doc = "index"
exclude_patterns = ["files"]

myst_enable_extensions = ["dollarmath", "colon_fence"]
myst_heading_anchors = 5
nb_execution_mode = os.environ["MOTE_SITE_EXECUTE"]
nb_execution_timeout = 300
nb_execution_raise_on_error = False  # a cell that raises is a warning, and those are errors at the end
nb_execution_show_tb = True
nb_merge_streams = True
highlight_language = "text"

html_theme = "furo"
html_title = f"mote {release}"
html_static_path = [os.environ["MOTE_SITE_STATIC"]]
html_css_files = ["mote.css"]
html_show_sourcelink = False
html_copy_source = False
html_show_search_summary = False  # summaries are fetched, which a browser refuses to pages of a folder
mathjax_path = "tex-svg.js"  # one file of MathJax 3, with its glyphs: formulas need no network

autodoc_member_order = "bysource"
autodoc_typehints = "none"


def plain_docstring(app, what, name, obj, options, lines):
    """Docstrings of the module are plain text: marks of reStructuredText in them are escaped, indented lines are code."""
    out, inside = [], False
    for line in lines:
        code = line.startswith("    ")
        if code and not inside:
            out += ["", "::", ""]
        elif not code and inside and line.strip():
            out.append("")
        inside = code or (inside and not line.strip())
        out.append(line if code else "".join("\\" + c if c in "*`|_\\" else c for c in line))
    lines[:] = out


def setup(app):
    app.connect("autodoc-process-docstring", plain_docstring)
