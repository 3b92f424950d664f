"""``linkwright interface``: list and show the types of messages, services and actions."""

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
_INTEGER_TYPES = frozenset(f"{kind}{bits}" for kind in ("int", "uint") for bits in (8, 16, 32, 64))
_PRIMITIVES = _INTEGER_TYPES | {"bool", "byte", "char", "float32", "float64", "string", "wstring"}
_MAX_DEPTH = 50


def _add_kind_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare ``--only-msgs``, ``--only-srvs`` and ``--only-actions``."""
    parser.add_argument("-m", "--only-msgs", dest="msg", action="store_true", help="list only message types")
    parser.add_argument("-s", "--only-srvs", dest="srv", action="store_true", help="list only service types")
    parser.add_argument("-a", "--only-actions", dest="action", action="store_true", help="list only action types")


def _find_requested_kinds(arguments: argparse.Namespace) -> list[str]:
    """Return the requested kinds (``msg``, ``srv``, ``action``), by default all."""
    return [kind for kind in _TITLES if getattr(arguments, kind)] or list(_TITLES)


def configure_list(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``interface list``."""
    _add_kind_arguments(parser)


def run_list(arguments: argparse.Namespace) -> int:
    """Print the type names by kind, as ros2 does."""
    from linkwright.messages import interface_names

    for kind in _find_requested_kinds(arguments):
        print(_TITLES[kind])
        for name in interface_names(kind):
            print(f"    {name}")
    return 0


def configure_packages(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``interface packages``."""
    _add_kind_arguments(parser)


def run_packages(arguments: argparse.Namespace) -> int:
    """Print the names of the packages that define interfaces, one per line."""
    from linkwright.messages import interface_names

    for package in sorted(
        {name.split("/")[0] for kind in _find_requested_kinds(arguments) for name in interface_names(kind)}
    ):
        print(package)
    return 0


def configure_package(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``interface package``."""
    parser.add_argument("package_name", metavar="PACKAGE", help="the package, such as example_interfaces")
    _add_kind_arguments(parser)


def run_package(arguments: argparse.Namespace) -> int:
    """Print the names of a package's interfaces, one per line."""
    from linkwright.messages import interface_names

    package = arguments.package_name
    names_by_kind = {kind: interface_names(kind) for kind in ("msg", "srv", "action")}
    packages = sorted({name.split("/")[0] for names in names_by_kind.values() for name in names})
    if package not in packages:
        hint = did_you_mean(package, packages) or phrase(
            "run `linkwright interface packages` to list the packages with types"
        )
        raise LinkwrightError(Diagnostic("CLI441", phrase("Unknown package '{package}'", package=package), hint=hint))
    names = [name for kind in _find_requested_kinds(arguments) for name in names_by_kind[kind]]
    for name in sorted(name for name in names if name.startswith(f"{package}/")):
        print(name)
    return 0


def configure_show(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``interface show``."""
    group = parser.add_mutually_exclusive_group()
    group.add_argument("--all-comments", action="store_true", help="also print the comments of nested types")
    group.add_argument("--no-comments", action="store_true", help="omit comments and blank lines")
    parser.add_argument(
        "type", metavar="TYPE", help="the type, such as std_msgs/msg/String; '-' reads it from standard input"
    )


def run_show(arguments: argparse.Namespace) -> int:
    """Print the definition of an interface, as ros2 does."""
    from linkwright.messages import definition_text, get_interface

    name = arguments.type
    if name == "-":
        name = sys.stdin.readline().strip()
        if not name:
            raise LinkwrightError(Diagnostic("CLI442", phrase("standard input does not contain a type")))
    name = get_interface(name).TYPE_NAME
    lines = format_definition(
        name,
        definition_text,
        comments=not arguments.no_comments,
        nested_comments=arguments.all_comments,
    )
    for line in lines:
        print(line)
    return 0


def configure_proto(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``interface proto``."""
    parser.add_argument("type", metavar="TYPE", help="the type, such as std_msgs/msg/String")
    parser.add_argument("--no-quotes", action="store_true", help="omit the quotes around the message")


def run_proto(arguments: argparse.Namespace) -> int:
    """Print a message with its default values, as ros2 does.

    For a service, this is the request; for an action, the goal.
    """
    from linkwright.messages import prototype

    text = prototype(arguments.type)
    print(text if arguments.no_quotes else f'"{text}"')
    return 0


def format_definition(
    name: str, read_definition: Callable[[str], str], *, comments: bool = True, nested_comments: bool = False
) -> Iterator[str]:
    """Yield the lines of an interface definition, with nested definitions indented.

    Args:
        name: the type, as ``package/kind/Name``.
        read_definition: returns the text of the interface file of a type.
        comments: whether to include comments and blank lines.
        nested_comments: whether to include the comments and blank lines of nested definitions.
    """
    yield from _format_definition(name, read_definition, comments, nested_comments, 0)


def _format_definition(
    name: str, read_definition: Callable[[str], str], comments: bool, nested_comments: bool, level: int
) -> Iterator[str]:
    package = name.split("/", maxsplit=1)[0]
    for line in read_definition(name).splitlines():
        line = line.rstrip()
        output_line = line if comments else _strip_comment(line).rstrip()
        if output_line:
            yield "\t" * level + output_line
        elif comments:
            yield ""
        nested_name = find_nested_type(line, package)
        if nested_name is not None and level < _MAX_DEPTH:
            yield from _format_definition(nested_name, read_definition, nested_comments, nested_comments, level + 1)


def find_nested_type(line: str, package: str) -> str | None:
    """Return the full name of the message type in a line that declares a field.

    The result is None if the line does not declare a field of a message type.
    """
    match = _FIELD.match(line)
    if match is None or match["equals"] or match["type"] in _PRIMITIVES:
        return None
    parts = match["type"].split("/")
    if parts == ["Header"]:
        return "std_msgs/msg/Header"
    if len(parts) == 1:
        return f"{package}/msg/{parts[0]}"
    return f"{parts[0]}/msg/{parts[-1]}"


def _strip_comment(line: str) -> str:
    """Return a line without its comment.

    A ``#`` in a string does not start a comment.
    """
    quote = ""
    for index, character in enumerate(line):
        if quote:
            quote = "" if character == quote else quote
        elif character in "\"'":
            quote = character
        elif character == "#":
            return line[:index]
    return line


VERBS = {
    "list": SubVerb(configure_list, run_list, help="list all types"),
    "package": SubVerb(configure_package, run_package, help="list the types of a package"),
    "packages": SubVerb(configure_packages, run_packages, help="list the packages that define types"),
    "proto": SubVerb(
        configure_proto, run_proto, help="print a message with its default values, ready to edit and publish"
    ),
    "show": SubVerb(configure_show, run_show, help="print the definition of a type and of its nested types"),
}

configure = partial(configure_nested, verbs=VERBS)
run = run_nested
