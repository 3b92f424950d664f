"""The exceptions of the module ``xacro``, with Linkwright's diagnostics."""

from __future__ import annotations

from collections.abc import Iterable
from xml.parsers.expat import ExpatError

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase
from linkwright.hosting.xacro_calls import DescriptionError, XacroCall


class XacroException(LinkwrightError):
    """Raised for an error in a description.

    Args:
        msg: the message; None for a message from `exc` or `suffix` only.
        suffix: a text to append to the message.
        exc: the exception that caused this error.
        macro: the macro that contains the error.

    Attributes:
        suffix: the text that was appended to the message.
        exc: the exception that caused this error.
        macros: the macro that contains the error, then the macros that call it.
    """

    def __init__(
        self, msg: object = None, suffix: object = None, exc: BaseException | None = None, macro: object = None
    ) -> None:
        message_text = " ".join(
            str(component) for component in (msg, exc, suffix) if component is not None and str(component)
        )
        super().__init__(Diagnostic("XAC706", foreign(message_text) or phrase("xacro failed")))
        self.suffix = suffix
        self.exc = exc
        self.macros = [] if macro is None else [macro]


class ExpansionError(XacroException, DescriptionError):
    """Raised when a file cannot be expanded.

    Attributes:
        call: the call of xacro with the file to expand.
    """

    def __init__(self, call: XacroCall, diagnostics: Iterable[Diagnostic]) -> None:
        DescriptionError.__init__(self, call, diagnostics)
        self.suffix = self.exc = None
        self.macros = []


class TextError(XacroException):
    """Raised when a description given as a string cannot be expanded."""

    def __init__(self, diagnostics: Iterable[Diagnostic]) -> None:
        LinkwrightError.__init__(self, *diagnostics)
        self.suffix = self.exc = None
        self.macros = []


class MalformedError(LinkwrightError, ExpatError):
    """Raised for a description that is not XML.

    `lineno` is the line of the error, starting at 1, and `offset` is the column, starting at 0.
    """

    def __init__(self, diagnostics: Iterable[Diagnostic]) -> None:
        LinkwrightError.__init__(self, *diagnostics)
        span = self.diagnostics[0].span
        self.code = 0
        self.lineno = span.line if span else 0
        self.offset = span.column - 1 if span else 0


class MalformedFileError(MalformedError, DescriptionError):
    """Raised if a file or an included file is not XML.

    Attributes:
        call: the call of xacro with the file to expand.
    """

    def __init__(self, call: XacroCall, diagnostics: Iterable[Diagnostic]) -> None:
        MalformedError.__init__(self, diagnostics)
        self.call = call


def translate_error(error: LinkwrightError, call: XacroCall | None) -> LinkwrightError:
    """Convert an error of the engine to an exception of the module ``xacro``.

    Args:
        error: the error of the engine.
        call: the call of xacro with the file to expand; None for a description given as a string.
    """
    diagnostics = error.diagnostics
    if isinstance(error, (XacroException, MalformedError)):
        return error
    is_malformed = diagnostics[0].code.startswith("XML2")
    if call is None:
        return MalformedError(diagnostics) if is_malformed else TextError(diagnostics)
    return MalformedFileError(call, diagnostics) if is_malformed else ExpansionError(call, diagnostics)
