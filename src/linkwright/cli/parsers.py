"""The argument parsers of commands, which extend argparse with suggestions and translation."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable, Iterator

from linkwright.cli.language import translate_help
from linkwright.diagnostics import did_you_mean
from linkwright.diagnostics.translation import language
from linkwright.loading.lean_typing import Any, NoReturn


def make_parser(
    program: str, description: str, configure: Callable[[argparse.ArgumentParser], None]
) -> argparse.ArgumentParser:
    """Return a parser whose texts are in the user's language.

    Args:
        program: the program's name in usage lines.
        description: the description of the program in the help.
        configure: declares the arguments.
    """
    parser = _Parser(prog=program, description=description, formatter_class=_make_formatter)
    configure(parser)
    _translate_help(parser)
    return parser


class _Parser(argparse.ArgumentParser):
    """An argument parser that suggests similar options.

    It raises errors that occur when help is printed.

    argparse itself ignores such errors.
    """

    def error(self, message: str) -> NoReturn:
        """Print a usage error with a suggestion for a misspelled option, and end the process."""
        suggestion = None
        unrecognized_prefix = translate_help("unrecognized arguments: %s").removesuffix("%s")
        if message.startswith(f"{unrecognized_prefix}-"):
            option = message.removeprefix(unrecognized_prefix).split()[0].partition("=")[0]
            suggestion = did_you_mean(option, _find_long_options(self))
        super().error(f"{message}; {suggestion}" if suggestion else message)

    def _print_message(self, message: str, file: Any = None) -> None:
        if file is sys.stdout:
            file.write(message)
        else:
            super()._print_message(message, file)


def _find_long_options(parser: argparse.ArgumentParser) -> Iterator[str]:
    """Yield the long options of a parser and its subparsers."""
    for action in parser._actions:
        yield from (name for name in action.option_strings if name.startswith("--"))
        if isinstance(action, argparse._SubParsersAction):
            for subparser in action.choices.values():
                yield from _find_long_options(subparser)


def _make_formatter(prog: str) -> argparse.HelpFormatter:
    """Return a help formatter as wide as the terminal.

    To determine the width itself, argparse would import many modules.
    """
    try:
        columns = int(os.environ.get("COLUMNS", "0")) or os.get_terminal_size().columns
    except (ValueError, OSError):
        columns = 80
    return argparse.HelpFormatter(prog, width=columns - 2)


# Replace the function with which argparse translates its own messages, such as "the following arguments are required".
# argparse uses gettext by default, which searches for catalogs that do not exist and imports `locale` to do so.
argparse._ = translate_help  # type: ignore[attr-defined]  # argparse imports gettext under this name


def _translate_help(parser: argparse.ArgumentParser) -> None:
    """Translate the texts of a parser and its subparsers into the user's language."""
    if language() != "en":
        _translate_parser(parser)


def _translate_parser(parser: argparse.ArgumentParser) -> None:
    parser.description = translate_help(parser.description or "")
    for group in parser._action_groups:
        group.title = translate_help(group.title or "")
    for action in parser._actions:
        if action.help and action.help != argparse.SUPPRESS:
            action.help = translate_help(action.help)
        if isinstance(action, argparse._SubParsersAction):
            for choice in action._choices_actions:
                choice.help = translate_help(choice.help or "")
            for subparser in action.choices.values():
                _translate_parser(subparser)
