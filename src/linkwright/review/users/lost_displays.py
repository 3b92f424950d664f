"""Find RViz configurations that still show a topic which a changed source no longer publishes."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from linkwright.diagnostics import phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.sources.names import CPP_SUFFIXES, PYTHON_SUFFIX, NameKind
from linkwright.review.sources.reading import read_source_names
from linkwright.review.versions import Version, Versions

_SOURCE_SUFFIXES = (*CPP_SUFFIXES, PYTHON_SUFFIX)
_USING_SUFFIXES = (*_SOURCE_SUFFIXES, ".launch", ".xml", ".yaml", ".yml")
"""The files that may publish a topic, or give it to another one as a name."""
_RVIZ_SUFFIX = ".rviz"


def find_lost_displays(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the RViz configurations that show a lost topic, each with a change.

    A topic is lost if no source, launch file or parameter file of the new version contains its name.
    """
    for file in changed_files:
        if not (file.old_path and file.new_path and file.path.endswith(_SOURCE_SUFFIXES)) or file.is_submodule:
            continue
        old, new = (
            {item.name for item in read_source_names(version.file(path)).of_kind(NameKind.PUBLISHER)}
            for version, path in ((versions.old, file.old_path), (versions.new, file.new_path))
        )
        for topic in sorted(old - new):
            for path, line in _find_displays(versions.new, topic):
                text = phrase(
                    "shows the topic '{topic}', which '{file}' no longer publishes", topic=topic, file=file.path
                )
                yield path, Change(text, Effect.BREAKING, phrase("the display is empty"), Location(path, line, 1))


def _find_displays(version: Version, topic: str) -> Iterator[tuple[str, int]]:
    """Yield the RViz configurations that show a topic, with the line; none if the topic has other users."""
    name = re.escape(topic.strip("/"))
    display = re.compile(rf"^[ \t]*(?:Value|[\w ]*Topic):[ \t]*/?{name}[ \t]*$", re.MULTILINE)
    found = []
    for path in version.paths((_RVIZ_SUFFIX,)):
        text = version.text(path)
        match = display.search(text)
        if match is not None:
            found.append((path, text.count("\n", 0, match.start()) + 1))
    use = re.compile(rf"[\"'>]/?{name}[\"'<]|[:=][ \t]*/?{name}[ \t]*$", re.MULTILINE)
    if found and not any(use.search(version.text(path)) for path in version.paths(_USING_SUFFIXES)):
        yield from found
