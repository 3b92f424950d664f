"""Find Python sources that newly use fields which the messages, services and actions of the repository do not have."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass
from pathlib import PurePosixPath

from linkwright.diagnostics import LinkwrightError, SourceText, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.messages import catalog
from linkwright.messages.definitions.interfaces import Container, Structure, list_structures
from linkwright.messages.definitions.library import TrustedMessages, parse_source
from linkwright.review.caching import cached_in_review
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.file_pair import UnreadableFileError
from linkwright.review.files.interfaces import read_structures
from linkwright.review.sources.interface_uses.definitions import InterfaceUse, LostInterface
from linkwright.review.sources.interface_uses.python import find_python_uses
from linkwright.review.sources.names import PYTHON_SUFFIX
from linkwright.review.users.lost_interfaces import INTERFACE_SUFFIXES, find_package, list_names
from linkwright.review.versions import TEST_FOLDERS, Version, Versions

_METHODS = frozenset(
    {
        *("SLOT_TYPES", "deserialize", "deserialize_numpy", "get_fields_and_field_types", "serialize"),
        "serialize_numpy",
    }
)
"""The public names that messages have in Python besides their fields and constants, in ROS 1 and ROS 2."""
_COMMON_PACKAGES = ("geometry_msgs", "nav_msgs", "sensor_msgs", "std_msgs", "std_srvs")
"""The packages of ROS 2 whose interfaces Linkwright knows, and hardly any distribution changes."""
_PARTS = {"msg": ("",), "srv": ("request ", "response ")}
"""The prefixes of the field names of a known interface, by its kind."""
_ROS1 = re.compile(r"\brospy\b")


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
    """Return the first use of each field that an interface does not have.

    Known interfaces of ROS 2 are left out in sources of ROS 1.
    """
    named = [item for item in interfaces if item.package in text and item.name in text]
    uses = sorted((use for item in named for use in find_python_uses(text, item)), key=lambda use: use.line)
    uses = [use for use in uses if use.interface.package not in _COMMON_PACKAGES or not _ROS1.search(text)]
    return {use.key: use for use in sorted({use.key: use for use in reversed(uses)}.values(), key=lambda use: use.line)}


def _read_interfaces(version: Version, files: Sequence[ChangedFile]) -> list[_Interface]:
    """Return the interfaces that the texts of sources may name, if only one file of the repository defines each.

    Those of `_COMMON_PACKAGES` are known.
    """
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
        types = {part: _read_field_types(structure) for part, structure in structures.items()}
        found.setdefault((package, name), []).append(_Interface(package, kind, name, names, field_types=types))
    own = [items[0] for items in found.values() if len(items) == 1]
    packages = {package for package, _ in found}
    return [*own, *_read_common_interfaces([package for package in _COMMON_PACKAGES if package not in packages], texts)]


def _read_common_interfaces(packages: Sequence[str], texts: Sequence[str]) -> Iterator[_Interface]:
    """Yield the interfaces of known packages that the texts of sources may name.

    An interface has the fields of all distributions.
    """
    for package in packages:
        users = [text for text in texts if package in text]
        names: dict[tuple[str, str], dict[str, frozenset[str]]] = {}
        types: dict[tuple[str, str], dict[str, dict[str, LostInterface]]] = {}
        for heading, definition in catalog.read_all_texts(package) if users else ():
            kind, _, name = heading.partition("/")
            if kind not in _PARTS or not any(name in text for text in users):
                continue
            source = SourceText(heading, definition)
            structures = list_structures(parse_source(source, f"{package}/{heading}", TrustedMessages()))
            parts = names.setdefault((kind, name), {})
            for part, structure in zip(_PARTS[kind], structures, strict=True):
                parts[part] = parts.get(part, frozenset()) | list_names(structure)
                types.setdefault((kind, name), {})[part] = _read_field_types(structure)
        for (kind, name), parts in names.items():
            yield _Interface(package, kind, name, parts, field_types=types[kind, name])


def _read_field_types(structure: Structure) -> dict[str, LostInterface]:
    """Return the types of the fields that are messages of known packages, such as a header."""
    single = [field for field in structure.fields if field.type.container is Container.ONE]
    types = {field.name: field.type.base.split("/") for field in single}
    known = {name: parts for name, parts in types.items() if parts[0] in _COMMON_PACKAGES}
    return {name: message for name, parts in known.items() if (message := _read_message(parts[0], parts[-1]))}


@cached_in_review(maxsize=128)
def _read_message(package: str, name: str) -> _Interface | None:
    """Return a message of a known package."""
    return next((item for item in _read_common_interfaces([package], [f"{package} {name}"]) if item.name == name), None)


def _make_change(path: str, use: InterfaceUse) -> Change:
    text = phrase("uses '{name}', which '{interface}' does not have", name=use.name, interface=use.interface.type_name)
    return Change(text, Effect.BREAKING, phrase("the access fails"), Location(path, use.line, use.column))
