"""Options that ``linkwright sim``, ``drive`` and ``spawn`` share, and reading the models for a simulation."""

from __future__ import annotations

import argparse
import sys
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from linkwright.diagnostics import Diagnostic, phrase, print_diagnostics

if TYPE_CHECKING:
    from collections.abc import Mapping
    from contextlib import AbstractContextManager

    from linkwright.bag import BagWriter
    from linkwright.descriptions import Description
    from linkwright.packages import PackageFinder
    from linkwright.sdf.models import Model


def add_simulation_options(parser: argparse.ArgumentParser) -> None:
    """Declare whether there is a page, how long simulated time goes on, and how fast."""
    parser.add_argument("--headless", action="store_true", help="without a page")
    parser.add_argument(
        "--seconds", metavar="S", type=positive, default=0.0, help="end after so many simulated seconds"
    )
    parser.add_argument(
        "--rate",
        metavar="FACTOR",
        type=_rate,
        default=0.0,
        help="simulated seconds in a real one, or max (default: as the world says)",
    )
    parser.add_argument(
        "--record",
        metavar="PATH",
        help="record all topics with their simulated times, as bag record -a does: into a folder, or a file NAME.mcap",
    )


def positive(text: str) -> float:
    """A positive number of seconds.

    Raises:
        argparse.ArgumentTypeError: it is none.
    """
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0.0 < value < 1e9:
        raise argparse.ArgumentTypeError(f"'{text}' is not a positive number of seconds")
    return value


def _rate(text: str) -> float:
    if text == "max":
        return -1.0
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0.0 < value < 1e6:
        raise argparse.ArgumentTypeError(f"'{text}' is neither a positive number nor max")
    return value


def add_place_options(parser: argparse.ArgumentParser) -> None:
    """Declare where a robot begins."""
    parser.add_argument("-x", metavar="M", type=float, default=0.0, help="where the robot begins, along x (m)")
    parser.add_argument("-y", metavar="M", type=float, default=0.0, help="the same along y")
    parser.add_argument("-z", metavar="M", type=float, default=0.0, help="the same upwards")
    parser.add_argument("-Y", metavar="RAD", type=float, default=0.0, help="how far the robot is turned (rad)")


def recording(arguments: argparse.Namespace) -> AbstractContextManager[BagWriter | None]:
    """The recording that `add_simulation_options` asks for, which is closed at the end of the block; None for none.

    Raises:
        LinkwrightError: BAG105, the folder or file exists or cannot be made; BAG107, `rosbags` is not installed.
    """
    if arguments.record is None:
        return nullcontext()
    from linkwright.bag import BagWriter

    return BagWriter(arguments.record, single_file=Path(arguments.record).suffix == ".mcap")


class LoadedModel(NamedTuple):
    """A model that is put into a world.

    Attributes:
        text: URDF or SDF.
        name: the one that it says.
        description: of a robot in URDF; None for a model in SDF.
    """

    text: str
    name: str
    description: Description | None


def load_model(path: Path, values: Mapping[str, str], finder: PackageFinder) -> LoadedModel | None:
    """Read a robot or model; None where it is wrong, which has been told then.

    Args:
        path: URDF, xacro or SDF.
        values: name -> value of the xacro arguments.
        finder: where packages are.
    """
    from linkwright.descriptions import examine, is_world
    from linkwright.descriptions.conversion import as_sdf

    if is_world(path.name):
        from linkwright.sdf.writer import save

        converted = as_sdf(path, finder, arguments=dict(values), folder=Path.cwd())
        if converted.sdf is None or not converted.sdf.models:
            print_diagnostics(converted.diagnostics or [_no_model(path)], sys.stderr)
            return None
        if converted.diagnostics:
            print_diagnostics(converted.diagnostics, sys.stderr)
        model = _found_beside(converted.sdf.models[0], path.parent, finder)
        return LoadedModel(save(model), model.name, None)
    description = examine(path, arguments=dict(values), packages=finder)
    if description.robot is None or not description.robot.links:
        print_diagnostics(description.diagnostics, sys.stderr)
        return None
    return LoadedModel(description.text, description.robot.name, description)


def _found_beside(model: Model, folder: Path, finder: PackageFinder) -> Model:
    """A model whose addresses lead to what only its own folder has: a text has none."""
    from linkwright.descriptions.conversion import with_addresses
    from linkwright.packages import PackageFinder
    from linkwright.sdf.resources import Missing, ResourceFinder

    here, beside = ResourceFinder(PackageFinder(start=[Path.cwd()])), ResourceFinder(finder)

    def whole(written: str, written_in: Path) -> str:
        if not written or not isinstance(here.file(written, Path.cwd()), Missing):
            return written
        found = beside.file(written, written_in)
        return written if isinstance(found, Missing) else found.absolute().as_uri()

    changed: Model = with_addresses(model, folder, whole)
    return changed


def _no_model(path: Path) -> Diagnostic:
    message = phrase("there is no model in '{path}'", path=str(path))
    return Diagnostic("CLI331", message, hint=phrase("the robot is to be URDF, xacro, or SDF with a <model>"))
