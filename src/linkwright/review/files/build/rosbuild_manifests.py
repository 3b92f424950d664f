"""Compare the manifests of rosbuild, the predecessor of catkin."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import PurePosixPath

from linkwright.diagnostics import LinkwrightError, Phrase, joined_first, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.packages.manifest import MANIFEST, ROSBUILD_MANIFEST
from linkwright.packages.readers.package_xml import Manifest
from linkwright.review.changes import MAX_NAMES, Change, Effect, Location, Subject, SubjectKind
from linkwright.review.versions import Version, Versions
from linkwright.xacro.cache import read_document
from linkwright.xmltree import Element

_FILES = (ROSBUILD_MANIFEST, "stack.xml")
_ROOTS = ("package", "stack")
_TEXT_TAGS = ("version", "license", "author", "url")
_Items = dict[tuple[str, str], Element]
"""Elements by tag and name."""


def compare_rosbuild_manifests(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[Subject]:
    """Yield the changed rosbuild manifests with their changes."""
    for file in changed_files:
        if PurePosixPath(file.path).name not in _FILES or file.is_submodule:
            continue
        old, new = _read(versions.old, file.old_path), _read(versions.new, file.new_path)
        changes = list(_find_changes(versions, file, old, new))
        if changes:
            yield Subject(SubjectKind.MANIFEST, file.path, file.old_path, file.new_path, changes)


def _read(version: Version, path: str | None) -> Element | None:
    """Return the root of a manifest; None if the file is absent or not a manifest."""
    if path is None or not version.file(path).is_file():
        return None
    try:
        root = read_document(str(version.file(path))).root
    except LinkwrightError:
        return None
    return root if root.tag in _ROOTS else None


def _find_changes(versions: Versions, file: ChangedFile, old: Element | None, new: Element | None) -> Iterator[Change]:
    if old is None and new is not None and file.old_path is None:
        names = list(dict.fromkeys(name for _, name in _read_dependencies(new)))
        text = phrase("stack added") if new.tag == "stack" else phrase("package of rosbuild added")
        items = phrase("depends on {names}", names=joined_first(names, MAX_NAMES))
        yield Change(phrase("{change}: {items}", change=text, items=items) if names else text)
    elif old is not None and new is None and file.new_path is None:
        yield from _describe_removal(versions, file.path, old)
    elif old is not None and new is not None:
        yield from _find_differences(file, old, new)


def _describe_removal(versions: Versions, path: str, old: Element) -> Iterator[Change]:
    """Yield the removal of a manifest, or its differences from the catkin manifest."""
    manifest = versions.new.file((PurePosixPath(path).parent / MANIFEST).as_posix())
    if old.tag == "stack":
        yield Change(phrase("stack removed"))
    elif manifest.is_file():
        yield Change(phrase("replaced by {file}", file=MANIFEST))
        try:
            new_names = {dependency.name for dependency in Manifest(read_document(str(manifest))).dependencies}
        except LinkwrightError:
            return
        removed = [name for tag, name in _read_dependencies(old) if tag == "depend" and name not in new_names]
        if removed:
            text = phrase("{tags} removed: {packages}", tags="depend", packages=joined_first(removed, MAX_NAMES))
            yield Change(text)
    else:
        reason = phrase("packages that depend on the package do not build or start")
        yield Change(phrase("package removed"), Effect.BREAKING, reason)


def _find_differences(file: ChangedFile, old: Element, new: Element) -> Iterator[Change]:
    old_name, new_name = (PurePosixPath(path or "").parent.name for path in (file.old_path, file.new_path))
    if old_name != new_name and new.tag == "package":
        text = phrase("package '{old}' renamed to '{new}'", old=old_name, new=new_name)
        reason = phrase("packages and launch files that name the package do not find it")
        yield Change(text, Effect.BREAKING, reason)
    for tag in _TEXT_TAGS:
        before, after = (", ".join(" ".join(part.text().split()) for part in root.elements(tag)) for root in (old, new))
        if before != after:
            text = phrase("{tag}: {old} -> {new}", tag=tag, old=before or "-", new=after or "-")
            yield Change(text, location=_find_location(file, (new.first(tag) or new), is_old=False))
    if _read_description(old) != _read_description(new):
        yield Change(phrase("description changed"), location=_find_location(file, new, is_old=False))
    old_items, new_items = ({**_read_dependencies(root), **_read_exports(root)} for root in (old, new))
    yield from _find_unpaired_elements(file, new_items, old_items, is_added=True)
    yield from _find_unpaired_elements(file, old_items, new_items, is_added=False)


def _read_dependencies(root: Element) -> _Items:
    """Return the dependencies on packages, stacks and system packages, by tag and name."""
    return {
        (tag, element.attributes[attribute]): element
        for tag, attribute in (("depend", "package"), ("depend", "stack"), ("rosdep", "name"))
        for element in root.elements(tag)
        if attribute in element.attributes
    }


def _read_exports(root: Element) -> _Items:
    export = root.first("export")
    elements = () if export is None else export.elements()
    return {
        ("export", " ".join([element.tag, *(f"{k}={v}" for k, v in element.attributes.items())])): element
        for element in elements
    }


def _find_unpaired_elements(file: ChangedFile, items: _Items, others: _Items, *, is_added: bool) -> Iterator[Change]:
    for tag in ("depend", "rosdep", "export"):
        unpaired = [
            (name, element)
            for (item_tag, name), element in items.items()
            if item_tag == tag and (item_tag, name) not in others
        ]
        if not unpaired:
            continue
        names = joined_first([name for name, _ in unpaired], MAX_NAMES)
        location = _find_location(file, unpaired[0][1], is_old=not is_added)
        if is_added:
            yield Change(phrase("{tags} added: {packages}", tags=tag, packages=names), location=location)
            continue
        text = phrase("{tags} removed: {packages}", tags=tag, packages=names)
        reason = _find_removal_reason(tag, [element for _, element in unpaired])
        yield Change(text, Effect.CHANGED if reason is None else Effect.BREAKING, reason, location)


def _find_removal_reason(tag: str, elements: Sequence[Element]) -> Phrase | None:
    """Return the reason why removing elements is breaking, or None if it is not."""
    plugins = [element.tag for element in elements if tag == "export" and "plugin" in element.attributes]
    if plugins:
        return phrase("programs that look for plugins of '{name}' do not find these", name=plugins[0])
    return None


def _read_description(root: Element) -> str:
    element = root.first("description")
    if element is None:
        return ""
    texts = (" ".join(part.text().split()) for part in element.walk())
    return " ".join([element.attributes.get("brief", ""), *texts])


def _find_location(file: ChangedFile, element: Element, *, is_old: bool) -> Location | None:
    span = element.span()
    if span is None:
        return None
    return Location((file.old_path if is_old else file.new_path) or file.path, span.line, span.column, is_old)
