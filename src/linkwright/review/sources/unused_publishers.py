"""Recognize publishers with which a source never published a message."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from pathlib import PurePosixPath

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
    if item.kind is not NameKind.PUBLISHER or names.counts[item.kind, item.name] != 1:
        return False
    text = without_comments(version.text(path), path)
    start = sum(map(len, version.text(path).splitlines(keepends=True)[: item.span.line]))
    matches = [match for match in _ASSIGNED.finditer(text, 0, start) if text.count(")", match.end(), start) <= 1]
    quoted = re.compile(rf"[\"']{re.escape(item.name)}[\"']")
    if not matches or quoted.search(text, matches[-1].end(), start) is None:
        return False
    variable = matches[-1]["variable"]
    is_python = path.endswith(PYTHON_SUFFIX)
    folder = version.package_of(path) or ""
    paths = _find_connected(version, path) if is_python else version.paths(CPP_SUFFIXES, folder)
    texts = [text, *(without_comments(version.text(other), other) for other in paths if other != path)]
    word = re.compile(rf"(?<![\"'/\w]){variable}(?![\"'/\w])")  # texts may have the same name
    declared = re.compile(_DECLARED.format(variable=variable))
    uses = sum(len(word.findall(other)) for other in texts)
    declarations = 0 if is_python else sum(len(declared.findall(other)) for other in texts)
    return uses == 1 + min(declarations, 1) and not any(map(_BY_TEXT.search, texts))


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
