"""Resolve ``package://`` and ``file://`` URIs and plain paths in descriptions."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, phrase
from linkwright.loading.deferred import lazy_pattern

_DRIVE = lazy_pattern(r"/?([A-Za-z]:[\\/])")
_SCHEME = lazy_pattern(r"([A-Za-z][A-Za-z0-9+.-]+):")


def resolve(address: str, share: Callable[[str], Path], relative_to: Path | None) -> Path:
    """Return the path for a URI or a plain path.

    Args:
        address: ``package://NAME/PATH``, ``file:///PATH`` or a plain path.
        share: the function that returns the share folder of a package.
        relative_to: the folder that a relative path starts from; None for the current folder.

    Raises:
        LinkwrightError: an error of `share`; PKG102, the URI has another form.
    """
    if not address.strip():
        raise _make_uri_error(phrase("the URI is empty; write the path of a file"))
    scheme = _SCHEME.match(address)
    if scheme is None:
        path = Path(address)
        return path if path.is_absolute() or relative_to is None else relative_to / path
    scheme_name, remainder = scheme.group(1).lower(), address[scheme.end() :]
    if scheme_name == "package":
        return _resolve_package_uri(address, remainder, share)
    if scheme_name == "file":
        return _resolve_file_uri(address, remainder)
    hint = phrase("use package://PACKAGE/PATH")
    if scheme_name in ("http", "https"):
        hint = phrase(
            "files are not fetched from the network: put the file into a package and use package://PACKAGE/PATH"
        )
    problem = phrase(
        "'{uri}' has the scheme '{scheme}', which does not name a local file", uri=address, scheme=scheme.group(1)
    )
    raise _make_uri_error(problem, hint)


def _resolve_package_uri(address: str, rest: str, share: Callable[[str], Path]) -> Path:
    if not rest.startswith("//"):
        raise _make_uri_error(
            phrase("'{uri}' has no '//' after the scheme", uri=address),
            phrase("write package://PACKAGE/PATH"),
        )
    name, _, path = rest[2:].partition("/")
    if not name:
        raise _make_uri_error(
            phrase("'{uri}' does not name a package", uri=address), phrase("write package://PACKAGE/PATH")
        )
    return share(_decode(name)) / _decode(path).lstrip("/")


def _resolve_file_uri(address: str, rest: str) -> Path:
    path = parse_absolute_path(rest)
    if path is None:
        raise _make_uri_error(
            phrase("'{uri}' has no absolute path", uri=address),
            phrase("write file:///ABSOLUTE/PATH, with three slashes"),
        )
    return Path(path)


def parse_absolute_path(rest: str, *, with_drives: bool = os.name == "nt") -> str | None:
    """Return the path in a ``file:`` URI, or None if the path is not absolute.

    Args:
        rest: the URI without ``file:``.
        with_drives: whether paths begin with a drive letter, as on Windows: ``///C:/robots``, as `pathlib.Path.as_uri`
            writes it, and ``//C:/robots``, which results from ``file://$(find PACKAGE)`` there.
    """
    if rest.startswith("//localhost/"):
        rest = rest.removeprefix("//localhost")
    elif rest.startswith("//"):
        rest = rest[2:]
    drive = _DRIVE.match(rest) if with_drives else None
    if drive is not None:
        return _decode(rest[drive.start(1) :])
    return _decode(rest) if rest.startswith("/") else None


def _decode(text: str) -> str:
    if "%" not in text:
        return text
    from urllib.parse import unquote

    return unquote(text)


def _make_uri_error(problem: Phrase, hint: Phrase | None = None) -> LinkwrightError:
    """Return the error for an invalid resource URI (PKG102)."""
    return LinkwrightError(Diagnostic("PKG102", problem, hint=hint))
