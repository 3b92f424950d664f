"""Read the files of models that programs add to a world."""

from __future__ import annotations

import re
from pathlib import Path
from xml.sax.saxutils import escape, unescape

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase
from linkwright.files.input_files import read_text
from linkwright.sdf.resources import Missing, ResourceFinder

_RELATIVE_PATH = re.compile(r"(>\s*)([^\s<>:/~$][^<>:\n]*\.\w+)(\s*</)")
"""An element that only contains a text such as ``meshes/wheel.dae``."""


def read_model_file(address: str, finder: ResourceFinder) -> str:
    """Read the description at a path or URI, or of a model on Fuel.

    The schemes of URIs are ``file://``, ``package://`` and ``model://``. The text does not tell where it was read from,
    so relative paths of meshes and textures in it become absolute.

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
        return _make_paths_absolute(read_text(path), path.parent)
    except (OSError, UnicodeDecodeError) as error:
        reason = foreign(getattr(error, "strerror", None) or error)
        message = phrase("cannot read '{path}': {reason}", path=path, reason=reason)
        raise LinkwrightError(Diagnostic("NODE811", message)) from error


def _make_paths_absolute(text: str, folder: Path) -> str:
    """Return SDF in which relative paths of files in a folder are absolute; other texts do not change."""
    if "<sdf" not in text:
        return text

    def replace_path(match: re.Match[str]) -> str:
        path = folder / unescape(match[2])
        try:
            is_file = path.is_file()
        except (OSError, ValueError):
            is_file = False
        return f"{match[1]}{escape(str(path))}{match[3]}" if is_file else match[0]

    return _RELATIVE_PATH.sub(replace_path, text)
