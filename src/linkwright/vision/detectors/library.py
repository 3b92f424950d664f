"""Imports of optional libraries: OpenCV and LiteRT.

OpenCV belongs to the extra ``vision``. No extra installs LiteRT.
"""

from __future__ import annotations

from functools import cache
from typing import Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, missing_extra, package_hint, phrase

_LITERT = "ai-edge-litert"


@cache
def load_opencv() -> Any:
    """Import the module ``cv2``.

    Raises:
        LinkwrightError: VISION101, it is not installed.
    """
    try:
        import cv2
    except ModuleNotFoundError as error:
        raise missing_extra("VISION101", error) from None
    return cv2


@cache
def load_litert() -> Any:
    """Import ``ai_edge_litert.interpreter``.

    No extra installs it, because it is large and only TFLite files need it.

    Raises:
        LinkwrightError: VISION101, it is not installed.
    """
    try:
        from ai_edge_litert import interpreter  # type: ignore[import-not-found, unused-ignore]
    except ModuleNotFoundError:
        message = phrase("TFLite files need the package '{package}', which is not installed", package=_LITERT)
        raise LinkwrightError(Diagnostic("VISION101", message, hint=package_hint(_LITERT))) from None
    return interpreter
