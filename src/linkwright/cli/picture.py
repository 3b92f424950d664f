"""``linkwright picture``: draw a robot or world as an image file, without a browser."""

from __future__ import annotations

import argparse
import math
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.cli.model_arguments import add_values
from linkwright.cli.output import write_output
from linkwright.diagnostics import Diagnostic, LinkwrightError, Severity, phrase, print_diagnostics, quoted_names
from linkwright.process.assignments import parse_assignments

if TYPE_CHECKING:
    from linkwright.packages import PackageFinder
    from linkwright.picture.camera import View
    from linkwright.picture.rendering import Style
    from linkwright.picture.scene import Scene

_MIN_SIDE, _MAX_SIDE, _MAX_PIXELS = 16, 16384, 25_000_000
_MAX_ANIMATED_PIXELS = 400_000_000
_MIN_SECONDS, _MAX_SECONDS = 0.5, 60.0
_DEFAULT_DURATION_S = 4


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``linkwright picture``."""
    parser.add_argument("file", metavar="FILE", help="the URDF, xacro or SDF file")
    add_values(parser, values_help="values for the file's <xacro:arg>")
    parser.add_argument(
        "-o",
        "--output",
        metavar="OUT",
        required=True,
        help="the file to write: OUT.png; with --turntable also OUT.webp",
    )
    parser.add_argument(
        "--view",
        type=_parse_view,
        default="iso",
        metavar="VIEW",
        help="iso, front, left or top, or AZIMUTH,ELEVATION of the camera in degrees: 0,0 is in front of the robot, "
        "90,0 on its left side; write --view=-30,20 for a negative azimuth (default: %(default)s)",
    )
    parser.add_argument(
        "--size",
        type=_parse_size,
        default="800x600",
        metavar="WIDTHxHEIGHT",
        help="the size in pixels (default: %(default)s)",
    )
    parser.add_argument(
        "--joint",
        type=_parse_joint,
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="the position of a joint in rad or m; repeat it for several joints (default: 0, or the middle of the "
        "limits where these exclude 0)",
    )
    parser.add_argument("--transparent", action="store_true", help="leave out the background")
    parser.add_argument("--grid", action="store_true", help="draw a grid on the ground, with x in red and y in green")
    parser.add_argument("--labels", choices=("links", "joints"), help="write the names of the links or joints")
    parser.add_argument(
        "--turntable",
        type=_parse_seconds,
        nargs="?",
        const=_DEFAULT_DURATION_S,
        metavar="SECONDS",
        help="write an animation of one turn, as APNG or WebP (default duration: %(const)s s)",
    )


def run(arguments: argparse.Namespace) -> int:
    """Write the file and print its name."""
    endings = (".png",) if arguments.turntable is None else (".png", ".webp")
    output = Path(arguments.output)
    if output.suffix.lower() not in endings:
        print(f"linkwright picture: '{output}' should end with {' or '.join(endings)}", file=sys.stderr)
        return 2
    if (
        arguments.turntable is not None
        and _compute_frame_count(arguments) * math.prod(arguments.size) > _MAX_ANIMATED_PIXELS
    ):
        limit = f"the images of an animation can have {_MAX_ANIMATED_PIXELS // 10**6} million pixels together"
        print(f"linkwright picture: {limit}; choose a smaller --size or fewer seconds", file=sys.stderr)
        return 2
    if output.suffix.lower() == ".webp":
        from linkwright.picture.animation import require_webp

        require_webp()
    scene = _read_scene(arguments)
    if scene is None:
        return 1
    print_diagnostics(scene.problems, sys.stderr)
    if not len(scene.mesh.faces):
        message = phrase("'{file}' has nothing to draw: none of its visuals can be drawn", file=arguments.file)
        raise LinkwrightError(Diagnostic("PIC110", message, hint=phrase("add a <visual> to a link")))
    style = _create_style(arguments, scene)
    if arguments.turntable is None:
        from linkwright.images.png import png
        from linkwright.picture.rendering import render

        data = png(render(scene, arguments.view, arguments.size, style))
    else:
        data = _render_animation(arguments, scene, style, output.suffix.lower())
    write_output(output, data)
    print(f"Created file {output}")
    return 1 if scene.problems else 0


def _read_scene(arguments: argparse.Namespace) -> Scene | None:
    """Print the findings about the file, and return its scene, or None if it cannot be drawn."""
    from linkwright.descriptions import examine, is_world
    from linkwright.packages import PackageFinder

    path = Path(arguments.file).absolute()
    finder = PackageFinder(start=[path.parent, Path.cwd()])
    values = parse_assignments(arguments.values)
    if is_world(path.name):
        return _read_world(arguments, path, finder)
    from linkwright.picture.robots import robot_scene

    description = examine(path, arguments=values, packages=finder, xacro=True)
    print_diagnostics(description.diagnostics, sys.stderr)
    if description.robot is None or not description.robot.root:
        return None
    return robot_scene(description.robot, finder, dict(arguments.joint), folder=path.parent)


def _read_world(arguments: argparse.Namespace, path: Path, finder: PackageFinder) -> Scene | None:
    from linkwright.descriptions import examine_world
    from linkwright.picture.worlds import world_scene
    from linkwright.sdf.frames import FrameError
    from linkwright.sdf.resources import ResourceFinder

    if arguments.joint:
        message = phrase("'{file}' is a world, but --joint moves only the joints of a robot", file=arguments.file)
        raise LinkwrightError(
            Diagnostic("PIC111", message, hint=phrase("pass a URDF or xacro file, or leave out --joint"))
        )
    world = examine_world(path, arguments=parse_assignments(arguments.values), packages=finder)
    print_diagnostics(world.diagnostics, sys.stderr)
    if world.sdf is None:
        return None
    try:
        return world_scene(world.sdf, ResourceFinder(finder))
    except FrameError as error:
        message = phrase(
            "'{file}' cannot be drawn: the pose of '{frame}' is not known", file=arguments.file, frame=error.name
        )
        raise LinkwrightError(Diagnostic("PIC112", message)) from None


def _create_style(arguments: argparse.Namespace, scene: Scene) -> Style:
    """Return the style of the image, and warn about labels that the font lacks."""
    from linkwright.picture.rendering import Style
    from linkwright.picture.stroke_font import is_drawable

    anchors = {"links": scene.labels.links, "joints": scene.labels.joints}.get(arguments.labels, ())
    names = [anchor.text for anchor in anchors if not is_drawable(anchor.text)]
    if names:
        message = phrase("letters of {names} are drawn as boxes: the font has ASCII only", names=quoted_names(names))
        print_diagnostics([Diagnostic("PIC104", message, severity=Severity.WARNING)], sys.stderr)
    return Style(transparent=arguments.transparent, grid=arguments.grid, labels=arguments.labels)


def _render_animation(arguments: argparse.Namespace, scene: Scene, style: Style, ending: str) -> bytes:
    """Return the file of a turn around a scene, and show its progress."""
    from linkwright.cli.progress import ProgressLine
    from linkwright.picture.animation import encode_animation
    from linkwright.picture.turntable import render_turntable

    count = _compute_frame_count(arguments)
    progress = ProgressLine()

    def report(finished_count: int) -> None:
        progress.show(phrase("drawing image {done} of {count}", done=finished_count, count=count))

    try:
        images = render_turntable(scene, arguments.view, arguments.size, style, count, report)
    finally:
        progress.end()
    return encode_animation(images, arguments.turntable / count, ending)


def _compute_frame_count(arguments: argparse.Namespace) -> int:
    """Return the number of images of an animation."""
    from linkwright.picture.turntable import FRAMES_PER_SECOND

    seconds: float = arguments.turntable
    return max(2, round(seconds * FRAMES_PER_SECOND))


def _parse_view(text: str) -> View:
    from linkwright.picture.camera import VIEWS, View

    if text in VIEWS:
        return VIEWS[text]
    azimuth, comma, elevation = text.partition(",")
    try:
        view = View(float(azimuth), float(elevation))
    except ValueError:
        comma = ""
    if not comma or not math.isfinite(view.azimuth) or not -90.0 <= view.elevation <= 90.0:
        names = ", ".join(VIEWS)
        raise argparse.ArgumentTypeError(f"'{text}' is not one of {names}, or AZIMUTH,ELEVATION in degrees")
    return view


def _parse_size(text: str) -> tuple[int, int]:
    width, _, height = text.lower().partition("x")
    if not (width.isascii() and width.isdigit() and height.isascii() and height.isdigit()):
        raise argparse.ArgumentTypeError(f"'{text}' is not WIDTHxHEIGHT in pixels, such as 800x600")
    sides = int(width), int(height)
    if not all(_MIN_SIDE <= side <= _MAX_SIDE for side in sides) or sides[0] * sides[1] > _MAX_PIXELS:
        raise argparse.ArgumentTypeError(
            f"each side must have {_MIN_SIDE} to {_MAX_SIDE} pixels, "
            f"and the image at most {_MAX_PIXELS // 10**6} million"
        )
    return sides


def _parse_joint(text: str) -> tuple[str, float]:
    name, _, value = text.rpartition("=")
    try:
        position = float(value)
    except ValueError:
        position = math.nan
    if not name or not math.isfinite(position):
        raise argparse.ArgumentTypeError(f"'{text}' is not NAME=VALUE with a number in rad or m")
    return name.removesuffix(":"), position


def _parse_seconds(text: str) -> float:
    try:
        seconds = float(text)
    except ValueError:
        seconds = math.nan
    if not _MIN_SECONDS <= seconds <= _MAX_SECONDS:
        raise argparse.ArgumentTypeError(f"'{text}' is not a duration from {_MIN_SECONDS:g} to {_MAX_SECONDS:g} s")
    return seconds
