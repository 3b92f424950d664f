"""Rename the name at an offset of a file in any format."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, Span, phrase
from linkwright.language.definitions import NameKind
from linkwright.language.format import Document
from linkwright.language.grammar import root_of
from linkwright.language.launch_names import LaunchName, is_launch_file
from linkwright.language.launch_renaming import launch_name_at, rename_launch_argument
from linkwright.language.mentions import FILE_SUFFIXES, Mention, mentions_in
from linkwright.language.name_sources import rename_in_template, source_value
from linkwright.language.occurrences import Occurrence
from linkwright.language.other_files import find_names_of_robot, find_robots_of_file
from linkwright.language.proof import UnprovedError
from linkwright.language.renaming import Renaming, occurrence_at, rename, xacro_name_at
from linkwright.language.robot_renaming import ROBOT_NAME_KINDS
from linkwright.language.sdf_names import SdfName, find_sdf_name_at, rename_in_sdf
from linkwright.language.srdf import is_srdf
from linkwright.language.trials import run_trials
from linkwright.language.workspace import Workspace
from linkwright.sdf.worlds import SDF

_WORD = re.compile(r"[^\s\"'\[\]{},<>=|#]+")
_LAUNCH_NAME = re.compile(r"[\w.-]+")
_UNPROVED_CODE = "LANG104"
_MAX_ROBOTS = 4


@dataclass(frozen=True, slots=True)
class RenamableName:
    """A name that can be renamed.

    Attributes:
        file: the file that contains it.
        start: the offset of the name.
        name: the name as written.
        meaning: a name in a description or SRDF, a mention of a link or joint in another file, a launch argument with
            the file that it belongs to, or a name in an SDF model.
    """

    file: Path
    start: int
    name: str
    meaning: Occurrence | Mention | tuple[LaunchName, Path] | SdfName

    @property
    def end(self) -> int:
        """The offset after the name."""
        return self.start + len(self.name)


def renamable_name_at(workspace: Workspace, texts: Mapping[Path, str], file: Path, offset: int) -> RenamableName | None:
    """Return the renamable name at an offset of a file, or None if there is none.

    Args:
        workspace: the folders that the editor has opened.
        texts: the texts of the open files.
        file: the file of the request.
        offset: the character offset of the cursor.
    """
    text = workspace.text(file, texts)
    if text is None:
        return None
    if is_launch_file(file):
        launch = launch_name_at(Document(workspace, texts, file, text), offset)
        if launch is not None:
            return RenamableName(file, launch[0].start, launch[0].name, launch)
    elif root_of(file) is SDF:
        name = find_sdf_name_at(text, file, offset)
        if name is not None:
            return RenamableName(file, name.start, name.name, name)
        occurrence = xacro_name_at(text, file, offset)
        return None if occurrence is None else RenamableName(file, occurrence.start, occurrence.name, occurrence)
    elif not file.name.endswith(FILE_SUFFIXES):
        occurrence = occurrence_at(text, file, offset)
        return None if occurrence is None else RenamableName(file, occurrence.start, occurrence.name, occurrence)
    mention = _find_mention_at(text, file, offset)
    if mention is None or next(_find_robots_with(workspace, texts, mention), None) is None:
        return None
    return RenamableName(file, mention.start, mention.name, mention)


def _find_mention_at(text: str, file: Path, offset: int) -> Mention | None:
    """Return the mention of a link or joint at an offset, or None.

    The file is not a description.
    """
    begin = text.rfind("\n", 0, offset) + 1
    end = text.find("\n", offset)
    line = text[begin : end if end >= 0 else len(text)]
    for word in _WORD.finditer(line):
        if word.start() <= offset - begin <= word.end():
            mentioned_name = word[0].removeprefix("/")
            names = frozenset({mentioned_name, mentioned_name.rstrip(":")})
            for mention in mentions_in(text, file, names):
                if mention.start <= offset <= mention.end and mention.kinds:
                    return mention
    return None


def _find_robots_with(
    workspace: Workspace, texts: Mapping[Path, str], mention: Mention
) -> Iterator[tuple[Path, NameKind]]:
    """Yield the descriptions that may contain the mentioned link or joint, each with the kind."""
    for robot in find_robots_of_file(workspace, texts, mention.file):
        robot_names = find_names_of_robot(workspace, texts, robot)
        for kind in mention.kinds:
            if (kind, mention.name) in robot_names:
                yield robot, kind


def _may_equal(source_name: str, name: str) -> bool:
    parts = re.split(r"\$\{[^{}]*\}|\$\([^()]*\)", source_name)
    return any(parts) and re.fullmatch(".*".join(map(re.escape, parts)), name) is not None


def rename_name(workspace: Workspace, texts: Mapping[Path, str], renamable: RenamableName, new: str) -> Renaming:
    """Return the edits that rename a name.

    Args:
        workspace: the folders that the editor has opened.
        texts: the texts of the open files.
        renamable: the name, as `renamable_name_at` returns it.
        new: the new name.

    Raises:
        LinkwrightError: LANG102, the new name is not valid; LANG103, it exists; LANG104, the edits cannot be proved.
    """
    meaning = renamable.meaning
    if isinstance(meaning, Occurrence):
        return _rename_occurrence(workspace, texts, meaning, new)
    if isinstance(meaning, Mention):
        return _rename_mention(workspace, texts, meaning, new)
    try:
        if isinstance(meaning, SdfName):
            edits, unchanged = rename_in_sdf(workspace, texts, meaning, new)
            return Renaming(tuple(sorted(edits)), {meaning.name: new}, tuple(unchanged))
        if not _LAUNCH_NAME.fullmatch(new):
            raise _invalid_name_error(new, phrase("launch argument"))
        renaming = rename_launch_argument(workspace, texts, meaning[1], meaning[0].name, new)
    except UnprovedError as error:
        raise _refusal_error(renamable.name, error.reason, error.span) from None
    return Renaming(tuple(sorted(renaming.edits)), {}, tuple(renaming.unchanged), tuple(dict.fromkeys(renaming.notes)))


def _rename_occurrence(workspace: Workspace, texts: Mapping[Path, str], name: Occurrence, new: str) -> Renaming:
    """Rename a name in a description, or a use in an SRDF of a name in another file."""
    is_use = name.kind in ROBOT_NAME_KINDS[:2] and not name.is_definition
    if is_use and is_srdf(name.file):
        return _rename_in_srdf(workspace, texts, name, new)
    try:
        return rename(workspace, texts, name, new)
    except LinkwrightError as error:
        if not is_use or error.diagnostics[0].code != _UNPROVED_CODE:
            raise
        try:
            return _rename_in_srdf(workspace, texts, name, new)
        except LinkwrightError:
            raise error from None


def _rename_mention(workspace: Workspace, texts: Mapping[Path, str], mention: Mention, new: str) -> Renaming:
    """Rename the link or joint in the first description whose renaming changes the mention."""
    error: LinkwrightError | None = None
    for robot, kind in islice(_find_robots_with(workspace, texts, mention), _MAX_ROBOTS):
        try:
            renaming = rename(workspace, texts, Occurrence(kind, mention.name, robot, 0), new)
        except LinkwrightError as reason:
            error = error or reason
            continue
        if any((edit.file, edit.start) == (mention.file, mention.start) for edit in renaming.edits):
            return renaming
        error = error or _refusal_error(
            mention.name, phrase("several robots have this name, and the file may refer to any")
        )
    raise error or _refusal_error(mention.name, phrase("no description in the workspace contains it"))


def _rename_in_srdf(workspace: Workspace, texts: Mapping[Path, str], name: Occurrence, new: str) -> Renaming:
    """Rename a link or joint, starting from its use in an SRDF."""
    if "$" not in name.name:
        return _rename_mention(workspace, texts, Mention(name.name, name.file, name.start, (name.kind,)), new)
    error: LinkwrightError | None = None
    for robot in find_robots_of_file(workspace, texts, name.file)[:_MAX_ROBOTS]:
        names_of_kind = sorted(
            value for kind, value in find_names_of_robot(workspace, texts, robot) if kind is name.kind
        )
        for value in (value for value in names_of_kind if _may_equal(name.name, value)):
            changed = rename_in_template(name.name, new, value)
            if changed is None or changed == value:
                continue
            definition = _find_definition(workspace, texts, robot, name, value)
            try:
                renaming = (
                    rename(workspace, texts, Occurrence(name.kind, value, robot, 0), changed)
                    if definition is None
                    else rename(workspace, texts, definition, new)
                )
            except LinkwrightError as reason:
                error = error or reason
                continue
            if any((edit.file, edit.start) == (name.file, name.start) for edit in renaming.edits):
                return renaming
    raise error or _refusal_error(name.name, phrase("no description in the workspace contains it"))


def _find_definition(
    workspace: Workspace, texts: Mapping[Path, str], robot: Path, name: Occurrence, value: str
) -> Occurrence | None:
    """Return the definition of a link or joint whose source equals a use, or None.

    The source of a name may contain expressions, such as ``${prefix}wheel``.
    """
    expansions, _ = run_trials(workspace, texts, robot, is_partial=True, is_switched=False)
    for trial in expansions:
        for element in trial.expansion.document.root.elements(name.kind.value):
            source = source_value(element, "name") if element.attributes.get("name") == value else None
            if source is not None and source.text == name.name:
                return occurrence_at(workspace.text(source.file, texts) or "", source.file, source.start)
    return None


def _refusal_error(name: str, reason: Phrase, span: Span | None = None) -> LinkwrightError:
    return LinkwrightError(
        Diagnostic(_UNPROVED_CODE, phrase("'{name}' is not renamed: {reason}", name=name, reason=reason), span)
    )


def _invalid_name_error(new: str, kind: Phrase) -> LinkwrightError:
    message = phrase("'{new}' is not a valid {kind} name", new=new, kind=kind)
    hint = phrase("use letters, digits and underscores, and begin with a letter")
    return LinkwrightError(Diagnostic("LANG102", message, hint=hint))
