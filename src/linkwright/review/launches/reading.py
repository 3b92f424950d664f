"""Read launch files in Python, XML and YAML."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from linkwright.diagnostics import SourceText, foreign, phrase
from linkwright.review.caching import cached_in_review
from linkwright.review.file_pair import UnreadableFileError
from linkwright.review.launches.markup import read_markup_outline, read_yaml_tags, tag_from_xml
from linkwright.review.launches.outlines import LaunchOutline, join_namespaces
from linkwright.review.launches.python.actions import ACTIONS
from linkwright.review.launches.python.dictionary_classes import expand_dictionary_classes
from linkwright.review.launches.python.environment import find_python_readings
from linkwright.review.launches.python.helpers import HelperFunctions
from linkwright.review.launches.python.imported_values import assign_imported_values, uses_unknown_actions
from linkwright.review.launches.python.names import LaunchPythonFile
from linkwright.review.launches.python.outlines import read_python_outline
from linkwright.xacro.cache import read_document

_MAX_OUTLINES = 512
"""The maximum number of outlines that are kept."""


@cached_in_review(maxsize=_MAX_OUTLINES)
def read_outline(path: Path, root: Path) -> LaunchOutline:
    """Return the outline of a launch file in Python, XML or YAML.

    Args:
        path: the file.
        root: the folder of the repository, which may contain functions that make actions.

    Raises:
        LinkwrightError: the file is not XML.
        UnreadableFileError: the file is not Python or YAML.
        OSError: the file cannot be read.
        ValueError: the file is not text in UTF-8.
    """
    return replace(join_namespaces(_read(path, root)), root=root)


def _read(path: Path, root: Path) -> LaunchOutline:
    if path.suffix in (".yaml", ".yml"):
        return read_markup_outline(read_yaml_tags(path))
    if path.suffix != ".py":
        return read_markup_outline(tag_from_xml(read_document(str(path)).root))
    try:
        python = LaunchPythonFile(SourceText(str(path), path.read_text("utf-8")))
    except SyntaxError as error:
        line, reason = error.lineno or 1, foreign(error.msg)
        message = phrase("line {line} is not valid Python: {reason}", line=line, reason=reason)
        raise UnreadableFileError(message) from None
    helpers = HelperFunctions(root, ACTIONS)
    python = expand_dictionary_classes(assign_imported_values(python, helpers), helpers)
    outline = read_python_outline(python, helpers)
    return replace(
        outline,
        entries=[*outline.entries, *find_python_readings(python)],
        has_unknown_actions=uses_unknown_actions(python, helpers),
    )
