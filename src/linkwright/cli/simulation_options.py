"""The shared options of ``linkwright sim``, ``drive`` and ``spawn``, and model loading."""

from __future__ import annotations

import argparse
import sys
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase, print_diagnostics

if TYPE_CHECKING:
    from collections.abc import Mapping
    from contextlib import AbstractContextManager

    from linkwright.bag import BagWriter
    from linkwright.descriptions import Description
    from linkwright.packages import PackageFinder
    from linkwright.sdf.models import Model


def add_simulation_options(parser: argparse.ArgumentParser) -> None:
    """Declare the options for the page, the duration and the rate of a simulation."""
    group = parser.add_argument_group(title="simulation")
    group.add_argument("--headless", action="store_true", help="run without a page in the browser")
    group.add_argument(
        "--seconds",
        metavar="S",
        type=parse_positive_seconds,
        default=0.0,
        help="stop after this many simulated seconds",
    )
    group.add_argument(
        "--rate",
        metavar="FACTOR",
        type=_parse_rate,
        default=0.0,
        help="simulated seconds per real second, or max (default: the world's)",
    )
    group.add_argument(
        "--record",
        metavar="PATH",
        help="record all topics with simulated time, as bag record -a does, into a folder or a file NAME.mcap",
    )


def refuse_terminal_without_page(arguments: argparse.Namespace) -> None:
    """Refuse ``--terminal`` beside ``--headless``.

    Raises:
        LinkwrightError: CLI334, both are given.
    """
    if arguments.headless and arguments.terminal:
        message = phrase("`--terminal` opens a shell in the page, but `--headless` runs without a page")
        raise LinkwrightError(Diagnostic("CLI334", message, hint=phrase("leave out one of the two options")))


def parse_positive_seconds(text: str) -> float:
    """Parse a positive number of seconds, below 1e9.

    Raises:
        argparse.ArgumentTypeError: the text is not such a number.
    """
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0.0 < value < 1e9:
        raise argparse.ArgumentTypeError(f"'{text}' is not a positive number of seconds")
    return value


def _parse_rate(text: str) -> float:
    if text == "max":
        return -1.0
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0.0 < value < 1e6:
        raise argparse.ArgumentTypeError(f"'{text}' is neither a positive number nor max")
    return value


def add_pose_options(parser: argparse.ArgumentParser) -> None:
    """Declare the options for the initial pose of a robot."""
    group = parser.add_argument_group(title="initial pose")
    group.add_argument("-x", metavar="M", type=float, default=0.0, help="the initial x of the robot (m)")
    group.add_argument("-y", metavar="M", type=float, default=0.0, help="the initial y (m)")
    group.add_argument("-z", metavar="M", type=float, default=0.0, help="the initial z (m)")
    group.add_argument("-Y", metavar="RAD", type=float, default=0.0, help="the initial yaw of the robot (rad)")


def open_recording(arguments: argparse.Namespace) -> AbstractContextManager[BagWriter | None]:
    """Return a context that yields the writer of the requested recording, or None.

    Raises:
        LinkwrightError: BAG105, the folder or file exists or cannot be created; BAG107, `rosbags` is not installed.
    """
    if arguments.record is None:
        return nullcontext()
    from linkwright.bag import BagWriter

    return BagWriter(arguments.record, single_file=Path(arguments.record).suffix == ".mcap")


class LoadedModel(NamedTuple):
    """A model to add to a world.

    Attributes:
        text: the model in URDF or SDF.
        name: the model's name in the file.
        description: the description of a robot in URDF; None for a model in SDF.
    """

    text: str
    name: str
    description: Description | None


def load_model(path: Path, values: Mapping[str, str], finder: PackageFinder) -> LoadedModel | None:
    """Load a robot or model.

    If it cannot be loaded, print the errors and return None.

    Args:
        path: a URDF, xacro or SDF file.
        values: the values of xacro arguments by name.
        finder: the package finder.
    """
    from linkwright.descriptions import examine, is_world
    from linkwright.descriptions.conversion import as_sdf

    if is_world(path.name):
        from linkwright.sdf.writer import save

        converted = as_sdf(path, finder, arguments=dict(values), folder=Path.cwd())
        if converted.sdf is None or not converted.sdf.models:
            print_diagnostics(converted.diagnostics or [_no_model_error(path)], sys.stderr)
            return None
        if converted.diagnostics:
            print_diagnostics(converted.diagnostics, sys.stderr)
        model = _with_absolute_uris(converted.sdf.models[0], path.parent, finder)
        return LoadedModel(save(model), model.name, None)
    description = examine(path, arguments=dict(values), packages=finder)
    if description.robot is None or not description.robot.links:
        print_diagnostics(description.diagnostics, sys.stderr)
        return None
    return LoadedModel(description.text, description.robot.name, description)


def _with_absolute_uris(model: Model, folder: Path, finder: PackageFinder) -> Model:
    """Return the model with absolute URIs for files that only the model's own folder resolves.

    The model is passed on as text, and thereby loses its folder.
    """
    from linkwright.descriptions.conversion import with_changed_uris
    from linkwright.packages import PackageFinder
    from linkwright.sdf.resources import Missing, ResourceFinder

    folder_finder, package_finder = ResourceFinder(PackageFinder(start=[Path.cwd()])), ResourceFinder(finder)

    def resolve(uri: str, uri_folder: Path) -> str:
        if not uri or not isinstance(folder_finder.file(uri, Path.cwd()), Missing):
            return uri
        path = package_finder.file(uri, uri_folder)
        return uri if isinstance(path, Missing) else path.absolute().as_uri()

    changed_model: Model = with_changed_uris(model, folder, resolve)
    return changed_model


def _no_model_error(path: Path) -> Diagnostic:
    message = phrase("the file '{path}' contains no model", path=str(path))
    return Diagnostic("CLI331", message, hint=phrase("use a URDF or xacro file, or an SDF file with a <model>"))
