"""Recognize launch files by their names and contents."""

from __future__ import annotations

import re
from pathlib import Path

from linkwright.diagnostics import LinkwrightError
from linkwright.packages.launch_files import is_launch_file_name
from linkwright.review.caching import cached_in_review
from linkwright.review.versions import Version
from linkwright.xacro.cache import read_document

_LAUNCH_ROOT_TAG = re.compile(rb"\s*(<\?[^>]*>\s*)?(<!--(?:[^-]|-(?!->))*-->\s*)*<launch[\s>]")
_OTHER_ROOT_TAG = re.compile(rb"\s*(<\?[^>]*>\s*)?(<!--(?:[^-]|-(?!->))*-->\s*)*<(?!launch[\s>])[A-Za-z]")
_LAUNCH_FUNCTION = re.compile(rb"^def generate_launch_description\b|^def generate_test_description\b", re.MULTILINE)
LAUNCH_TEMPLATE_SUFFIXES = (".em", ".j2", ".jinja")
"""The ends of the names of templates from which a program makes launch files."""
_XML_SUFFIXES = (".xml", ".test", *LAUNCH_TEMPLATE_SUFFIXES)
_SUFFIXES = (".launch", *_XML_SUFFIXES, ".py", ".yaml", ".yml")
_MAX_BYTES = 1 << 20


def is_launch_file(path: str) -> bool:
    """Return whether a path is a launch file of ROS 1 or ROS 2."""
    return path.endswith(".launch") or is_launch_file_name(path)


def is_launch_xml(file: Path) -> bool:
    """Return whether the root of an XML file is ``<launch>``.

    Included files may have any name. A template counts if it is valid XML, although its expressions are not evaluated.
    """
    try:
        is_launch = file.suffix in _XML_SUFFIXES and _LAUNCH_ROOT_TAG.match(file.read_bytes()) is not None
        if is_launch and file.suffix in LAUNCH_TEMPLATE_SUFFIXES:
            read_document(str(file))
    except (OSError, LinkwrightError):
        return False
    return is_launch


def is_other_launch(file: Path) -> bool:
    """Return whether a file with the name of a launch file is XML of another program, such as Eclipse."""
    try:
        return file.suffix == ".launch" and _OTHER_ROOT_TAG.match(file.read_bytes()) is not None
    except OSError:
        return False


def is_launch_yaml(file: Path) -> bool:
    """Return whether a YAML file has the top-level key ``launch``.

    Included files may have any name.
    """
    try:
        return re.search(rb"(?m)^launch[ \t]*:", file.read_bytes()) is not None
    except OSError:
        return False


@cached_in_review(maxsize=8)
def find_launch_files(version: Version) -> tuple[str, ...]:
    """Return the paths of all launch files of a version: by their names, or by their contents."""
    return tuple(path for path in version.paths(_SUFFIXES) if is_launch_file(path) or contains_actions(version, path))


def contains_actions(version: Version, path: str) -> bool:
    """Return whether a file in Python, XML or YAML is a launch file by its contents, whatever its name."""
    file = version.file(path)
    try:
        if file.stat().st_size > _MAX_BYTES:
            return False
        if file.suffix == ".py":
            return _LAUNCH_FUNCTION.search(file.read_bytes()) is not None
    except OSError:
        return False
    return is_launch_yaml(file) if file.suffix in (".yaml", ".yml") else is_launch_xml(file)
