"""Find the files that read an environment variable."""

from __future__ import annotations

import re
from collections.abc import Mapping

from linkwright.diagnostics import Phrase, phrase
from linkwright.review.caching import cached_in_review
from linkwright.review.environment_names import is_read_by_others
from linkwright.review.file_pair import FilePair
from linkwright.review.launch_paths import is_launch_file
from linkwright.review.texts.comments import without_comments
from linkwright.review.versions import Version

_SEARCHED_SUFFIXES = (".launch", ".xml", ".py", ".yaml", ".yml", ".xacro", ".urdf", ".cpp", ".hpp", ".h", ".c")
_READING = re.compile(r"(?:env|environ|getenv|environ\.get|EnvironmentVariable)\W{1,8}(?P<name>[A-Za-z_]\w*)")


def _find_reader(version: Version, name: str, excluded: str) -> str | None:
    """Return a file that reads an environment variable, or None if there is none.

    The path is relative to the root.

    Args:
        version: the version of the repository.
        name: the name of the variable.
        excluded: the path of a file that is not searched, relative to the root.
    """
    return next((path for path in _find_readers_by_variable(version).get(name, ()) if path != excluded), None)


def explain_removed_reading(pair: FilePair, name: str) -> tuple[str | None, Phrase | None]:
    """Return the file that still reads an environment variable which a launch file no longer reads, and the reason.

    The reason why this is breaking is None if it is not. The path is relative to the root.
    """
    reader = _find_reader(pair.versions.new, name, pair.new_path)
    if reader is None and is_read_by_others(name):
        return None, None
    if reader is None:
        return None, phrase("a value that a user sets for '{name}' has no effect", name=name)
    was_reader = reader in _find_readers_by_variable(pair.versions.old).get(name, ())
    is_ignored = was_reader and not is_launch_file(reader) and not is_read_by_others(name)
    return reader, phrase("the launch file ignores the value of '{name}'", name=name) if is_ignored else None


@cached_in_review(maxsize=2)
def _find_readers_by_variable(version: Version) -> Mapping[str, list[str]]:
    """Return the files that read environment variables outside of comments, by the name of the variable.

    The paths are relative to the root.
    """
    readers: dict[str, list[str]] = {}
    for path in version.paths(_SEARCHED_SUFFIXES):
        names = {match["name"] for match in _READING.finditer(version.text(path))}
        if names:
            names = {match["name"] for match in _READING.finditer(without_comments(version.text(path), path))}
        for variable in names:
            readers.setdefault(variable, []).append(path)
    return readers
