"""Compare the arguments that choose the files of an action.

In the new version, an argument may choose a different file or none.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator

from linkwright.diagnostics import Phrase, phrase, quoted_names
from linkwright.review.file_pair import FilePair
from linkwright.review.launches.included import find_callers
from linkwright.review.launches.outlines import Entry, LaunchOutline, without_condition

_VARIABLE = re.compile(r"\$\((?:var|arg) (?P<name>[^() ]+)[^()]*\)")
_FOLDER = re.compile(r"\$\((find|find-pkg-share|dirname)[ )]")
_FILE = re.compile(r"/.*\.(xacro|urdf|srdf|sdf|world|yaml|yml|rviz|xml|launch|json|pgm|png|stl|dae|py)$")
_SEPARATORS = frozenset(" ,'\"[]=")


class FileChoices:
    """Report changes to the arguments that choose files in a launch file.

    Args:
        pair: both versions of the launch file.
        old: the old outline, with the new names of arguments.
        new: the outline of the new file.
        renamed: the new names of renamed arguments, which choose nothing under their old names anyway.
    """

    def __init__(
        self, pair: FilePair, old: LaunchOutline, new: LaunchOutline, renamed: Collection[str] = frozenset()
    ) -> None:
        self._pair = pair
        self._old = old
        self._new = new
        self._renamed = frozenset(renamed)
        self._reported_texts: set[str] = set()

    def compare(self, old: Entry, new: Entry) -> None:
        """Report the files of an action that depend on different arguments."""
        old_files, new_files = _find_file_paths(old, self._old), _find_file_paths(new, self._new)
        removed, added = old_files.keys() - new_files.keys(), new_files.keys() - old_files.keys()
        for old_path in sorted(removed):
            for new_path in sorted(path for path in added if old_files[old_path] & new_files[path]):
                is_same_file = self._old.resolve(old_path) == self._new.resolve(new_path)
                is_only_candidate = len(removed) == 1 and (not _find_argument_names(old_path) or len(added) == 1)
                if is_same_file or is_only_candidate or _get_file_name(old_path) == _get_file_name(new_path):
                    self._compare_files(old_path, new_path, new)

    def _compare_files(self, old_path: str, new_path: str, entry: Entry) -> None:
        """Report that an action has a different file, or that different arguments choose it."""
        arguments = {argument.name for argument in self._new.entries if argument.kind == "argument"}
        lost_arguments = (_find_argument_names(old_path) - _find_argument_names(new_path)) & arguments - self._renamed
        old_file, new_file = self._old.resolve(old_path), self._new.resolve(new_path)
        is_known = not _VARIABLE.search(old_file + new_file)
        if lost_arguments:
            names = quoted_names(sorted(lost_arguments))
            is_breaking = (is_known and old_file != new_file) or any(map(self._is_passed, lost_arguments))
            reason = phrase("the value that a caller passes for {names} chooses another file", names=names)
            text = phrase("{names} no longer chooses the file '{file}'", names=names, file=new_path)
            if is_known and old_file != new_file:
                text = phrase(
                    "{change}; by default, it is '{new}' instead of '{old}'", change=text, old=old_file, new=new_file
                )
            self._add(text, entry, reason if is_breaking else None)
        elif _find_argument_names(old_path) and _find_argument_names(new_path) and is_known and old_file != new_file:
            text = phrase("by default, the file is '{new}' instead of '{old}'", old=old_file, new=new_file)
            self._add(text, entry, None)
        elif not _find_argument_names(old_path) and _find_argument_names(new_path):
            names = quoted_names(sorted(_find_argument_names(new_path)))
            text = phrase("the file '{file}' depends on {names} now", file=new_path, names=names)
            known = {argument.name for argument in self._old.entries if argument.kind == "argument"}
            is_new = known.isdisjoint(_find_argument_names(new_path)) and new_path not in entry.name
            if old_file == new_file and is_new:
                return  # the lines about the setting and the added argument tell it
            if is_known and old_file == new_file:
                text = phrase("{change}; by default, it is the same as before", change=text)
            elif is_known:
                text = phrase("{change}; by default, it is '{file}'", change=text, file=new_file)
            self._add(text, entry, None)

    def _add(self, text: Phrase, entry: Entry, reason: Phrase | None) -> None:
        """Add a change to the report, unless the report already has a change with this text."""
        if str(text) not in self._reported_texts:
            self._reported_texts.add(str(text))
            self._pair.add(text, self._pair.location(entry.span), reason)

    def _is_passed(self, name: str) -> bool:
        """Return whether another launch file passes an argument to this one."""
        callers = find_callers(self._pair.versions.new, self._pair.new_path, name)
        return any(name in include.settings for _, include in callers)


def _find_file_paths(entry: Entry, outline: LaunchOutline) -> dict[str, set[str]]:
    """Return the paths of files in the name and the settings of an action, each with the settings that name it."""
    paths: dict[str, set[str]] = {}
    if entry.has_value:
        return paths
    names = {"": entry.name} if entry.kind in ("include", "parameters", "process") else {}
    for setting, text in (names | entry.settings).items():
        for word in _split_words(text):
            path = outline.resolve(word)
            if "/" in path and (_FOLDER.match(path) or _FILE.search(path)):
                paths.setdefault(word, set()).add(without_condition(setting))
    return paths


def _split_words(text: str) -> Iterator[str]:
    """Yield the words of a text, such as a command line, without splitting substitutions."""
    word, depth = "", 0
    for character in text.replace("$(command ", " "):
        if depth == 0 and (character in _SEPARATORS or character == ")"):
            if word:
                yield word
            word = ""
            continue
        depth += (character == "(") - (character == ")")
        word += character
    if word:
        yield word


def _find_argument_names(path: str) -> set[str]:
    return set(_VARIABLE.findall(path))


def _get_file_name(path: str) -> str:
    return path.rpartition("/")[2]
