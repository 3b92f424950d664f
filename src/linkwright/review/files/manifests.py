"""The comparison of the manifests of packages (REP 149)."""

from __future__ import annotations

from pathlib import Path

from linkwright.diagnostics import Phrase, phrase
from linkwright.packages.readers.package_xml import Manifest
from linkwright.review.file_pair import FilePair
from linkwright.xacro.cache import read_document
from linkwright.xmltree import Element

_TEXTS = ("name", "version", "license", "maintainer", "author", "url", "member_of_group", "group_depend")
_CONDITIONS = ("condition", "version_lt", "version_lte", "version_eq", "version_gte", "version_gt")
_PLUGIN = "plugin"
"""The attribute of an export that names a plugin description."""


def compare_manifests(pair: FilePair) -> None:
    """Compare two versions of the manifest of a package."""
    manifests = pair.read(_read)
    if manifests is None:
        return
    old, new = manifests
    _compare_texts(pair, old, new)
    formats = [manifest.root.attributes.get("format", "1") for manifest in manifests]
    if formats[0] != formats[1]:
        text = phrase("format: {old} -> {new}", old=formats[0], new=formats[1])
        pair.add(text, pair.location(new.root.span()))
    if old.build_type != new.build_type:
        text = phrase("build type: {old} -> {new}", old=old.build_type or "-", new=new.build_type or "-")
        pair.add(text, pair.location(new.root.span()))
    _compare_dependencies(pair, old, new)
    _compare_exports(pair, old, new)


def _compare_texts(pair: FilePair, old: Manifest, new: Manifest) -> None:
    manifests = old, new
    for tag in _TEXTS:
        old_text, new_text = (_texts(manifest, tag) for manifest in manifests)
        if old_text != new_text:
            text = phrase("{tag}: {old} -> {new}", tag=tag, old=old_text or "-", new=new_text or "-")
            reason = phrase("packages and launch files that name the package do not find it")
            element = new.root.first(tag) or new.root
            pair.add(text, pair.location(element.span()), reason if tag == "name" else None)
    for tag in ("maintainer", "author"):
        old_addresses, new_addresses = (_addresses(manifest, tag) for manifest in manifests)
        if old_addresses != new_addresses and _texts(old, tag) == _texts(new, tag):
            text = phrase("email of {tag}: {old} -> {new}", tag=tag, old=old_addresses or "-", new=new_addresses or "-")
            pair.add(text, pair.location((new.root.first(tag) or new.root).span()))
    if old.text("description") != new.text("description"):
        pair.add(phrase("description changed"), pair.location((new.root.first("description") or new.root).span()))


def _read(file: Path) -> Manifest:
    return Manifest(read_document(str(file)))


def _texts(manifest: Manifest, tag: str) -> str:
    return ", ".join(" ".join(element.text().split()) for element in manifest.root.elements(tag))


def _addresses(manifest: Manifest, tag: str) -> str:
    return ", ".join(element.attributes.get("email", "") for element in manifest.root.elements(tag))


def _compare_exports(pair: FilePair, old: Manifest, new: Manifest) -> None:
    """Add the changes of the information for other packages, such as where plugin descriptions are."""
    old_exports, new_exports = ({_export_text(element): element for element in _exports(each)} for each in (old, new))
    for text, element in new_exports.items():
        if text not in old_exports:
            pair.add(phrase("export added: {export}", export=text), pair.location(element.span()))
    for text, element in old_exports.items():
        if text not in new_exports:
            is_there = any(_offers_same(element, other) for other in new_exports.values())
            reason = None if is_there else _export_reason(element)
            location = pair.location(element.span(), is_old=True)
            pair.add(phrase("export removed: {export}", export=text), location, reason)


def _exports(manifest: Manifest) -> list[Element]:
    export = manifest.root.first("export")
    return [] if export is None else [element for element in export.elements() if element.tag != "build_type"]


def _export_text(element: Element) -> str:
    words = [element.tag, *(f"{name}={value}" for name, value in sorted(element.attributes.items()))]
    return " ".join([*words, *element.text().split()])


def _offers_same(old: Element, new: Element) -> bool:
    """Return whether two exports offer plugins or folders to the same package."""
    return old.tag == new.tag and set(old.attributes) <= set(new.attributes)


def _export_reason(element: Element) -> Phrase | None:
    """Return why a removed export is breaking, or None if it is not."""
    if _PLUGIN in element.attributes:
        return phrase("programs that look for plugins of '{name}' do not find these", name=element.tag)
    if element.tag.startswith("gazebo"):
        return phrase("the simulator does not find the folders of the package")
    return None


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
        for key in [key for key in new_elements if key[1] == package and key in old_elements]:
            _compare_conditions(pair, old_elements[key], new_elements[key], package)
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


def _compare_conditions(pair: FilePair, old: Element, new: Element, package: str) -> None:
    for name in _CONDITIONS:
        before, after = old.attributes.get(name), new.attributes.get(name)
        if before != after:
            text = phrase(
                "{tag} {package}: {name} {old} -> {new}",
                tag=new.tag,
                package=package,
                name=name,
                old=before or "-",
                new=after or "-",
            )
            pair.add(text, pair.location(new.span()))
