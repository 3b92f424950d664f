"""Find parameter files and clients that still name a node which a launch file or a source has renamed."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from pathlib import PurePosixPath

from linkwright.diagnostics import phrase
from linkwright.diagnostics.suggest import is_misspelled
from linkwright.files.git_repository import ChangedFile
from linkwright.packages.launch_files import is_launch_file_name
from linkwright.packages.manifest import package_name
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.file_pair import UnreadableFileError
from linkwright.review.files.parameters.names import find_node_name
from linkwright.review.files.parameters.yaml_values import YamlValue, read_yaml_values
from linkwright.review.launch_paths import is_launch_file
from linkwright.review.launches.outlines import Entry, LaunchOutline
from linkwright.review.launches.programs.sources import list_nodes, read_launch_files, try_read_outline
from linkwright.review.sources.changed_sources import COMMUNICATION_KINDS
from linkwright.review.sources.names import CPP_SUFFIXES, PYTHON_SUFFIX, NameKind, SourceName
from linkwright.review.sources.reading import read_source_names
from linkwright.review.sources.unchanged_sources import get_counterpart
from linkwright.review.versions import TEST_FOLDERS, Version, Versions

_SETTINGS_SUFFIXES = (".yaml", ".yml")
_SOURCE_SUFFIXES = (*CPP_SUFFIXES, PYTHON_SUFFIX)
_SHARE_PATH = re.compile(r"\$\(find(?:-pkg-share)? (?P<package>[\w-]+)\)/(?P<path>[\w./-]+\.ya?ml)(?![\w.])")
_WILDCARDS = ("*", "**")
_PRIVATE = re.compile(r"[\"']~")
_PLAIN_NAME = re.compile(r"\w+")
_MIN_LETTERS = 3
"""The minimum length of a word that can be a misspelling of another word."""
_NODE_SERVICES = frozenset(
    {
        *("set_parameters", "set_parameters_atomically", "get_parameters", "get_parameter_types", "list_parameters"),
        *("describe_parameters", "change_state", "get_state", "get_available_states", "get_available_transitions"),
        *("get_transition_graph", "get_loggers", "set_logger_level", "get_logger_levels", "set_logger_levels"),
    }
)
"""The services below its name that each node, or each lifecycle node, has."""


def find_left_nodes(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the parameter files and sources that still name a renamed node, each with a change.

    So are launch files that give a node another name than its parameter file. Only the last part of a name counts,
    without namespaces.
    """
    for file in changed_files:
        if not file.new_path or file.is_submodule or not TEST_FOLDERS.isdisjoint(PurePosixPath(file.path).parts):
            continue
        if is_launch_file(file.path):
            found = list(_find_in_launch_file(versions, file.old_path, file.new_path)) if file.old_path else []
            yield from found
            if not found:
                yield from _find_unmatched_names(versions, file.old_path, file.new_path)
        elif file.old_path and file.path.endswith(_SOURCE_SUFFIXES):
            yield from _find_in_source(versions, file.old_path, file.new_path)


def _find_in_launch_file(versions: Versions, old_path: str, new_path: str) -> Iterator[tuple[str, Change]]:
    """Yield the users of a node to which a launch file gives another name now.

    They are the parameter files that the launch file loads for it, and the sources that use its private names.
    """
    old, new = try_read_outline(versions.old, old_path), try_read_outline(versions.new, new_path)
    if old is None or new is None:
        return
    started = {_get_name(new, entry) for entry in list_nodes(new)}
    for entry in list_nodes(new):
        name = _get_name(new, entry)
        same = [other for other in list_nodes(old) if other.name == entry.name]
        old_names = {_get_name(old, other) for other in same}
        if len(same) != 1 or not _PLAIN_NAME.fullmatch(name) or not old_names.isdisjoint(started):
            continue
        for old_name in sorted(old_names):
            yield from _find_users(versions.new, old_name, name, new_path, entry.name.partition("/")[0])
        for path in _find_files(versions.new, new_path, new, entry):
            nodes = _read_nodes(versions.new, path)
            if not nodes or name in nodes or not nodes.keys().isdisjoint(_WILDCARDS):
                continue
            for old_name in sorted(old_names & nodes.keys()):
                yield path, _make_change(path, old_name, name, new_path, nodes[old_name])


def _find_unmatched_names(versions: Versions, old_path: str | None, new_path: str) -> Iterator[tuple[str, Change]]:
    """Yield a change for each node whose parameter file newly spells its name in another way.

    It is breaking if the old launch file started the program, too.
    """
    old = _read_unmatched_names(versions.old, old_path) if old_path else {}
    outline = try_read_outline(versions.old, old_path) if old_path else None
    programs = [] if outline is None else [entry.name for entry in list_nodes(outline)]
    for (name, path), (section, entry) in _read_unmatched_names(versions.new, new_path).items():
        if (name, path) not in old:
            text = phrase(
                "node '{name}' gets no parameters from '{file}', which has those of '{section}'",
                name=name,
                file=path,
                section=section,
            )
            location = Location(new_path, entry.span.line, entry.span.column)
            if entry.name not in programs:
                yield new_path, Change(text, location=location)
                continue
            reason = phrase("the node '{name}' starts without these parameters", name=name)
            yield new_path, Change(text, Effect.BREAKING, reason, location)


def _read_unmatched_names(version: Version, path: str) -> dict[tuple[str, str], tuple[str, Entry]]:
    """Return the nodes that get no parameters from their file, because it spells their name in another way.

    The result maps the name of each node and the path of the file to the name in the file, which no other node of the
    launch file has, and to the node.
    """
    outline = try_read_outline(version, path)
    if outline is None:
        return {}
    names = {_get_name(outline, entry) for entry in list_nodes(outline)}
    found: dict[tuple[str, str], tuple[str, Entry]] = {}
    for entry in list_nodes(outline) if all(map(_PLAIN_NAME.fullmatch, names)) else ():
        name = _get_name(outline, entry)
        files = {file: _read_nodes(version, file) for file in _find_files(version, path, outline, entry)}
        sections = {section for file_nodes in files.values() for section in file_nodes}
        if name in sections or not all(map(_PLAIN_NAME.fullmatch, sections)):
            continue
        for file, file_nodes in files.items():
            similar = [section for section in file_nodes if section not in names and _is_same_node(name, section)]
            if len(similar) == 1:
                found[name, file] = similar[0], entry
    return found


def _is_same_node(first: str, second: str) -> bool:
    """Return whether two names differ only by a typing error in a word, or by the word ``node`` at the end."""
    shorter, longer = sorted((first, second), key=len)
    if longer == f"{shorter}_node":
        return True
    words = list(zip(first.split("_"), second.split("_"), strict=False))
    different = [pair for pair in words if pair[0] != pair[1]]
    if first.count("_") != second.count("_") or len(different) != 1:
        return False
    word, other = different[0]
    is_long = min(len(word), len(other)) >= _MIN_LETTERS and f"{word}{other}".isalpha()
    return is_long and is_misspelled(word, [other]) and is_misspelled(other, [word])


def _find_in_source(versions: Versions, old_path: str, new_path: str) -> Iterator[tuple[str, Change]]:
    """Yield the users of a node to which a source gives another name now.

    They are the parameter files of its package, and the sources that use its private names.
    """
    names = []
    for version, path in ((versions.old, old_path), (versions.new, new_path)):
        source = read_source_names(version.file(path))
        if source.error_line:
            return
        names.append({item.name for item in source.of_kind(NameKind.NODE)})
    package = versions.new.package_of(new_path)
    if package is None or len(names[0]) != 1 or len(names[1]) != 1 or names[0] == names[1]:
        return
    (old_name,), (new_name,) = names
    if not _PLAIN_NAME.fullmatch(old_name) or _is_named(versions.new, old_name, new_name):
        return
    yield from _find_users(versions.new, old_name, new_name, new_path, package_name(versions.new.file(package)) or "")
    for path in versions.new.paths(_SETTINGS_SUFFIXES, package):
        nodes = _read_nodes(versions.new, path) if TEST_FOLDERS.isdisjoint(PurePosixPath(path).parts) else {}
        if old_name in nodes and new_name not in nodes and nodes.keys().isdisjoint(_WILDCARDS):
            yield path, _make_change(path, old_name, new_name, new_path, nodes[old_name])


def _find_users(version: Version, old: str, new: str, file: str, package: str) -> Iterator[tuple[str, Change]]:
    """Yield the sources that use a private name of a node with its old name, such as ``/lamp/set_parameters``.

    Sources that also use the new name are left out.

    Args:
        version: the new version.
        old: the old name of the node.
        new: its new name.
        file: the path of the file that gives it the new name.
        package: the name of its package, whose sources tell its private topics, services and actions.
    """
    if not _PLAIN_NAME.fullmatch(old):
        return
    private = _read_private_names(version, package)
    for path in version.paths(_SOURCE_SUFFIXES):
        is_searched = TEST_FOLDERS.isdisjoint(PurePosixPath(path).parts) and f"{old}/" in version.text(path)
        if not is_searched or is_launch_file_name(PurePosixPath(path).name):
            continue
        names = [item for item in read_source_names(version.file(path)).names if item.kind in COMMUNICATION_KINDS]
        found = {node: next((item for item in names if _is_private(item, node, private)), None) for node in (old, new)}
        user = found[old]
        if user is None or found[new] is not None:
            continue
        values = {"name": user.name, "old": old, "file": file, "new": new}
        text = phrase("uses '{name}' of the node '{old}', which '{file}' now calls '{new}'", **values)
        reason = phrase("with this name, no node has the topic, service or action")
        if user.kind is NameKind.CLIENT:
            text = phrase("calls '{name}' of the node '{old}', which '{file}' now calls '{new}'", **values)
            reason = phrase("with this name, no node has the service")
        yield path, Change(text, Effect.BREAKING, reason, Location(path, user.span.line, user.span.column))


def _is_private(item: SourceName, node: str, private: Collection[tuple[NameKind, str]]) -> bool:
    """Return whether a name is the other end of a private name of a node, or that of a service of each node."""
    if item.kind is NameKind.CLIENT and item.name.rpartition("/")[2] in _NODE_SERVICES:
        return item.name.rpartition("/")[0].rpartition("/")[2] == node
    name = item.name.strip("/")
    return name.startswith(f"{node}/") and (get_counterpart(item.kind), name.removeprefix(f"{node}/")) in private


def _read_private_names(version: Version, package: str) -> set[tuple[NameKind, str]]:
    """Return the private topics, services and actions in the sources of a package, each with its kind."""
    share = version.shares.get(package)
    folder = None if share is None else version.relative(share)
    paths = () if folder is None else version.paths(_SOURCE_SUFFIXES, "" if folder == "." else folder)
    names = (read_source_names(version.file(path)).names for path in paths if _PRIVATE.search(version.text(path)))
    items = (item for found in names for item in found if item.kind in COMMUNICATION_KINDS)
    return {(item.kind, item.name.lstrip("~/")) for item in items if item.name.startswith("~")}


def _is_named(version: Version, name: str, new_name: str) -> bool:
    """Return whether a launch file or another source gives a node one of two names."""
    for _, outline in read_launch_files(version, name, new_name):
        if {_get_name(outline, entry) for entry in list_nodes(outline)} & {name, new_name}:
            return True
    for path in version.paths(_SOURCE_SUFFIXES):
        if name in version.text(path) and not is_launch_file_name(PurePosixPath(path).name):
            nodes = read_source_names(version.file(path)).of_kind(NameKind.NODE)
            if any(item.name == name for item in nodes):
                return True
    return False


def _find_files(version: Version, path: str, outline: LaunchOutline, entry: Entry) -> Iterator[str]:
    """Yield the parameter files in the repository that a node loads."""
    for match in _SHARE_PATH.finditer(outline.resolve(entry.settings.get("parameters", ""))):
        share = version.share_of(match["package"], version.file(path).parent)
        file = None if share is None else version.relative(share / match["path"])
        if file is not None and version.file(file).is_file():
            yield file


def _read_nodes(version: Version, path: str) -> Mapping[str, YamlValue]:
    """Return the last parts of the names of the nodes in a parameter file, each with its first value."""
    text = version.text(path)
    try:
        values = read_yaml_values(text) if "ros__parameters" in text else {}
    except UnreadableFileError:
        return {}
    nodes: dict[str, YamlValue] = {}
    for name, value in values.items():
        node = find_node_name(name)
        if node:
            nodes.setdefault(re.split(r"[./]", node.strip("/"))[-1], value)
    return nodes


def _get_name(outline: LaunchOutline, entry: Entry) -> str:
    return outline.resolve(entry.settings.get("name", "")).strip("/")


def _make_change(path: str, old: str, new: str, file: str, value: YamlValue) -> Change:
    text = phrase("names the node '{old}', which '{file}' now calls '{new}'", old=old, file=file, new=new)
    reason = phrase("the node '{name}' starts without these parameters", name=new)
    return Change(text, Effect.BREAKING, reason, Location(path, value.line, 1))
