"""The site of these pages: ``sphinx-build -W --keep-going -c docs . build/site``.

The source folder is the project's own, so that links between files are the same on GitHub and here, and the protocol,
the change log and the like are pages as they are. What a link reaches beside the pages is a file in the repository.
"""

from __future__ import annotations

import importlib
import inspect
import posixpath
import re
from pathlib import Path
from typing import Any

from docutils import nodes
from docutils.statemachine import StringList
from sphinx.application import Sphinx
from sphinx.errors import ExtensionError
from sphinx.util.docutils import SphinxDirective
from sphinx.util.nodes import nested_parse_with_titles

import paneldraw

PROJECT = Path(__file__).parent.parent
_SETTINGS = (PROJECT / "pyproject.toml").read_text(encoding="utf-8")
HOME, release = (re.search(rf'^{name} = "(.*)"$', _SETTINGS, re.M)[1] for name in ("Source", "version"))

project = "paneldraw"
author = "the paneldraw authors"
copyright = f"2026, {author}"
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
root_doc = "docs/index"
include_patterns = [
    "docs/**",
    "firmware_protocol/PROTOCOL.md",
    "firmware_protocol/firmware/README.md",
    "README.md",
    "CHANGELOG.md",
    "CONTRIBUTING.md",
    "SECURITY.md",
]
exclude_patterns = [".*", "build", "paneldraw", "tests"]
nitpicky = True

html_theme = "furo"
html_title = f"paneldraw {release}"
html_theme_options = {
    "source_repository": HOME,
    "source_branch": "main",
    "source_directory": "",
}
html_copy_source = False
html_static_path = ["_static"]
html_css_files = ["pages.css"]

myst_heading_anchors = 4
myst_links_external_new_tab = False
# Pages are read on GitHub too, where quotes stay as they are written.
smartquotes_action = "D"
linkcheck_anchors = False  # a thread's comments come by JavaScript
linkcheck_retries = 3
suppress_warnings = ["ref.python"]  # `bus` may be one of many

autodoc_member_order = "bysource"
autodoc_typehints = "none"  # the docstrings give them, in words
autodoc_default_options = {
    "members": True,
    "special-members": "__call__",
    # What a class has from others stands with it, but for what is Python's and what all simulated chips have.
    "inherited-members": "object,BaseException,OSError,tuple,int,list,Chip,DisplayChip,Protocol,Generic",
}
napoleon_google_docstring = False
napoleon_use_ivar = True
napoleon_use_rtype = False

napoleon_preprocess_types = True
default_role = "py:obj"
# What stands in single backquotes in a docstring, and the words of a type, are links where there is such a name.
nitpick_ignore_regex = [("py:obj", ".*"), ("py:class", "(?!paneldraw|firmware_protocol).*")]

_LINK = re.compile(r"(\]\()([^)#\s]+)((?:#[^)\s]*)?\))")
_ENTRY = re.compile(r"(?<!!)\[([^]`]+)\]\(([^)#:]+\.md)\)")
_FENCED = re.compile(r"(^```.*?^```$)", re.M | re.S)
_PART = re.compile(r"^## (.+)\n((?s:.*?))(?=^## |\Z)", re.M)


def links_that_lead_somewhere(app: Sphinx, page: str, source: list[str]) -> None:
    """Let a link to a file that is no page lead to where the project is at home."""
    folder = posixpath.dirname(page)

    def leading(link: re.Match[str]) -> str:
        target = posixpath.normpath(posixpath.join(folder, link[2]))
        if (
            re.match(r"[a-z]+:", link[2])
            or target.startswith("docs/")
            or target.removesuffix(".md") in app.env.found_docs
        ):
            return link[0]
        if not (PROJECT / target).exists():
            raise ExtensionError(f"{page}.md: there is no {target}")
        return f"{link[1]}{HOME}/{'tree' if (PROJECT / target).is_dir() else 'blob'}/main/{target}{link[3]}"

    parts = _FENCED.split(source[0])
    parts[::2] = [_LINK.sub(leading, part) for part in parts[::2]]
    source[0] = "".join(parts)


def navigation(app: Sphinx, page: str, source: list[str]) -> None:
    """Make the table of contents of what the first pages link, in that order: of each section, or of a page without."""
    if page.endswith("/index"):
        parts = [(f":caption: {part[1]}\n", part[2]) for part in _PART.finditer(source[0])] or [("", source[0])]
        for caption, text in parts:
            entries = "\n".join(f"{name} <{target}>" for name, target in _ENTRY.findall(text))
            source[0] += f"\n\n```{{toctree}}\n:hidden:\n{caption}\n{entries}\n```\n"


class Public(SphinxDirective):
    """All that a module says is public, in the order of its list; what another page has already is a link to it."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        name = self.arguments[0]
        module = importlib.import_module(name)
        lines = [f".. py:module:: {name}", "", *(inspect.getdoc(module) or "").splitlines(), ""]
        for public in module.__all__:
            lines += [*described(name, public, getattr(module, public)), ""]
        content = StringList(lines, source=f"{name}.__all__")
        into = nodes.Element()
        nested_parse_with_titles(self.state, content, into)
        return into.children


def described(module: str, name: str, value: object) -> list[str]:
    """One name, as reStructuredText."""
    if module.startswith("paneldraw.") and getattr(paneldraw, name, None) is value:
        return [f"`{name}` is `paneldraw.{name}`."]
    if inspect.isclass(value):
        return [f".. autoclass:: {module}.{name}"]
    if callable(value) and not hasattr(value, "about"):
        return [f".. autofunction:: {module}.{name}"]
    said = getattr(value, "about", f"Of {', '.join(map(str, value))}." if isinstance(value, dict) else "")
    shown = [] if said or len(repr(value)) > 60 else [f"   :value: {value!r}"]
    return [f".. py:data:: {name}", *shown, "", f"   {said}"]


def front_door(app: Sphinx, failed: Exception | None) -> None:
    """Let the address without a page lead to the first one."""
    if failed is None and app.builder.name == "html":
        page = f'<!doctype html><meta http-equiv="refresh" content="0; url={root_doc}.html"><title>paneldraw</title>\n'
        Path(app.outdir, "index.html").write_text(page, encoding="utf-8")
        Path(app.outdir, ".nojekyll").touch()


def setup(app: Sphinx) -> dict[str, Any]:
    """Sphinx calls this."""
    app.add_directive("public", Public)
    app.connect("source-read", links_that_lead_somewhere)
    app.connect("source-read", navigation)
    app.connect("build-finished", front_door)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
