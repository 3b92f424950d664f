"""Compare the definitions of messages, services and actions."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path, PurePosixPath

from linkwright.diagnostics import LinkwrightError, Phrase, joined, joined_first, phrase
from linkwright.messages.definitions.idl import ENUMERATION, parse_idl_structures
from linkwright.messages.definitions.interfaces import Constant, Field, Structure, is_interface_name, list_structures
from linkwright.messages.definitions.library import TrustedMessages, parse_source, read_source
from linkwright.messages.definitions.parser import SECTIONS
from linkwright.packages import MANIFEST, enclosing_package
from linkwright.packages.manifest import ROSBUILD_MANIFEST
from linkwright.packages.readers.package_xml import Manifest
from linkwright.review.changes import MAX_NAMES, Change, Effect, Location
from linkwright.review.file_pair import FilePair, LimitError
from linkwright.review.files.build.cmake_files import CMAKE_FILE
from linkwright.review.files.build.unbuilt_interfaces import is_unbuilt
from linkwright.review.files.containing_interfaces import find_containing_interfaces
from linkwright.review.files.renamed_fields import find_renamed_constants, find_renamed_fields
from linkwright.review.versions import Version
from linkwright.xacro.cache import read_document

_SEPARATOR = "---"
_IDL = ".idl"
_MIN_RENUMBERED = 3
"""The minimum number of changed constants that share a line. An inserted constant can renumber those below it."""
_MIN_LISTED = 2
"""The minimum number of added or removed fields or constants that share a line."""
_ROS2_TYPE = re.compile(r"^builtin_interfaces/(?:msg/)?(Time|Duration)\b")
"""A type of ROS 2 that is built in in ROS 1."""
_PART_PREFIXES = {1: ("",), 2: ("request ", "response "), 3: ("goal ", "result ", "feedback ")}
"""The prefixes of field names: the structures of a message, a service and an action."""


def compare_interfaces(pair: FilePair) -> None:
    """Compare two versions of the definition of a message, service or action.

    A change to a field is breaking: the hash of the type changes (REP 2016), and nodes that were built with different
    versions do not exchange messages. In ROS 1, constants are a part of the MD5 sum of a type. No program uses a
    definition that the old version does not build, such as one for ROS 1 in a package of ROS 2.
    """
    definitions = pair.read(read_structures)
    is_foreign = definitions is None
    if is_foreign:
        definitions = _read_ros1_definition(pair)
    if definitions is not None:
        _compare(pair, *definitions)
    if definitions is not None and is_foreign:
        _report_ros1_types(pair, *definitions)
    _name_containing_interfaces(pair)
    was_unbuilt = is_unbuilt(pair.versions.old, pair.old_path)
    is_still_unbuilt = was_unbuilt and is_unbuilt(pair.versions.new, pair.new_path)
    if is_still_unbuilt or (not pair.is_lost and (is_foreign or was_unbuilt)):
        pair.changes = [replace(change, effect=Effect.CHANGED, reason=None) for change in pair.changes]
    if pair.old_path != pair.new_path and not was_unbuilt and is_unbuilt(pair.versions.new, pair.new_path):
        pair.add(phrase("CMakeLists.txt does not build it"), Location(pair.new_path, 1, 1), _make_use_reason())


def _name_containing_interfaces(pair: FilePair) -> None:
    """Add the other types that change with this one, because they contain it, to the reasons of breaking changes."""
    reasons = (_make_exchange_reason(), _make_ros1_exchange_reason())
    if all(change.reason not in reasons for change in pair.changes):
        return
    changed = {file.new_path for file in pair.versions.changed_files}
    paths = [path for path in find_containing_interfaces(pair.versions.new, pair.new_path) if path not in changed]
    if paths:
        names = joined_first((f"'{PurePosixPath(path).name}'" for path in paths), MAX_NAMES)
        for reason in reasons:
            more = phrase("{reason}; the same holds for the types that contain it: {names}", reason=reason, names=names)
            pair.changes = [
                replace(change, reason=more) if change.reason == reason else change for change in pair.changes
            ]


def _read_ros1_definition(pair: FilePair) -> tuple[Mapping[str, Structure], Mapping[str, Structure]] | None:
    """Return both versions of a definition that only ROS 1 could read before; None if there is another fault."""
    if pair.is_lost or pair.problems:
        return None
    try:
        return read_structures(pair.old_file, is_ros1=True), read_structures(pair.new_file)
    except LinkwrightError:
        return None


def _report_ros1_types(pair: FilePair, old: Mapping[str, Structure], new: Mapping[str, Structure]) -> None:
    """Report the fields of types that only ROS 1 has, and that are otherwise unchanged."""
    for index, (part, structure) in enumerate(new.items()):
        old_fields = old[part].fields if part in old else ()
        locations = _Locations(pair, index, structure.type_name)
        for field in [field for field in structure.fields if field in old_fields]:
            text = field.type.to_msg_text()
            old_text = _format_type(field, is_ros1=True)
            if old_text != text:
                sentence = phrase("field '{name}': {old} -> {new}", name=part + field.name, old=old_text, new=text)
                pair.add(sentence, locations.find(field.name))


def _compare(pair: FilePair, old: Mapping[str, Structure], new: Mapping[str, Structure]) -> None:
    if old.keys() != new.keys() and pair.new_file.suffix != _IDL:
        return  # such as a message that became a service, with a different file name
    renamed = _find_renamed_structures(old, new)
    is_ros1 = _is_ros1(pair.new_file)
    for index, (name, new_part) in enumerate(new.items()):
        locations = _Locations(pair, index, new_part.type_name)
        old_part = old.get(renamed.get(name, name), Structure(name, ()))
        if name in renamed:
            names = {"old": old_part.type_name, "new": new_part.type_name}
            text = phrase("structure '{old}' renamed to '{new}'", **names)
            if _is_enumeration(new_part):
                text = phrase("enumeration '{old}' renamed to '{new}'", **names)
            pair.add(text, locations.new_start, _make_use_reason())
        elif name not in old and _is_enumeration(new_part):
            values = joined_first([constant.name for constant in new_part.constants], MAX_NAMES)
            text = phrase("enumeration '{name}' added: {values}", name=new_part.type_name, values=values)
            pair.add(text, locations.new_start)
            continue
        elif name not in old and new_part.fields:
            pair.add(phrase("structure '{name}' added", name=new_part.type_name), locations.new_start)
            continue
        packages = [structure.type_name.partition("/")[0] for structure in (old_part, new_part)]
        _compare_fields(pair, old_part.fields, new_part.fields, name, locations, packages)
        _compare_constants(pair, old_part.constants, new_part.constants, name, locations, is_ros1=is_ros1)
    for name in [name for name in old if name not in new and name not in renamed.values()]:
        text = phrase("structure '{name}' removed", name=old[name].type_name)
        if _is_enumeration(old[name]):
            text = phrase("enumeration '{name}' removed", name=old[name].type_name)
        pair.add(text, _Locations(pair, 0, old[name].type_name).old_start, _make_use_reason())


def interface_contents(version: Version, path: str) -> Phrase | None:
    """Return the typed fields and the constants of an interface, and whether it is not built; None for neither."""
    file = version.file(path)
    parts = read_structures(file)
    is_ros1 = file.suffix != _IDL and _is_ros1(file)
    is_idl = file.suffix == _IDL  # any number of structures, whose names are prefixes
    texts = []
    for part, structure in parts.items():
        prefix = part if is_idl else ""
        names = [f"{_format_type(field, is_ros1=is_ros1)} {prefix}{field.name}" for field in structure.fields]
        names += [f"{constant.name} = {constant.value!s}" for constant in structure.constants]
        if names:
            items = joined_first(names, MAX_NAMES)
            texts.append(phrase("{part}: {items}", part=part.strip(), items=items) if part and not is_idl else items)
    contents = joined(texts, ", " if is_idl else "; ") if texts else None
    if not is_unbuilt(version, path):
        return contents
    if not version.file(f"{version.package_of(path)}/{CMAKE_FILE}".lstrip("/")).is_file():
        unbuilt = phrase("the package has no CMakeLists.txt")
    elif version.is_old:
        unbuilt = phrase("CMakeLists.txt did not build it")
    else:
        unbuilt = phrase("CMakeLists.txt does not build it")
    return unbuilt if contents is None else joined([contents, unbuilt], "; ")


def find_syntax_errors(version: Version, path: str) -> list[Change]:
    """Return a change if an added interface is built and cannot be read; otherwise an empty list."""
    try:
        read_structures(version.file(path))
    except LinkwrightError as error:
        diagnostic = error.diagnostics[0]
        text = phrase("the definition cannot be read: {reason}", reason=diagnostic.message)
        if is_unbuilt(version, path):
            return [Change(text)]
        line = diagnostic.span.line if diagnostic.span is not None else 1
        return [Change(text, Effect.BREAKING, phrase("the package does not build"), Location(path, line, 1))]
    except (LimitError, OSError):
        pass
    return []


def _format_type(field: Field, *, is_ros1: bool) -> str:
    """Return the type of a field as a definition for its ROS version writes it."""
    text = field.type.to_msg_text()
    return _ROS2_TYPE.sub(lambda match: match[1].lower(), text) if is_ros1 else text


def read_structures(file: Path, *, is_ros1: bool | None = None) -> Mapping[str, Structure]:
    """Return the structures of a file by the prefix of their field names.

    Args:
        file: the definition.
        is_ros1: whether to read it as ROS 1 does; None for the ROS version of its package.
    """
    kind = file.parent.name if file.suffix == _IDL else file.suffix.removeprefix(".")
    if kind not in SECTIONS:  # not a ROS file, so it can have any number of structures
        try:
            return {f"{structure.type_name}.": structure for structure in parse_idl_structures(read_source(file))}
        except LinkwrightError as error:
            raise LimitError(error.diagnostics[0].message) from None  # ROS supports less of IDL than other programs
    package = enclosing_package(file.parent)
    name = package[0] if package else file.parent.name
    if package is None and (file.parent.parent / ROSBUILD_MANIFEST).is_file():
        name = file.parent.parent.name
    type_name = f"{name}/{kind}/{file.stem}"
    is_ros1 = _is_ros1(file) if is_ros1 is None else is_ros1
    known = _TrustedMessages(name, file.parent.parent / "msg")
    parts = list_structures(parse_source(read_source(file), type_name, known, is_ros1=is_ros1))
    return dict(zip(_PART_PREFIXES[len(parts)], parts, strict=True))


class _TrustedMessages(TrustedMessages):
    """Messages of which only the own ones with lower-case names are looked up.

    Otherwise, a misspelled primitive type would be accepted as a message of the package.

    Args:
        package: the name of the package.
        folder: the folder with its messages.
    """

    def __init__(self, package: str, folder: Path) -> None:
        self._package = package
        self._folder = folder

    def has_message(self, type_name: str) -> bool:
        """Return whether a message exists, or may exist in another package."""
        package, _, name = type_name.split("/")
        return package != self._package or is_interface_name(name) or (self._folder / f"{name}.msg").is_file()


def _find_renamed_structures(old: Mapping[str, Structure], new: Mapping[str, Structure]) -> dict[str, str]:
    """Return the old names of renamed structures by new name. Their contents are equal."""
    renamed: dict[str, str] = {}
    removed = [name for name in old if name not in new and (old[name].fields or _is_enumeration(old[name]))]
    for name in [name for name in new if name not in old]:
        matching = [old_name for old_name in removed if old[old_name][1:] == new[name][1:]]
        if len(matching) == 1 and matching[0] not in renamed.values():
            renamed[name] = matching[0]
    return renamed


def _is_enumeration(structure: Structure) -> bool:
    return not structure.fields and any(constant.type == ENUMERATION for constant in structure.constants)


def _make_use_reason() -> Phrase:
    return phrase("programs that use the type do not build or start")


def _is_ros1(file: Path) -> bool:
    """Return whether the package of an interface is a ROS 1 package."""
    package = enclosing_package(file.parent)
    if package is None:
        return (file.parent.parent / ROSBUILD_MANIFEST).is_file()
    return Manifest(read_document(str(package[1] / MANIFEST))).is_ros1


class _Locations:
    """The locations of the names in a structure of a definition.

    Args:
        pair: both versions of the file.
        index: the index of the structure, such as 0 for the request and 1 for the response.
        name: the name of the structure.
    """

    def __init__(self, pair: FilePair, index: int, name: str) -> None:
        self._pair = pair
        self._old, self._new = (_read_numbered_lines(file, index, name) for file in (pair.old_file, pair.new_file))

    @property
    def new_start(self) -> Location:
        """The location of the structure in the new version."""
        return Location(self._pair.new_path, self._new[0][0] if self._new else 1, 1)

    @property
    def old_start(self) -> Location:
        """The location of the structure in the old version."""
        return Location(self._pair.old_path, self._old[0][0] if self._old else 1, 1, is_old=True)

    def find(self, name: str, *, is_old: bool = False) -> Location:
        """Return the location of a field or constant."""
        path, lines = (self._pair.old_path, self._old) if is_old else (self._pair.new_path, self._new)
        start = r".*\s" if path.endswith(_IDL) else r"\s*[^#\s]\S*\s+"
        pattern = re.compile(rf"{start}({re.escape(name)})\b")
        for number, line in lines:
            match = pattern.match(line)
            if match is not None:
                return Location(path, number, match.start(1) + 1, is_old)
        return Location(path, 1, 1, is_old)


def _read_numbered_lines(file: Path, index: int, name: str) -> list[tuple[int, str]]:
    """Return the numbered lines of a structure.

    For IDL, these are all lines from the start of the structure to the end of the file.
    """
    lines = list(enumerate(read_source(file).text.splitlines(), 1))
    if file.suffix == _IDL:
        head = re.compile(rf"\s*(?:struct|enum|union)\s+{re.split('/|::', name)[-1]}\b")
        first = next((line for line, text in lines if head.match(text)), 1)
        return lines[first - 1 :]
    ends = [number for number, line in lines if line.strip() == _SEPARATOR]
    start, end = ([0, *ends][index], [*ends, len(lines) + 1][index]) if index <= len(ends) else (0, 0)
    return lines[start : end - 1]


def _compare_fields(
    pair: FilePair,
    old: Sequence[Field],
    new: Sequence[Field],
    part: str,
    locations: _Locations,
    packages: Sequence[str],
) -> None:
    """Report the changes to the fields of a structure.

    Args:
        pair: both versions of the file.
        old: the fields in the old version.
        new: the fields in the new version.
        part: the prefix of the names of the fields.
        locations: the locations of the fields.
        packages: the packages of the interface in both versions.
    """
    reason = _make_exchange_reason()
    renamed = find_renamed_fields(old, new)
    for old_field, new_field in renamed:
        text = phrase("field '{old}' renamed to '{new}'", old=part + old_field.name, new=part + new_field.name)
        pair.add(text, locations.find(new_field.name), reason)
    names = {field.name for fields in renamed for field in fields}
    old_fields, new_fields = ({field.name: field for field in items if field.name not in names} for items in (old, new))
    listed = _list_fields(pair, old_fields, new_fields, part, locations)
    for name in dict.fromkeys([*new_fields, *old_fields]):
        before, after = old_fields.get(name), new_fields.get(name)
        if name in listed:
            continue
        if before is None and after is not None:
            type_name = _format_type(after, is_ros1=_is_ros1(pair.new_file))
            text = phrase("field '{name}' of type {type} added", name=part + name, type=type_name)
            pair.add(text, locations.find(name), reason)
        elif after is None:
            text = phrase("field '{name}' removed", name=part + name)
            pair.add(text, locations.find(name, is_old=True), reason)
        elif before is not None and not _have_same_type(before, after, packages):
            text = phrase(
                "field '{name}': {old} -> {new}",
                name=part + name,
                old=before.type.to_msg_text(),
                new=after.type.to_msg_text(),
            )
            pair.add(text, locations.find(name), reason)
        elif before is not None and before.default != after.default:
            text = phrase(
                "default of field '{name}': {old} -> {new}",
                name=part + name,
                old=str(before.default),
                new=str(after.default),
            )
            pair.add(text, locations.find(name))
    common = [name for name in new_fields if name in old_fields]
    if common != [name for name in old_fields if name in new_fields]:
        pair.add(phrase("order of the fields changed"), locations.find(common[0]), reason)
    for name, replaced, successor in _find_new_meanings(old_fields, new_fields, packages):
        text = phrase(
            "field '{name}' is in the place of '{old}' now, and '{new}' in its old place: it may have another meaning",
            name=part + name,
            old=replaced,
            new=successor,
        )
        pair.add(text, locations.find(name))


def _find_new_meanings(
    old: Mapping[str, Field], new: Mapping[str, Field], packages: Sequence[str]
) -> Iterator[tuple[str, str, str]]:
    """Yield the fields that take the place of a removed one while an added one takes theirs: three names each.

    Both names may only have moved to other values, if all types are equal.
    """
    if len(old) != len(new):
        return
    for name, (old_name, field), (new_name, new_field) in _pair_places(old, new):
        is_shifted = old_name not in new and new_name not in old
        types = (old[name], new[name]), (field, new[name]), (old[name], new_field)
        if is_shifted and all(_have_same_type(*pair, packages) for pair in types):
            yield name, old_name, new_name


def _pair_places(
    old: Mapping[str, Field], new: Mapping[str, Field]
) -> Iterator[tuple[str, tuple[str, Field], tuple[str, Field]]]:
    """Yield each common field, with the old field in its new place and the new field in its old place."""
    before, after = list(old.items()), list(new.items())
    for name in new:
        if name in old:
            yield name, before[list(new).index(name)], after[list(old).index(name)]


def _have_same_type(old: Field, new: Field, packages: Sequence[str]) -> bool:
    """Return whether two fields have the same type, which may be of the package of the interface in each version."""
    texts = old.type.to_msg_text(), new.type.to_msg_text()
    is_moved = len(set(packages)) > 1 and texts[0].startswith(f"{packages[0]}/")
    return old.type == new.type or (is_moved and texts[0].replace(packages[0], packages[1], 1) == texts[1])


def _list_fields(
    pair: FilePair, old: Mapping[str, Field], new: Mapping[str, Field], part: str, locations: _Locations
) -> set[str]:
    """Report added and removed fields in one line if they are several, and return their names."""
    added, removed = ([name for name in own if name not in other] for own, other in ((new, old), (old, new)))
    if max(len(added), len(removed)) < _MIN_LISTED:
        return set()
    items = [
        joined_first([f"{_format_type(own[name], is_ros1=_is_ros1(file))} {part}{name}" for name in names], MAX_NAMES)
        for own, names, file in ((new, added, pair.new_file), (old, removed, pair.old_file))
    ]
    text = phrase("fields removed: {old}; added: {new}", old=items[1], new=items[0])
    if not removed:
        text = phrase("fields added: {names}", names=items[0])
    elif not added:
        text = phrase("fields removed: {names}", names=items[1])
    pair.add(text, locations.find((added or removed)[0], is_old=not added), _make_exchange_reason())
    return {*added, *removed}


def _make_exchange_reason() -> Phrase:
    return phrase("nodes that were built with the old type do not exchange messages with new ones")


def _make_constant_reason() -> Phrase:
    return phrase("programs that use the constant do not build or start")


def _make_constants_reason(file: Path) -> Phrase:
    """Return the reason why other constants of a type are breaking; its hash in ROS 2 leaves them out (REP 2016)."""
    package = enclosing_package(file.parent)
    if package is not None and len(Manifest(read_document(str(package[1] / MANIFEST))).ros_versions) > 1:
        return _make_ros1_exchange_reason()
    return _make_exchange_reason()


def _make_ros1_exchange_reason() -> Phrase:
    return phrase("in ROS 1, nodes that were built with the old type do not exchange messages with new ones")


def _compare_constants(
    pair: FilePair, old: Sequence[Constant], new: Sequence[Constant], part: str, locations: _Locations, *, is_ros1: bool
) -> None:
    renamed = find_renamed_constants(old, new)
    for old_constant, new_constant in renamed:
        names = {"old": part + old_constant.name, "new": part + new_constant.name}
        text = phrase("constant '{old}' renamed to '{new}'", **names)
        pair.add(
            text, locations.find(new_constant.name), phrase("programs that use the constant do not build or start")
        )
    renamed_names = {constant.name for constants in renamed for constant in constants}
    old_values, new_values = (
        {constant.name: constant.value for constant in constants if constant.name not in renamed_names}
        for constants in (old, new)
    )
    added = {part + name: str(value) for name, value in new_values.items() if name not in old_values}
    texts = [phrase("constant '{name}' = {value} added", name=name, value=value) for name, value in added.items()]
    if len(texts) >= _MIN_LISTED:
        shown = joined_first([f"{name} = {value}" for name, value in added.items()], MAX_NAMES)
        texts = [phrase("constants added: {constants}", constants=shown)]
    first = next(iter(added), part).removeprefix(part)
    for text in texts:
        pair.add(text, locations.find(first), _make_constants_reason(pair.new_file) if is_ros1 else None)
    removed = [part + name for name in old_values if name not in new_values]
    texts = [phrase("constant '{name}' removed", name=name) for name in removed]
    reason = _make_constant_reason()
    if len(texts) >= _MIN_LISTED:
        texts = [phrase("constants removed: {constants}", constants=joined_first(removed, MAX_NAMES))]
        reason = phrase("programs that use the constants do not build or start")
    for text in texts:
        pair.add(text, locations.find(removed[0].removeprefix(part), is_old=True), reason)
    changes = [
        (name, str(old_values[name]), str(value))
        for name, value in new_values.items()
        if name in old_values and old_values[name] != value
    ]
    reason = phrase("programs that were built with the old value send or expect another one")
    if len(changes) < _MIN_RENUMBERED:
        for name, before, after in changes:
            text = phrase("constant '{name}': {old} -> {new}", name=part + name, old=before, new=after)
            pair.add(text, locations.find(name), reason)
        return
    items = ", ".join(f"{part}{name} {before} -> {after}" for name, before, after in changes)
    text = phrase("{count} constants have other values: {changes}", count=len(changes), changes=items)
    pair.add(text, locations.find(changes[0][0]), reason)
