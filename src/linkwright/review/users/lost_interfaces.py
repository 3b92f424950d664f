"""Find sources and interfaces that use removed messages, services, actions, fields or constants."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from pathlib import PurePosixPath

from linkwright.diagnostics import LinkwrightError, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.messages.definitions.interfaces import Structure
from linkwright.packages.manifest import MANIFEST, ROSBUILD_MANIFEST, package_name
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.file_pair import UnreadableFileError
from linkwright.review.files.build.cmake_files import CMAKE_FILE
from linkwright.review.files.build.facts import FactKind
from linkwright.review.files.build.unbuilt_interfaces import is_unbuilt
from linkwright.review.files.interfaces import read_structures
from linkwright.review.launches.programs.missing import find_packages
from linkwright.review.sources.headers.lost_types import find_including_files
from linkwright.review.sources.interface_uses.cpp import find_cpp_uses, find_member_uses, find_members
from linkwright.review.sources.interface_uses.definitions import InterfaceUse, LostInterface
from linkwright.review.sources.interface_uses.python import find_python_uses
from linkwright.review.sources.names import CPP_SUFFIXES, HEADER_SUFFIXES, PYTHON_SUFFIX
from linkwright.review.versions import TEST_FOLDERS, Version, Versions

INTERFACE_SUFFIXES = (".msg", ".srv", ".action")


def find_lost_interfaces(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the sources that use something that the interfaces of the repository lost, each with a change.

    Interfaces of packages that the new version does not have are left out, as are tests.
    """
    changed = [file for file in changed_files if file.path.endswith(INTERFACE_SUFFIXES) and not file.is_submodule]
    lost = [interface for file in changed if (interface := _find_lost(versions, file)) is not None]
    packages = {interface.package for interface in lost}
    for path in versions.new.paths((*CPP_SUFFIXES, PYTHON_SUFFIX)) if lost else ():
        text = versions.new.text(path)
        if not TEST_FOLDERS.isdisjoint(PurePosixPath(path).parts) or not any(name in text for name in packages):
            continue
        find_uses = find_python_uses if path.endswith(PYTHON_SUFFIX) else find_cpp_uses
        uses = {use.key: use for use in reversed([use for item in lost for use in find_uses(text, item)])}
        yield from ((path, _make_change(path, use)) for use in reversed(uses.values()))
    yield from _find_member_uses(versions.new, lost)
    yield from _find_dependencies(versions.new, {item.package for item in lost if item.is_removed})


def _find_dependencies(version: Version, packages: Collection[str]) -> Iterator[tuple[str, Change]]:
    """Yield the build files of ROS 1 whose interfaces depend on a package that no longer has any.

    Args:
        version: the new version.
        packages: the packages that lost interfaces.
    """
    left = {find_package(version, path) for path in version.paths(INTERFACE_SUFFIXES)} if packages else set()
    empty = {name for name in packages if name not in left}
    for package in find_packages(version).values() if empty else ():
        path = (PurePosixPath(package.folder) / CMAKE_FILE).as_posix()
        for fact in package.facts.facts if package.facts is not None and package.is_ros1 else ():
            if fact.kind is FactKind.INTERFACE_DEPENDENCY and fact.name in empty:
                text = phrase("the interfaces depend on '{name}', which no longer has any", name=fact.name)
                location = Location(path, fact.span.line, fact.span.column) if fact.span is not None else None
                yield path, Change(text, Effect.BREAKING, phrase("the interfaces are not built"), location)


def _find_member_uses(version: Version, lost: Sequence[LostInterface]) -> Iterator[tuple[str, Change]]:
    """Yield the C++ sources that use what interfaces lost of members which an included header declares."""
    paths = version.paths(CPP_SUFFIXES) if lost else []
    texts = {path: version.text(path) for path in paths if TEST_FOLDERS.isdisjoint(PurePosixPath(path).parts)}
    for interface in lost:
        found: dict[str, set[str]] = {}
        for header in [path for path in texts if path.endswith(HEADER_SUFFIXES) and interface.name in texts[path]]:
            members = find_members(texts[header], interface)
            for user in find_including_files(texts, header) if members else ():
                found.setdefault(user, set()).update(members)
        for user, members in found.items():
            yield from ((user, _make_change(user, use)) for use in find_member_uses(texts[user], interface, members))


def _make_change(path: str, use: InterfaceUse) -> Change:
    interface = use.interface
    text = phrase("uses the interface '{name}', which no longer exists", name=interface.type_name)
    if use.name:
        text = phrase("uses '{name}', which '{interface}' no longer has", name=use.name, interface=interface.type_name)
    reason = phrase("the code does not build")
    if path.endswith(PYTHON_SUFFIX):
        reason = phrase("the access fails") if use.name else phrase("the import fails")
    return Change(text, Effect.BREAKING, reason, Location(path, use.line, use.column))


def _find_lost(versions: Versions, file: ChangedFile) -> LostInterface | None:
    """Return what an interface lost; None if it lost nothing, was not built, or its package was removed."""
    if file.old_path is None or is_unbuilt(versions.old, file.old_path):
        return None
    package = find_package(versions.old, file.old_path)
    old_path = PurePosixPath(file.old_path)
    folder = versions.old.package_of(file.old_path, (MANIFEST, ROSBUILD_MANIFEST))
    if package is None or folder is None:
        return None
    paths = [
        path
        for path in versions.new.paths((old_path.suffix,))
        if PurePosixPath(path).name == old_path.name and find_package(versions.new, path) == package
    ]
    kind = old_path.suffix.removeprefix(".")
    if not paths:
        is_left = any((versions.new.file(folder) / name).is_file() for name in (MANIFEST, ROSBUILD_MANIFEST))
        has_own_header = (versions.new.file(folder) / f"include/{package}/{old_path.stem}.h").is_file()
        if not is_left or has_own_header:
            return None
        return LostInterface(package, kind, old_path.stem, {}, is_removed=True)
    if len(paths) > 1:
        return None  # several copies of the package
    try:
        old, new = (
            read_structures(versions.old.file(file.old_path)),
            read_structures(versions.new.file(paths[0])),
        )
    except (LinkwrightError, UnreadableFileError, OSError, ValueError, RecursionError, KeyError):
        return None
    lost = {part: list_names(old[part]) - list_names(new[part]) for part in old if part in new}
    constants = {name for part in old for name in _list_constants(old[part])}
    if not any(lost.values()):
        return None
    return LostInterface(package, kind, old_path.stem, lost, frozenset(constants))


def list_names(structure: Structure) -> frozenset[str]:
    """Return the fields and constants of a structure."""
    return frozenset(field.name for field in structure.fields) | _list_constants(structure)


def _list_constants(structure: Structure) -> frozenset[str]:
    return frozenset(constant.name for constant in structure.constants)


def find_package(version: Version, path: str) -> str | None:
    """Return the name of the package that contains a file, or None if there is none."""
    folder = version.package_of(path, (MANIFEST, ROSBUILD_MANIFEST))
    return None if folder is None else package_name(version.file(folder)) or version.file(folder).name
