"""Why a transform cannot be given, in tf2's words."""

from __future__ import annotations

from linkwright.diagnostics import Diagnostic, LinkwrightError, did_you_mean


class TransformError(LinkwrightError):
    """A transform cannot be given."""


class TransformLookupError(TransformError):
    """A frame is not known (tf2 LookupException)."""

    def __init__(self, argument: str, frame: str, known: tuple[str, ...]) -> None:
        text = f'"{frame}" passed to lookupTransform argument {argument} does not exist. '
        super().__init__(Diagnostic("GRAPH301", text, hint=did_you_mean(frame, known)))


class TransformConnectivityError(TransformError):
    """Two frames are in different trees (tf2 ConnectivityException)."""

    def __init__(self, target: str, source: str) -> None:
        text = (
            f"Could not find a connection between '{target}' and '{source}' because they are not part of the same "
            "tree.Tf has two or more unconnected trees."
        )
        super().__init__(Diagnostic("GRAPH302", text))


class TransformLoopError(TransformError):
    """A frame's parents go round in a loop (tf2 LookupException)."""

    def __init__(self, frame: str) -> None:
        text = "The tf tree is invalid because it contains a loop."
        super().__init__(Diagnostic("GRAPH303", f"{text} Frame '{frame}' is on it or below it."))


class TransformArgumentError(TransformError):
    """A frame name cannot be one (tf2 InvalidArgumentException)."""

    def __init__(self, argument: str, frame: str, reason: str) -> None:
        text = f'Invalid argument "{frame}" passed to lookupTransform argument {argument} - {reason}'
        super().__init__(Diagnostic("GRAPH304", text))
