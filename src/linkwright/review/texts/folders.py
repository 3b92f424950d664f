"""Remove the folders of the versions from texts, so that the same commits give the same report everywhere."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import TypeVar, cast

from linkwright.diagnostics import Diagnostic
from linkwright.diagnostics.phrase import Phrase, as_phrase
from linkwright.review.changes import Review, Subject
from linkwright.xacro.omissions import PLACEHOLDER_FOLDER

_Value = TypeVar("_Value")
_MISSING_FILE = re.compile(rf"file://{re.escape(str(PLACEHOLDER_FOLDER))}/([^/\s]+)/")
"""The address of a file of a missing package that a description writes as ``file://$(find arm)/...``."""


def without_folder(value: _Value, folder: Path) -> _Value:
    """Return a text, or a tuple or mapping of texts, with paths relative to a folder.

    The arguments of phrases are treated in the same way. Paths in packages that are missing become URIs.
    """

    def change(text: str) -> str:
        text = text.replace(f"{folder}/", "").replace(str(folder), ".")
        text = _MISSING_FILE.sub(r"file://$(find \1)/", text)
        return text.replace(f"{PLACEHOLDER_FOLDER}/", "package://")

    return change_texts(value, change)


def finding_without_folders(finding: Diagnostic, folder: Path, shares: Mapping[str, Path]) -> Diagnostic:
    """Return a finding whose texts have paths relative to a folder, and URIs in place of paths in share folders.

    Args:
        finding: the finding to change.
        folder: the folder of a version.
        shares: the share folders outside the version, such as those that show installed files, by package.
    """
    write_uris = _make_uri_writer(shares)
    return _change_finding(finding, lambda text: without_folder(write_uris(text), folder))


def _make_uri_writer(shares: Mapping[str, Path]) -> Callable[[str], str]:
    """Return a function that replaces paths in share folders in a text by URIs."""

    def change(text: str) -> str:
        for name, share in shares.items():
            text = text.replace(f"file://{share}/", f"file://$(find {name})/")
            text = text.replace(f"{share}/", f"package://{name}/")
        return text

    return change


def change_texts(value: _Value, change: Callable[[str], str]) -> _Value:
    """Return a text, or a tuple or mapping of texts, with each text changed.

    The arguments of phrases are also changed.
    """
    if isinstance(value, Phrase):
        if change(str(value)) == str(value):
            return value
        create, arguments = cast("tuple[Callable[..., _Value], tuple[object, ...]]", value.__reduce__())
        return create(*(change_texts(argument, change) for argument in arguments))
    if isinstance(value, str):
        return cast(_Value, change(value))
    if isinstance(value, tuple):
        return cast(_Value, tuple(change_texts(item, change) for item in value))
    if isinstance(value, Mapping):
        return cast(_Value, {name: change_texts(item, change) for name, item in value.items()})
    return value


def review_without_folder(result: Review, folder: Path, shares: Mapping[str, Path]) -> Review:
    """Return a review with its texts changed by `without_folder`, and with URIs in place of paths in share folders.

    Args:
        result: the review.
        folder: the folder of a version.
        shares: the share folders of the packages of the version. Paths inside the folder stay paths, but not URIs.
    """
    write_uris = _make_uri_writer({name: share for name, share in shares.items() if not share.is_relative_to(folder)})
    own = {name: share for name, share in shares.items() if share.is_relative_to(folder)}

    def change(text: str) -> str:
        if "file://" in text:
            for name, share in own.items():
                text = text.replace(f"file://{share}/", f"file://$(find {name})/")
        return without_folder(write_uris(text), folder)

    return review_with_texts(result, change)


def review_with_texts(result: Review, change: Callable[[str], str]) -> Review:
    """Return a review with each text of its changes, findings and notes changed."""
    return replace(
        result,
        subjects=[_change_subject(subject, change) for subject in result.subjects],
        new_findings=[_change_finding(finding, change) for finding in result.new_findings],
        fixed_findings=[_change_finding(finding, change) for finding in result.fixed_findings],
        notes=[change_texts(note, change) for note in result.notes],
    )


def _change_subject(subject: Subject, change_text: Callable[[str], str]) -> Subject:
    return replace(
        subject,
        changes=[
            replace(
                change,
                sentence=change_texts(change.sentence, change_text),
                reason=change_texts(change.reason, change_text),
                cases=change_texts(change.cases, change_text),
            )
            for change in subject.changes
        ],
        figures=[
            replace(figure, old=change_texts(figure.old, change_text), new=change_texts(figure.new, change_text))
            for figure in subject.figures
        ],
        problems=[replace(problem, text=change_texts(problem.text, change_text)) for problem in subject.problems],
        cases=[change_texts(case, change_text) for case in subject.cases],
        images=[replace(view, notes=change_texts(view.notes, change_text)) for view in subject.images],
    )


def _change_finding(finding: Diagnostic, change: Callable[[str], str]) -> Diagnostic:
    """Return a finding with its message, hint and notes changed."""
    notes = tuple(note._replace(message=change_texts(as_phrase(note.message), change)) for note in finding.notes)
    hint = None if finding.hint is None else change_texts(as_phrase(finding.hint), change)
    return finding.with_changes(message=change_texts(as_phrase(finding.message), change), hint=hint, notes=notes)
