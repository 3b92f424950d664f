"""Find out who in the repository has the other end of a topic, service or action that a source loses or renames."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import PurePosixPath
from typing import NamedTuple

from linkwright.diagnostics import Phrase, Span, phrase
from linkwright.review.caching import cached_in_review
from linkwright.review.file_pair import UnreadableFileError
from linkwright.review.files.parameters.names import read_controller_classes
from linkwright.review.files.parameters.yaml_values import read_yaml_values
from linkwright.review.launch_paths import find_launch_files
from linkwright.review.sources.changed_sources import COMMUNICATION_KINDS, ChangedSources
from linkwright.review.sources.default_names import is_set_in_repository
from linkwright.review.sources.names import CPP_SUFFIXES, PYTHON_SUFFIX, NameKind, SourceName, SourceNames
from linkwright.review.sources.parameter_defaults import SUM
from linkwright.review.sources.unchanged_sources import get_counterpart, make_user_reason
from linkwright.review.texts.comments import without_comments
from linkwright.review.versions import TEST_FOLDERS, Version, Versions

_OFFERED_KINDS = (NameKind.PUBLISHER, NameKind.SERVICE, NameKind.ACTION)
_SETTING_SUFFIXES = (".yaml", ".yml")
_NAMING_SUFFIXES = (
    *(*CPP_SUFFIXES, PYTHON_SUFFIX, ".launch", ".xml", *_SETTING_SUFFIXES, ".json", ".toml", ".ini", ".sh"),
    *(".xacro", ".urdf", ".sdf", ".world", ".lua"),
)
"""The ends of the names of files that can give a topic, service or action its name."""
_IMPLIED = re.compile(
    r"compressed\w*|theora|ffmpeg|zstd|draco|cloudini|\w*_parameters?(?:_types|_atomically)?|change_state|get_state"
)
"""The last parts of names that nodes and plugins add by themselves."""
_NAMESPACE = re.compile(r"Push\w*Namespace|push[-_]\w+[-_]namespace|__ns\b|\b(?:ns|namespace)\s*=\s*(?![\"']{2})")
_NAME = re.compile(r"[~/]*\w+(?:/\w+)*")


class OtherEnd(NamedTuple):
    """A source with the other end of a topic, service or action.

    Attributes:
        path: the path of the source.
        controller: the name under which a controller manager loads its class; empty for other sources.
        file: the parameter file with the name of the controller.
    """

    path: str
    controller: str = ""
    file: str = ""


def find_left_reason(
    items: Sequence[SourceName], old: ChangedSources | None, new: ChangedSources, path: str
) -> Phrase | None:
    """Return the reason why a lost name breaks a source of the repository that still has its other end, or None.

    Args:
        items: the lost names, all of the same kind.
        old: the changed sources of the old version; if given, the other source must have had the name there, too.
        new: the changed sources of the new version.
        path: the path of the source that loses them.
    """
    for item in items:
        end = _find_end(item, old, new, path)
        if end is not None:
            reason = make_user_reason(item.kind, end.path, item.name)
            if not end.controller:
                return reason
            values = {"reason": reason, "controller": end.controller, "file": PurePosixPath(end.file).name}
            return phrase("{reason} as controller '{controller}' of '{file}'", **values)
    return None


def describe_new_end(
    reason: Phrase | None,
    old_item: SourceName,
    item: SourceName,
    old: ChangedSources,
    new: ChangedSources,
    path: str,
) -> Phrase | None:
    """Return the reason why a new name is breaking, with the source that has the other end of the new name.

    Args:
        reason: the reason without it; None if the name is not breaking.
        old_item: the old name. If a source still has its other end, the result tells that none has that of the new one.
        item: the new name.
        old: the changed sources of the old version.
        new: the changed sources of the new version.
        path: the path of the source with the name.
    """
    if reason is None or item.kind not in COMMUNICATION_KINDS or not _NAME.fullmatch(item.name):
        return reason
    end = _find_certain_end(item, None, new, path)
    if end is not None:
        return _add(reason, item, PurePosixPath(end.path).name)
    is_left = _find_end(old_item, old, new, path) is not None
    return _add(reason, item, None) if is_left and _is_made_nowhere(item.name, new.version, path) else reason


def find_given_reason(reason: Phrase, kind: NameKind, names: tuple[str, str], versions: Versions, path: str) -> Phrase:
    """Return the reason why another name that a file gives to a program is breaking, with the sources at its other end.

    Args:
        reason: the reason without them.
        kind: the kind of the name.
        names: the old and the new name.
        versions: both versions.
        path: the path of the file.
    """
    old, new = (SourceName(kind, name, "", Span(path, 1, 1, 1, 1)) for name in names)
    sides = _open_sources(versions.old), _open_sources(versions.new)
    return describe_new_end(find_left_reason([old], *sides, path) or reason, old, new, *sides, path) or reason


@cached_in_review(maxsize=4)
def _open_sources(version: Version) -> ChangedSources:
    return ChangedSources(version, ())


def is_served(item: SourceName, new: ChangedSources, path: str) -> bool:
    """Return whether a source of the repository serves the service or action of a client."""
    return new.has_counterpart(item) or _find_end(item, None, new, path) is not None


def _add(reason: Phrase, item: SourceName, file: str | None) -> Phrase:
    """Return a reason with the file that has the other end of a new name, or with the fact that none has it."""
    values = {"reason": reason, "name": item.name}
    if file is None:
        if item.kind is NameKind.PUBLISHER:
            return phrase("{reason}; nothing in the repository subscribes to '{name}'", **values)
        if item.kind is NameKind.SUBSCRIPTION:
            return phrase("{reason}; nothing in the repository publishes '{name}'", **values)
        if item.kind in _OFFERED_KINDS:
            return phrase("{reason}; nothing in the repository calls '{name}'", **values)
        return phrase("{reason}; nothing in the repository serves '{name}'", **values)
    if item.kind is NameKind.PUBLISHER:
        return phrase("{reason}; '{file}' subscribes to '{name}'", **values, file=file)
    if item.kind is NameKind.SUBSCRIPTION:
        return phrase("{reason}; '{file}' publishes '{name}'", **values, file=file)
    if item.kind in _OFFERED_KINDS:
        return phrase("{reason}; '{file}' calls '{name}'", **values, file=file)
    return phrase("{reason}; '{file}' serves '{name}'", **values, file=file)


def _find_end(item: SourceName, old: ChangedSources | None, new: ChangedSources, path: str) -> OtherEnd | None:
    """Return the source of the repository with the other end of a name, or None if it is unknown.

    In the same package, namespaces and types are ignored.

    Args:
        item: the name.
        old: the changed sources of the old version, for a name that the new version lost; else None.
        new: the changed sources of the new version.
        path: the path of the source with the name.
    """
    user = new.find_user(item, path, old)
    return _find_certain_end(item, old, new, path) if user is None else OtherEnd(user)


def _find_certain_end(item: SourceName, old: ChangedSources | None, new: ChangedSources, path: str) -> OtherEnd | None:
    """Return the source of any package that certainly has the other end of a name, or None; see `_find_end`.

    The types must be equal, or the name has several parts.
    """
    kind = get_counterpart(item.kind)
    if kind is None or not _NAME.fullmatch(item.name):
        return None
    is_moved = old is not None and item.kind in _OFFERED_KINDS and any(_list_ends(item, item.kind, new, path))
    for end, other in () if is_moved else _list_ends(item, kind, new, path):
        before = None if old is None else old.find_names(end.path)
        is_new = before is not None and all(known.name != other.name for known in _list_names(before, kind))
        if not is_new and not _is_remapped(new.version, {item.name, other.name}):
            return end
    return None


def _list_ends(
    item: SourceName, kind: NameKind, sources: ChangedSources, path: str
) -> Iterator[tuple[OtherEnd, SourceName]]:
    """Yield the sources that have the same topic, service or action under a kind of name, each with the name there."""
    own = {name for name, _, _ in _list_full_names(item, sources.get_names(path), sources.version)}
    last = item.name.rpartition("/")[2].lstrip("~")
    for other_path, names in sources.list_all_sources(f'{last}"', f"{last}'"):
        for other in _list_names(names, kind, sources.version) if other_path != path else ():
            is_typed = bool(item.type and other.type)
            if is_typed and not item.has_type_of(other):
                continue
            for name, controller, file in _list_full_names(other, names, sources.version):
                is_full = item.name.startswith(("/", "~")) and other.name.startswith(("/", "~"))
                if name in own and (is_typed or "/" in name) and (is_full or not _has_namespaces(sources.version)):
                    yield OtherEnd(other_path, controller, file), other


def _list_names(names: SourceNames, kind: NameKind, version: Version | None = None) -> Iterator[SourceName]:
    """Yield the literal names of a kind, and those that a parameter gives by default.

    With a version, no file of it may set the parameter.
    """
    yield from names.of_kind(kind)
    for item in names.expressions:
        default = names.find_default(item) if item.kind is kind else None
        if default is None or SUM in default.parameter:
            continue
        if version is None or not is_set_in_repository(version, default.parameter):
            yield replace(item, name=default.name)


def _list_full_names(item: SourceName, names: SourceNames, version: Version) -> Iterator[tuple[str, str, str]]:
    """Yield the full names that a name may have, without a slash at their start and without namespaces of nodes.

    A private name gets that of its node, or those under which a controller manager loads its class. Each comes with
    the controller and the parameter file. A relative name of a plugin is unknown.
    """
    classes = {known.name.replace("::", "/") for known in names.of_kind(NameKind.PLUGINLIB_CLASS)}
    if not item.name.startswith("~"):
        if item.name.startswith("/") or not classes:
            yield item.name.lstrip("/"), "", ""
        return
    name = item.name.lstrip("~/")
    for class_name in sorted(classes):
        for controller, file in _read_controllers(version).get(class_name, ()):
            yield f"{controller}/{name}", controller, file
    nodes = {known.name.strip("/") for known in names.of_kind(NameKind.NODE)}
    if len(nodes) == 1 and not classes and _keeps_name(version, *nodes):
        yield f"{min(nodes)}/{name}", "", ""


@cached_in_review(maxsize=4)
def _read_controllers(version: Version) -> dict[str, list[tuple[str, str]]]:
    """Return the names that controller managers give to each class, with their parameter files, by the class."""
    controllers: dict[str, list[tuple[str, str]]] = {}
    for path in version.paths(_SETTING_SUFFIXES):
        text = version.text(path) if TEST_FOLDERS.isdisjoint(PurePosixPath(path).parts) else ""
        if "controller_manager" not in text:
            continue
        try:
            found = read_controller_classes(read_yaml_values(text))
        except UnreadableFileError:
            continue
        for name, class_name in found.items():
            controllers.setdefault(class_name.replace("::", "/"), []).append((name, path))
    return controllers


def _keeps_name(version: Version, node: str) -> bool:
    """Return whether launch files certainly do not give a node another name: they name it, or name no node."""
    texts = _read_launch_texts(version)
    return not texts or any(f'"{node}"' in text or f"'{node}'" in text for text in texts)


def _has_namespaces(version: Version) -> bool:
    """Return whether a launch file may give nodes a namespace, so that equal relative names may differ."""
    return any(map(_NAMESPACE.search, _read_launch_texts(version)))


def _is_remapped(version: Version, names: set[str]) -> bool:
    """Return whether a launch file may remap one of several names."""
    for name in names:
        word = rf"[~/]*{re.escape(name.lstrip('~/'))}"
        pattern = re.compile(rf"[\"']{word}[\"']\s*[,:]|\bfrom\s*[=:]\s*[\"']?{word}(?![\w/])|(?<![\w/]){word}:=")
        if any(pattern.search(text) for text in _read_launch_texts(version)):
            return True
    return False


@cached_in_review(maxsize=4)
def _read_launch_texts(version: Version) -> tuple[str, ...]:
    return tuple(version.text(path) for path in find_launch_files(version))


def _is_made_nowhere(name: str, version: Version, path: str) -> bool:
    """Return whether no other file of a version can make a name: none has one of its parts, even split."""
    parts = name.strip("~/").split("/")
    known = [part for part in parts if part != parts[-1] or not _IMPLIED.fullmatch(part)]
    for other in version.paths(_NAMING_SUFFIXES):
        text = version.text(other) if other != path else ""
        if not any(part.partition("_")[0] in text for part in known):
            continue
        text = without_comments(text, other)
        is_source = other.endswith((*CPP_SUFFIXES, PYTHON_SUFFIX))
        known = [part for part in known if not _can_have(text, part, is_source=is_source)]
    return bool(known)


def _can_have(text: str, part: str, *, is_source: bool) -> bool:
    """Return whether a file can have a part of a name: as a word, in sources that of a literal, or split at ``_``."""
    if part.partition("_")[0] not in text:
        return False
    word = rf"(?<![^\"'/}}~]){part}(?![^\"'/{{])" if is_source else rf"\b{part}\b"
    return re.search(rf"{word}|\b{part.partition('_')[0]}_?[\"'{{%$]", text) is not None
