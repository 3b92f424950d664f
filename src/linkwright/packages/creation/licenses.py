"""Licenses by SPDX identifier, and their texts for the ``LICENSE`` of a new package."""

from __future__ import annotations

from pathlib import Path

_TEXT_FOLDER = Path(__file__).with_name("license_texts")


def list_known_licenses() -> list[str]:
    """Return the identifiers of the licenses whose texts are available, in alphabetical order."""
    return sorted(path.name.removesuffix(".txt") for path in _TEXT_FOLDER.glob("*.txt"))


def license_text(identifier: str, *, year: int, holder: str) -> str | None:
    """Return the text of a license with its copyright line, or None for an unknown identifier.

    The Lesser GPL is a set of additional permissions to the GPL, so the text of the GPL follows its text.
    """
    if identifier not in list_known_licenses():
        return None
    text = _read_text(identifier)
    if identifier.startswith("LGPL-"):
        text += "\n" + _read_text(identifier.removeprefix("L"))
    return text.replace("<year> <holder>", f"{year} {holder}")


def _read_text(identifier: str) -> str:
    return (_TEXT_FOLDER / f"{identifier}.txt").read_text(encoding="utf-8")
