"""Tell YAML files that configure robots from those of other tools, in packages and in other folders alike."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import PurePosixPath

import yaml

from linkwright.packages.manifest import MANIFEST, ROSBUILD_MANIFEST
from linkwright.review.file_pair import UnreadableFileError
from linkwright.review.files.parameters.yaml_values import compose_yaml, read_yaml_text
from linkwright.review.versions import TEST_FOLDERS, Version

YAML_SUFFIXES = (".yaml", ".yml")
_NODE_PARAMETERS = "ros__parameters"
"""The key above the parameters of a node in a YAML file of ROS 2."""
_TOOL_FILE = re.compile(
    r"(?:(?:.*[._-])?compose(?:[._-].*)?|mkdocs|_config|conda|appveyor|codecov|azure-pipelines|bitbucket-pipelines"
    r"|cloudbuild|readthedocs|snapcraft)\.ya?ml"
)
"""The names of files of container tools, services for builds and generators of documentation."""
_TOOL_KEYS = tuple(
    map(
        frozenset,
        (
            ("site_name",),  # MkDocs
            ("channels", "dependencies"),  # conda
            ("apiVersion", "kind"),  # Kubernetes
            ("on", "jobs"),  # GitHub
            ("train", "val"),  # data sets of Ultralytics
            ("rosbag2_bagfile_information",),
        ),
    )
)
"""Keys at the root that the files of a tool have together."""
_KNOWN_KEY = re.compile(
    r"""^[ \t-]*(?:topic:\s*["']?[/~]|(?:\w+_topic|(?:\w+_)?frame_id):\s*["']?[/~]?[A-Za-z])[\w/]*["']?\s*(?:\#.*)?$"""
    r"|^[ \t-]*joint_names:",
    re.MULTILINE,
)
"""A line with the name of a topic or frame, or a list of joints."""
_PROGRAM_SUFFIXES = (".py", ".cpp", ".cc", ".cxx", ".hpp", ".h", ".launch", ".launch.xml")
_SCRIPTS_OF_TOOLS = frozenset({"setup.py", "conf.py", "conftest.py"})
_MIN_COMMON_KEYS = 2


def is_configuration(version: Version, path: str) -> bool:
    """Return whether a YAML file configures a robot or its programs.

    Such a file belongs to a package, has parameters of nodes, names topics, frames or joints, is named by a program
    or launch file, or has the same shape as such a file of its folder. Files of other tools, such as those of
    Compose, never count.

    Args:
        version: the version that contains the file.
        path: the path of the file relative to the root.
    """
    root = _compose(version, path)
    if _belongs_to_tool(path, root):
        return False
    if version.package_of(path, (MANIFEST, ROSBUILD_MANIFEST)) is not None or _NODE_PARAMETERS in version.text(path):
        return True
    if root is None:
        return False
    return _has_known_key(version, path) or _is_named(version, path) or _has_sibling(version, path, root)


def _compose(version: Version, path: str) -> yaml.Node | None:
    """Return the root of a YAML file; None if the file is empty or cannot be read."""
    try:
        return compose_yaml(read_yaml_text(version.file(path)))
    except (UnreadableFileError, OSError, ValueError):
        return None


def _belongs_to_tool(path: str, root: yaml.Node | None) -> bool:
    """Return whether a file is one of a tool, by its name or by the keys at its root."""
    if _TOOL_FILE.fullmatch(PurePosixPath(path).name.lower()):
        return True
    keys = _list_keys(root)
    if isinstance(root, yaml.SequenceNode) and root.value:
        return all("hosts" in item or "import_playbook" in item for item in map(_list_keys, root.value))
    return any(tool_keys <= keys for tool_keys in _TOOL_KEYS)


def _list_keys(node: yaml.Node | None) -> set[str]:
    """Return the keys of a mapping; an empty set for other nodes."""
    items = node.value if isinstance(node, yaml.MappingNode) else ()
    return {key.value for key, _ in items if isinstance(key, yaml.ScalarNode)}


def _has_known_key(version: Version, path: str) -> bool:
    """Return whether a file names topics, frames or joints."""
    return _KNOWN_KEY.search(version.text(path)) is not None


def _is_named(version: Version, path: str) -> bool:
    """Return whether a program or launch file contains the name of a file.

    If other files have the same name, the program has to name the folder, too.
    """
    file = PurePosixPath(path)
    is_only_one = sum(PurePosixPath(other).name == file.name for other in version.paths((file.name,))) <= 1
    name = re.escape(file.name)
    folder = r"" if is_only_one else re.escape(file.parent.name) + r"""(?:/|["'],\s*["']|["']\s*/\s*["'])"""
    pattern = re.compile(rf"""["'/]{folder}{name}["']""")
    return any(pattern.search(version.text(program)) for program in _list_programs(version))


def _list_programs(version: Version) -> Iterator[str]:
    """Yield the paths of programs and launch files, without tests and scripts of tools."""
    for path in version.paths(_PROGRAM_SUFFIXES):
        file = PurePosixPath(path)
        if TEST_FOLDERS.isdisjoint(file.parts) and file.name not in _SCRIPTS_OF_TOOLS:
            yield path


def _has_sibling(version: Version, path: str, root: yaml.Node) -> bool:
    """Return whether a configuration of the same folder has most of the keys at the root of a file."""
    keys, folder = _list_keys(root), PurePosixPath(path).parent
    if len(keys) < _MIN_COMMON_KEYS:
        return False
    for other in version.paths(YAML_SUFFIXES, "" if folder == PurePosixPath() else folder.as_posix()):
        if other == path or PurePosixPath(other).parent != folder:
            continue
        common = keys & _list_keys(_compose(version, other))
        if len(common) >= max(_MIN_COMMON_KEYS, len(keys) / 2) and (
            _has_known_key(version, other) or _is_named(version, other)
        ):
            return True
    return False
