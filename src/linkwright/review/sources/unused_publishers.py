"""Recognize publishers with which a source never published a message, or no longer publishes one."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from pathlib import PurePosixPath

from linkwright.files.git_repository import ChangedFile
from linkwright.review.sources.changed_sources import imports
from linkwright.review.sources.names import CPP_SUFFIXES, PYTHON_SUFFIX, NameKind, SourceName, SourceNames
from linkwright.review.texts.comments import without_comments
from linkwright.review.versions import Version

_ASSIGNED = re.compile(
    r"^[ \t]*(?:self\.|this\s*->\s*)?(?P<variable>\w+)\s*=\s*[\w.:>-]*?"
    r"(?:create_publisher|Publisher|advertise)\b\s*(?:<[^;()]*>)?\s*\(",
    re.MULTILINE,
)
_DECLARED = r"(?:Publisher\w*|SharedPtr|Ptr|>)\s+{variable}\s*(?:;|=\s*(?:nullptr|None)\b|\{{)"
_PUBLISHED = re.compile(r"\b(\w+)\s*(?:\.|->)\s*publish\s*\(")
"""A call with which a variable publishes a message."""
_BY_TEXT = re.compile(r"\b(?:getattr|vars|__dict__)\b")
"""Code that can use an attribute without its name."""


def is_unused_publisher(item: SourceName, names: SourceNames, version: Version, path: str) -> bool:
    """Return whether a name is that of a publisher whose variable is not used, so that it never published a message.

    Sources that the source imports, and those that import it, do not name it either, such as those of base classes.

    Args:
        item: the name.
        names: all names in the source.
        version: the version with the source.
        path: the path of the source.
    """
    return _find_unused_variable(item, names, version, path) is not None


def find_silent_publishers(old: Version, new: Version, file: ChangedFile, names: SourceNames) -> list[SourceName]:
    """Return the publishers that both versions have but whose variable only the old version used to publish.

    Args:
        old: the old version.
        new: the new version.
        file: the changed source.
        names: all names in the new source.
    """
    if file.old_path is None or file.new_path is None:
        return []
    text, new_text = (
        without_comments(version.text(path), path) for version, path in ((old, file.old_path), (new, file.new_path))
    )
    silent = set(_PUBLISHED.findall(text)).difference(_PUBLISHED.findall(new_text))
    return [
        item
        for item in (names.names if silent else ())
        if re.search(rf"[\"']{re.escape(item.name)}[\"']", text)
        and _find_unused_variable(item, names, new, file.new_path) in silent
    ]


def _find_unused_variable(item: SourceName, names: SourceNames, version: Version, path: str) -> str | None:
    """Return the variable of a publisher that nothing uses; None if it is used, or for another name."""
    if item.kind is not NameKind.PUBLISHER or names.counts[item.kind, item.name] != 1:
        return None
    text = without_comments(version.text(path), path)
    start = sum(map(len, version.text(path).splitlines(keepends=True)[: item.span.line]))
    matches = [match for match in _ASSIGNED.finditer(text, 0, start) if text.count(")", match.end(), start) <= 1]
    quoted = re.compile(rf"[\"']{re.escape(item.name)}[\"']")
    if not matches or quoted.search(text, matches[-1].end(), start) is None:
        return None
    variable: str = matches[-1]["variable"]
    is_python = path.endswith(PYTHON_SUFFIX)
    folder = version.package_of(path) or ""
    paths = _find_connected(version, path) if is_python else version.paths(CPP_SUFFIXES, folder)
    texts = [text, *(without_comments(version.text(other), other) for other in paths if other != path)]
    word = re.compile(rf"(?<![\"'/\w]){variable}(?![\"'/\w])")  # texts may have the same name
    declared = re.compile(_DECLARED.format(variable=variable))
    uses = sum(len(word.findall(other)) for other in texts)
    declarations = 0 if is_python else sum(len(declared.findall(other)) for other in texts)
    is_unused = uses == 1 + min(declarations, 1) and not any(map(_BY_TEXT.search, texts))
    return variable if is_unused else None


def _find_connected(version: Version, path: str) -> Collection[str]:
    """Return the Python sources that a source imports, also through others, and those that import it."""
    texts = {other: version.text(other) for other in version.paths((PYTHON_SUFFIX,))}
    found: dict[str, None] = {}
    pending = [path]
    while pending:
        source = pending.pop()
        for other in _list_imported(texts, texts.get(source, "")):
            if other not in found:
                found[other] = None
                pending.append(other)
    stem = PurePosixPath(path).stem
    found.update(dict.fromkeys(other for other, text in texts.items() if stem in text and imports(text, stem)))
    return [other for other in found if other != path]


def _list_imported(texts: Collection[str], text: str) -> Iterator[str]:
    stems = set(re.findall(r"\w+", "\n".join(re.findall(r"^\s*(?:import|from)\b.*", text, re.MULTILINE))))
    yield from (path for path in texts if PurePosixPath(path).stem in stems)
