"""The ``linkwright`` command: finds and runs the subcommand, and reports errors.

Exit statuses: 0 success, 1 findings or an error in the user's input, 2 wrong usage, 3 a bug in Linkwright,
130 interrupted.
"""

from __future__ import annotations

import gc
import os
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from importlib import import_module

from linkwright._version import __version__
from linkwright.cli.exit_status import FINE, USAGE, run_command
from linkwright.cli.language import LANGUAGE_HELP, take_language, translate_help
from linkwright.diagnostics import did_you_mean
from linkwright.diagnostics.translation import set_language
from linkwright.loading.lean_typing import TYPE_CHECKING, Any, Protocol, cast
from linkwright.process.interruption import end_on_interrupt, raise_interrupts

if TYPE_CHECKING:
    import argparse

    from linkwright.cli.nested import SubVerb

COMMANDS = {
    "check": "check URDF, xacro and SDF files and whole packages; for one file, print its link tree",
    "format": "format the XML files of a package: descriptions, worlds, launch files, manifests",
    "xacro": "expand a xacro file to URDF, list its arguments, or explain its elements",
    "diff": "compare two descriptions, or a description with a commit: links, joints, origins, masses",
    "explain": "explain a diagnostic code, or an element or attribute of URDF",
    "inertia": "compare masses and inertias with the links' shapes, compute them, or write them",
    "convert": "convert a robot or world to SDF, to URDF, or to MJCF for MuJoCo",
    "picture": "draw a robot or world as a PNG file, or as an animation, without a browser",
}
"""The commands of linkwright-core, with their help texts.

`linkwright.cli.workbench` contains the other commands.
Each command is a module of this package, which is loaded only when the command runs.
"""

_ENGINE_GROUP = "robot descriptions"
"""The group of the help that has these commands."""

PROGRAM = "linkwright"

SUMMARY_HELP = (
    "A ROS 2 workbench for a robot: "
    "describe it, check it, see it, simulate it, drive it and test it, without installing ROS."
)
"""The description of Linkwright, the same in pyproject.toml, the READMEs and the documentation."""

MORE_HELP = "`linkwright COMMAND --help` describes a command. `linkwright --version` prints the version."

_OPTIONS = ("--help", "--lang", "--version")
"""The options that precede or replace a command."""

_GC_THRESHOLD = 50_000
"""The number of new objects that starts a garbage collection. With Python's 700, a short command would spend a tenth of
its time on garbage collection."""

_FIRST_GC_THRESHOLD = 200_000
"""The number of new objects that starts the first collection, because imports create many objects but no garbage."""


class Verb(Protocol):
    """The interface of a command's module."""

    def configure(self, parser: argparse.ArgumentParser) -> None:
        """Declare the command's arguments."""

    def run(self, arguments: argparse.Namespace) -> int:
        """Run the command and return the exit status."""


def main(words: Sequence[str] | None = None, *, program: str = PROGRAM) -> int:
    """Run the command line and return its exit status.

    The function never raises an exception.

    Args:
        words: the arguments after the program's name; None for the arguments of this process.
        program: the program's name in usage lines, such as ``ros2``; empty if the subcommand is itself a program.
    """
    is_program = words is None
    if is_program:
        _reduce_garbage_collection()
    try:
        return run_command(lambda: _dispatch(take_language(sys.argv[1:] if words is None else words), program))
    finally:
        set_language(None)
        if is_program:
            end_on_interrupt()
            gc.freeze()  # freeze all objects, so that Python skips its last garbage collection at exit


def _reduce_garbage_collection() -> None:
    def on_collection(phase: str, _: object) -> None:
        if phase == "stop" and gc.get_threshold()[0] == _FIRST_GC_THRESHOLD:
            gc.set_threshold(_GC_THRESHOLD)

    gc.set_threshold(_FIRST_GC_THRESHOLD)
    gc.callbacks.append(on_collection)


def find_command_groups() -> dict[str, dict[str, str]]:
    """Return the help texts of the installed commands, by group and name in help order."""
    workbench = _import_workbench()
    workbench_groups: dict[str, dict[str, str]] = {} if workbench is None else workbench.GROUPS
    engine_commands = {**workbench_groups.get(_ENGINE_GROUP, {}), **COMMANDS}
    return {
        _ENGINE_GROUP: engine_commands,
        **{title: verbs for title, verbs in workbench_groups.items() if title != _ENGINE_GROUP},
    }


def collect_help_texts() -> dict[str, str]:
    """Return the help text of each installed command."""
    return {name: text for verbs in find_command_groups().values() for name, text in verbs.items()}


def _import_workbench() -> Any:
    """Return the module that lists the commands of ``linkwright``.

    The result is None if only ``linkwright-core`` is installed.
    """
    try:
        return import_module("linkwright.cli.workbench")
    except ModuleNotFoundError:
        return None


def import_command(name: str) -> Verb:
    """Return the module of a command."""
    return cast("Verb", import_module(f"linkwright.cli.{name}"))


def create_parser(name: str, *, program: str = PROGRAM) -> argparse.ArgumentParser:
    """Return the argument parser of a command.

    Args:
        name: the name of the command.
        program: the program's name in usage lines; empty if the command is itself a program.
    """
    from linkwright.cli.parsers import make_parser  # importing argparse takes as long as expanding a small file

    module = import_command(name)
    prog = f"{program} {name}".strip()
    parser = make_parser(prog, COMMANDS.get(name) or collect_help_texts()[name], module.configure)
    if parser.usage is not None:
        parser.usage = parser.usage.replace(f"{PROGRAM} {name}", prog, 1)
    return parser


def _dispatch(words: list[str], program: str) -> int:
    if not words or words[0] in ("-h", "--help", "help"):
        print(_format_overview())
        return FINE if words else USAGE
    name = words[0]
    if name in ("-V", "--version"):
        print(f"linkwright {__version__}")
        return FINE
    workbench = None if name in COMMANDS else _import_workbench()
    if workbench is not None:
        name = workbench.OTHER_NAMES.get(name, name)
    if name not in COMMANDS and name not in collect_help_texts():
        return _report_unknown(name, _OPTIONS if name.startswith("-") else collect_help_texts(), program or PROGRAM)
    module = import_command(name)
    in_order = workbench is not None and name in workbench.ORDERED_COMMANDS
    parsed = _parse_without_options(module, words[1:]) or _parse(name, module, words, program, in_order=in_order)
    if isinstance(parsed, int):
        return parsed
    if workbench is None or name not in workbench.EVENT_LOOP_COMMANDS:
        raise_interrupts()
    return module.run(parsed)


def _parse_without_options(module: Verb, words: list[str]) -> argparse.Namespace | None:
    """Parse a command line without argparse, because creating a parser is slow.

    Returns:
        The arguments, or None if the line contains options or the command needs argparse.
    """
    parse_fast: Callable[[list[str]], argparse.Namespace | None] | None = getattr(module, "parse_without_options", None)
    return None if parse_fast is None or any(word.startswith("-") for word in words) else parse_fast(words)


def _parse(name: str, module: Verb, words: list[str], program: str, *, in_order: bool) -> argparse.Namespace | int:
    """Parse a command line with argparse, and return the arguments.

    If the subcommand is unknown, report it and return the exit status instead.
    """
    parser = create_parser(name, program=program)
    sub_verbs: Mapping[str, SubVerb] = getattr(module, "VERBS", {})
    default_verb: str | None = getattr(module, "DEFAULT_VERB", None)
    if default_verb is not None and _begins_without_verb(words[1:], sub_verbs):
        words = [words[0], default_verb, *words[1:]]
    if sub_verbs:
        sub_verb_name = next(iter(words[1:]), "-")
        if not sub_verb_name.startswith("-") and sub_verb_name not in sub_verbs:
            return _report_unknown(sub_verb_name, sub_verbs, parser.prog)
    is_intermixed = not sub_verbs and not in_order and any(word.startswith("-") for word in words)
    parse = parser.parse_intermixed_args if is_intermixed else parser.parse_args
    return parse(words[1:])


def _begins_without_verb(words: Sequence[str], verbs: Mapping[str, SubVerb]) -> bool:
    """Return whether words are arguments of a default subcommand.

    They are not if they begin with a subcommand, a misspelled one, or --help.
    """
    first_word = next(iter(words), "")
    if first_word in verbs or first_word in ("-h", "--help"):
        return False
    is_folder = first_word.startswith("-") or "/" in first_word or os.path.isdir(first_word)  # noqa: PTH112 - importing pathlib is slow
    return is_folder or did_you_mean(first_word, verbs) is None


def _report_unknown(name: str, names: Iterable[str], prog: str) -> int:
    """Report an unknown command or option, and return the exit status for wrong usage."""
    hint = did_you_mean(name, names) or f"`{prog} --help` lists the commands"
    if _import_workbench() is None:
        hint += "; only linkwright-core is installed, and linkwright has more commands"
    kind = "option" if name.startswith("-") else "command"
    print(f"{prog}: there is no {kind} '{name}'; {hint}", file=sys.stderr)
    return USAGE


def _format_overview() -> str:
    command_groups = find_command_groups()
    width = max(len(name) for verbs in command_groups.values() for name in verbs)
    lines = ["usage: linkwright COMMAND ...", "", translate_help(SUMMARY_HELP)]
    for title, verbs in command_groups.items():
        lines += ["", f"{translate_help(title)}:"]
        lines += [f"  {name:{width}}  {translate_help(text)}" for name, text in verbs.items()]
    lines += [
        "",
        f"{translate_help('options of all commands')}:",
        f"  --lang LANGUAGE  {translate_help(LANGUAGE_HELP)}",
    ]
    lines += ["", translate_help(MORE_HELP)]
    return "\n".join(lines)
