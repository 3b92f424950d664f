"""Models and worlds in SDF that are written as templates of Jinja or empy, and read as far as they are XML."""

from __future__ import annotations

import re
from pathlib import PurePosixPath

from linkwright.sdf.text import parse_as_gazebo
from linkwright.xmltree import Element
from linkwright.xmltree.reader import read_bytes

TEMPLATE_SUFFIXES = (".sdf.jinja", ".sdf.jinja2", ".world.jinja", ".sdf.em", ".world.em")
_STATEMENT = re.compile(r"\{%.*?%\}|\{#.*?#\}|@\[.*?\]@?(?=\s*$)|^\s*@#.*?$", re.DOTALL | re.MULTILINE)
_EXPRESSION = re.compile(r"\{\{(?P<content>.*?)\}\}", re.DOTALL)
_ESCAPED = {"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;"}


def is_template(path: str) -> bool:
    """Return whether a path is that of a template for SDF."""
    return PurePosixPath(path).name.endswith(TEMPLATE_SUFFIXES)


def template_elements(file: str) -> list[Element]:
    """Return the elements of a template in which the statements are left out; expressions stay as texts.

    The result has the elements of all branches. Lines and columns are those of the file.

    Raises:
        LinkwrightError: the template is not XML without its statements, or the file cannot be read.
    """
    text = read_bytes(file).decode("utf-8", errors="replace")
    text = _STATEMENT.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), text)
    text = _EXPRESSION.sub(lambda match: f"{{{{{_escaped(match['content'])}}}}}", text)
    document, _ = parse_as_gazebo(text, file)
    return list(document.root.elements())


def _escaped(text: str) -> str:
    return "".join(_ESCAPED.get(character, character) for character in text)
