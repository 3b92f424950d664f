"""The reasons why no edit of the text makes exactly the requested change."""

from __future__ import annotations

from collections.abc import Sequence

from linkwright.descriptions.editing.places import Place
from linkwright.diagnostics import Diagnostic, Note, display_path, joined, phrase
from linkwright.loading.lean_dataclasses import dataclass

_MOST_NAMED = 6


@dataclass(frozen=True, slots=True)
class Attempt:
    """A candidate whose edit failed.

    Attributes:
        place: the range of the candidate's text.
        also: the names of the other parts that the edit would change.
        forbidden: the reason why the file must not be written, or None.
        choice: whether the text is a factor that selects a side.
        doubtful: whether the text may be such a factor.
        error: whether the description could not be expanded with the edit.
    """

    place: Place
    also: tuple[str, ...] = ()
    forbidden: Diagnostic | None = None
    choice: bool = False
    doubtful: bool = False
    error: bool = False


def refusal(place: Place, index: int | None, attempts: Sequence[Attempt], tag: str = "") -> Diagnostic:
    """Return the finding with the reason why an edit is refused.

    Args:
        place: the range of the attribute's text, or the position at which it would be added.
        index: the index of the number that cannot be changed, or None for an attribute that is missing.
        attempts: the failed candidates, in the order in which they were tried.
        tag: the tag of the element that would be added.
    """
    written = " ".join(place.text.split())
    noted = {
        attempt.place.span: attempt
        for attempt in attempts
        if attempt.place != place and (attempt.also or attempt.choice)
    }
    notes = tuple(map(_note, noted.values()))[:_MOST_NAMED]
    also = min(
        (attempt for attempt in attempts if attempt.also),
        key=lambda attempt: (len(attempt.also), attempt.doubtful),
        default=None,
    )
    forbidden = next((attempt.forbidden for attempt in attempts if attempt.forbidden is not None), None)
    if also is not None:
        what = _named(also.also)
        hint = phrase(
            "add a parameter or property for this part to the macro or expression here, or change the "
            "text for all of these parts"
        )
        if index is None:
            message = phrase("an <{tag}> written here would also change {what}", tag=tag, what=what)
        else:
            message = phrase("another number in '{written}' would also change {what}", written=written, what=what)
        return Diagnostic("EDIT104", message, place.span, notes=notes, hint=hint, source=place.source)
    if forbidden is not None:
        return forbidden
    message = phrase("no number gives '{written}' the requested value", written=written)
    hint = phrase("write a number, or a sum with one, in place of the expression")
    return Diagnostic("EDIT105", message, place.span, notes=notes, hint=hint, source=place.source)


def _note(attempt: Attempt) -> Note:
    text = " ".join(attempt.place.text.split())
    if attempt.choice:
        return Note(phrase("'{text}' selects the side and is not changed", text=text), attempt.place.span)
    return Note(phrase("'{text}' also produces {what}", text=text, what=_named(attempt.also)), attempt.place.span)


def _named(also: Sequence[str]) -> object:
    named = list(also[:_MOST_NAMED])
    if len(also) > len(named):
        named.append(str(phrase("{count} more", count=len(also) - len(named))))
    return joined(named)


def forbidden_file(path: str, why: object) -> Diagnostic:
    """Return the finding that a file must not be written."""
    message = phrase("'{path}' is not written: {why}", path=display_path(path), why=why)
    hint = phrase("open the description from your own workspace, or change a copy of the file")
    return Diagnostic("EDIT106", message, hint=hint)


def changed_file(path: str) -> Diagnostic:
    """Return the finding that another program has changed a file, so that it is not written."""
    message = phrase(
        "another program has changed '{path}' since it was read, so it is not written", path=display_path(path)
    )
    return Diagnostic("EDIT107", message, hint=phrase("check the current robot, and repeat the edit"))
