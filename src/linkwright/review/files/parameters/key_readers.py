"""Find unchanged programs that read a removed key or name of a YAML file."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import PurePosixPath

from linkwright.diagnostics import Phrase, phrase
from linkwright.packages.launch_files import is_launch_file_name
from linkwright.review.files.parameters.declared_types import declare_type
from linkwright.review.files.parameters.yaml_values import YamlValue
from linkwright.review.launch_paths import find_launch_files
from linkwright.review.texts.list_changes import EMPTY, list_items
from linkwright.review.versions import TEST_FOLDERS, Version, Versions

_PROGRAM_SUFFIXES = (".py", ".cpp", ".cc", ".cxx", ".hpp", ".h", ".launch", ".launch.xml")
_DESCRIPTION_SUFFIXES = (".xacro", ".urdf")
_SOURCE_SUFFIXES = (".py", ".cpp", ".cc", ".cxx", ".hpp", ".h")
_COMMENT = re.compile(r"(^|\s)(#|//)[^\n]*")
_NAME_PARAMETER = re.compile(r"(^|[._])names?$")
"""The keys of lists of names. Other lists, such as modes, contain words that many programs use."""
_PLACEHOLDER = re.compile(r"[A-Z][A-Z0-9_]*|<\w+>|\$\{?\w+\}?")
"""A value that another one can replace."""
_NAME = re.compile(r"[A-Za-z_][\w/.-]{3,}")
_WORDS = re.compile(r"[./]")
_LAUNCH_SUFFIXES = (".py", ".launch", ".xml", ".yaml", ".yml", ".sh")
_STARTED = re.compile(r"\b(?:executable|plugin)\s*=|<(?:node|composable_node)\b")
_NODE_NAME = re.compile(r"(?:[(,]|<node\b[^<>]*\s)\s*name\s*=\s*[\"'](\w+)[\"']")
_OTHER_FILE = re.compile(r"IncludeLaunchDescription|<include\b|ros2 (?:run|launch)")


@dataclass(frozen=True)
class KeyReaders:
    """The programs of the new version that may read a YAML file.

    Attributes:
        versions: the repository before and after the change.
        path: the path of the YAML file in the new version.
    """

    versions: Versions
    path: str

    def find_key_reason(self, keys: Iterable[str]) -> Phrase | None:
        """Return the reason why removing keys is breaking; None if no unchanged program needs them.

        Only a read without a default certainly fails, such as ``settings["rate"]``.
        """
        for key in keys:
            pattern = re.compile(rf"(?<=[\w\])])\[\s*[\"']{re.escape(key)}[\"']\s*\]")
            reader = next((path for path, text in self._readers if pattern.search(text)), None)
            if reader is not None:
                return phrase("'{file}' reads the key '{name}' and does not find it", file=reader, name=key)
        return None

    def find_name_reason(self, parameter: str, old: YamlValue, new: YamlValue) -> Phrase | None:
        """Return the reason why removing names from a list is breaking; None if it is not.

        It is breaking if an unchanged source contains one of the names.

        Args:
            parameter: the path of the list.
            old: the old list.
            new: the new list.
        """
        if not (old.is_list and new.is_list) or not _NAME_PARAMETER.search(parameter):
            return None
        new_names = set(list_items(new.text))
        removed = [
            item for item in list_items(old.text) if item not in new_names and item != EMPTY and _NAME.fullmatch(item)
        ]
        for name in removed if self._is_file_used else ():
            pattern = re.compile(rf"[\"']{re.escape(name)}[\"']")
            reader = next((path for path, text in self._unchanged_sources if pattern.search(text)), None)
            if reader is not None:
                return phrase("'{file}' still uses the name '{name}'", file=reader, name=name)
        return None

    def is_replaced(self, value: str) -> bool:
        """Return whether a launch file replaces a value, such as ``KEEPOUT_ENABLED``, before it loads the file."""
        return _PLACEHOLDER.fullmatch(value) is not None and _replaces(self.versions.new, value)

    def was_replaced(self, placeholder: str) -> bool:
        """Return whether a launch file of the old version replaces a placeholder before it loads the file."""
        return _replaces(self.versions.old, placeholder)

    def have_stopped_reading(self, group: str) -> bool:
        """Return whether the sources that named a group of parameters changed, and no source names it any more.

        A source may add the last word of the name to a variable, such as ``name + "_pose.x"`` for ``arm_pose``.

        Args:
            group: the last name of the group, which may be a part of longer names: ``limits`` of ``arm.limits.speed``.
        """
        rest = r"(?:\.[\w.]*)?[\"']"
        word = rf"|\+\s*[\"']{re.escape(group[group.rindex('_') :])}{rest}" if "_" in group else ""
        pattern = re.compile(rf"[\"'](?:[\w.]*\.)?{re.escape(group)}{rest}{word}")
        changed = {file.old_path for file in self.versions.changed_files}
        readers = {path for path in _list_sources(self.versions.old) if _names(self.versions.old, path, pattern)}
        return (
            bool(readers)
            and readers <= changed
            and not any(_names(self.versions.new, path, pattern) for path in _list_sources(self.versions.new))
        )

    def have_renamed_node(self, node: str, new_nodes: Iterable[str]) -> bool:
        """Return whether the programs name one of the new nodes of the file, and no longer a lost one.

        The file then follows the programs. So does a file that the old version only gave to a new one.

        Args:
            node: the lost node.
            new_nodes: the nodes that only the new version of the file has.
        """
        names = [_WORDS.split(name)[-1] for name in new_nodes]
        is_named = any(map(self._is_node_named, names))
        return is_named and (not self._is_node_named(node) or self._was_given_to(names, instead_of=node))

    def _was_given_to(self, nodes: Collection[str], *, instead_of: str) -> bool:
        """Return whether the old version started one of these nodes with the file, but not another node.

        Each launch file that contained the name of the file must have started one program, with a name of its own.
        """
        version, pattern = self.versions.old, re.compile(rf"(?<![\w.-]){re.escape(PurePosixPath(self.path).name)}\b")
        paths = [path for path in version.paths(_LAUNCH_SUFFIXES) if _names(version, path, pattern)]
        texts = [_COMMENT.sub(r"\1", version.text(path)) for path in paths]
        names = [_NODE_NAME.findall(text) for text in texts]
        return (
            all(len(_STARTED.findall(text)) == 1 and not _OTHER_FILE.search(text) for text in texts)
            and all(len(found) == 1 and found[0] != _WORDS.split(instead_of)[-1] for found in names)
            and any(found[0] in nodes for found in names)
        )

    def is_package_without_node(self, name: str) -> bool:
        """Return whether a name is that of a package of the repository, and no program or description has it as a text.

        Then no node has the name, such as that of a section for hardware that ros2_control loads as a plugin.
        """
        if name not in self.versions.old.shares:
            return False
        pattern = re.compile(rf"[\"'/]{re.escape(name)}[\"']")
        versions = (self.versions.old, self.versions.new)
        return not any(
            pattern.search(version.text(path))
            for version in versions
            for path in version.paths((*_PROGRAM_SUFFIXES, *_DESCRIPTION_SUFFIXES))
        )

    def declare_type(self, node: str, parameter: str, value: YamlValue) -> bool:
        """Return whether the packages with a node declare one of its parameters with the type of a value.

        Args:
            node: the name of the node.
            parameter: the name of the parameter.
            value: the new value.
        """
        version, name = self.versions.new, node.strip("/")
        if not re.fullmatch(r"\w+", name):
            return False
        pattern = re.compile(rf"[({{]\s*[\"']{name}[\"']")
        packages = {version.package_of(path) for path in _list_sources(version) if _names(version, path, pattern)}
        texts = (version.text(path) for path in _list_sources(version) if version.package_of(path) in packages)
        return declare_type(texts, parameter, value)

    def _is_node_named(self, node: str) -> bool:
        """Return whether a program of the new version contains the last part of a node's name as a text."""
        pattern = re.compile(rf"[\"'/]{re.escape(_WORDS.split(node)[-1])}[\"']")
        return any(_names(self.versions.new, path, pattern) for path in self._list_paths(_PROGRAM_SUFFIXES, ()))

    @cached_property
    def _is_file_used(self) -> bool:
        """Whether a program contains the name of the file."""
        name = PurePosixPath(self.path).name
        return any(name in self.versions.new.text(path) for path in self._list_paths(_PROGRAM_SUFFIXES, ()))

    @cached_property
    def _readers(self) -> list[tuple[str, str]]:
        """The paths and texts of the unchanged sources that contain the name of the file."""
        name = PurePosixPath(self.path).name
        return [(path, text) for path, text in self._unchanged_sources if name in text]

    @cached_property
    def _unchanged_sources(self) -> list[tuple[str, str]]:
        """The paths and texts, without comments, of the unchanged sources."""
        changed = {file.new_path for file in self.versions.changed_files}
        paths = self._list_paths(_SOURCE_SUFFIXES, changed)
        return [(path, _COMMENT.sub(r"\1", self.versions.new.text(path))) for path in paths]

    def _list_paths(self, suffixes: tuple[str, ...], excluded: Collection[str | None]) -> Iterator[str]:
        for path in self.versions.new.paths(suffixes):
            if path not in excluded and TEST_FOLDERS.isdisjoint(PurePosixPath(path).parts):
                yield path


def _replaces(version: Version, placeholder: str) -> bool:
    """Return whether a launch file of a version names a placeholder as a text."""
    texts = map(version.text, find_launch_files(version))
    return any(f'"{placeholder}"' in text or f"'{placeholder}'" in text for text in texts)


def _list_sources(version: Version) -> Iterator[str]:
    """Yield the paths of the sources of a version, without tests."""
    for path in version.paths(_SOURCE_SUFFIXES):
        if TEST_FOLDERS.isdisjoint(PurePosixPath(path).parts) and not is_launch_file_name(PurePosixPath(path).name):
            yield path


def _names(version: Version, path: str, pattern: re.Pattern[str]) -> bool:
    """Return whether the code of a source contains a text outside of comments."""
    return pattern.search(_COMMENT.sub(r"\1", version.text(path))) is not None
