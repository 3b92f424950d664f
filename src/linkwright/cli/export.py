"""``linkwright export``: write a robot as one self-contained HTML file, or as glTF."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.cli.model_arguments import add_second_model, names_file, open_requested_pair
from linkwright.cli.output import write_output
from linkwright.diagnostics import (
    Diagnostic,
    LinkwrightError,
    Note,
    Severity,
    counted,
    display_path,
    foreign,
    phrase,
    print_diagnostics,
)
from linkwright.process.assignments import parse_assignments

if TYPE_CHECKING:
    from linkwright.descriptions.pairs import Pair


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``export``."""
    parser.add_argument(
        "out",
        metavar="OUT",
        help="the file to write: OUT.html shows the robot with joint sliders and needs neither a server nor a "
        "network; OUT.glb is glTF 2.0 with a node for each link",
    )
    parser.add_argument("file", metavar="FILE", help="the URDF or xacro file")
    add_second_model(parser)


def run(arguments: argparse.Namespace) -> int:
    """Write the export, and print its name."""
    from linkwright.panels.export.feature import FORMATS, find_format

    if find_format(arguments.out) is None:
        extensions = " or ".join(f".{ending}" for ending in FORMATS)
        order_hint = "; the file to write comes first" if find_format(arguments.file) is not None else ""
        print(f"linkwright export: '{arguments.out}' should end with {extensions}{order_hint}", file=sys.stderr)
        return 2
    with ExitStack() as stack:
        pair = None
        if arguments.against or any(map(names_file, arguments.words)):
            pair = open_requested_pair(arguments, stack)
            if pair is None or not arguments.out.lower().endswith(".html"):
                usage_error = "pass one file, two to compare, or one and --against COMMIT"
                extension_error = f"'{arguments.out}' should end with .html, as two descriptions are compared"
                print(f"linkwright export: {usage_error if pair is None else extension_error}", file=sys.stderr)
                return 2
        try:
            return _export(arguments, pair)
        except LinkwrightError as error:
            print_diagnostics(error.diagnostics, sys.stderr)
            return 1


def _export(arguments: argparse.Namespace, pair: Pair | None) -> int:
    """Export one description or a comparison of two, and return the exit status."""
    from linkwright.descriptions import DescriptionLibrary, examine
    from linkwright.descriptions.pairs import make_old_description_key
    from linkwright.packages import PackageFinder
    from linkwright.panels.export.feature import export_snapshot
    from linkwright.viewer.model_snapshot import OldDescription, take_model_snapshot

    library = DescriptionLibrary()
    old = None
    if pair is None:
        path = Path(arguments.file).absolute()
        finder = PackageFinder(start=[path.parent, Path.cwd()])
        description = examine(path, arguments=parse_assignments(arguments.words), packages=finder, xacro=True)
    else:
        finder, description, old_description = pair.new.finder, pair.new.read(), pair.old.read()
        old = OldDescription(
            pair, library.store(old_description, make_old_description_key(old_description), pair.old.finder)
        )
    text = library.store(description)
    print_diagnostics(description.diagnostics, sys.stderr)
    if description.robot is None or not description.robot.root:
        return 1  # without a root link, no link has a pose
    snapshot = take_model_snapshot(text, description.robot, library, finder, old)
    print_diagnostics(snapshot.problems, sys.stderr)
    data = export_snapshot(snapshot, arguments.out.rpartition(".")[2].lower())
    write_output(Path(arguments.out), data)
    print(f"Created file {arguments.out} ({_format_size(len(data))})")
    if snapshot.outside_files:
        print_diagnostics([_outside_files_warning(snapshot.outside_files)], sys.stderr)
    return 1 if snapshot.problems else 0


def _outside_files_warning(files: Sequence[Path]) -> Diagnostic:
    """Return a warning about exported files that are not in a package.

    Includes and ``file://`` URIs can refer to any file on the computer.
    """
    message = counted(
        "the export contains a file from outside the packages",
        "the export contains {count} files from outside the packages",
        len(files),
    )
    names = tuple(Note(foreign(display_path(path))) for path in files)
    hint = phrase("check that the contents may be published before you share the file")
    return Diagnostic("VIEW206", message, severity=Severity.WARNING, notes=names, hint=hint)


def _format_size(count: int) -> str:
    return f"{count / 1e6:.1f} MB" if count >= 1e6 else f"{max(1, round(count / 1e3))} kB"
