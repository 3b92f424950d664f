"""Remove the comments of files in C++, XML, and languages whose comments begin with ``#``."""

from __future__ import annotations

import re

CPP_SUFFIXES = (".cpp", ".cc", ".cxx", ".hpp", ".hh", ".h")
XML_SUFFIXES = (".launch", ".xml", ".xacro", ".urdf", ".srdf", ".sdf", ".world", ".test")
_COMMENTS = {
    "xml": re.compile(r"<!--.*?-->", re.DOTALL),
    "cpp": re.compile(r"/\*.*?\*/|(?<![:\"])//[^\n]*", re.DOTALL),
    "hash": re.compile(r"(?:(?<=\s)|^)#[^\n]*", re.MULTILINE),
}


def without_comments(text: str, path: str) -> str:
    """Return a text of the same length, with spaces in place of comments."""
    kind = "cpp" if path.endswith(CPP_SUFFIXES) else "xml" if path.endswith(XML_SUFFIXES) else "hash"
    return _COMMENTS[kind].sub(lambda match: " " * len(match[0]), text)
