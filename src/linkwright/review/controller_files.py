"""Find controllers that a plugin of ros2_control no longer loads, because it names another parameter file."""

from __future__ import annotations

import re
from pathlib import PurePosixPath

from linkwright.descriptions.comparison import Difference
from linkwright.diagnostics import Phrase, phrase
from linkwright.review.file_pair import UnreadableFileError
from linkwright.review.files.parameters.names import find_all_controllers, make_controllers_reason
from linkwright.review.files.parameters.yaml_values import read_yaml_values
from linkwright.review.versions import Version, Versions

_PARAMETERS = re.compile(r"(?:.* )?parameters")
"""The path of the value with the parameter file of a plugin."""
_SUFFIXES = (".yaml", ".yml")
_PACKAGE = re.compile(r"\$\(find(?:-pkg-share)? ([\w.-]+)\)|package://(?=[\w.-]+/)")
_SOURCE_SUFFIXES = (".py",)


def find_controller_file_reason(difference: Difference, versions: Versions) -> Phrase | None:
    """Return the reason why another parameter file of a plugin is breaking, or None if it is not.

    It is breaking if the new file lacks controllers of the old one, or if a source of the repository wrote the old one.

    Args:
        difference: the difference between both versions.
        versions: both versions.
    """
    old, new = difference.old or "", difference.new or ""
    if difference.subject != "extension" or not _PARAMETERS.fullmatch(difference.property):
        return None
    new_path = _find_file(versions.new, new)
    if not (old.endswith(_SUFFIXES) and new.endswith(_SUFFIXES)) or new_path is None:
        return None
    old_path = _find_file(versions.old, old)
    if old_path is None:
        if not _is_written(versions.old, PurePosixPath(old).name):
            return None
        file = "/".join(PurePosixPath(old).parts[-2:])
        return phrase("controllers that only '{file}' configures do not start", file=file)
    try:
        lost = _read_controllers(versions.old, old_path) - _read_controllers(versions.new, new_path)
    except UnreadableFileError:
        return None
    return make_controllers_reason(sorted(lost)) if lost else None


def _find_file(version: Version, text: str) -> str | None:
    """Return the path of the file of the repository that a text names with its package, or None."""
    text = _PACKAGE.sub(lambda match: f"/{match[1] or ''}", text)
    for path in version.paths((PurePosixPath(text).name,)):
        package = version.package_of(path)
        if package and text.endswith(f"/{PurePosixPath(package).name}/{PurePosixPath(path).relative_to(package)}"):
            return path
    return None


def _is_written(version: Version, name: str) -> bool:
    """Return whether a source of a version opens a file of this name for writing."""
    pattern = re.compile(rf"\bopen\([^\n]*\b{re.escape(name)}['\"][^\n]*,\s*(?:mode\s*=\s*)?['\"]w")
    return any(pattern.search(version.text(path)) for path in version.paths(_SOURCE_SUFFIXES))


def _read_controllers(version: Version, path: str) -> set[str]:
    return set(find_all_controllers(read_yaml_values(version.text(path))))
