"""The comparison of the manifests of packages (REP 149)."""

from __future__ import annotations

from pathlib import Path

from linkwright.diagnostics import phrase
from linkwright.packages.readers.package_xml import Manifest
from linkwright.review.file_pair import FilePair
from linkwright.xacro.cache import read_document

_TEXTS = ("name", "version", "license", "maintainer", "author")


def compare_manifests(pair: FilePair) -> None:
    """Compare two versions of the manifest of a package."""
    manifests = pair.read(_read)
    if manifests is None:
        return
    old, new = manifests
    for tag in _TEXTS:
        old_text, new_text = (_texts(manifest, tag) for manifest in manifests)
        if old_text != new_text:
            text = phrase("{tag}: {old} -> {new}", tag=tag, old=old_text or "-", new=new_text or "-")
            reason = phrase("packages and launch files that name the package do not find it")
            element = new.root.first(tag) or new.root
            pair.add(text, pair.location(element.span()), reason if tag == "name" else None)
    if old.build_type != new.build_type:
        text = phrase("build type: {old} -> {new}", old=old.build_type or "-", new=new.build_type or "-")
        pair.add(text, pair.location(new.root.span()))
    _compare_dependencies(pair, old, new)


def _read(file: Path) -> Manifest:
    return Manifest(read_document(str(file)))


def _texts(manifest: Manifest, tag: str) -> str:
    return ", ".join(" ".join(element.text().split()) for element in manifest.root.elements(tag))


def _compare_dependencies(pair: FilePair, old: Manifest, new: Manifest) -> None:
    old_elements, new_elements = (
        {(dependency.tag, dependency.name): dependency.element for dependency in manifest.dependencies}
        for manifest in (old, new)
    )
    for (tag, package), element in new_elements.items():
        if (tag, package) not in old_elements:
            pair.add(phrase("{tag} {package} added", tag=tag, package=package), pair.location(element.span()))
    for (tag, package), element in old_elements.items():
        if (tag, package) not in new_elements:
            location = pair.location(element.span(), is_old=True)
            pair.add(phrase("{tag} {package} removed", tag=tag, package=package), location)
