"""Makes the site of this folder: sphinx-build -W --keep-going -n -b html docs docs/_build/html."""

import re
from html import escape

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.writers.html5 import HTML5Translator
from ziamath import Latex

import yawdesign

project = "yawdesign"
author = "The yawdesign developers"
version = release = yawdesign.__version__
extensions = ["myst_parser", "sphinx.ext.autodoc", "numpydoc"]
exclude_patterns = ["_build"]
highlight_language = "none"  # of a block that names none: what a command prints

# Links to headings as code-hosting sites make them, formulas between dollar signs.
myst_heading_anchors = 4
myst_enable_extensions = ["dollarmath"]

autodoc_preserve_defaults = True
autodoc_typehints = "none"  # the docstrings name the types
autodoc_member_order = "bysource"
autodoc_default_options = {"members": True}
numpydoc_show_class_members = False  # what has a docstring of its own follows its class

html_theme = "furo"
html_title = f"yawdesign {release}"
html_static_path = ["static"]
html_css_files = ["site.css"]
html_show_copyright = False
html_copy_source = False
html_math_renderer = "drawn"
EM = 15  # units of a formula's drawing in the size of the letters around it


def formula(translator: HTML5Translator, node: nodes.math | nodes.math_block) -> None:
    """Draw a formula into the page, which then shows it without a script, a network or a font for mathematics."""
    block, text = isinstance(node, nodes.math_block), node.astext()
    drawn = Latex(text, size=16, inline=not block, color="currentColor")
    svg = drawn.svg()
    width, height = (float(re.search(rf'{side}="([\d.]+)"', svg)[1]) / EM for side in ("width", "height"))
    style = f"width:{width:.3f}em;height:{height:.3f}em;vertical-align:{drawn.getyofst() / EM:.3f}em"
    svg = svg.replace("<svg ", f'<svg role="img" aria-label="{escape(text, quote=True)}" style="{style}" ', 1)
    translator.body.append(f'<div class="formula">{svg}</div>' if block else svg)
    raise nodes.SkipNode


def setup(app: Sphinx) -> None:
    """Add how formulas are written."""
    app.add_html_math_renderer("drawn", (formula, None), (formula, None))
