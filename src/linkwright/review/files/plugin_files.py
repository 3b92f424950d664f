"""Compare plugin descriptions of pluginlib, which name the classes that programs load."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path, PurePosixPath

from linkwright.diagnostics import LinkwrightError, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.packages.manifest import MANIFEST
from linkwright.review.changes import Change, Effect, Location, Subject, SubjectKind
from linkwright.review.lenient_xml import read_lenient_root
from linkwright.review.renames.packages import PackageNames, find_renamed_packages
from linkwright.review.versions import Version, Versions

_ROOTS = frozenset({"library", "class_libraries"})
_UNKNOWN_EXPORT = re.compile(r"pluginlib_export_plugin_description_file\s*\([^)]*\$", re.IGNORECASE)
_LOST_REASON = phrase("programs and configurations that load the class do not find it")


@dataclass(frozen=True)
class _PluginClass:
    """A class in a plugin description: its type, base class, library and location."""

    type: str
    base: str
    library: str
    path: str
    location: Location | None


def compare_plugin_files(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[Subject]:
    """Yield the changed plugin descriptions with added, removed and changed classes.

    Moving a class to a different file is not a change.
    """
    old = _read_declared_classes(versions.old, [file.old_path for file in changed_files])
    new = _read_declared_classes(versions.new, [file.new_path for file in changed_files])
    changes: dict[str, list[Change]] = {}
    names = PackageNames(find_renamed_packages(versions))
    renamed = _find_renamed_classes(old, new, names)
    for old_name, name in renamed.items():
        text = phrase("plugin class '{old}' renamed to '{new}'", old=old_name, new=name)
        changes.setdefault(new[name].path, []).append(Change(text, Effect.BREAKING, _LOST_REASON, new[name].location))
    old = {renamed.get(name, name): plugin for name, plugin in old.items()}
    for name, plugin in new.items():
        for change in _compare_class(name, old.get(name), plugin, names):
            changes.setdefault(plugin.path, []).append(change)
    for name, plugin in old.items():
        if name not in new:
            text = phrase("plugin class '{name}' removed", name=name)
            change = Change(text, location=plugin.location)
            if _is_exported(versions.old, plugin.path):
                change = replace(change, effect=Effect.BREAKING, reason=_LOST_REASON)
            changes.setdefault(plugin.path, []).append(change)
    paths = {path: file for file in changed_files for path in (file.old_path, file.new_path) if path}
    for path in sorted(changes):
        file = paths[path]
        yield Subject(SubjectKind.PLUGINS, path, file.old_path, file.new_path, changes[path])


def list_lost_classes(versions: Versions, changed_files: Sequence[ChangedFile]) -> set[str]:
    """Return the names of plugin classes that changed plugin descriptions no longer declare."""
    old = _read_declared_classes(versions.old, [file.old_path for file in changed_files])
    new = _read_declared_classes(versions.new, [file.new_path for file in changed_files])
    return {name for name, plugin in old.items() if name not in new and _is_exported(versions.old, plugin.path)}


def _read_declared_classes(version: Version, paths: Sequence[str | None]) -> Mapping[str, _PluginClass]:
    """Return the classes that plugin descriptions declare, by the name that programs load."""
    classes: dict[str, _PluginClass] = {}
    for path in paths:
        if path is None or not path.endswith(".xml") or not version.file(path).is_file():
            continue
        classes.update(_read_classes(version.file(path), path, is_old=version.is_old))
    return classes


def _read_classes(file: Path, path: str, *, is_old: bool) -> Iterator[tuple[str, _PluginClass]]:
    try:
        root = read_lenient_root(file)
    except LinkwrightError:
        return
    if root.tag not in _ROOTS:
        return
    library = ""
    for element in root.walk():
        attributes, span = element.attributes, element.span()
        library = attributes.get("path", "") if element.tag == "library" else library
        name = attributes.get("name") or attributes.get("type")
        if element.tag == "class" and name:
            location = None if span is None else Location(path, span.line, span.column, is_old)
            types = attributes.get("type", ""), attributes.get("base_class_type", "")
            yield name, _PluginClass(*types, library, path, location)


def _is_exported(version: Version, path: str) -> bool:
    """Return whether a package may export a plugin description.

    Programs do not find a plugin description without an export.
    """
    folders = (version.file(parent.as_posix()) for parent in PurePosixPath(path).parents)
    package = next((folder for folder in folders if (folder / MANIFEST).is_file()), None)
    if package is None:
        return True
    files = (package / name for name in (MANIFEST, "CMakeLists.txt", "setup.py", "setup.cfg"))
    text = "\n".join(file.read_text("utf-8", errors="replace") for file in files if file.is_file())
    return PurePosixPath(path).name in text or _UNKNOWN_EXPORT.search(text) is not None


def _find_renamed_classes(
    old: Mapping[str, _PluginClass], new: Mapping[str, _PluginClass], names: PackageNames
) -> dict[str, str]:
    """Return the new names of renamed classes by old name.

    A class is renamed if only the package part of its name differs, or if it keeps its type.
    """
    removed = {name: plugin for name, plugin in old.items() if name not in new}
    added = {name: plugin for name, plugin in new.items() if name not in old}
    renamed: dict[str, str] = {}
    for old_name, plugin in removed.items():
        classes_of_type = [
            name for name, other in added.items() if plugin.type and other.type == names.rename_derived(plugin.type)
        ]
        derived = names.rename_derived(old_name)
        new_name = derived if derived in added else classes_of_type[0] if len(classes_of_type) == 1 else None
        if new_name is not None:
            renamed[old_name] = new_name
            del added[new_name]
    return renamed


def _compare_class(name: str, old: _PluginClass | None, new: _PluginClass, names: PackageNames) -> Iterator[Change]:
    if old is None:
        yield Change(phrase("plugin class '{name}' added", name=name), location=new.location)
        return
    if names.rename_derived(old.base) != new.base:
        text = phrase("plugin class '{name}': base class {old} -> {new}", name=name, old=old.base, new=new.base)
        reason = phrase("programs that load the class as the old base class do not start")
        yield Change(text, Effect.BREAKING, reason, new.location)
    if names.rename_derived(old.type) != new.type:
        text = phrase("plugin class '{name}': type {old} -> {new}", name=name, old=old.type, new=new.type)
        yield Change(text, location=new.location)
    if _get_library_name(names.rename_derived(old.library)) != _get_library_name(new.library):
        text = phrase("plugin class '{name}': library {old} -> {new}", name=name, old=old.library, new=new.library)
        yield Change(text, location=new.location)


def _get_library_name(path: str) -> str:
    """Return the name of a library without folder, prefix and suffix.

    pluginlib adds these itself.
    """
    return PurePosixPath(path).name.removeprefix("lib").removesuffix(".so")
