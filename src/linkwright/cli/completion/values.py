"""Candidates for the arguments of commands.

The candidates are packages, executables, launch files and their arguments, and names and types of the graph.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

from linkwright.cli.completion.graph_names import names_of
from linkwright.cli.completion.scripts import FILES
from linkwright.packages import PackageFinder, install_prefix, is_installed
from linkwright.packages.launch_files import find_launch_files_below

_LAUNCH_ARGUMENT = re.compile(
    r"""Declare(?:Boolean)?LaunchArgument\(\s*(?:name\s*=\s*)?["']([^"']+)["']"""
    r"""|<arg\s[^>]*?\bname\s*=\s*["']([^"']+)["']|-\s*arg:\s*\n\s+name:\s*["']?([\w./-]+)"""
)
_XACRO_ARGUMENT = re.compile(r"""<xacro:arg\s[^>]*?\bname\s*=\s*["']([^"']+)["']""")

_INTERFACE_KINDS = {"topic": ("msg",), "bag": ("msg",), "service": ("srv",), "action": ("action",)}

Asked = tuple[list[str], list[str], Mapping[str, Any]]
"""A request for candidates of an argument.

It contains the names of the command and subcommand, the preceding positional arguments, and the table of commands.
"""


def argument_candidates(kind: str, path: list[str], positionals: list[str], table: Mapping[str, Any]) -> Iterable[str]:
    """Return the candidates for an argument.

    Args:
        kind: the argument's name in the help.
        path: the names of the command and the subcommand, such as ``topic`` and ``echo``.
        positionals: the preceding positional arguments.
        table: the contents of ``commands.json``.
    """
    find_candidates = _KINDS.get(kind)
    return [] if find_candidates is None else find_candidates((path, positionals, table))


def _packages(request: Asked) -> Iterable[str]:
    return sorted({*PackageFinder().packages(), *request[2]["executables"]})


def _executables(request: Asked) -> Iterable[str]:
    _, positionals, table = request
    package = positionals[-1] if positionals else ""
    names = set(table["executables"].get(package, ()))
    share = PackageFinder().find(package)
    if share is not None:
        if not is_installed(share):
            from linkwright.packages.programs.source_programs import find_source_programs

            programs = find_source_programs(share)
            names |= {*programs.entry_points, *programs.scripts}
        folder = install_prefix(share) / "lib" / package
        names |= {path.name for path in folder.glob("*") if path.is_file() and path.suffix not in (".so", ".dylib")}
    return sorted(names)


def _launch_packages(_: Asked) -> Iterable[str]:
    return [*sorted(PackageFinder().packages()), FILES]


def _launch_files(request: Asked) -> Iterable[str]:
    path_or_package = Path(request[1][0])
    if path_or_package.is_file():
        return _declared_arguments(path_or_package, _LAUNCH_ARGUMENT)
    share = PackageFinder().find(request[1][0])
    return [] if share is None else sorted(path.name for path in find_launch_files_below(share))


def _launch_arguments(request: Asked) -> Iterable[str]:
    package, file = request[1][:2]
    if Path(package).is_file():
        return _declared_arguments(Path(package), _LAUNCH_ARGUMENT)
    share = PackageFinder().find(package)
    launch_file = next((path for path in find_launch_files_below(share) if path.name == file), None) if share else None
    return [] if launch_file is None else _declared_arguments(launch_file, _LAUNCH_ARGUMENT)


def _description_arguments(request: Asked) -> Iterable[str]:
    paths = [Path(word) for word in request[1] if ":=" not in word]
    return [name for path in paths if path.is_file() for name in _declared_arguments(path, _XACRO_ARGUMENT)]


def _second_description(request: Asked) -> Iterable[str]:
    return [*_description_arguments(request), FILES]


def _declared_arguments(path: Path, pattern: re.Pattern[str]) -> list[str]:
    """Return the arguments that a launch file or xacro file declares.

    The file is searched with a regular expression, because executing it takes too long.
    """
    text = path.read_text(encoding="utf-8", errors="replace")
    names = (next(filter(None, match.groups())) for match in pattern.finditer(text))
    return [f"{name}:=" for name in dict.fromkeys(names)]


def _types(request: Asked) -> Iterable[str]:
    path, _, table = request
    kinds = _INTERFACE_KINDS.get(path[0], ("msg", "srv", "action"))
    package_types = (
        f"{package}/{kind}/{file.stem}"
        for package, share in PackageFinder().packages().items()
        for kind in kinds
        for file in (share / kind).glob(f"*.{kind}")
    )
    return sorted({*(name for kind in kinds for name in table["types"][kind]), *package_types})


def _graph_names(kind: str) -> Callable[[Asked], Iterable[str]]:
    return lambda _: names_of(kind)


def _detectors(request: Asked) -> Iterable[str]:
    from linkwright.vision.detectors.registry import detector_names

    return [*detector_names(), *_files(request)]


def _models(_: Asked) -> Iterable[str]:
    from linkwright.model_files import model_table

    return model_table()


def _engines(_: Asked) -> Iterable[str]:
    from linkwright.speech.engine import engine_names

    return engine_names()


def _files(_: Asked) -> Iterable[str]:
    return [FILES]


_KINDS: dict[str, Callable[[Asked], Iterable[str]]] = {
    "PACKAGE": _packages,
    "EXECUTABLE": _executables,
    "LAUNCH_PACKAGE": _launch_packages,
    "LAUNCH_FILE": _launch_files,
    "LAUNCH_ARGUMENT": _launch_arguments,
    "NAME:=VALUE": _description_arguments,
    "NEW": _second_description,
    "MODEL": _models,
    "ENGINE": _engines,
    "WAV": _files,
    "TOPIC": _graph_names("topics"),
    "NODE": _graph_names("nodes"),
    "CONTAINER": _graph_names("nodes"),
    "SERVICE": _graph_names("services"),
    "ACTION": _graph_names("actions"),
    "TYPE": _types,
    "FILE|NAME": _detectors,
    **dict.fromkeys(("IMAGE", "FILE", "FOLDER", "DIR", "OUT", "BAG", "FILE|FOLDER|NAME:=VALUE"), _files),
}
