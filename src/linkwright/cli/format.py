"""``linkwright format``: write XML files of robot packages in a uniform layout."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.cli.exit_status import FINE, print_message
from linkwright.cli.numbers import positive_int
from linkwright.diagnostics import Diagnostic, LinkwrightError, counted, display_path, joined, phrase, print_diagnostics
from linkwright.diagnostics.translation import localized

if TYPE_CHECKING:
    from linkwright.xmltree.style import Style

_STDIN = "-"
_HAS_CHANGES = 1


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``format``."""
    parser.add_argument(
        "paths",
        metavar="FILE|FOLDER",
        nargs="*",
        default=["."],
        help="files to format, folders to search for descriptions, worlds, launch files and manifests in XML, or - for "
        "standard input (default: the current folder)",
    )
    parser.add_argument(
        "--check", action="store_true", help="change nothing; exit with status 1 if a file would change"
    )
    parser.add_argument(
        "--diff",
        action="store_true",
        help="change nothing; print the changes, and exit with the same status as --check",
    )
    parser.add_argument(
        "--indent",
        metavar="N",
        type=positive_int,
        help=("the number of spaces for each level of indentation (default: 2)"),
    )
    parser.add_argument(
        "--width", metavar="N", type=positive_int, help="the maximum length of a line, in characters (default: 120)"
    )
    parser.add_argument(
        "--range",
        metavar="FIRST-LAST",
        type=_parse_line_range,
        help="change only these lines, counted from 1, of a single file",
    )
    parser.add_argument(
        "--stdin-filename",
        metavar="NAME",
        help=("the file name to assume for standard input, which selects the settings"),
    )


def run(arguments: argparse.Namespace) -> int:
    """Format the files, and return the exit status."""
    from linkwright.lint.targets import find_xml_files

    if arguments.paths == [_STDIN]:
        return _format_stdin(arguments)
    files = find_xml_files(map(Path, arguments.paths))
    if not files:
        path_list = ", ".join(f"'{path}'" for path in arguments.paths)
        raise LinkwrightError(
            Diagnostic("CLI305", phrase("there is no XML file to format in {named}", named=path_list))
        )
    if arguments.range and len(files) > 1:
        hint = phrase("pass one file: linkwright format --range 10-20 robot.xacro")
        raise LinkwrightError(Diagnostic("CLI306", phrase("--range needs a single file"), hint=hint))
    dry_run = arguments.check or arguments.diff
    changes = [_format_file(file, arguments, dry_run=dry_run) for file in files]
    changed_count, has_failed = changes.count(True), None in changes
    _summarize(changed_count, changes.count(False), dry_run=dry_run)
    return _HAS_CHANGES if has_failed or (changed_count and dry_run) else FINE


def _format_file(file: Path, arguments: argparse.Namespace, *, dry_run: bool) -> bool | None:
    """Format a file, and return whether its contents change.

    The result is None if the file is not XML, or cannot be read or written.
    """
    try:
        return _format_or_raise(file, arguments, dry_run=dry_run)
    except LinkwrightError as error:
        print_diagnostics(error.diagnostics, sys.stderr)
        return None


def _format_or_raise(file: Path, arguments: argparse.Namespace, *, dry_run: bool) -> bool:
    from linkwright.lint.apply import make_unified_diff, write_text
    from linkwright.xmltree.decoding import decode_with_encoding
    from linkwright.xmltree.reader import read_bytes

    old_text, encoding = decode_with_encoding(read_bytes(file), str(file))
    new_text = _format_text(old_text, file, arguments)
    if new_text == old_text:
        return False
    if arguments.diff:
        sys.stdout.write(make_unified_diff(display_path(file), old_text, new_text))
    elif arguments.check:
        print(localized(phrase("would format {file}", file=display_path(file))))
    if not dry_run:
        write_text(file, new_text, encoding)
    return True


def _format_stdin(arguments: argparse.Namespace) -> int:
    from linkwright.lint.apply import make_unified_diff
    from linkwright.xmltree.decoding import decode_with_encoding

    name = arguments.stdin_filename or "<stdin>"
    old_text = decode_with_encoding(sys.stdin.buffer.read(), name).text
    new_text = _format_text(old_text, Path(arguments.stdin_filename or Path.cwd() / "stdin.xacro"), arguments, name)
    if arguments.diff:
        sys.stdout.write(make_unified_diff(name, old_text, new_text))
    elif not arguments.check:
        sys.stdout.buffer.write(new_text.encode("utf-8"))
    return _HAS_CHANGES if new_text != old_text and (arguments.check or arguments.diff) else FINE


def _format_text(text: str, file: Path, arguments: argparse.Namespace, name: str | None = None) -> str:
    from linkwright.xmltree.formatting import apply_edits, changes, format_text

    new_text = format_text(text, name or str(file), _read_style(file, arguments))
    return apply_edits(text, changes(text, new_text, arguments.range)) if arguments.range else new_text


def _read_style(file: Path, arguments: argparse.Namespace) -> Style:
    """Return the formatting style from the settings file, overridden by the command line."""
    from linkwright.lint.configuration import find_settings

    settings, diagnostics = find_settings(file)
    print_diagnostics(diagnostics, sys.stderr)
    style = settings.style
    return style._replace(indent=arguments.indent or style.indent, width=arguments.width or style.width)


def _summarize(changed_count: int, unchanged_count: int, *, dry_run: bool) -> None:
    parts = []
    if changed_count and dry_run:
        parts.append(counted("{count} file would be formatted", "{count} files would be formatted", changed_count))
    elif changed_count:
        parts.append(counted("{count} file formatted", "{count} files formatted", changed_count))
    if unchanged_count:
        parts.append(counted("{count} file left unchanged", "{count} files left unchanged", unchanged_count))
    if parts:  # there is nothing to summarize if every file has an error
        print_message(localized(joined(parts)))


def _parse_line_range(text: str) -> tuple[int, int]:
    """Parse a range of lines such as ``10-20`` to a 0-based, half-open range.

    Raises:
        argparse.ArgumentTypeError: the text is not such a range.
    """
    first, separator, last = text.partition("-")
    if not separator or not first.isdigit() or not last.isdigit() or not 0 < int(first) <= int(last):
        raise argparse.ArgumentTypeError("value must be two line numbers such as 10-20")
    return int(first) - 1, int(last)
