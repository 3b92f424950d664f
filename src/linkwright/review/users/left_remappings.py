"""Find remappings to a name that the other files of the repository have renamed."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from difflib import SequenceMatcher
from pathlib import PurePosixPath

from linkwright.diagnostics import phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.launch_paths import is_launch_file
from linkwright.review.launches.outlines import REMAPPING, Entry, LaunchOutline
from linkwright.review.launches.programs.sources import try_read_outline
from linkwright.review.sources.names import CPP_SUFFIXES, PYTHON_SUFFIX
from linkwright.review.texts.comments import without_comments
from linkwright.review.versions import TEST_FOLDERS, Version, Versions

_SUFFIXES = (".launch", ".xml", ".yaml", ".yml", PYTHON_SUFFIX, *CPP_SUFFIXES)
_WORD = re.compile(r"\w+")
_NAME = re.compile(r"[A-Za-z]\w*_\w+")
"""A name that is not a common word, because it consists of several."""
_MIN_FILES = 3
"""The minimum number of files that replace a name in the same way."""
_MAX_LEFT = 2
"""The maximum number of lines that still have a name which the commit meant to replace everywhere."""
_MAX_FILES = 100
_MAX_BYTES = 1 << 18
_Edit = tuple[str, str]
"""The old and the new name."""


def find_left_remappings(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the launch files that still remap to a name which other files have replaced, each with a change.

    The other files of the repository no longer have the name.
    """
    files: dict[_Edit, set[str]] = {}
    for file in [file for file in changed_files if _is_searched(file)][:_MAX_FILES]:
        texts = versions.old.text(file.old_path or ""), versions.new.text(file.new_path or "")
        if max(map(len, texts)) <= _MAX_BYTES:
            for edit in _find_edits(*texts):
                files.setdefault(edit, set()).add(file.path)
    edits = {old: (new, len(paths)) for (old, new), paths in files.items() if len(paths) >= _MIN_FILES}
    for old, (new, count) in sorted(edits.items()):
        mentions = list(_find_mentions(versions.new, old))
        if len(mentions) > _MAX_LEFT:
            continue
        for path in sorted({path for path, _ in mentions if is_launch_file(path)}):
            outline = try_read_outline(versions.new, path)
            entry = None if outline is None else _find_remapping(outline, old)
            if entry is not None:
                text = phrase(
                    "still remaps to '{old}', which {count} other files call '{new}' now", old=old, count=count, new=new
                )
                reason = phrase("no other file uses '{name}' any more", name=old)
                lines = [line for mentioning, line in mentions if mentioning == path]
                yield path, Change(text, Effect.BREAKING, reason, Location(path, lines[0], 1))


def _is_searched(file: ChangedFile) -> bool:
    is_changed = file.old_path is not None and file.new_path is not None and not file.is_submodule
    return is_changed and _is_compared(file.path)


def _is_compared(path: str) -> bool:
    return path.endswith(_SUFFIXES) and TEST_FOLDERS.isdisjoint(PurePosixPath(path).parts)


def _find_edits(old: str, new: str) -> set[_Edit]:
    """Return the names that lines replace by another name and in which they differ in nothing else."""
    lines = old.splitlines(), new.splitlines()
    edits: set[_Edit] = set()
    for tag, start, end, new_start, new_end in SequenceMatcher(None, *lines, autojunk=False).get_opcodes():
        if tag != "replace" or end - start != new_end - new_start:
            continue
        for before, after in zip(lines[0][start:end], lines[1][new_start:new_end], strict=True):
            words = _WORD.findall(before), _WORD.findall(after)
            if len(words[0]) != len(words[1]):
                continue
            pairs = {pair for pair in zip(*words, strict=True) if pair[0] != pair[1]}
            edits |= {pair for pair in pairs if len(pairs) == 1 and _NAME.fullmatch(pair[0])}
    return edits


def _find_mentions(version: Version, name: str) -> Iterator[tuple[str, int]]:
    """Yield the lines of a version that have a name outside of comments, with the paths of their files."""
    word = re.compile(rf"\b{re.escape(name)}\b")
    for path in version.paths(_SUFFIXES):
        text = version.text(path) if _is_compared(path) else ""
        if name in text:
            code = without_comments(text, path)
            yield from ((path, code.count("\n", 0, match.start()) + 1) for match in word.finditer(code))


def _find_remapping(outline: LaunchOutline, name: str) -> Entry | None:
    """Return an action that remaps to a name, or None if there is none."""
    for entry in outline.entries:
        values = [value for setting, value in entry.settings.items() if setting.startswith(REMAPPING)]
        if entry.kind == "remapping":
            values = [entry.settings.get("to", "")]
        if any(outline.resolve(value).strip("/~").rpartition("/")[2] == name for value in values):
            return entry
    return None
