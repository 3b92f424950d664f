"""Compare robots and worlds of MuJoCo (MJCF), element by element, as the files are written."""

from __future__ import annotations

import posixpath
import re
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import zip_longest
from pathlib import Path, PurePosixPath

from linkwright.diagnostics import LinkwrightError, Phrase, joined, joined_first, phrase, quoted
from linkwright.review.breaking import name_reason
from linkwright.review.file_pair import FilePair
from linkwright.review.lenient_xml import read_lenient_root
from linkwright.review.texts.list_changes import change_text
from linkwright.review.versions import Version
from linkwright.xmltree import Element

_MARK = re.compile(rb"<mujoco\b")
_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
_MAX_BYTES = 1 << 24
_WORLD, _BODY, _DEFAULT, _INCLUDE = "worldbody", "body", "default", "include"
_OWNERS = (_BODY, _DEFAULT, "tendon")
"""The kinds of elements with which a line names the elements in them that have no name."""
_SECTIONS = frozenset({"actuator", "sensor", "equality", "tendon"})
"""The sections whose elements share one space of names. Their tags are types."""
_TYPES = {"freejoint": ("joint", "free")}
"""The kinds and types of elements whose tag is a short form."""
_FILES = frozenset({"mesh", "hfield", "skin", _INCLUDE})
"""The tags of elements that a file gives a name."""
_CALLED = frozenset({_BODY, "joint", "site", "camera", "actuator", "sensor", "key"})
"""The kinds of elements that programs look up by name."""
_SHOWN = (_BODY, "joint", "actuator", "sensor")
"""The kinds of elements whose names summarize an added file."""
_TYPE, _PARENT = "type", "parent"
_MAX_VALUES = 8
"""The maximum number of values of an added element in a line."""


@dataclass(frozen=True)
class _Item:
    """An element of a file.

    Attributes:
        kind: the kind of element, such as ``joint``.
        name: its name; empty without one.
        owner: the body, default class or tendon that contains it, such as ``body 'arm'``; empty outside of them.
        values: its other attributes, and its type where that is the tag.
        element: the element.
    """

    kind: str
    name: str
    owner: str
    values: Mapping[str, str]
    element: Element

    @property
    def label(self) -> Phrase | str:
        """The words for the element in a line."""
        if self.name:
            return f"{self.kind} '{self.name}'"
        return phrase("{part} in {owner}", part=self.kind, owner=self.owner) if self.owner else self.kind

    @property
    def content(self) -> tuple[object, ...]:
        """Everything but the name, to be compared. Numbers are equal however they are written."""
        values = ((key, _parse_value(value)) for key, value in sorted(self.values.items()))
        return self.kind, self.owner, *values


def is_mujoco_file(file: Path) -> bool:
    """Return whether a file is a robot or world of MuJoCo, or a part of one."""
    try:
        if file.suffix.lower() != ".xml" or file.stat().st_size > _MAX_BYTES:
            return False
        with file.open("rb") as opened:
            return _MARK.search(opened.read(4096)) is not None
    except OSError:
        return False


def compare_mujoco_files(pair: FilePair) -> None:
    """Compare two versions of a robot or world of MuJoCo.

    Included files and the values of default classes are not put in, but a name that moves into an included file is not
    lost. Elements without a name are paired with those of the same kind in the same body.
    """
    versions = pair.read(_read)
    if versions is None:
        return
    old_items, new_items = versions
    renamed = _find_renamed(old_items, new_items)
    owners = {f"{kind} '{old}'": f"{kind} '{new}'" for (kind, old), new in renamed.items()}
    old_items = [replace(item, owner=owners.get(item.owner, item.owner)) for item in old_items]
    for (kind, old_name), name in renamed.items():
        item = next(item for item in new_items if (item.kind, item.name) == (kind, name))
        text = phrase("{element} renamed to '{new}'", element=f"{kind} '{old_name}'", new=name)
        pair.add(text, pair.location(item.element.span()), name_reason(old_name) if kind in _CALLED else None)
    bodies = [{f"{_BODY} '{item.name}'" for item in items if item.kind == _BODY} for items in (old_items, new_items)]
    included = {(item.kind, item.name) for item in _read_included(pair.versions.new, pair.new_path, new_items, set())}
    reported = (bodies[0] ^ bodies[1]) - set(owners.values())
    for old, new in _match(old_items, new_items, renamed):
        if old is not None and new is not None:
            pair.add(_describe_change(old, new), pair.location(new.element.span()))
        elif new is not None and (new.name or new.owner not in reported):
            pair.add(_describe_added(new), pair.location(new.element.span()))
        elif old is not None and (old.name or old.owner not in reported):
            is_lost = old.name and old.kind in _CALLED and (old.kind, old.name) not in included
            reason = name_reason(old.name) if is_lost else None
            text = phrase("{part} removed", part=old.label)
            pair.add(text, pair.location(old.element.span(), is_old=True), reason)


def mujoco_contents(version: Version, path: str) -> Phrase | None:
    """Return the names of the bodies, joints, actuators and sensors of a file, or None if there are none."""
    items = _read(version.file(path))
    texts = []
    for kind in _SHOWN:
        names = [item.name for item in items if item.kind == kind and item.name]
        if names:
            texts.append(f"{kind} {joined_first(map(quoted, names), _MAX_VALUES)}")
    return joined(texts, "; ") if texts else None


def _read(file: Path) -> list[_Item]:
    """Return the elements of a file in the order of the file.

    Raises:
        LinkwrightError: the file is not XML.
    """
    return list(_list_items(read_lenient_root(file), "", ""))


def _read_included(version: Version, path: str, items: Iterable[_Item], seen: set[str]) -> Iterator[_Item]:
    """Yield the elements of the files that a file includes, directly or not. Unreadable files have none.

    Args:
        version: the version that contains the file.
        path: the path of the file relative to the root of the repository.
        items: the elements of the file.
        seen: the paths that were read already, which are extended.
    """
    for item in items:
        file = posixpath.normpath(posixpath.join(posixpath.dirname(path), item.name))
        if (
            item.kind != _INCLUDE
            or file in seen
            or file.startswith(("..", "/"))
            or not is_mujoco_file(version.file(file))
        ):
            continue
        seen.add(file)
        try:
            included = _read(version.file(file))
        except (LinkwrightError, OSError, ValueError, RecursionError):
            continue
        yield from included
        yield from _read_included(version, file, included, seen)


def _list_items(element: Element, section: str, owner: str) -> Iterator[_Item]:
    for child in element.elements():
        kind, child_type = _TYPES.get(child.tag, (child.tag, ""))
        if section in _SECTIONS:
            kind, child_type = section, child.tag
        values = dict(child.attributes)
        name = values.pop("name", "")
        if child.tag == _DEFAULT:
            name = values.pop("class", "main")
        if child.tag in _FILES and not name:
            name = values.pop("file", "") if child.tag == _INCLUDE else PurePosixPath(values.get("file", "")).stem
        if child_type:
            values = {_TYPE: child_type, **values}
        if child.tag != _DEFAULT and (name or values or owner):
            yield _Item(kind, name, owner, values, child)
        if child.tag == _WORLD:
            yield from _list_items(child, "", _WORLD)
        else:
            is_section = not owner and child.tag in _SECTIONS
            child_owner = f"{kind} '{name}'" if kind in _OWNERS and name else owner
            yield from _list_items(child, child.tag if is_section else "", child_owner)


def _parse_value(value: str) -> tuple[float | str, ...]:
    """Return the words of a value, with numbers as numbers."""
    return tuple(float(word) if _NUMBER.fullmatch(word) else word for word in value.split())


def _find_renamed(old_items: Iterable[_Item], new_items: Iterable[_Item]) -> dict[tuple[str, str], str]:
    """Return the new names of the elements that only got another name, by kind and old name."""
    old_names = {(item.kind, item.name) for item in old_items}
    new_names = {(item.kind, item.name) for item in new_items}
    removed, added = _group_by_content(old_items, new_names), _group_by_content(new_items, old_names)
    return {
        (items[0].kind, items[0].name): added[content][0].name
        for content, items in removed.items()
        if len(items) == 1 and len(added.get(content, ())) == 1
    }


def _group_by_content(
    items: Iterable[_Item], other_names: set[tuple[str, str]]
) -> dict[tuple[object, ...], list[_Item]]:
    groups: dict[tuple[object, ...], list[_Item]] = defaultdict(list)
    for item in items:
        if item.name and item.values and (item.kind, item.name) not in other_names:
            groups[item.content].append(item)
    return groups


def _match(
    old_items: Iterable[_Item], new_items: Iterable[_Item], renamed: Mapping[tuple[str, str], str]
) -> Iterator[tuple[_Item | None, _Item | None]]:
    """Yield both versions of each element that differs; None for the version that lacks it.

    Of several elements with one key, which have no name, those without an equal one are paired in their order.
    """
    groups: dict[tuple[str, ...], tuple[list[_Item], list[_Item]]] = defaultdict(lambda: ([], []))
    for item in new_items:
        groups[_key(item, item.name)][1].append(item)
    for item in old_items:
        groups[_key(item, renamed.get((item.kind, item.name), item.name))][0].append(item)
    for old, new in groups.values():
        common = Counter(item.content for item in old) & Counter(item.content for item in new)
        yield from zip_longest(_drop_common(old, common), _drop_common(new, common))


def _drop_common(items: Iterable[_Item], common: Counter[tuple[object, ...]]) -> list[_Item]:
    """Return the elements without those that have an equal counterpart in the other version."""
    left = Counter(common)
    rest = []
    for item in items:
        if left[item.content]:
            left[item.content] -= 1
        else:
            rest.append(item)
    return rest


def _key(item: _Item, name: str) -> tuple[str, ...]:
    return (item.kind, name) if name else (item.kind, "", item.owner)


def _describe_added(item: _Item) -> Phrase:
    """Return an added element with its first values in one line."""
    text = phrase("{part} added", part=item.label)
    values = [f"{key} {value}" for key, value in item.values.items()]
    return phrase("{change}: {items}", change=text, items=joined_first(values, _MAX_VALUES)) if values else text


def _describe_change(old: _Item, new: _Item) -> Phrase:
    """Return the changed values of an element in one line."""
    olds, news = ({_PARENT: item.owner, **item.values} for item in (old, new))
    changes = []
    for key in dict.fromkeys([*news, *olds]):
        before, after = olds.get(key, ""), news.get(key, "")
        if _parse_value(before) == _parse_value(after):
            continue
        if before and after:
            changes.append(change_text(key, before, after))
        else:
            part = f"{key} {after or before}"
            changes.append(phrase("{part} added", part=part) if after else phrase("{part} removed", part=part))
    return phrase("{parameter}: {changes}", parameter=new.label, changes=joined(changes))
