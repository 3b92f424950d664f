"""``linkwright interface``: the types of messages, services and actions."""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Callable, Iterator
from functools import partial

from linkwright.cli.nested import SubVerb, configure_nested, run_nested
from linkwright.diagnostics import Diagnostic, LinkwrightError, did_you_mean, phrase

_TITLES = {"msg": "Messages:", "srv": "Services:", "action": "Actions:"}
_FIELD = re.compile(r"\s*(?P<type>[A-Za-z]\w*(?:/[A-Za-z]\w*)*)[^\s#]*\s+[A-Za-z]\w*\s*(?P<equals>=)?")
_SIZED = frozenset(f"{kind}{bits}" for kind in ("int", "uint") for bits in (8, 16, 32, 64))
_PRIMITIVES = _SIZED | {"bool", "byte", "char", "float32", "float64", "string", "wstring"}
_DEEPEST = 50


def _add_kind_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare ``--only-msgs``, ``--only-srvs`` and ``--only-actions``."""
    parser.add_argument("-m", "--only-msgs", dest="msg", action="store_true", help="only message types")
    parser.add_argument("-s", "--only-srvs", dest="srv", action="store_true", help="only service types")
    parser.add_argument("-a", "--only-actions", dest="action", action="store_true", help="only action types")


def _kinds(arguments: argparse.Namespace) -> list[str]:
    """The kinds asked for: ``msg``, ``srv``, ``action``; all when none is."""
    return [kind for kind in _TITLES if getattr(arguments, kind)] or list(_TITLES)


def configure_list(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    _add_kind_arguments(parser)


def run_list(arguments: argparse.Namespace) -> int:
    """Print their names, by kind, as ros2 does."""
    from linkwright.messages import interface_names

    for kind in _kinds(arguments):
        print(_TITLES[kind])
        for name in interface_names(kind):
            print(f"    {name}")
    return 0


def configure_packages(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    _add_kind_arguments(parser)


def run_packages(arguments: argparse.Namespace) -> int:
    """Print their names, a line each."""
    from linkwright.messages import interface_names

    for package in sorted({name.split("/")[0] for kind in _kinds(arguments) for name in interface_names(kind)}):
        print(package)
    return 0


def configure_package(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument("package_name", metavar="PACKAGE", help="such as example_interfaces")
    _add_kind_arguments(parser)


def run_package(arguments: argparse.Namespace) -> int:
    """Print their names, a line each."""
    from linkwright.messages import interface_names

    package = arguments.package_name
    known = {kind: interface_names(kind) for kind in ("msg", "srv", "action")}
    packages = sorted({name.split("/")[0] for names in known.values() for name in names})
    if package not in packages:
        hint = did_you_mean(package, packages) or phrase("`linkwright interface packages` lists those with types")
        raise LinkwrightError(Diagnostic("CLI441", phrase("Unknown package '{package}'", package=package), hint=hint))
    names = [name for kind in _kinds(arguments) for name in known[kind]]
    for name in sorted(name for name in names if name.startswith(f"{package}/")):
        print(name)
    return 0


def configure_show(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    group = parser.add_mutually_exclusive_group()
    group.add_argument("--all-comments", action="store_true", help="print the comments of nested types too")
    group.add_argument("--no-comments", action="store_true", help="print no comments and no blank lines")
    parser.add_argument("type", metavar="TYPE", help="such as std_msgs/msg/String; '-' reads it from standard input")


def run_show(arguments: argparse.Namespace) -> int:
    """Print the definition, as ros2 does."""
    from linkwright.messages import definition_text, get_interface

    name = arguments.type
    if name == "-":
        name = sys.stdin.readline().strip()
        if not name:
            raise LinkwrightError(Diagnostic("CLI442", phrase("there is no type on standard input")))
    name = get_interface(name).TYPE_NAME
    lines = definition_lines(
        name,
        definition_text,
        comments=not arguments.no_comments,
        nested_comments=arguments.all_comments,
    )
    for line in lines:
        print(line)
    return 0


def configure_proto(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument("type", metavar="TYPE", help="such as std_msgs/msg/String")
    parser.add_argument("--no-quotes", action="store_true", help="leave the quotes around it out")


def run_proto(arguments: argparse.Namespace) -> int:
    """Print it: of a service the request, of an action the goal, as ros2 does."""
    from linkwright.messages import prototype

    text = prototype(arguments.type)
    print(text if arguments.no_quotes else f'"{text}"')
    return 0


def definition_lines(
    name: str, source: Callable[[str], str], *, comments: bool = True, nested_comments: bool = False
) -> Iterator[str]:
    """The lines of a definition.

    Args:
        name: ``package/kind/Name``.
        source: gives the text of the interface file of a name.
        comments: whether comments and blank lines are kept.
        nested_comments: whether they are kept in nested definitions.
    """
    yield from _lines(name, source, comments, nested_comments, 0)


def _lines(name: str, source: Callable[[str], str], comments: bool, nested_comments: bool, level: int) -> Iterator[str]:
    package = name.split("/", maxsplit=1)[0]
    for line in source(name).splitlines():
        line = line.rstrip()
        shown = line if comments else _without_comment(line).rstrip()
        if shown:
            yield "\t" * level + shown
        elif comments:
            yield ""
        nested = nested_type(line, package)
        if nested is not None and level < _DEEPEST:
            yield from _lines(nested, source, nested_comments, nested_comments, level + 1)


def nested_type(line: str, package: str) -> str | None:
    """The message type that a line of a definition has a field of, in full; None for anything else."""
    found = _FIELD.match(line)
    if found is None or found["equals"] or found["type"] in _PRIMITIVES:
        return None
    parts = found["type"].split("/")
    if parts == ["Header"]:
        return "std_msgs/msg/Header"
    if len(parts) == 1:
        return f"{package}/msg/{parts[0]}"
    return f"{parts[0]}/msg/{parts[-1]}"


def _without_comment(line: str) -> str:
    """The line before a ``#`` that does not stand in a text."""
    quote = ""
    for at, character in enumerate(line):
        if quote:
            quote = "" if character == quote else quote
        elif character in "\"'":
            quote = character
        elif character == "#":
            return line[:at]
    return line


VERBS = {
    "list": SubVerb(configure_list, run_list, help="list the types there are"),
    "package": SubVerb(configure_package, run_package, help="list the types of a package"),
    "packages": SubVerb(configure_packages, run_packages, help="list the packages that have types"),
    "proto": SubVerb(
        configure_proto, run_proto, help="print a message with its defaults, to be filled in and published"
    ),
    "show": SubVerb(configure_show, run_show, help="print the definition of a type, with those of the types in it"),
}

configure = partial(configure_nested, verbs=VERBS)
run = run_nested
