"""The findings for errors of plugins and sensors."""

from __future__ import annotations

from pathlib import Path
from traceback import extract_tb

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase
from linkwright.xmltree import Element


def findings_of(error: Exception, name: str, element: Element | None) -> list[Diagnostic]:
    """The findings for an error of a plugin.

    Args:
        error: its exception: a `LinkwrightError` is reported as it is, any other one as a fault of its code (SIM138).
        name: the plugin's or sensor's.
        element: where it is declared, if anywhere.
    """
    if isinstance(error, LinkwrightError):
        return list(error.diagnostics)
    reason = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
    message = phrase("'{plugin}' ended because its code failed: {error}", plugin=name, error=foreign(reason))
    hint = phrase("everything else continues without it")
    if places := extract_tb(error.__traceback__):
        where = f"{Path(places[-1].filename).name}:{places[-1].lineno}"
        hint = phrase("it failed in {place}; everything else continues without it", place=where)
    span, source = (None, None) if element is None else (element.span(), element.source)
    return [Diagnostic("SIM138", message, span, hint=hint, source=source)]
