"""Find launch files and parameter files that still set a parameter which a program no longer reads."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import PurePosixPath

from linkwright.diagnostics import phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.packages.launch_files import is_launch_file_name
from linkwright.packages.manifest import MANIFEST, package_name
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.file_pair import UnreadableFileError
from linkwright.review.files.parameters.names import find_node_name
from linkwright.review.files.parameters.yaml_values import YamlValue, read_yaml_values
from linkwright.review.launches.outlines import PARAMETER, PROGRAM_KINDS, Entry, LaunchOutline, without_condition
from linkwright.review.launches.programs.sources import SourcePrograms, list_nodes, read_launch_files
from linkwright.review.sources.names import CPP_SUFFIXES, DYNAMIC_SUFFIX, PYTHON_SUFFIX, NameKind, SourceNames
from linkwright.review.sources.reading import read_source_names
from linkwright.review.versions import TEST_FOLDERS, Version, Versions

_SOURCE_SUFFIXES = (*CPP_SUFFIXES, PYTHON_SUFFIX, DYNAMIC_SUFFIX)
_SETTINGS_SUFFIXES = (".yaml", ".yml")
_ANY_READING = re.compile(
    r"\b(?:automatically_declare_parameters_from_overrides|allow_undeclared_parameters|get_parameters_by_prefix"
    r"|list_parameters|get_param_names|getParamNames|ParamListener|get_node_parameters_interface)\b"
    r"|\bget_?param\w*\(\s*[\"'][~/.]*[\"']",
    re.IGNORECASE,
)
"""Code with which a program reads parameters whose names it does not contain."""
_COMMENT = re.compile(r"(^|\s)(#|//)[^\n]*")
_PARAMETERS = ".ros__parameters."
_DOT = re.escape(".")
_VARIABLE = re.compile(r"\$\((?:arg|var) \w+\)")
_CHOSEN_FILE = re.compile(
    rf"\$\(find(?:-pkg-share)? (?P<package>[\w-]+)\)/(?P<path>(?:[\w./-]|{_VARIABLE.pattern})*\.ya?ml)(?![\w.])"
)
"""The path of a parameter file of a package, which may contain arguments."""
_MAX_FILES = 100


@dataclass(frozen=True)
class _Lost:
    """The parameters that a source no longer reads.

    Args:
        version: the new version.
        path: the path of the source.
        names: the names of the parameters, without ``~`` and with dots between their parts.
        source: the names in the new source.
    """

    version: Version
    path: str
    names: frozenset[str]
    source: SourceNames

    @cached_property
    def programs(self) -> SourcePrograms:
        """The programs that contain the source."""
        return SourcePrograms(self.version, self.path)

    @cached_property
    def launch_files(self) -> list[tuple[str, LaunchOutline]]:
        """The launch files that name the package."""
        return list(read_launch_files(self.version, self.programs.package or "\n"))

    @cached_property
    def nodes(self) -> list[tuple[str, LaunchOutline, Entry]]:
        """The nodes that run the source, with their launch files."""
        return [
            (path, outline, entry)
            for path, outline in self.launch_files
            for entry in list_nodes(outline)
            if self.programs.runs(entry.name)
        ]

    def find_in_launch_files(self) -> Iterator[tuple[str, Change]]:
        """Yield the launch files that set the parameters for their nodes, each with a change."""
        for path, _, entry in self.nodes:
            settings = [without_condition(name) for name in entry.settings if name.startswith(PARAMETER)]
            for name in dict.fromkeys(setting.removeprefix(PARAMETER) for setting in settings):
                if _to_path(name) in self.names:
                    yield path, self._make_change(name, Location(path, entry.span.line, entry.span.column))

    def find_in_parameter_files(self) -> Iterator[tuple[str, Change]]:
        """Yield the parameter files that set the parameters for the node of the source, each with a change."""
        node_names = self._find_node_names()
        words = {name.rpartition(".")[2] for name in self.names}
        for path in self.version.paths(_SETTINGS_SUFFIXES):
            text = self.version.text(path)
            if not TEST_FOLDERS.isdisjoint(PurePosixPath(path).parts) or not any(name in text for name in words):
                continue
            is_own: bool | None = None
            for name, value in _try_read_values(text).items():
                node = find_node_name(name)
                parameter = name if node is None else name.partition(_PARAMETERS)[2]
                if _to_path(parameter) not in self.names:
                    continue
                is_named = node is not None and node.strip("/") in node_names
                if not is_named and node is not None and "*" not in node:
                    continue
                if not is_named and is_own is None:
                    is_own = self._is_loaded_only_by_nodes(path)
                if is_named or is_own:
                    yield path, self._make_change(parameter, Location(path, value.line, value.column))

    def _find_node_names(self) -> set[str]:
        """Return the names of nodes that certainly run the source."""
        names = {item.name for item in self.source.of_kind(NameKind.NODE)}
        names |= {name for _, outline, entry in self.nodes if (name := _find_name(outline, entry))}
        if not names:
            return set()
        foreign = {
            _find_name(outline, entry)
            for _, outline in read_launch_files(self.version, *names)
            for entry in list_nodes(outline)
            if not self.programs.runs(entry.name)
        }
        names -= foreign
        for path in _list_sources(self.version) if names else ():
            text = self.version.text(path) if path != self.path else ""
            if any(name in text for name in names):
                names -= {item.name for item in read_source_names(self.version.file(path)).of_kind(NameKind.NODE)}
        return names

    def _is_loaded_only_by_nodes(self, path: str) -> bool:
        """Return whether only nodes that run the source load a file, and all of its keys are theirs.

        Arguments of a launch file may choose the file in its folder.
        """
        name, folder = PurePosixPath(path).name, self.version.package_of(path)
        package = None if folder is None else package_name(self.version.file(folder))
        inner = PurePosixPath(path).relative_to(folder or "").as_posix()
        users = [
            (outline, entry)
            for _, outline in read_launch_files(self.version, name, PurePosixPath(path).stem, package or name)
            for entry in outline.entries
            for texts in [[outline.resolve(text) for text in (entry.name, *entry.settings.values())]]
            if any(name in text or _may_choose(text, package, inner) for text in texts) and not entry.has_value
        ]
        return bool(users) and all(
            entry.kind in PROGRAM_KINDS
            and self.programs.runs(entry.name)
            and f"{name} (" not in entry.settings.get("parameters", "")
            for _, entry in users
        )

    def _make_change(self, name: str, location: Location) -> Change:
        text = phrase("sets the parameter '{name}', which '{file}' no longer reads", name=name, file=self.path)
        return Change(text, Effect.BREAKING, phrase("the value has no effect"), location)


def find_left_parameters(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the files that set a parameter which a changed source no longer reads, each with a change.

    A parameter that a source of the package still names is left out, and so are all parameters of a program that
    reads parameters without their names.
    """
    for file in changed_files[:_MAX_FILES]:
        if not (file.old_path and file.new_path and file.path.endswith(_SOURCE_SUFFIXES)) or file.is_submodule:
            continue
        parts = PurePosixPath(file.path)
        if not TEST_FOLDERS.isdisjoint(parts.parts) or is_launch_file_name(parts.name):
            continue
        lost = _find_lost(versions, file.old_path, file.new_path)
        if lost is not None:
            yield from dict.fromkeys((*lost.find_in_launch_files(), *lost.find_in_parameter_files()))


def _find_lost(versions: Versions, old_path: str, new_path: str) -> _Lost | None:
    """Return the parameters that only the old version of a source reads, or None."""
    old = read_source_names(versions.old.file(old_path))
    new = read_source_names(versions.new.file(new_path))
    package = versions.new.package_of(new_path)
    if new.error_line or old.error_line or package is None:
        return None
    parameters = list(old.of_kind(NameKind.PARAMETER))
    is_ros1 = any(item.name.startswith("~") for item in parameters)
    names = {
        _to_path(item.name)
        for item in parameters
        if not is_ros1 or (item.name.startswith("~") and item.name not in old.unknown_scopes)
    }
    known = {_to_path(item.name) for item in new.of_kind(NameKind.PARAMETER)}
    names = {name for name in names if not any(name == other or name.startswith(f"{other}.") for other in known)}
    names -= _find_named(versions.new, package, new_path, names) if names else set()
    return _Lost(versions.new, new_path, frozenset(names), new) if names else None


def _may_choose(text: str, package: str | None, path: str) -> bool:
    """Return whether arguments in a path may choose a file of a package: ``$(find arm)/config/$(arg robot).yaml``."""
    return any(
        match["package"] == package and re.fullmatch(".+".join(map(re.escape, _VARIABLE.split(match["path"]))), path)
        for match in _CHOSEN_FILE.finditer(text)
    )


def _to_path(name: str) -> str:
    """Return the name of a parameter without ``~``, with dots between its parts."""
    return name.lstrip("~/").replace("/", ".")


def _find_named(version: Version, package: str, source: str, names: set[str]) -> set[str]:
    """Return the parameters that sources of a package or of its dependencies may still read.

    A description of parameters beside the source, from which code is generated, counts as a source.
    """
    manifest = version.text((PurePosixPath(package) / MANIFEST).as_posix())
    found = set[str]()
    patterns = {
        name: re.compile(rf"[\"'](?:[^\"'\n]*[/.~}}])?{re.escape(name).replace(_DOT, '[./]')}[\"'./{{]")
        for name in names
    }
    for path in _list_sources(version):
        folder = version.package_of(path)
        if folder != package and not _is_named(manifest, folder):
            continue
        text = _COMMENT.sub(r"\1", version.text(path))
        if folder == package and _ANY_READING.search(text):
            return names
        found |= {name for name, pattern in patterns.items() if pattern.search(text)}
    for file in version.file(source).parent.glob("*.y*ml"):
        text = file.read_text("utf-8", errors="replace")
        found |= {name for name in names if f"{name.rpartition('.')[2]}:" in text}
    return found


def _is_named(manifest: str, folder: str | None) -> bool:
    """Return whether a manifest names the package in a folder."""
    return bool(folder) and f">{PurePosixPath(folder or '').name}<" in manifest


def _list_sources(version: Version) -> Iterator[str]:
    """Yield the paths of the sources of a version, without tests and launch files."""
    for path in version.paths(_SOURCE_SUFFIXES):
        pure_path = PurePosixPath(path)
        if TEST_FOLDERS.isdisjoint(pure_path.parts) and not is_launch_file_name(pure_path.name):
            yield path


def _find_name(outline: LaunchOutline, entry: Entry) -> str:
    return outline.resolve(entry.settings.get("name", "")).strip("/")


def _try_read_values(text: str) -> Mapping[str, YamlValue]:
    try:
        return read_yaml_values(text)
    except UnreadableFileError:
        return {}
