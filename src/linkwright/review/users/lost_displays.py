"""Find RViz configurations that still show a topic which a changed source or launch file no longer publishes."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import PurePosixPath

from linkwright.diagnostics import phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.launch_paths import is_launch_file
from linkwright.review.launches.name_effects import publishes
from linkwright.review.launches.outlines import NAMESPACE, REMAPPING, Entry, LaunchOutline
from linkwright.review.launches.programs.sources import try_read_outline
from linkwright.review.sources.names import CPP_SUFFIXES, PYTHON_SUFFIX, NameKind
from linkwright.review.sources.reading import read_source_names
from linkwright.review.versions import Version, Versions

_SOURCE_SUFFIXES = (*CPP_SUFFIXES, PYTHON_SUFFIX)
_USING_SUFFIXES = (*_SOURCE_SUFFIXES, ".launch", ".xml", ".yaml", ".yml")
"""The files that may publish a topic, or give it to another one as a name."""
_RVIZ_SUFFIX = ".rviz"
_RVIZ = ("rviz2/rviz2", "rviz/rviz")
_LAUNCH_SUFFIX = re.compile(r"[._]launch(?:\.\w+)?$|\.\w+$")
_FROM_FILE = re.compile(r"^[ \t]*Description Source:[ \t]*File\b", re.MULTILINE)
"""The setting of a display that reads the robot description from a file instead of the topic."""


def find_lost_displays(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the RViz configurations that show a lost topic, each with a change.

    A topic of a source is lost if no source, launch file or parameter file of the new version contains its name.
    """
    yield from _find_remapped_displays(versions, changed_files)
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
    display = _compile_display(topic)
    found = []
    for path in version.paths((_RVIZ_SUFFIX,)):
        text = version.text(path)
        match = display.search(text)
        if match is not None:
            found.append((path, text.count("\n", 0, match.start()) + 1))
    use = re.compile(rf"[\"'>]/?{name}[\"'<]|[:=][ \t]*/?{name}[ \t]*$", re.MULTILINE)
    if found and not any(use.search(version.text(path)) for path in version.paths(_USING_SUFFIXES)):
        yield from found


def _compile_display(topic: str) -> re.Pattern[str]:
    """Return the pattern of a line of an RViz configuration that shows a topic."""
    return re.compile(rf"^[ \t]*(?:Value|[\w ]*Topic):[ \t]*/?{re.escape(topic.strip('/'))}[ \t]*$", re.MULTILINE)


def _find_remapped_displays(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the RViz configurations that show a topic which the launch file that opens them remaps now."""
    for file in changed_files:
        if file.old_path is None or file.new_path is None or not is_launch_file(file.path):
            continue
        old, new = try_read_outline(versions.old, file.old_path), try_read_outline(versions.new, file.new_path)
        lost = {} if old is None or new is None else _find_remapped_topics(old, new)
        for path in sorted(_find_configurations(versions.new, file.path, new)) if lost and new is not None else ():
            text = versions.new.text(path)
            for topic, new_name in lost.items():
                match = _compile_display(topic).search(text)
                if match is not None and _FROM_FILE.search(text) is None:
                    change = phrase(
                        "shows the topic '{topic}', which '{file}' remaps to '{name}' now",
                        topic=topic,
                        file=file.path,
                        name=new_name,
                    )
                    line = text.count("\n", 0, match.start()) + 1
                    yield path, Change(change, Effect.BREAKING, phrase("the display is empty"), Location(path, line, 1))


def _find_remapped_topics(old: LaunchOutline, new: LaunchOutline) -> dict[str, str]:
    """Return the topics that all nodes of a launch file which publish them newly remap, each with a new name.

    Nothing is certain if the file includes others, or remaps topics of several nodes or of RViz.
    """
    entries = [entry for entry in new.entries if entry.kind == "node"]
    is_open = any(entry.kind in ("include", "remapping") for entry in new.entries)
    is_remapped = any(
        entry.name in _RVIZ and (_list_remapped(entry) or NAMESPACE in entry.settings) for entry in entries
    )
    lost: dict[str, str] = {}
    for program in dict.fromkeys(entry.name for entry in entries) if not is_open and not is_remapped else ():
        own = [entry for entry in entries if entry.name == program]
        before = [entry for entry in old.entries if entry.kind == "node" and entry.name == program]
        for source in dict.fromkeys(source for entry in own for source in _list_remapped(entry)):
            if not publishes(program, source, old, new):
                continue
            old_names, new_names = (
                {_resolve_name(entry, source, outline) for entry in group}
                for group, outline in ((before, old), (own, new))
            )
            others = {_resolve_name(entry, name, new) for entry in entries for name in _list_remapped(entry)}
            topic = source.lstrip("/")
            if topic in old_names - new_names - others:
                lost[source] = min(new_names)
    return lost


def _list_remapped(entry: Entry) -> list[str]:
    """Return the names that a node remaps, without those of a condition."""
    return [name.removeprefix(REMAPPING) for name in entry.settings if name.startswith(REMAPPING) and " (" not in name]


def _resolve_name(entry: Entry, source: str, outline: LaunchOutline) -> str:
    """Return the name of a topic of a node outside of the node, without a slash at its start."""
    name = outline.resolve(entry.settings.get(f"{REMAPPING}{source}", source))
    namespace = "" if name.startswith("/") else outline.resolve(entry.settings.get(NAMESPACE, ""))
    return f"{namespace}/{name}".strip("/")


def _find_configurations(version: Version, file: str, outline: LaunchOutline) -> Iterator[str]:
    """Yield the RViz configurations of the repository that show what a launch file starts.

    These are the ones that it opens, or the one with its name beside it if it starts RViz without one.
    """
    windows = [entry for entry in outline.entries if entry.name in _RVIZ]
    arguments = " ".join(outline.resolve(entry.settings.get("arguments", "")) for entry in windows)
    launch_file = PurePosixPath(file)
    stem = _LAUNCH_SUFFIX.sub("", launch_file.name)
    for path in map(PurePosixPath, version.paths((_RVIZ_SUFFIX,)) if windows else ()):
        is_beside = path.parent == launch_file.parent or path.parent.parent == launch_file.parent.parent
        is_opened = f"/{path.parent.name}/{path.name}" in arguments
        if is_opened or (not arguments and is_beside and path.stem == stem):
            yield path.as_posix()
