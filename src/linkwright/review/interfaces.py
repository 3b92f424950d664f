"""The comparison of the definitions of messages, services and actions."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from linkwright.diagnostics import phrase
from linkwright.messages.definitions.interfaces import Constant, Definition, Field, structures_of
from linkwright.messages.definitions.library import TrustedMessages, parse_source, read_source
from linkwright.packages import enclosing_package
from linkwright.review.changes import Location
from linkwright.review.file_pair import FilePair

_PARTS = {1: ("",), 2: ("request ", "response "), 3: ("goal ", "result ", "feedback ")}
"""The names of the structures of a message, a service and an action, in front of the names of fields."""


def compare_interfaces(pair: FilePair) -> None:
    """Compare two versions of the definition of a message, service or action.

    A change of a field is breaking: the type gets another hash (REP 2016), and nodes that were built with different
    versions do not exchange messages.
    """
    definitions = pair.read(_read)
    if definitions is None:
        return
    old, new = map(structures_of, definitions)
    for old_part, new_part, name in zip(old, new, _PARTS[len(new)], strict=True):
        _compare_fields(pair, old_part.fields, new_part.fields, name)
        _compare_constants(pair, old_part.constants, new_part.constants, name)


def _read(file: Path) -> Definition:
    package = enclosing_package(file.parent)
    kind = file.parent.name if file.suffix == ".idl" else file.suffix.removeprefix(".")
    type_name = f"{package[0] if package else file.parent.name}/{kind}/{file.stem}"
    return parse_source(read_source(file), type_name, TrustedMessages())


def _compare_fields(pair: FilePair, old: Sequence[Field], new: Sequence[Field], part: str) -> None:
    location = Location(pair.new_path, 1, 1)
    reason = phrase("nodes that were built with the old type do not exchange messages with new ones")
    old_fields, new_fields = ({field.name: field for field in fields} for fields in (old, new))
    for name in dict.fromkeys([*new_fields, *old_fields]):
        before, after = old_fields.get(name), new_fields.get(name)
        if before is None and after is not None:
            text = phrase("field '{name}' of type {type} added", name=part + name, type=after.type.to_msg_text())
            pair.add(text, location, reason)
        elif after is None:
            pair.add(phrase("field '{name}' removed", name=part + name), location, reason)
        elif before is not None and before.type != after.type:
            text = phrase(
                "field '{name}': {old} -> {new}",
                name=part + name,
                old=before.type.to_msg_text(),
                new=after.type.to_msg_text(),
            )
            pair.add(text, location, reason)
        elif before is not None and before.default != after.default:
            text = phrase(
                "default of field '{name}': {old} -> {new}",
                name=part + name,
                old=str(before.default),
                new=str(after.default),
            )
            pair.add(text, location)
    common = [name for name in new_fields if name in old_fields]
    if common != [name for name in old_fields if name in new_fields]:
        pair.add(phrase("order of the fields changed"), location, reason)


def _compare_constants(pair: FilePair, old: Sequence[Constant], new: Sequence[Constant], part: str) -> None:
    location = Location(pair.new_path, 1, 1)
    old_values, new_values = ({constant.name: constant.value for constant in constants} for constants in (old, new))
    for name in dict.fromkeys([*new_values, *old_values]):
        before, after = old_values.get(name), new_values.get(name)
        if name not in old_values:
            text = phrase("constant '{name}' = {value} added", name=part + name, value=str(after))
            pair.add(text, location)
        elif name not in new_values:
            reason = phrase("programs that use the constant do not build or start")
            pair.add(phrase("constant '{name}' removed", name=part + name), location, reason)
        elif before != after:
            reason = phrase("programs that were built with the old value send or expect another one")
            text = phrase("constant '{name}': {old} -> {new}", name=part + name, old=str(before), new=str(after))
            pair.add(text, location, reason)
