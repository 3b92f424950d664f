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
    formats = [manifest.root.attributes.get("format", "1") for manifest in manifests]
    if formats[0] != formats[1]:
        text = phrase("format: {old} -> {new}", old=formats[0], new=formats[1])
        pair.add(text, pair.location(new.root.span()))
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
    retagged: dict[tuple[tuple[str, ...], tuple[str, ...]], list[str]] = {}
    for package in dict.fromkeys(package for _, package in (*new_elements, *old_elements)):
        removed = [tag for tag, name in old_elements if name == package and (tag, name) not in new_elements]
        added = [tag for tag, name in new_elements if name == package and (tag, name) not in old_elements]
        if added and removed:
            retagged.setdefault((tuple(removed), tuple(added)), []).append(package)
            continue
        for tag in added:
            location = pair.location(new_elements[tag, package].span())
            pair.add(phrase("{tag} {package} added", tag=tag, package=package), location)
        for tag in removed:
            location = pair.location(old_elements[tag, package].span(), is_old=True)
            pair.add(phrase("{tag} {package} removed", tag=tag, package=package), location)
    for (removed_tags, added_tags), packages in retagged.items():
        text = phrase(
            "{old} -> {new}: {packages}",
            old=" + ".join(removed_tags),
            new=" + ".join(added_tags),
            packages=", ".join(packages),
        )
        pair.add(text, pair.location(new_elements[added_tags[0], packages[0]].span()))
