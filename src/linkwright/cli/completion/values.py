"""Candidates for the arguments of commands.

The candidates are packages, executables, launch files and their arguments, and names and types of the graph.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

from linkwright.cli.completion.graph_names import read_names
from linkwright.cli.completion.scripts import FILES
from linkwright.packages import PackageFinder, install_prefix, is_installed
from linkwright.packages.launch_files import find_launch_files_below

_LAUNCH_ARGUMENT = re.compile(
    r"""Declare(?:Boolean)?LaunchArgument\(\s*(?:name\s*=\s*)?["']([^"']+)["']"""
    r"""|<arg\s[^>]*?\bname\s*=\s*["']([^"']+)["']|-\s*arg:\s*\n\s+name:\s*["']?([\w./-]+)"""
)
_XACRO_ARGUMENT = re.compile(r"""<xacro:arg\s[^>]*?\bname\s*=\s*["']([^"']+)["']""")

_INTERFACE_KINDS = {"topic": ("msg",), "bag": ("msg",), "service": ("srv",), "action": ("action",)}

Request = tuple[list[str], list[str], Mapping[str, Any]]
"""A request for candidates of an argument.

It contains the names of the command and subcommand, the preceding positional arguments, and the table of commands.
"""


def find_argument_candidates(
    kind: str, path: list[str], positionals: list[str], table: Mapping[str, Any]
) -> Iterable[str]:
    """Return the candidates for an argument.

    Args:
        kind: the argument's name in the help.
        path: the names of the command and the subcommand, such as ``topic`` and ``echo``.
        positionals: the preceding positional arguments.
        table: the contents of ``commands.json``.
    """
    find_candidates = _FINDERS_BY_KIND.get(kind)
    return [] if find_candidates is None else find_candidates((path, positionals, table))


def _find_packages(request: Request) -> Iterable[str]:
    return sorted({*PackageFinder().packages(), *request[2]["executables"]})


def _find_executables(request: Request) -> Iterable[str]:
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


def _find_launch_packages(_: Request) -> Iterable[str]:
    return [*sorted(PackageFinder().packages()), FILES]


def _find_launch_files(request: Request) -> Iterable[str]:
    path_or_package = Path(request[1][0])
    if path_or_package.is_file():
        return _find_declared_arguments(path_or_package, _LAUNCH_ARGUMENT)
    share = PackageFinder().find(request[1][0])
    return [] if share is None else sorted(path.name for path in find_launch_files_below(share))


def _find_launch_arguments(request: Request) -> Iterable[str]:
    package, file = request[1][:2]
    if Path(package).is_file():
        return _find_declared_arguments(Path(package), _LAUNCH_ARGUMENT)
    share = PackageFinder().find(package)
    launch_file = next((path for path in find_launch_files_below(share) if path.name == file), None) if share else None
    return [] if launch_file is None else _find_declared_arguments(launch_file, _LAUNCH_ARGUMENT)


def _find_description_arguments(request: Request) -> Iterable[str]:
    paths = [Path(word) for word in request[1] if ":=" not in word]
    return [name for path in paths if path.is_file() for name in _find_declared_arguments(path, _XACRO_ARGUMENT)]


def _find_second_description(request: Request) -> Iterable[str]:
    return [*_find_description_arguments(request), FILES]


def _find_declared_arguments(path: Path, pattern: re.Pattern[str]) -> list[str]:
    """Return the arguments that a launch file or xacro file declares.

    The file is searched with a regular expression, because executing it takes too long.
    """
    text = path.read_text(encoding="utf-8", errors="replace")
    names = (next(filter(None, match.groups())) for match in pattern.finditer(text))
    return [f"{name}:=" for name in dict.fromkeys(names)]


def _find_types(request: Request) -> Iterable[str]:
    path, _, table = request
    kinds = _INTERFACE_KINDS.get(path[0], ("msg", "srv", "action"))
    package_types = (
        f"{package}/{kind}/{file.stem}"
        for package, share in PackageFinder().packages().items()
        for kind in kinds
        for file in (share / kind).glob(f"*.{kind}")
    )
    return sorted({*(name for kind in kinds for name in table["types"][kind]), *package_types})


def _graph_names(kind: str) -> Callable[[Request], Iterable[str]]:
    return lambda _: read_names(kind)


def _find_detectors(request: Request) -> Iterable[str]:
    from linkwright.vision.detectors.registry import detector_names

    return [*detector_names(), *_find_files(request)]


def _find_models(_: Request) -> Iterable[str]:
    from linkwright.model_files import model_table

    return model_table()


def _find_engines(_: Request) -> Iterable[str]:
    from linkwright.speech.engine import engine_names

    return engine_names()


def _find_files(_: Request) -> Iterable[str]:
    return [FILES]


_FINDERS_BY_KIND: dict[str, Callable[[Request], Iterable[str]]] = {
    "PACKAGE": _find_packages,
    "EXECUTABLE": _find_executables,
    "LAUNCH_PACKAGE": _find_launch_packages,
    "LAUNCH_FILE": _find_launch_files,
    "LAUNCH_ARGUMENT": _find_launch_arguments,
    "NAME:=VALUE": _find_description_arguments,
    "NEW": _find_second_description,
    "MODEL": _find_models,
    "ENGINE": _find_engines,
    "WAV": _find_files,
    "TOPIC": _graph_names("topics"),
    "NODE": _graph_names("nodes"),
    "CONTAINER": _graph_names("nodes"),
    "SERVICE": _graph_names("services"),
    "ACTION": _graph_names("actions"),
    "TYPE": _find_types,
    "FILE|NAME": _find_detectors,
    **dict.fromkeys(("IMAGE", "FILE", "FOLDER", "DIR", "OUT", "BAG", "FILE|FOLDER|NAME:=VALUE"), _find_files),
}
