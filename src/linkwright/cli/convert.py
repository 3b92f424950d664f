"""``linkwright convert``: convert a robot or world to one SDF, URDF or MJCF file."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

from linkwright.cli.model_arguments import add_values
from linkwright.cli.output import write_output
from linkwright.diagnostics import Diagnostic, LinkwrightError, has_errors, phrase, print_diagnostics
from linkwright.process.assignments import parse_assignments

if TYPE_CHECKING:
    from linkwright.packages import PackageFinder
    from linkwright.sdf.worlds import Sdf

    Writer: TypeAlias = Callable[[Sdf, PackageFinder], tuple[str | None, Sequence[Diagnostic]]]

_FORMATS = ("sdf", "urdf", "mjcf")
_ENTRY_POINT_GROUP = "linkwright.model_formats"
"""The group of entry points that provide file formats. Each entry point is a `Writer`."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``convert``."""
    parser.add_argument("file", metavar="FILE", help="the URDF, xacro or SDF file")
    add_values(parser, values_help="values for the file's <xacro:arg>")
    parser.add_argument("-o", "--output", metavar="OUT", help="the file to write (default: standard output)")
    parser.add_argument(
        "--to",
        choices=_FORMATS,
        default="sdf",
        help="sdf: SDF 1.11, as gz converts a URDF, or a world with its includes resolved (default); urdf: the "
        "robot of an SDF model, as sdformat_urdf converts it; mjcf: a model for MuJoCo with embedded "
        "meshes",
    )
    fixed_joints_group = parser.add_mutually_exclusive_group()
    fixed_joints_group.add_argument(
        "--lump-fixed-joints",
        action="store_true",
        default=True,
        help="merge links of a URDF that fixed joints connect, as gz does (default)",
    )
    fixed_joints_group.add_argument(
        "--keep-fixed-joints",
        action="store_false",
        dest="lump_fixed_joints",
        help="keep all links and fixed joints of a URDF",
    )


def run(arguments: argparse.Namespace) -> int:
    """Convert a file, write or print the result, and return 1 if there are errors.

    Findings are printed to standard error.
    """
    from linkwright.descriptions.conversion import as_sdf
    from linkwright.descriptions.service import is_world
    from linkwright.packages import PackageFinder

    write_format = _find_writer(arguments.to)
    path = Path(arguments.file).absolute()
    if arguments.to == "urdf" and not is_world(path.name):
        hint = phrase("to expand a xacro file, run `linkwright xacro`")
        raise LinkwrightError(
            Diagnostic("CLI322", phrase("'{file}' is not an SDF file", file=arguments.file), hint=hint)
        )
    finder = PackageFinder(start=[path.parent, Path.cwd()])
    output_path = None if arguments.output is None else Path(arguments.output)
    converted = as_sdf(
        path,
        finder,
        arguments=parse_assignments(arguments.values),
        lump_fixed_joints=arguments.lump_fixed_joints,
        folder=None if output_path is None else output_path.absolute().parent,
    )
    print_diagnostics(converted.diagnostics, sys.stderr)
    if converted.sdf is None or (arguments.to != "sdf" and has_errors(converted.diagnostics)):
        return 1  # a URDF or MJCF file must be complete, so write nothing if there are errors
    text, diagnostics = write_format(converted.sdf, finder)
    print_diagnostics(diagnostics, sys.stderr)
    if text is None:
        return 1
    if output_path is None:
        sys.stdout.write(text)
    else:
        write_output(output_path, text)
        print(f"Created file {output_path}")
    return 1 if has_errors((*converted.diagnostics, *diagnostics)) else 0


def _write_sdf(sdf: Sdf, _finder: PackageFinder) -> tuple[str, Sequence[Diagnostic]]:
    from linkwright.sdf.writer import save

    return save(sdf), ()


def _write_urdf(sdf: Sdf, _finder: PackageFinder) -> tuple[str | None, Sequence[Diagnostic]]:
    from linkwright.sdf.to_urdf import robot_from_sdf
    from linkwright.urdf import save
    from linkwright.xmltree import Element

    element = sdf.worlds[0].element if sdf.worlds else sdf.models[0].element if sdf.models else None
    reading = robot_from_sdf(sdf, element or Element("sdf"))
    return None if reading.robot is None else save(reading.robot), reading.diagnostics


def _find_writer(format_name: str) -> Writer:
    """Return the function that writes a file format.

    Raises:
        LinkwrightError: CLI323, the package that provides the format is not installed.
    """
    if format_name in _WRITERS:
        return _WRITERS[format_name]
    from linkwright.loading.extensions import extensions

    entry_point = extensions(_ENTRY_POINT_GROUP).get(format_name)
    if entry_point is None:
        message = phrase("cannot write '{format}': linkwright-core is installed without linkwright", format=format_name)
        raise LinkwrightError(Diagnostic("CLI323", message, hint=phrase("install linkwright")))
    writer: Writer = entry_point.load()
    return writer


_WRITERS: dict[str, Writer] = {"sdf": _write_sdf, "urdf": _write_urdf}
