# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sphinx's settings of the site, which scripts/site.sh builds."""

import shutil
from pathlib import Path

from sphinx_gallery.scrapers import figure_rst

project = "CiliaVal"
copyright = "the CiliaVal developers; LGPL-2.1-or-later"
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx_copybutton", "sphinx_gallery.gen_gallery"]
# Of GitHub's view of this folder; the scripts, which are shown on pages of their own.
exclude_patterns = ["README.md", "gallery"]

myst_heading_anchors = 4  # the links to headings that GitHub makes

html_theme = "furo"
html_title = project
html_show_sphinx = False
pygments_style = "friendly"

copybutton_prompt_text = "$ "

autoclass_content = "both"  # with the constructor's arguments
autodoc_typehints = "none"  # the docstrings have types, shapes and units
autodoc_member_order = "bysource"


def picture(block, variables, gallery):
    """The picture that a script writes, named after it."""
    made = Path(variables["src_file"]).with_suffix(".png")
    if not made.exists():
        return ""
    path = Path(next(variables["image_path_iterator"]))
    shutil.move(made, path)
    return figure_rst([str(path)], gallery["src_dir"])


sphinx_gallery_conf = {
    "examples_dirs": "gallery",
    "gallery_dirs": "gallery_pages",
    "filename_pattern": r"\.py$",
    "image_scrapers": (picture,),
    "abort_on_example_error": True,
    "download_all_examples": False,
    "show_signature": False,
    "min_reported_time": 1e9,
}
