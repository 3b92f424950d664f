"""The comparison of worlds and models in SDF."""

from __future__ import annotations

from pathlib import Path

from linkwright.descriptions.comparison import Difference, ElementComparison
from linkwright.diagnostics import Phrase, phrase
from linkwright.review.breaking import plugin_name_reason
from linkwright.review.file_pair import FilePair
from linkwright.xacro.cache import read_document
from linkwright.xmltree import Element


def compare_worlds(pair: FilePair) -> None:
    """Compare two versions of a file in SDF, without the models that it includes."""
    elements = pair.read(_elements)
    if elements is None:
        return
    for difference in ElementComparison().child_differences(*elements):
        place = difference.new_place or difference.old_place
        location = None if place is None else pair.location(place.span, is_old=difference.new_place is None)
        pair.add(_sentence(difference), location, _breaking_reason(difference))


def _elements(file: Path) -> list[Element]:
    return list(read_document(str(file)).root.elements())


def _sentence(difference: Difference) -> Phrase:
    name = f"{difference.name} {difference.property}".strip()
    if difference.kind == "added" or (difference.old is None and difference.kind == "changed"):
        content = " ".join(word for word in (difference.new or "").split() if not word.startswith("<"))
        return phrase("{element} added", element=f"{name} {content}".strip())
    if difference.kind == "removed" or difference.new is None:
        return phrase("{element} removed", element=name)
    return phrase("{element}: {old} -> {new}", element=name, old=difference.old or "-", new=difference.new or "-")


def _breaking_reason(difference: Difference) -> Phrase | None:
    """Return why a difference breaks programs that use the world, or None if it does not."""
    tag, _, name = difference.name.partition(" ")
    if difference.kind == "removed" and tag == "world":
        return phrase("programs that use the topics and services of the world '{name}' do not find them", name=name)
    return plugin_name_reason(difference) if "plugin " in difference.property else None
