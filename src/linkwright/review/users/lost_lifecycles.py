"""Find node classes that are no longer lifecycle nodes, or are such nodes now."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import PurePosixPath

from linkwright.diagnostics import phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.sources.headers.lost_types import blank_comments
from linkwright.review.sources.names import CPP_SUFFIXES, PYTHON_SUFFIX
from linkwright.review.versions import TEST_FOLDERS, Version, Versions

_CPP_CLASS = re.compile(
    r"\b(?:class|struct)\s+(?:[A-Z]\w*_\w+\s+)?(?P<name>\w+)\s*(?:final\s*)?:(?!:)(?P<bases>[^;{]*)\{"
)
_PYTHON_CLASS = re.compile(r"^[ \t]*class[ \t]+(?P<name>\w+)[ \t]*\((?P<bases>[^)]*)\)", re.MULTILINE)
_LIFECYCLE = re.compile(r"\bLifecycleNode\b")
_NODE = re.compile(r"\bNode\b")
_CONFIGURING = re.compile(
    r"trigger_configure|trigger_transition|TRANSITION_CONFIGURE|TRANSITION_ACTIVATE|lifecycle_manager|ChangeState\b|"
    r"\blifecycle\s+set\b|->\s*configure\(\)"
)
"""A call or launch action that may configure a lifecycle node."""
_CONFIGURING_SUFFIXES = (*CPP_SUFFIXES, PYTHON_SUFFIX, ".xml", ".yaml", ".yml", ".launch", ".sh")


def find_lost_lifecycles(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the changed sources with a class that was a lifecycle node and is a plain node, or the other way round.

    Each comes with a change.
    """
    for file in changed_files:
        is_source = file.path.endswith((*CPP_SUFFIXES, PYTHON_SUFFIX))
        if not (file.old_path and file.new_path and is_source) or file.is_submodule:
            continue
        if not TEST_FOLDERS.isdisjoint(PurePosixPath(file.path).parts):
            continue
        old, new = _read_bases(versions.old, file.old_path), _read_bases(versions.new, file.new_path)
        for name, (bases, line) in new.items():
            was_managed = name in old and _LIFECYCLE.search(old[name][0])
            if was_managed and not _LIFECYCLE.search(bases) and _NODE.search(bases):
                text = phrase("class '{name}' is no longer a lifecycle node", name=name)
                reason = phrase("programs that configure and activate the node do not find its services")
                yield file.new_path, Change(text, Effect.BREAKING, reason, Location(file.new_path, line, 1))
            was_plain = name in old and _NODE.search(old[name][0]) and not _LIFECYCLE.search(old[name][0])
            if was_plain and _LIFECYCLE.search(bases):
                yield file.new_path, _make_lifecycle_change(versions.new, name, Location(file.new_path, line, 1))


def _make_lifecycle_change(version: Version, name: str, location: Location) -> Change:
    """Return the change of a plain node to a lifecycle node, which is breaking unless a file may configure it."""
    text = phrase("class '{name}' is a lifecycle node now", name=name)
    if any(_CONFIGURING.search(version.text(path)) for path in version.paths(_CONFIGURING_SUFFIXES)):
        return Change(text, location=location)
    reason = phrase("the node does nothing until a program configures and activates it")
    return Change(text, Effect.BREAKING, reason, location)


def _read_bases(version: Version, path: str) -> dict[str, tuple[str, int]]:
    """Return the base classes and the line of each class with base classes in a source."""
    is_python = path.endswith(PYTHON_SUFFIX)
    text = version.text(path) if is_python else blank_comments(version.text(path))
    pattern = _PYTHON_CLASS if is_python else _CPP_CLASS
    return {
        match["name"]: (match["bases"], text.count("\n", 0, match.start("name")) + 1)
        for match in pattern.finditer(text)
    }
