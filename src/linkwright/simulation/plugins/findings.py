"""The findings for errors of plugins and sensors."""

from __future__ import annotations

from pathlib import Path
from traceback import extract_tb

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase
from linkwright.xmltree import Element


def findings_of(error: Exception, name: str, element: Element | None) -> list[Diagnostic]:
    """Return the findings for an error of a plugin or sensor.

    Args:
        error: the exception; the findings of a `LinkwrightError` are reported unchanged, any other exception is
            reported as a fault of the plugin's code (SIM138).
        name: the name of the plugin or sensor.
        element: the element that declares it; None if there is none.
    """
    if isinstance(error, LinkwrightError):
        return list(error.diagnostics)
    reason = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
    message = phrase("'{plugin}' stopped because its code failed: {error}", plugin=name, error=foreign(reason))
    hint = phrase("everything else continues without it")
    if places := extract_tb(error.__traceback__):
        where = f"{Path(places[-1].filename).name}:{places[-1].lineno}"
        hint = phrase("it failed in {place}; everything else continues without it", place=where)
    span, source = (None, None) if element is None else (element.span(), element.source)
    return [Diagnostic("SIM138", message, span, hint=hint, source=source)]
