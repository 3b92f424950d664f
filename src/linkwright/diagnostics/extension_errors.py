"""The error about an extension of another package whose import fails."""

from __future__ import annotations

from linkwright.diagnostics.diagnostic import Diagnostic, LinkwrightError
from linkwright.diagnostics.phrase import Phrase, foreign, phrase
from linkwright.loading.extensions import EntryPoint
from linkwright.loading.lean_typing import Any


def load_extension(entry_point: EntryPoint, code: str, message: Phrase) -> Any:
    """Import an extension, and return the object that its entry point names.

    Args:
        entry_point: the entry point of the extension.
        code: the code of the error.
        message: the message of the error; the hint names the package and the problem.

    Raises:
        LinkwrightError: `code`, the extension cannot be imported; or the error that its import raises.
    """
    try:
        return entry_point.load()
    except LinkwrightError:
        raise
    except Exception as error:
        hint = phrase(
            "fix the Python package '{package}', whose import fails: {problem}",
            package=entry_point.distribution,
            problem=foreign(error),
        )
        raise LinkwrightError(Diagnostic(code, message, hint=hint)) from error
