"""Remove the folders of the versions from texts, so that the same commits give the same report everywhere."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import TypeVar, cast

from linkwright.diagnostics import Diagnostic
from linkwright.diagnostics.phrase import Phrase, as_phrase
from linkwright.review.changes import Review, Subject
from linkwright.xacro.omissions import PLACEHOLDER_FOLDER

_Value = TypeVar("_Value")


def without_folder(value: _Value, folder: Path) -> _Value:
    """Return a text, or a tuple or mapping of texts, with paths relative to a folder.

    The arguments of phrases are treated in the same way. Paths in packages that are missing become URIs.
    """

    def change(text: str) -> str:
        text = text.replace(f"file://{folder}/", "").replace(f"{folder}/", "").replace(str(folder), ".")
        return text.replace(f"{PLACEHOLDER_FOLDER}/", "package://")

    return _change_texts(value, change)


def finding_with_package_uris(finding: Diagnostic, shares: Mapping[str, Path]) -> Diagnostic:
    """Return a finding with URIs in place of paths in share folders.

    Args:
        finding: the finding to change.
        shares: the share folders outside the version, such as those that show installed files, by package.
    """

    def change(text: str) -> str:
        for name, share in shares.items():
            text = text.replace(f"{share}/", f"package://{name}/")
        return text

    return _change_finding(finding, change)


def _change_texts(value: _Value, change: Callable[[str], str]) -> _Value:
    """Return a text, or a tuple or mapping of texts, with each text changed.

    The arguments of phrases are also changed.
    """
    if isinstance(value, Phrase):
        if change(str(value)) == str(value):
            return value
        create, arguments = cast("tuple[Callable[..., _Value], tuple[object, ...]]", value.__reduce__())
        return create(*(_change_texts(argument, change) for argument in arguments))
    if isinstance(value, str):
        return cast(_Value, change(value))
    if isinstance(value, tuple):
        return cast(_Value, tuple(_change_texts(item, change) for item in value))
    if isinstance(value, Mapping):
        return cast(_Value, {name: _change_texts(item, change) for name, item in value.items()})
    return value


def review_without_folder(result: Review, folder: Path) -> Review:
    """Return a review with its texts changed by `without_folder`."""
    return replace(
        result,
        subjects=[_remove_folder_from_subject(subject, folder) for subject in result.subjects],
        new_findings=[_remove_folder_from_finding(finding, folder) for finding in result.new_findings],
        fixed_findings=[_remove_folder_from_finding(finding, folder) for finding in result.fixed_findings],
        notes=[without_folder(note, folder) for note in result.notes],
    )


def _remove_folder_from_subject(subject: Subject, folder: Path) -> Subject:
    return replace(
        subject,
        changes=[
            replace(
                change,
                sentence=without_folder(change.sentence, folder),
                reason=without_folder(change.reason, folder),
                cases=without_folder(change.cases, folder),
            )
            for change in subject.changes
        ],
        figures=[
            replace(figure, old=without_folder(figure.old, folder), new=without_folder(figure.new, folder))
            for figure in subject.figures
        ],
        problems=[replace(problem, text=without_folder(problem.text, folder)) for problem in subject.problems],
        cases=[without_folder(case, folder) for case in subject.cases],
    )


def _remove_folder_from_finding(finding: Diagnostic, folder: Path) -> Diagnostic:
    """Return a finding with its texts changed by `without_folder`."""
    return _change_finding(finding, lambda text: without_folder(text, folder))


def _change_finding(finding: Diagnostic, change: Callable[[str], str]) -> Diagnostic:
    """Return a finding with its message, hint and notes changed."""
    notes = tuple(note._replace(message=_change_texts(as_phrase(note.message), change)) for note in finding.notes)
    hint = None if finding.hint is None else _change_texts(as_phrase(finding.hint), change)
    return finding.with_changes(message=_change_texts(as_phrase(finding.message), change), hint=hint, notes=notes)
