"""Compare the ``model.config`` files of Gazebo's models: the names, the versions and the SDF files."""

from __future__ import annotations

from pathlib import Path

from linkwright.diagnostics import Span, phrase
from linkwright.review.file_pair import FilePair
from linkwright.review.texts.list_changes import change_text
from linkwright.xmltree import parse

MODEL_CONFIGURATION = "model.config"
_FILE = "sdf"
"""The element with the SDF file of the model. The attribute ``version`` names the version of SDF."""
_COMPARED = ("name", "version", _FILE)


def compare_model_configurations(pair: FilePair) -> None:
    """Compare two versions of a ``model.config``, without the author and the description."""
    versions = pair.read(_read)
    if versions is None:
        return
    old, new = versions
    for key in dict.fromkeys([*new, *old]):
        is_file = key.startswith(_FILE)
        if key not in old:
            text = phrase("{element} added", element=f"{key} {new[key][0]}")
            reason = None
        elif key not in new:
            text = phrase("{element} removed", element=f"{key} {old[key][0]}")
            is_lost = is_file and not any(other.startswith(_FILE) for other in new)
            reason = phrase("Gazebo does not find the model") if is_lost else None
        elif old[key][0] != new[key][0]:
            text, reason = change_text(key, old[key][0], new[key][0]), None
        else:
            continue
        span = new[key][1] if key in new else old[key][1]
        pair.add(text, pair.location(span, is_old=key not in new), reason)


def _read(file: Path) -> dict[str, tuple[str, Span | None]]:
    """Return the compared values of a configuration with their places.

    Raises:
        LinkwrightError: the file is not XML.
    """
    root = parse(file.read_bytes(), str(file)).root
    values = {}
    for element in root.elements():
        if element.tag in _COMPARED:
            key = f"{element.tag} {element.attributes.get('version', '')}".strip()
            values[key] = element.text().strip(), element.span()
    return values
