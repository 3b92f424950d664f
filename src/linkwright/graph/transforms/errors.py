"""tf2's exceptions for transforms that are not available, with tf2's names and messages."""

from __future__ import annotations

from collections.abc import Iterable

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, did_you_mean, foreign, phrase


class TransformException(LinkwrightError):  # noqa: N818  # tf2's name, which users' code catches
    """Raised when a transform is not available.

    Args:
        text: the reason.
        hint: how to fix the problem.
        code: the code of the finding.
    """

    def __init__(self, text: str = "", *, hint: Phrase | None = None, code: str = "GRAPH307") -> None:
        super().__init__(Diagnostic(code, foreign(text), hint=hint))


class LookupException(TransformException):
    """Raised when a frame is not known, or the tree has a loop."""

    def __init__(self, text: str = "", *, hint: Phrase | None = None, code: str = "GRAPH301") -> None:
        super().__init__(text, hint=hint, code=code)


class ConnectivityException(TransformException):
    """Raised when two frames are in different trees."""

    def __init__(self, text: str = "") -> None:
        super().__init__(text, code="GRAPH302")


class InvalidArgumentException(TransformException):
    """Raised when a frame name is not valid."""

    def __init__(self, text: str = "") -> None:
        super().__init__(text, code="GRAPH304")


class ExtrapolationException(TransformException):
    """Raised when there is no data for the requested time."""

    def __init__(self, text: str = "") -> None:
        super().__init__(text, code="GRAPH305")


class TimeoutException(TransformException):
    """Raised when a transform does not become available before the timeout."""

    def __init__(self, text: str = "") -> None:
        super().__init__(text, code="GRAPH306")


def frame_loop_error(detail: str) -> LookupException:
    """Return the error for parents that form a loop, with `detail` appended to the message."""
    return LookupException(
        phrase("The tf tree is invalid because it contains a loop.{detail}", detail=detail), code="GRAPH303"
    )


def unknown_frame_error(argument: str, frame: str, frame_names: Iterable[str]) -> LookupException:
    """Return the error for a frame that does not exist."""
    text = phrase('"{frame}" passed to {argument} does not exist. ', frame=frame, argument=argument)
    return LookupException(text, hint=did_you_mean(frame, frame_names))


def frame_name_error(argument: str, frame: str) -> InvalidArgumentException | None:
    """Return the error for a frame name that is not valid, or None if the name is valid.

    Args:
        argument: the name of the argument, for the message.
        frame: the frame name.
    """
    reason = find_frame_name_problem(frame)
    if reason is None:
        return None
    return InvalidArgumentException(
        phrase(
            'Invalid argument "{frame}" passed to {argument} - {reason}', frame=frame, argument=argument, reason=reason
        )
    )


def find_frame_name_problem(frame: str) -> Phrase | None:
    """Return the reason why a frame name is not valid, or None if the name is valid."""
    if not frame:
        return phrase("in tf2 frame_ids cannot be empty")
    if frame.startswith("/"):
        return phrase("in tf2 frame_ids cannot start with a '/'")
    return None


def not_connected_error(target: str, source: str) -> ConnectivityException:
    """Return the error for frames in different trees."""
    return ConnectivityException(
        phrase(
            "Could not find a connection between '{target}' and '{source}' because they are not part"
            " of the same tree.Tf has two or more unconnected trees.",
            target=target,
            source=source,
        )
    )
