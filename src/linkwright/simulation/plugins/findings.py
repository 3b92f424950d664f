"""Findings that report errors in plugins and sensors."""

from __future__ import annotations

from pathlib import Path
from traceback import extract_tb

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase
from linkwright.xmltree import Element


def error_findings(error: Exception, name: str, element: Element | None) -> list[Diagnostic]:
    """Return the findings for an error of a plugin or sensor.

    Args:
        error: the exception. The findings of a `LinkwrightError` are returned unchanged; any other exception gives the
            finding SIM138, a fault in the plugin's code.
        name: the name of the plugin or sensor.
        element: the element that declares the plugin or sensor; None if it has no element.
    """
    if isinstance(error, LinkwrightError):
        return list(error.diagnostics)
    reason = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
    message = phrase("'{plugin}' stopped because its code failed: {error}", plugin=name, error=foreign(reason))
    hint = phrase("the simulation continues without it")
    if frames := extract_tb(error.__traceback__):
        location = f"{Path(frames[-1].filename).name}:{frames[-1].lineno}"
        hint = phrase("the code failed in {location}; the simulation continues without it", location=location)
    span, source = (None, None) if element is None else (element.span(), element.source)
    return [Diagnostic("SIM138", message, span, hint=hint, source=source)]
