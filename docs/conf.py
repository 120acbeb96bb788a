"""Sphinx configuration."""

from __future__ import annotations

import sys
from pathlib import Path

import carom

sys.path.insert(0, str(Path(__file__).parent))  # api_pages, examples_gallery

project = "carom"
author = "The carom developers"
copyright = "The carom developers"
version = release = carom.__version__

extensions = [
    "api_pages",
    "myst_parser",
    "numpydoc",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.mathjax",
    "sphinx.ext.viewcode",
    "sphinx-mathjax-offline",  # equations without a network
    "sphinx_gallery.gen_gallery",
]
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}
exclude_patterns = ["_build", "_templates", "**/GALLERY_HEADER.rst"]
templates_path = ["_templates"]

myst_enable_extensions = ["amsmath", "deflist", "dollarmath"]
myst_heading_anchors = 3
suppress_warnings = [
    "myst.strikethrough",
    "ref.python",  # the word in "array, shape (3,)", which is a field of two classes
]

autosummary_generate = True
autodoc_typehints = "none"  # the docstrings say it, with shapes and units
autodoc_member_order = "bysource"
numpydoc_show_class_members = False
default_role = "literal"

SECTIONS = ("first_steps", "impacts", "contact", "mechanisms", "many_runs", "paper")
sphinx_gallery_conf = {
    "examples_dirs": "../examples",
    "gallery_dirs": "gallery",
    "filename_pattern": r"\.py$",  # each one is run
    "subsection_order": [f"../examples/{name}" for name in SECTIONS],
    "within_subsection_order": "examples_gallery.Order",
    "image_scrapers": ("examples_gallery.pictures",),
    "reset_modules": ("examples_gallery.thumbnails",),
    "reset_modules_order": "both",
    "abort_on_example_error": True,
    "download_all_examples": False,
    "show_signature": False,
    "write_computation_times": False,
    "min_reported_time": 1e6,
    "copyfile_regex": r"",
    "thumbnail_size": (400, 400),
}

html_theme = "pydata_sphinx_theme"
html_title = "carom"
html_logo = html_favicon = "_static/logo.svg"  # docs/pictures/logo.py
html_static_path = ["_static"]
html_css_files = ["carom.css", "gallery.css"]
_ALONE = ("index", "start", "notation", "verification", "benchmarks", "comparison")
_ALONE += ("limits", "support", "changes", "cite")
html_sidebars = {page: [] for page in _ALONE}  # pages without others beside them
html_theme_options = {
    "logo": {"text": "carom"},  # beside the mark
    "show_toc_level": 2,
    "header_links_before_dropdown": 6,
    "navigation_with_keys": False,
    "secondary_sidebar_items": ["page-toc"],
}
html_show_sourcelink = False
