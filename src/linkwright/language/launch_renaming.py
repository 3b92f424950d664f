"""Rename launch arguments, in the launch files that share them through includes.

A launch configuration is visible in included files, and a configuration that an included file sets is visible after the
include. So a name means the same argument in two files if one includes the other without passing the argument. A passed
argument belongs to the included file: its key changes with that file, and its value stays.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from itertools import islice
from pathlib import Path

from linkwright.diagnostics import Phrase, SourceText, Span, display_path, phrase
from linkwright.language.format import Document
from linkwright.language.launch_names import LaunchInclude, LaunchName, LaunchNames, find_launch_names, is_launch_file
from linkwright.language.mentions import Mention
from linkwright.language.proof import Edit, UnprovedError
from linkwright.language.workspace import Workspace

_ENDINGS = (".py", ".launch", ".launch.xml", "_launch.xml", ".yaml", ".yml")
_MAX_FILES = 600


@dataclass
class LaunchRenaming:
    """The edits for a new name of a launch argument.

    Attributes:
        edits: the edits of all launch files that share the argument.
        unchanged: strings with the name that may mean the argument, and stay unchanged.
        notes: includes that cannot be followed.
    """

    edits: set[Edit] = field(default_factory=set)
    unchanged: list[Mention] = field(default_factory=list)
    notes: list[Phrase] = field(default_factory=list)


def launch_name_at(document: Document, offset: int) -> tuple[LaunchName, Path] | None:
    """Return the launch argument at an offset and the file that it belongs to, or None."""
    names = find_launch_names(document)
    for name in names.names:
        if name.start <= offset <= name.end:
            return name, document.file
    for include in names.includes:
        for name in include.passed_names:
            if name.start <= offset <= name.end:
                return (name, include.target) if include.target is not None else None
    return None


def rename_launch_argument(
    workspace: Workspace, texts: Mapping[Path, str], owner: Path, old: str, new: str
) -> LaunchRenaming:
    """Return the edits that rename a launch argument.

    Args:
        workspace: the folders that the editor has opened.
        texts: the texts of the open files.
        owner: the launch file that the argument belongs to.
        old: the present name.
        new: the new name.

    Raises:
        UnprovedError: the new name exists, or a file that cannot be edited shares the argument.
    """
    return _ArgumentSearch(workspace, texts, old, new).run(owner)


class _ArgumentSearch:
    """The launch files that share an argument.

    Args:
        workspace: the folders that the editor has opened.
        texts: the texts of the open files.
        old: the present name.
        new: the new name.
    """

    def __init__(self, workspace: Workspace, texts: Mapping[Path, str], old: str, new: str) -> None:
        self._project, self._texts, self._old, self._new = workspace, texts, old, new
        self._names_by_file: dict[Path, LaunchNames] = {}
        self._result = LaunchRenaming()

    def run(self, owner: Path) -> LaunchRenaming:
        """Return the edits, from the file that the argument belongs to."""
        includers = self._index_includers()
        shared: dict[Path, None] = {}
        pending = [owner]
        while pending:
            file = pending.pop()
            if file in shared:
                continue
            shared[file] = None
            for include in self._read_names(file).includes:
                pending += self._sharing_files(file, include)
            for other, include in includers.get(file, ()):
                key = self._find_passed_name(include)
                if key is not None:
                    self._add_edit(key)
                elif not include.is_known:
                    self._result.notes.append(
                        phrase(
                            "'{file}' passes computed arguments to '{included_file}'",
                            file=other.name,
                            included_file=file.name,
                        )
                    )
                elif self._mentions_above(other, includers, {file}):
                    pending.append(other)
        for file in shared:
            names = self._read_names(file)
            for name in names.names:
                if name.name == self._new:
                    raise UnprovedError(
                        phrase("'{file}' already uses '{name}'", file=file.name, name=self._new), self._span(name)
                    )
                if name.name == self._old:
                    self._add_edit(name)
            self._result.unchanged += [
                Mention(name.name, name.file, name.start) for name in names.texts if name.name == self._old
            ]
        return self._result

    def _sharing_files(self, file: Path, include: LaunchInclude) -> Iterator[Path]:
        """Yield the file of an include if it shares the argument."""
        if self._find_passed_name(include) is not None:
            return
        if include.target is None:
            if include.path_text:
                self._result.notes.append(
                    phrase(
                        "'{file}' includes '{included_file}', which cannot be found",
                        file=file.name,
                        included_file=include.path_text,
                    )
                )
        elif self._mentions_below(include.target, set()):
            yield include.target

    def _mentions_argument(self, file: Path) -> bool:
        return any(name.name == self._old for name in self._read_names(file).names)

    def _mentions_below(self, file: Path, seen_files: set[Path]) -> bool:
        """Return whether a file, or a file that shares its arguments, mentions the argument."""
        if file in seen_files:
            return False
        seen_files.add(file)
        return self._mentions_argument(file) or any(
            include.target is not None
            and self._find_passed_name(include) is None
            and self._mentions_below(include.target, seen_files)
            for include in self._read_names(file).includes
        )

    def _mentions_above(
        self, file: Path, includers: Mapping[Path, list[tuple[Path, LaunchInclude]]], seen_files: set[Path]
    ) -> bool:
        """Return whether a file, one of its includes or one of its includers has the argument."""
        if file in seen_files:
            return False
        seen_files.add(file)
        if self._mentions_argument(file):
            return True
        targets = (
            include.target
            for include in self._read_names(file).includes
            if include.target is not None and self._find_passed_name(include) is None
        )
        return any(
            self._mentions_below(target, {*seen_files}) for target in targets if target not in seen_files
        ) or any(
            self._find_passed_name(include) is None
            and include.is_known
            and self._mentions_above(other, includers, seen_files)
            for other, include in includers.get(file, ())
        )

    def _find_passed_name(self, include: LaunchInclude) -> LaunchName | None:
        return next((name for name in include.passed_names if name.name == self._old), None)

    def _add_edit(self, name: LaunchName) -> None:
        if not self._project.contains(name.file):
            raise UnprovedError(
                phrase("'{file}' is outside the workspace", file=display_path(str(name.file))), self._span(name)
            )
        self._result.edits.add(Edit(name.file, name.start, name.end, self._new))

    def _span(self, name: LaunchName) -> Span:
        return SourceText(str(name.file), self._project.text(name.file, self._texts) or "").span(name.start, name.end)

    def _index_includers(self) -> dict[Path, list[tuple[Path, LaunchInclude]]]:
        """Return the launch files of the workspace that include a file, by the file."""
        includers: dict[Path, list[tuple[Path, LaunchInclude]]] = {}
        files = (file for file in self._project.files(_ENDINGS) if is_launch_file(file))
        for file in islice(files, _MAX_FILES):
            for include in self._read_names(file).includes:
                if include.target is not None:
                    includers.setdefault(include.target, []).append((file, include))
        return includers

    def _read_names(self, file: Path) -> LaunchNames:
        if file not in self._names_by_file:
            text = self._project.text(file, self._texts) or ""
            is_launch = is_launch_file(file)
            self._names_by_file[file] = (
                find_launch_names(Document(self._project, self._texts, file, text)) if is_launch else LaunchNames()
            )
        return self._names_by_file[file]
