"""Errors of two classes: ours, with a diagnostic for the user, and the one that ROS raises, for programs."""

from __future__ import annotations

from typing import Any

from linkwright.diagnostics import Diagnostic, LinkwrightError


def as_ros_error(ros_error: Exception | None, *diagnostics: Diagnostic) -> LinkwrightError:
    """A LinkwrightError that is also of another exception's class.

    Args:
        ros_error: the exception a program may expect; the error's text begins with its text. None for a plain error.
        diagnostics: what is shown to a user.
    """
    if ros_error is None:
        return LinkwrightError(*diagnostics)
    error = _class_for(_base_of(type(ros_error)))(*diagnostics)
    vars(error)["ros_text"] = str(ros_error)
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
        return ours if self.ros_text in ours else f"{self.ros_text}\n{ours}"

    made = _classes[kind] = type(kind.__name__, (LinkwrightError, kind), {"__str__": __str__})
    return made
