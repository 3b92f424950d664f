"""Rename macros, properties, links and other names in descriptions.

The edits are tried on the descriptions that include the file, with each set of arguments that their callers pass. A
macro, parameter, property or argument may be renamed if all expansions stay equal. A link, joint or material may be
renamed if the expansions differ only in names, and every name that changes has a single new name.
"""

from __future__ import annotations

import ast
import keyword
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, SourceText, Span, phrase, quoted_names, term
from linkwright.language.definitions import NameKind
from linkwright.language.grammar import root_of
from linkwright.language.includes import real_path
from linkwright.language.mentions import Mention
from linkwright.language.occurrences import Occurrence, occurrences_in
from linkwright.language.probes import generate_probes, is_reached
from linkwright.language.proof import Edit, ExpansionProof, UnprovedError
from linkwright.language.robot_renaming import ROBOT_NAME_KINDS, RobotRenaming
from linkwright.language.workspace import Workspace
from linkwright.sdf.worlds import SDF

_FORWARDED_DEFAULT = re.compile(r"\s*:?=\s*\^")
_NAME = re.compile(r"[^\s<>&\"']+")


@dataclass(frozen=True, slots=True)
class Renaming:
    """A proved renaming.

    Attributes:
        edits: the edits, in the order of files and offsets.
        names: the names of links, joints and materials that change, old name -> new name.
        unchanged: uncertain mentions of these names, which the edits do not change.
        notes: notes for the user about further names that change, and parts that could not be compared.
    """

    edits: tuple[Edit, ...]
    names: Mapping[str, str] = field(default_factory=dict)
    unchanged: tuple[Mention, ...] = ()
    notes: tuple[Phrase, ...] = ()


def occurrence_at(text: str, file: Path, offset: int) -> Occurrence | None:
    """Return the name at an offset, or None if there is no renamable name."""
    if root_of(file) is SDF:  # Names in SDF models have their own scopes.
        return None
    return _find_innermost(occurrences_in(text, file), offset)


def xacro_name_at(text: str, file: Path, offset: int) -> Occurrence | None:
    """Return the name that xacro defines at an offset of an SDF xacro file, or None.

    It is the name of a macro, parameter, property or argument.
    """
    return _find_innermost((name for name in occurrences_in(text, file) if name.kind not in ROBOT_NAME_KINDS), offset)


def _find_innermost(names: Iterable[Occurrence], offset: int) -> Occurrence | None:
    occurrences = [name for name in names if name.start <= offset <= name.end]
    return min(occurrences, key=lambda name: (name.end - name.start, not name.is_definition), default=None)


def find_references(workspace: Workspace, texts: Mapping[Path, str], name: Occurrence) -> list[Occurrence]:
    """Return the definitions and uses of a name in all files of its descriptions.

    Args:
        workspace: the folders that the editor has opened.
        texts: the texts of the open files.
        name: one of its occurrences.
    """
    occurrences: dict[Path, list[Occurrence]] = {}
    pending = [name.file]
    is_shared = name.kind not in ROBOT_NAME_KINDS  # A link with the same name in another robot is a different link.
    for start in pending:
        for file in workspace.index.related_files(start, texts, computed=True):
            if file not in occurrences:
                uses = occurrences_in(workspace.text(file, texts) or "", file)
                occurrences[file] = [use for use in uses if _is_same(use, name)]
                if occurrences[file] and is_shared:
                    pending.append(file)
    return [use for uses in occurrences.values() for use in uses]


def rename(workspace: Workspace, texts: Mapping[Path, str], name: Occurrence, new: str) -> Renaming:
    """Return the proved edits that rename a name of a description.

    Args:
        workspace: the folders that the editor has opened.
        texts: the texts of the open files.
        name: the name, as `occurrence_at` returns it.
        new: the new name, as it replaces the text of the old one.

    Raises:
        LinkwrightError: LANG102, the new name is not valid; LANG103, it exists; LANG104, the edits cannot be proved.
    """
    _check_new_name(name, new)
    seeds = find_references(workspace, texts, name)
    if not any(seed.is_definition for seed in seeds) and name.kind not in ROBOT_NAME_KINDS:
        raise _unproved_error(phrase("'{name}' is not defined in the files of the workspace", name=name.name), name)
    existing = next(
        (other for other in find_references(workspace, texts, _with_name(name, new)) if other.is_definition), None
    )
    if existing is not None:
        message = phrase("{kind} '{name}' already exists", kind=term(name.kind.value), name=new)
        raise LinkwrightError(Diagnostic("LANG103", message, _span(workspace, texts, existing)))
    try:
        return _prove_renaming(workspace, texts, name, new)
    except UnprovedError as error:
        raise _unproved_error(error.reason, name, error.span) from None


def _prove_renaming(workspace: Workspace, texts: Mapping[Path, str], name: Occurrence, new: str) -> Renaming:
    """Return the edits of the occurrences of a name, and the edits that follow from them."""
    proof = ExpansionProof(workspace, texts, name.file, is_partial=True)
    notes: list[Phrase] = []
    probes = (
        {}
        if is_reached(proof, workspace.text(name.file, texts) or "", name)
        else generate_probes(workspace, texts, name)
    )
    if probes:  # No expansion contains the name, so generated calls of its macro are compared.
        texts = {**texts, **probes}
        proof = ExpansionProof(workspace, texts, name.file, is_partial=True)
        notes.append(phrase("no description calls this macro, so the edits were checked with generated calls"))
    seeds = find_references(workspace, texts, name)
    if name.kind in ROBOT_NAME_KINDS:
        renaming = RobotRenaming(workspace, texts, name, new, proof)
        renaming.run(seeds)
        edits, names, unchanged = renaming.edits, renaming.names, renaming.unchanged
        derived_names = sorted(old for (_, old) in names if old != name.name) if "$" not in name.name else []
        if derived_names:
            notes.append(phrase("these names change, too: {names}", names=quoted_names(derived_names)))
    else:
        edits = {Edit(seed.file, seed.start, seed.end, new) for seed in seeds}
        renamed = {}
        if name.kind is NameKind.ARGUMENT:
            edits |= _edit_callers(workspace, texts, proof, name, new)
            renamed = {name.name: new}
        edits = _extend_until_equal(workspace, texts, proof, name, new, edits, renamed)
        names, unchanged = {}, ()
    if proof.gap_reason is not None:
        notes.append(
            phrase("compared without the elements that cannot be expanded here: {reason}", reason=proof.gap_reason)
        )
    file_edits = tuple(sorted(edit for edit in edits if edit.file not in probes))
    return Renaming(file_edits, {old: changed for (_, old), changed in names.items()}, unchanged, tuple(notes))


def _extend_until_equal(
    workspace: Workspace,
    texts: Mapping[Path, str],
    proof: ExpansionProof,
    name: Occurrence,
    new: str,
    edits: set[Edit],
    renamed: Mapping[str, str],
) -> set[Edit]:
    """Return edits that keep all expansions equal, with uses of a parameter in other macros.

    xacro's scopes are dynamic: a macro that is called in another one sees its parameters, and ``name:=^`` forwards
    them.

    Raises:
        UnprovedError: the expansions differ.
    """
    try:
        proof.check_equal(edits, renamed)
    except UnprovedError:
        extended_edits = edits | _edit_related_parameters(workspace, texts, name, new)
        if extended_edits == edits:
            raise
        try:
            proof.check_equal(extended_edits, renamed)
        except UnprovedError:
            pass
        else:
            return extended_edits
        raise
    return edits


def _edit_related_parameters(workspace: Workspace, texts: Mapping[Path, str], name: Occurrence, new: str) -> set[Edit]:
    """Return the edits of forwarding parameters and of properties with a parameter's name."""
    if name.kind not in (NameKind.PARAMETER, NameKind.PROPERTY):
        return set()
    edits: set[Edit] = set()
    for file in workspace.index.related_files(name.file, texts, computed=True):
        text = workspace.text(file, texts) or ""
        uses = [use for use in occurrences_in(text, file) if use.name == name.name]
        forwarding = {use.owner for use in uses if use.is_definition and _FORWARDED_DEFAULT.match(text, use.end)}
        edits |= {
            Edit(file, use.start, use.end, new)
            for use in uses
            if use.kind is NameKind.PROPERTY or (use.kind is NameKind.PARAMETER and use.owner in forwarding)
        }
    return edits


def _edit_callers(
    workspace: Workspace, texts: Mapping[Path, str], proof: ExpansionProof, name: Occurrence, new: str
) -> set[Edit]:
    """Return the edits of the calls that pass an argument to the descriptions.

    Raises:
        UnprovedError: a caller passes the argument by a name that is not written in the call.
    """
    old = name.name
    passed = re.compile(rf"(?<!\w){re.escape(old)}(?=:=)|(?<=['\"]){re.escape(old)}(?=['\"]\s*:)")
    edits: set[Edit] = set()
    for entry in proof.entries:
        for values, span in workspace.argument_calls(entry):
            if old not in values or span is None:
                continue
            file = real_path(span.file)
            text = workspace.text(file, texts) or ""
            call_edits = {
                Edit(file, *match.span(), new) for match in passed.finditer(text, *_find_call_range(text, span))
            }
            if not call_edits:
                raise UnprovedError(
                    phrase("a caller passes the argument, but its name is not written in the call"), span
                )
            edits |= call_edits
    return edits


def _is_same(other: Occurrence, name: Occurrence) -> bool:
    if (other.kind, other.name) != (name.kind, name.name):
        return False
    if name.kind is NameKind.PARAMETER:
        return other.owner == name.owner
    is_template = name.kind in ROBOT_NAME_KINDS and "$" in name.name
    return not is_template or (other.file, other.owner) == (name.file, name.owner)


def _with_name(name: Occurrence, new: str) -> Occurrence:
    return Occurrence(name.kind, new, name.file, name.start, name.is_definition, name.owner)


def _check_new_name(name: Occurrence, new: str) -> None:
    is_variable = name.kind not in ROBOT_NAME_KINDS
    is_valid = new.isidentifier() and not keyword.iskeyword(new) if is_variable else bool(new.strip())
    if name.kind is NameKind.MACRO or (name.kind in ROBOT_NAME_KINDS and "$" not in new):
        is_valid = _NAME.fullmatch(new) is not None
    if not is_valid:
        message = phrase("'{new}' is not a valid {kind} name", new=new, kind=term(name.kind.value))
        hint = phrase("use letters, digits and underscores, and begin with a letter")
        raise LinkwrightError(Diagnostic("LANG102", message, hint=hint))


def _unproved_error(message: Phrase, name: Occurrence, span: Span | None = None) -> LinkwrightError:
    return LinkwrightError(
        Diagnostic("LANG104", phrase("'{name}' is not renamed: {reason}", name=name.name, reason=message), span)
    )


def _span(workspace: Workspace, texts: Mapping[Path, str], name: Occurrence) -> Span:
    return SourceText(str(name.file), workspace.text(name.file, texts) or "").span(name.start, name.end)


def _find_call_range(text: str, span: Span) -> tuple[int, int]:
    """Return the start and end of a call in its file.

    In Python, the end is the end of the last line of the expression.
    """
    source = SourceText(span.file, text)
    first, last = source.offset(span.line, 1), source.offset(span.end_line, span.end_column)
    if span.file.endswith(".py"):
        try:
            tree = ast.parse(text)
        except (SyntaxError, ValueError, RecursionError, MemoryError):
            return first, last
        for node in ast.walk(tree):
            if isinstance(node, ast.expr) and (node.lineno, node.col_offset + 1) == (span.line, span.column):
                last = max(last, source.offset((node.end_lineno or 0) + 1, 1))
    return first, last
