"""Find the parameter files that launch files of a package give to nodes with known names."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from linkwright.diagnostics import LinkwrightError, SourceText, Span
from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_dataclasses import dataclass
from linkwright.loading.lean_typing import TYPE_CHECKING
from linkwright.packages.readers.python_values import SharePath, argument_of
from linkwright.xacro.cache import read_document

if TYPE_CHECKING:
    from linkwright.lint.package import PackageContext
    from linkwright.packages.readers.launch_files import LaunchFile

_MARKUP_SUFFIXES = (".launch", ".launch.xml", "_launch.xml")
_SHARED_FILE = lazy_pattern(r"\$\(find-pkg-share\s+(?P<package>[\w-]+)\s*\)/(?P<path>[^$]+)")
_NAME = lazy_pattern(r"[A-Za-z_]\w*")
_YAML_SUFFIXES = (".yaml", ".yml")
_SEVERAL_NODES = lazy_pattern(r"component_container|ros2_control_node|move_group|gzserver|gz_server|spawner")
"""The names of programs that contain other nodes, or that give the file to others."""
_INNER_NODES = frozenset({"controller_manager", "global_costmap", "local_costmap"})
"""The nodes that programs with other names contain, such as the drivers of simulators and the servers of Nav2."""


@dataclass(frozen=True, slots=True)
class GivenFile:
    """A parameter file that a launch file gives to a node.

    Attributes:
        file: the path of the parameter file.
        node: the name of the node; None if it is unknown.
        span: the place of the name, or of the node.
        source: the launch file.
    """

    file: Path
    node: str | None
    span: Span
    source: SourceText


def find_given_files(package: PackageContext) -> Iterator[GivenFile]:
    """Yield the parameter files of the package that its launch files give to nodes."""
    for file in package.launch_files.values():
        yield from _find_in_python(file, package)
    for path in package.files:
        if path.endswith(_MARKUP_SUFFIXES):
            yield from _find_in_markup(package.folder / path, package)


def _find_in_python(file: LaunchFile, package: PackageContext) -> Iterator[GivenFile]:
    import ast

    python_file = file.python_file
    if python_file is None:
        return
    for call in python_file.calls("Node", "LifecycleNode", "ComposableNode"):
        parameters = argument_of(call, "parameters")
        values = None if parameters is None else python_file.resolved(parameters)
        name_argument = argument_of(call, "name")
        name = None if name_argument is None else python_file.text(name_argument)
        executable = argument_of(call, "executable")
        has_several = executable is not None and _has_several_nodes(python_file.text(executable))
        for item in values.elts if isinstance(values, (ast.List, ast.Tuple)) else ():
            value = python_file.value(item)
            if isinstance(value, SharePath) and value.package == package.name:
                given = package.folder / value.subpath.strip("/")
                span = python_file.span(call if name_argument is None else name_argument)
                yield GivenFile(given, None if has_several else _clean(name), span, file.source)


def _find_in_markup(path: Path, package: PackageContext) -> Iterator[GivenFile]:
    try:
        root = read_document(str(path)).root
    except (LinkwrightError, OSError):
        return
    for element in root.walk():
        if element.tag not in ("node", "composable_node") or "pkg" not in element.attributes:
            continue
        name = element.attributes.get("name")
        has_several = _has_several_nodes(element.attributes.get("exec"))
        for child in element.elements():
            match = _SHARED_FILE.fullmatch(child.attributes.get("from", "")) if child.tag == "param" else None
            if match is None or match["package"] != package.name or element.source is None:
                continue
            end = element.offset + len(element.tag) + 1
            span = element.source.span(element.offset, end)
            yield GivenFile(package.folder / match["path"], None if has_several else _clean(name), span, element.source)


def _has_several_nodes(executable: str | None) -> bool:
    return executable is not None and _SEVERAL_NODES.search(executable) is not None


def _clean(name: str | None) -> str | None:
    """Return a constant name of a node, or None."""
    return name if name is not None and _NAME.fullmatch(name) else None


def read_sections(file: Path) -> list[str] | None:
    """Return the last parts of the names of the nodes for which a parameter file has sections.

    The result is None if the file cannot be read, if it has a section for any node or for one that other programs
    contain, or a part without parameters.
    """
    import yaml

    if not str(file).endswith(_YAML_SUFFIXES):
        return None
    try:
        content = yaml.safe_load(file.read_text("utf-8"))
    except (OSError, ValueError, yaml.YAMLError, RecursionError):
        return None
    names = list(_list_sections(content, ""))
    is_for_others = any("*" in name for name in names) or not _INNER_NODES.isdisjoint(names)
    return None if not names or "" in names or is_for_others else names


def _list_sections(content: object, name: str) -> Iterator[str]:
    """Yield the last parts of the names of nodes, and an empty text for a part without parameters."""
    if not isinstance(content, dict) or not content:
        yield ""
    elif "ros__parameters" in content:
        yield name.rpartition("/")[2] if "*" not in name else name
    else:
        for key, value in content.items():
            yield from _list_sections(value, str(key))
