"""Compare package manifests (REP 149)."""

from __future__ import annotations

from collections.abc import Hashable, Iterator
from pathlib import Path, PurePosixPath

from linkwright.diagnostics import Phrase, joined, joined_first, phrase
from linkwright.lint.targets import find_targets
from linkwright.packages.manifest import package_name
from linkwright.packages.readers.package_xml import CATKIN, Manifest
from linkwright.review.changes import MAX_NAMES
from linkwright.review.file_pair import FilePair
from linkwright.review.files.build.cmake_files import CMAKE_FILE, read_cmake_facts
from linkwright.review.files.build.dependencies import compare_dependencies, find_lost_ros_versions
from linkwright.review.renames.packages import PackageNames, find_renamed_packages
from linkwright.review.texts.excerpts import differing_excerpts
from linkwright.review.versions import Version
from linkwright.xacro.cache import read_document
from linkwright.xmltree import Element, Text

_TEXT_TAGS = ("name", "version", "license", "maintainer", "author", "url", "member_of_group", "group_depend")
_PLUGIN_ATTRIBUTE = "plugin"
"""The attribute of an export that names a plugin description."""
_BLOCK_TAGS = frozenset({"p", "br", "li", "ul", "ol", "div", "tr", "h1", "h2", "h3"})
"""The tags of XHTML after which a new line begins."""


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
    lost = find_lost_ros_versions(old, new)
    if old.build_type != new.build_type or lost:
        old_type, new_type = (
            manifest.build_type or (CATKIN if lost and manifest.is_ros1 else "-") for manifest in manifests
        )
        text = phrase("build type: {old} -> {new}", old=old_type, new=new_type)
        reason = phrase("packages of ROS {versions} no longer find the package", versions=", ".join(map(str, lost)))
        pair.add(text, pair.location(new.root.span()), reason if lost else None)
    compare_dependencies(pair, old, new)
    _compare_exports(pair, old, new)


def manifest_contents(version: Version, path: str) -> Phrase:
    """Return the name, version, build type and dependencies of a package.

    A folder with a package of the same name is added.
    """
    manifest = _read(version.file(path))
    export = manifest.root.first("export")
    is_metapackage = export is not None and export.first("metapackage") is not None
    build_type = phrase("metapackage") if is_metapackage else manifest.build_type or CATKIN
    names = list(dict.fromkeys(dependency.name for dependency in manifest.dependencies))
    texts: list[Phrase] = [
        phrase("'{name}' {version}, {type}", name=manifest.name or "", version=manifest.text("version") or "-",
               type=build_type)
    ]  # fmt: skip
    if names:
        texts.append(phrase("depends on {names}", names=joined_first(names, MAX_NAMES)))
    folders = [folder for folder in find_targets([version.root]).packages if package_name(folder) == manifest.name]
    paths = [other for other in map(version.relative, folders) if other != PurePosixPath(path).parent.as_posix()]
    if paths:
        texts.append(phrase("{folder} has a package with the same name", folder=f"{paths[0]}/"))
    return joined(texts, "; ")


def _compare_texts(pair: FilePair, old: Manifest, new: Manifest) -> None:
    manifests = old, new
    for tag in _TEXT_TAGS:
        old_text, new_text = (_join_texts(manifest, tag) for manifest in manifests)
        if old_text != new_text:
            text = phrase("{tag}: {old} -> {new}", tag=tag, old=old_text or "-", new=new_text or "-")
            if tag == "name":
                text = phrase("package '{old}' renamed to '{new}'", old=old_text, new=new_text)
            reason = phrase("packages and launch files that name the package do not find it")
            is_breaking = tag == "name" and not (old.ros_versions and _is_old_project(pair, new_text))
            element = new.root.first(tag) or new.root
            pair.add(text, pair.location(element.span()), reason if is_breaking else None)
    for tag in ("maintainer", "author"):
        old_addresses, new_addresses = (_join_addresses(manifest, tag) for manifest in manifests)
        if old_addresses != new_addresses and _join_texts(old, tag) == _join_texts(new, tag):
            text = phrase("email of {tag}: {old} -> {new}", tag=tag, old=old_addresses or "-", new=new_addresses or "-")
            pair.add(text, pair.location((new.root.first(tag) or new.root).span()))
    _compare_descriptions(pair, old, new)


def _is_old_project(pair: FilePair, name: str) -> bool:
    """Return whether CMakeLists.txt of the old version has a name, without which catkin and ament refuse to build."""
    build_file = (PurePosixPath(pair.old_path).parent / CMAKE_FILE).as_posix()
    is_built = pair.versions.old.file(build_file).is_file()
    return is_built and read_cmake_facts(pair.versions.old, build_file).project == name


def _compare_descriptions(pair: FilePair, old: Manifest, new: Manifest) -> None:
    """Report a changed text of the description, or else changed markup."""
    elements = [manifest.root.first("description") for manifest in (old, new)]
    old_text, new_text = ("" if element is None else _read_plain_text(element) for element in elements)
    location = pair.location((elements[1] or new.root).span())
    if old_text != new_text:
        before, after = differing_excerpts(old_text, new_text)
        pair.add(phrase("description: {old} -> {new}", old=before or "-", new=after or "-"), location)
    elif _read_markup(elements[0]) != _read_markup(elements[1]):
        pair.add(phrase("markup of the description changed"), location)


def _read_plain_text(element: Element) -> str:
    """Return the text of an element without markup."""
    return " ".join("".join(_iterate_texts(element)).split())


def _iterate_texts(element: Element) -> Iterator[str]:
    for child in element.children:
        if isinstance(child, Element):
            yield from _iterate_texts(child)
            yield " " if child.tag in _BLOCK_TAGS else ""
        elif isinstance(child, Text):
            yield child.data


def _read_markup(element: Element | None) -> list[Hashable]:
    """Return the tags and attributes of the elements in a description."""
    parts = () if element is None else element.walk()
    return [(part.tag, tuple(sorted(part.attributes.items()))) for part in parts if part is not element]


def _read(file: Path) -> Manifest:
    return Manifest(read_document(str(file)))


def _join_texts(manifest: Manifest, tag: str) -> str:
    return ", ".join(" ".join(element.text().split()) for element in manifest.root.elements(tag))


def _join_addresses(manifest: Manifest, tag: str) -> str:
    return ", ".join(element.attributes.get("email", "") for element in manifest.root.elements(tag))


def _compare_exports(pair: FilePair, old: Manifest, new: Manifest) -> None:
    """Report added, removed and changed ``<export>`` elements."""
    old_exports, new_exports = (
        {_format_export(element): element for element in _read_exports(manifest)} for manifest in (old, new)
    )
    names = PackageNames(find_renamed_packages(pair.versions))
    removed = [element for text, element in old_exports.items() if text not in new_exports]
    added = [element for text, element in new_exports.items() if text not in old_exports]
    for element in list(removed):
        successor = next(
            (successor for successor in added if successor.tag == names.translate_package(element.tag)), None
        )
        if successor is not None:
            removed.remove(element)
            added.remove(successor)
            _compare_attributes(pair, element, successor)
    for element in added:
        pair.add(phrase("export added: {export}", export=_format_export(element)), pair.location(element.span()))
    for element in removed:
        is_replaced = any(_have_same_purpose(element, other) for other in new_exports.values())
        reason = None if is_replaced else _find_export_reason(element)
        location = pair.location(element.span(), is_old=True)
        pair.add(phrase("export removed: {export}", export=_format_export(element)), location, reason)


def _compare_attributes(pair: FilePair, old: Element, new: Element) -> None:
    """Report the changed attributes and text of an export."""
    location = pair.location(new.span())
    for name in dict.fromkeys((*new.attributes, *old.attributes)):
        before, after = old.attributes.get(name), new.attributes.get(name)
        if before == after:
            continue
        if before is None or after is None:
            value = before if after is None else after
            text = phrase("export {tag}: {name} {value} added", tag=new.tag, name=name, value=value)
            if after is None:
                text = phrase("export {tag}: {name} {value} removed", tag=new.tag, name=name, value=value)
            pair.add(text, location, _find_export_reason(old) if after is None else None)
        else:
            text = phrase("export {tag}: {name} {old} -> {new}", tag=new.tag, name=name, old=before, new=after)
            pair.add(text, location)
    old_text, new_text = (" ".join(element.text().split()) for element in (old, new))
    if old_text != new_text:
        text = phrase("export {tag}: {old} -> {new}", tag=new.tag, old=old_text or "-", new=new_text or "-")
        pair.add(text, location)


def _read_exports(manifest: Manifest) -> list[Element]:
    export = manifest.root.first("export")
    return [] if export is None else [element for element in export.elements() if element.tag != "build_type"]


def _format_export(element: Element) -> str:
    words = [element.tag, *(f"{name}={value}" for name, value in sorted(element.attributes.items()))]
    return " ".join([*words, *element.text().split()])


def _have_same_purpose(old: Element, new: Element) -> bool:
    """Return whether two exports declare plugins or folders for the same package."""
    return old.tag == new.tag and set(old.attributes) <= set(new.attributes)


def _find_export_reason(element: Element) -> Phrase | None:
    """Return the reason why removing an export is breaking, or None if it is not."""
    if _PLUGIN_ATTRIBUTE in element.attributes:
        return phrase("programs that look for plugins of '{name}' do not find these", name=element.tag)
    if element.tag.startswith("gazebo"):
        return phrase("the simulator does not find the folders of the package")
    return None
