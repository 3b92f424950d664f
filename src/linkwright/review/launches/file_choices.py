"""Compare the arguments that choose the files of an action: such an argument may choose another file or none."""

from __future__ import annotations

import re
from collections.abc import Iterator

from linkwright.diagnostics import Phrase, phrase, quoted_names
from linkwright.review.file_pair import FilePair
from linkwright.review.launches.included import callers_of
from linkwright.review.launches.outlines import Entry, LaunchOutline

_VARIABLE = re.compile(r"\$\((?:var|arg) (?P<name>[^() ]+)[^()]*\)")
_FOLDER = re.compile(r"\$\((find|find-pkg-share|dirname)[ )]")
_FILE = re.compile(r"/.*\.(xacro|urdf|srdf|sdf|world|yaml|yml|rviz|xml|launch|json|pgm|png|stl|dae|py)$")
_SEPARATORS = frozenset(" ,'\"[]=")


class FileChoices:
    """Report changes of the arguments that choose files in a launch file.

    Args:
        pair: both versions of the launch file.
        old: the old outline, with the new names of arguments.
        new: the outline of the new file.
    """

    def __init__(self, pair: FilePair, old: LaunchOutline, new: LaunchOutline) -> None:
        self._pair = pair
        self._old = old
        self._new = new
        self._seen: set[str] = set()

    def compare(self, old: Entry, new: Entry) -> None:
        """Report the files of an action that depend on other arguments."""
        old_files, new_files = set(_file_paths(old, self._old)), set(_file_paths(new, self._new))
        removed, added = old_files - new_files, new_files - old_files
        for before in sorted(removed):
            for after in sorted(added):
                is_same = self._old.resolve(before) == self._new.resolve(after)
                is_lone = len(removed) == 1 and (not _argument_names(before) or len(added) == 1)
                if is_same or is_lone or _last_part(before) == _last_part(after):
                    self._compare_files(before, after, new)

    def _compare_files(self, before: str, after: str, entry: Entry) -> None:
        arguments = {argument.name for argument in self._new.entries if argument.kind == "argument"}
        lost = (_argument_names(before) - _argument_names(after)) & arguments
        old_file, new_file = self._old.resolve(before), self._new.resolve(after)
        is_known = not _VARIABLE.search(old_file + new_file)
        if lost:
            names = quoted_names(sorted(lost))
            is_used = (is_known and old_file != new_file) or any(map(self._is_passed, lost))
            reason = phrase("the value that a caller passes for {names} chooses another file", names=names)
            text = phrase("{names} no longer chooses the file '{file}'", names=names, file=after)
            if is_known and old_file != new_file:
                text = phrase(
                    "{change}; by default, it is '{new}' instead of '{old}'", change=text, old=old_file, new=new_file
                )
            self._add(text, entry, reason if is_used else None)
        elif _argument_names(before) and _argument_names(after) and is_known and old_file != new_file:
            text = phrase("by default, the file is '{new}' instead of '{old}'", old=old_file, new=new_file)
            self._add(text, entry, None)
        elif not _argument_names(before) and _argument_names(after):
            names = quoted_names(sorted(_argument_names(after)))
            text = phrase("the file '{file}' depends on {names} now", file=after, names=names)
            if is_known and old_file == new_file:
                text = phrase("{change}; by default, it is the same as before", change=text)
            elif is_known:
                text = phrase("{change}; by default, it is '{file}'", change=text, file=new_file)
            self._add(text, entry, None)

    def _add(self, text: Phrase, entry: Entry, reason: Phrase | None) -> None:
        if str(text) not in self._seen:
            self._seen.add(str(text))
            self._pair.add(text, self._pair.location(entry.span), reason)

    def _is_passed(self, name: str) -> bool:
        """Return whether another launch file passes an argument to this one."""
        callers = callers_of(self._pair.versions.new, self._pair.new_path, name)
        return any(name in include.settings for _, include in callers)


def _file_paths(entry: Entry, outline: LaunchOutline) -> Iterator[str]:
    """Yield the paths of files in the name and the settings of an action."""
    if entry.has_value:
        return
    names = (entry.name,) if entry.kind in ("include", "parameters", "process") else ()
    for text in (*names, *entry.settings.values()):
        for word in _split_words(text):
            path = outline.resolve(word)
            if "/" in path and (_FOLDER.match(path) or _FILE.search(path)):
                yield word


def _split_words(text: str) -> Iterator[str]:
    """Yield the words of a text, such as a command line. A substitution is not split."""
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


def _argument_names(path: str) -> set[str]:
    return set(_VARIABLE.findall(path))


def _last_part(path: str) -> str:
    return path.rpartition("/")[2]
