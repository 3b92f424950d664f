"""Find Python sources that newly use fields which the messages, services and actions of the repository do not have."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass
from pathlib import PurePosixPath

from linkwright.diagnostics import LinkwrightError, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.file_pair import UnreadableFileError
from linkwright.review.files.interfaces import read_structures
from linkwright.review.sources.interface_uses import InterfaceUse, LostInterface
from linkwright.review.sources.names import PYTHON_SUFFIX
from linkwright.review.sources.python_interface_uses import find_python_uses
from linkwright.review.users.lost_interfaces import INTERFACE_SUFFIXES, find_package, list_names
from linkwright.review.versions import TEST_FOLDERS, Version, Versions

_METHODS = frozenset(
    {
        *("SLOT_TYPES", "deserialize", "deserialize_numpy", "get_fields_and_field_types", "serialize"),
        "serialize_numpy",
    }
)
"""The public names that messages have in Python besides their fields and constants, in ROS 1 and ROS 2."""


class _OtherNames(frozenset[str]):
    """All names except those of a set, of methods, and private ones."""

    def __contains__(self, name: object) -> bool:
        return not super().__contains__(name) and name not in _METHODS and not str(name).startswith("_")

    def __and__(self, other: AbstractSet[object]) -> frozenset[str]:
        return frozenset(str(name) for name in other if name in self)


@dataclass(frozen=True)
class _Interface(LostInterface):
    """An interface of which any other field counts as lost."""

    def lost_from(self, part: str) -> frozenset[str]:
        """Return all names except the fields and constants of a part."""
        return _OtherNames(self.names[part]) if part in self.names else frozenset()


def find_missing_fields(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the changed Python sources that newly use a field which no version of the interface has."""
    files = [file for file in changed_files if (file.new_path or "").endswith(PYTHON_SUFFIX)]
    files = [file for file in files if TEST_FOLDERS.isdisjoint(PurePosixPath(file.path).parts)]
    interfaces = _read_interfaces(versions.new, files) if files else []
    old_interfaces = {item.type_name: item for item in (_read_interfaces(versions.old, files) if interfaces else ())}
    for file in files if interfaces else ():
        path = file.new_path or ""
        uses = _find_uses(versions.new.text(path), interfaces)
        old_text = versions.old.text(file.old_path) if file.old_path and uses else ""
        old_uses = _find_uses(old_text, list(old_interfaces.values()))
        for key, use in uses.items():
            old = old_interfaces.get(use.interface.type_name)
            name = use.name.rpartition(" ")[2]
            part = use.name.removesuffix(name)
            had_field = old is not None and name in old.names.get(part, ())  # another line tells it as lost
            if key not in old_uses and not had_field:
                yield path, _make_change(path, use)


def _find_uses(text: str, interfaces: Sequence[_Interface]) -> dict[tuple[str, str, str], InterfaceUse]:
    """Return the first use of each field that an interface does not have."""
    named = [item for item in interfaces if item.package in text and item.name in text]
    return {use.key: use for use in reversed([use for item in named for use in find_python_uses(text, item)])}


def _read_interfaces(version: Version, files: Sequence[ChangedFile]) -> list[_Interface]:
    """Return the interfaces of the repository that the texts of sources may name, if only one file defines each."""
    paths = (file.old_path if version.is_old else file.new_path for file in files)
    texts = [version.text(path) for path in paths if path]
    found: dict[tuple[str, str], list[_Interface]] = {}
    for path in version.paths(INTERFACE_SUFFIXES):
        name, package = PurePosixPath(path).stem, find_package(version, path)
        if package is None or not any(package in text and name in text for text in texts):
            continue
        try:
            structures = read_structures(version.file(path))
        except (LinkwrightError, UnreadableFileError, OSError, ValueError, RecursionError, KeyError):
            continue
        names = {part: list_names(structure) for part, structure in structures.items()}
        kind = PurePosixPath(path).suffix.removeprefix(".")
        found.setdefault((package, name), []).append(_Interface(package, kind, name, names))
    return [items[0] for items in found.values() if len(items) == 1]


def _make_change(path: str, use: InterfaceUse) -> Change:
    text = phrase("uses '{name}', which '{interface}' does not have", name=use.name, interface=use.interface.type_name)
    return Change(text, Effect.BREAKING, phrase("the access fails"), Location(path, use.line, use.column))
