"""The comparison of YAML files: parameters of nodes and controllers, and settings that launch files read."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from linkwright.diagnostics import Phrase, counted, phrase
from linkwright.review.changes import Location
from linkwright.review.file_pair import FilePair, LimitError
from linkwright.review.files.bridges import compare_bridges, read_bridges
from linkwright.review.files.parameter_names import NameRules, renamed_parts
from linkwright.review.files.yaml_values import YamlValue, read_yaml_values
from linkwright.review.list_changes import change_text

_MAX_BYTES = 4 << 20


def compare_parameter_files(pair: FilePair) -> None:
    """Compare two versions of a YAML file, value by value."""
    texts = pair.read(_read)
    if texts is None:
        return
    bridges = pair.read(lambda file: read_bridges(texts[file == pair.new_file]) or [])
    if bridges is None:
        return
    if all(bridges):
        compare_bridges(pair, *bridges)
        return
    values = pair.read(lambda file: read_yaml_values(texts[file == pair.new_file]))
    if values is None:
        return
    new = values[1]
    old = _with_new_names(pair, *values)
    rules = NameRules(old, new)
    for name, value in new.items():
        old_value = old.get(name)
        if old_value is not None and not _are_equal(old_value.text, value.text):
            location = Location(pair.new_path, value.line, value.column)
            change = change_text(name, old_value.text, value.text)
            pair.add(change, location, rules.change_reason(name, old_value.text, value.text))
    for name, values_below in _lone_parts(new, old):
        location = Location(pair.new_path, values_below[0].line, values_below[0].column)
        pair.add(_lone_text(name, values_below, is_added=True), location)
    for name, values_below in _lone_parts(old, new):
        location = Location(pair.old_path, values_below[0].line, values_below[0].column, is_old=True)
        below = [(each, old[each].text) for each in old if each not in new and _is_below(each, name)]
        reasons = (rules.removal_reason(parameter, value) for parameter, value in below)
        reason = next((reason for reason in reasons if reason is not None), None)
        pair.add(_lone_text(name, values_below, is_added=False), location, reason)


def _lone_parts(
    values: Mapping[str, YamlValue], others: Mapping[str, YamlValue]
) -> Iterator[tuple[str, list[YamlValue]]]:
    """Yield the parts of a file that another version does not have, as large as possible, with their values."""
    other_parts = {part for name in others for part in _parts(name)}
    parts: dict[str, list[tuple[str, YamlValue]]] = {}
    for name, value in values.items():
        if name not in others:
            part = next((part for part in _parts(name) if part not in other_parts), name)
            parts.setdefault(part, []).append((name, value))
    for part, named_values in parts.items():
        yield named_values[0][0] if len(named_values) == 1 else part, [value for _, value in named_values]


def _parts(name: str) -> list[str]:
    """Return the paths of the mappings that contain a value, the outermost first, and the path of the value."""
    words = name.split(".")
    return [".".join(words[: count + 1]) for count in range(len(words))]


def _is_below(name: str, part: str) -> bool:
    return name == part or name.startswith(f"{part}.")


def _lone_text(name: str, values: Sequence[YamlValue], *, is_added: bool) -> Phrase:
    if len(values) > 1:
        part = counted("{parameter} with {count} value", "{parameter} with {count} values", len(values), parameter=name)
    else:
        part = phrase("{parameter} {value}", parameter=name, value=values[0].text)
    return phrase("{part} added", part=part) if is_added else phrase("{part} removed", part=part)


def _with_new_names(
    pair: FilePair, old: Mapping[str, YamlValue], new: Mapping[str, YamlValue]
) -> Mapping[str, YamlValue]:
    """Add the renamed parts of a file, and return the old values with the new names of these parts."""
    for old_part, new_part in renamed_parts(old, new).items():
        inside = next(value for name, value in new.items() if _is_below(name, new_part))
        text = phrase("{old} renamed to {name}", old=old_part, name=new_part)
        pair.add(text, Location(pair.new_path, inside.line, inside.column))
        old = {
            f"{new_part}{name.removeprefix(old_part)}" if _is_below(name, old_part) else name: value
            for name, value in old.items()
        }
    return old


def _read(file: Path) -> str:
    if file.stat().st_size > _MAX_BYTES:
        raise LimitError(phrase("it is larger than {megabytes} MB", megabytes=_MAX_BYTES >> 20))
    return file.read_text(encoding="utf-8")


def _are_equal(old: str, new: str) -> bool:
    """Return whether two values are equal as texts or as numbers: ``0`` and ``0.000`` are."""
    if old == new:
        return True
    try:
        return [float(word) for word in old.strip("[]").split(", ")] == [
            float(word) for word in new.strip("[]").split(", ")
        ]
    except ValueError:
        return False
