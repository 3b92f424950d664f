"""Read the files of models that programs add to a world."""

from __future__ import annotations

from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase
from linkwright.files.input_files import read_text
from linkwright.sdf.resources import Missing, ResourceFinder


def read_model_file(address: str, finder: ResourceFinder) -> str:
    """Read the description at a path or URI, or of a model on Fuel.

    The schemes of URIs are ``file://``, ``package://`` and ``model://``.

    Args:
        address: the path or URI as the user wrote it.
        finder: resolves the URI.

    Raises:
        LinkwrightError: NODE811, there is no such description, or it cannot be read.
    """
    path = finder.model(address, Path.cwd())
    if isinstance(path, Missing):
        raise LinkwrightError(Diagnostic("NODE811", path.reason, hint=path.hint))
    try:
        return read_text(path)
    except (OSError, UnicodeDecodeError) as error:
        reason = foreign(getattr(error, "strerror", None) or error)
        message = phrase("cannot read '{path}': {reason}", path=path, reason=reason)
        raise LinkwrightError(Diagnostic("NODE811", message)) from error
