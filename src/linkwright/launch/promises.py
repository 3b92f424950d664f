"""Errors with two faces: a diagnostic for the user, and the exception class that ROS's own API promises programs."""

from __future__ import annotations

from typing import Any

from linkwright.diagnostics import Diagnostic, LinkwrightError


def keeping(promised: Exception | None, *diagnostics: Diagnostic) -> LinkwrightError:
    """A LinkwrightError that is also of another exception's class.

    Args:
        promised: the exception a program may expect; the error's text begins with its text. None for a plain error.
        diagnostics: what is shown to a user.
    """
    if promised is None:
        return LinkwrightError(*diagnostics)
    error = _class_for(_base_of(type(promised)))(*diagnostics)
    error.promised_text = str(promised)  # type: ignore[attr-defined]
    return error


def _base_of(kind: type[Exception]) -> type[Exception]:
    """The nearest class that can be made from a text alone."""
    for each in kind.__mro__:
        try:
            each("")
        except TypeError:
            continue
        return each
    return Exception


_classes: dict[type, type[LinkwrightError]] = {}


def _class_for(kind: type[Exception]) -> type[LinkwrightError]:
    if kind in _classes:
        return _classes[kind]
    if issubclass(kind, LinkwrightError) or issubclass(LinkwrightError, kind):
        return LinkwrightError

    def __str__(self: Any) -> str:  # noqa: N807 - becomes the method of that name
        ours = LinkwrightError.__str__(self)
        return ours if self.promised_text in ours else f"{self.promised_text}\n{ours}"

    made = _classes[kind] = type(kind.__name__, (LinkwrightError, kind), {"__str__": __str__})
    return made
