"""``linkwright dataset``: render labeled images of worlds, to train a detector."""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.cli.exit_status import FINE, print_message
from linkwright.cli.numbers import positive_int, unsigned_int
from linkwright.diagnostics import counted, display_path, phrase
from linkwright.diagnostics.translation import localized
from linkwright.process.interruption import INTERRUPTED
from linkwright.vision.datasets.options import FORMATS

if TYPE_CHECKING:
    from linkwright.vision.datasets.rendering import DatasetRenderer

_MIN_SIDE, _MAX_SIDE = 32, 4096
_FIXABLE_PROPERTIES = ("lights", "colors", "lens")


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``dataset``."""
    parser.add_argument("worlds", metavar="WORLD", nargs="+", help="SDF files, or names of worlds")
    parser.add_argument("--output", "-o", metavar="DIR", required=True, help="the folder of the dataset")
    parser.add_argument(
        "--images",
        "-n",
        metavar="N",
        type=positive_int,
        default=1000,
        help="the number of images to render (default: 1000)",
    )
    parser.add_argument("--seed", metavar="N", type=unsigned_int, default=0, help="the random seed (default: 0)")
    parser.add_argument(
        "--size",
        metavar="WIDTHxHEIGHT",
        type=_parse_size,
        default=(640, 480),
        help="the size of images (default: 640x480)",
    )
    parser.add_argument(
        "--format",
        metavar="FORMATS",
        type=_parse_formats,
        default=FORMATS,
        help="coco, yolo or both (default: coco,yolo)",
    )
    parser.add_argument(
        "--image-format", choices=("jpg", "png"), default="jpg", help="the file format of images (default: %(default)s)"
    )
    parser.add_argument(
        "--classes", metavar="FILE", help="a YAML file of classes and their models (default: one class per model)"
    )
    parser.add_argument(
        "--add",
        metavar="FILE",
        action="append",
        default=[],
        help="the URDF, xacro or SDF file of a robot or model to add to each world; may be repeated",
    )
    parser.add_argument(
        "--splits",
        metavar="TRAIN,VAL,TEST",
        type=_parse_splits,
        default=(0.8, 0.1, 0.1),
        help="the fractions of images for training, validation and testing (default: 0.8,0.1,0.1)",
    )
    parser.add_argument(
        "--copies",
        metavar="N",
        type=unsigned_int,
        default=3,
        help="the minimum number of objects of each class (default: 3)",
    )
    parser.add_argument(
        "--most",
        metavar="N",
        type=positive_int,
        default=8,
        help="the maximum number of objects placed in an image (default: 8)",
    )
    parser.add_argument(
        "--distractors",
        metavar="N",
        type=unsigned_int,
        default=6,
        help="the number of shapes without a label (default: 6)",
    )
    parser.add_argument(
        "--keep",
        metavar="PROPERTIES",
        type=_parse_fixed_properties,
        default=(),
        help="properties not to randomize: lights, colors, lens (no blur, no noise), separated by commas",
    )
    parser.add_argument(
        "--min-size",
        metavar="PIXELS",
        type=unsigned_int,
        default=12,
        help="ignore objects whose bounding box has a side shorter than this many pixels (default: 12)",
    )
    parser.add_argument(
        "--min-visible",
        metavar="FRACTION",
        type=_parse_fraction,
        default=0.5,
        help="ignore objects of which less than this fraction is visible (default: 0.5)",
    )
    parser.add_argument(
        "--workers", metavar="N", type=positive_int, help="the number of processes (default: one for each processor)"
    )
    existing_group = parser.add_mutually_exclusive_group()
    existing_group.add_argument("--append", action="store_true", help="add images to the existing dataset")
    existing_group.add_argument("--force", action="store_true", help="replace the existing dataset")


def run(arguments: argparse.Namespace) -> int:
    """Render the data set, and return the exit status, which is 130 after an interruption."""
    from linkwright.vision.datasets.dataset import make_dataset
    from linkwright.vision.datasets.options import Options
    from linkwright.vision.datasets.statistics import format_table

    width, height = arguments.size
    options = Options(
        width=width,
        height=height,
        seed=arguments.seed,
        splits=arguments.splits,
        copies=arguments.copies,
        distractors=arguments.distractors,
        max_objects=arguments.most,
        fixed_properties=arguments.keep,
        min_size=arguments.min_size,
        min_visible=arguments.min_visible,
        image_format=arguments.image_format,
    )
    path = Path(arguments.output)
    progress = _Progress(arguments.images)
    result = make_dataset(
        arguments.worlds,
        path,
        arguments.images,
        models=arguments.add,
        classes=arguments.classes,
        options=options,
        formats=arguments.format,
        workers=arguments.workers,
        force=arguments.force,
        append=arguments.append,
        progress=progress.update,
        on_start=progress.show_method,
    )
    progress.end()
    print(format_table(result.folder.statistics()), end="")
    images = counted("{count} image", "{count} images", result.folder.count)
    print(localized(phrase("{images} in {folder}", images=images, folder=display_path(path))))
    if result.was_interrupted:
        message = phrase(
            "{done} of {count} images were rendered; the dataset can be used, and `--append` adds more images",
            done=result.added,
            count=arguments.images,
        )
        print_message(localized(message))
        return INTERRUPTED
    return FINE


class _Progress:
    """The progress line of the command, which is printed only to a terminal."""

    def __init__(self, count: int) -> None:
        self._count = count
        self._start_time = 0.0
        self._is_terminal = sys.stderr.isatty()

    def show_method(self, renderer: DatasetRenderer) -> None:
        """Print the classes and the rendering method."""
        print_message(localized(phrase("Classes: {names}", names=", ".join(renderer.classes))))
        print_message(localized(phrase("Rendering images with {renderer}", renderer=renderer.render_method)))
        if renderer.unused:
            print_message(
                localized(
                    phrase("These worlds have no object of the classes {names}", names=", ".join(renderer.unused))
                )
            )
        self._start_time = time.monotonic()

    def update(self, finished_count: int) -> None:
        """Show the number of finished images."""
        if self._is_terminal:
            rate = finished_count / max(time.monotonic() - self._start_time, 1e-9)
            text = localized(phrase("{done} of {count} images, {rate} a second", done=finished_count, count=self._count,
                                     rate=f"{rate:.1f}"))  # fmt: skip
            print(f"\r{text}\x1b[K", end="", file=sys.stderr, flush=True)

    def end(self) -> None:
        """End the progress line."""
        if self._is_terminal:
            print(file=sys.stderr)


def _parse_size(text: str) -> tuple[int, int]:
    width, separator, height = text.partition("x")
    sides = [int(side) if side.isascii() and side.isdigit() and len(side) < 6 else 0 for side in (width, height)]
    if not separator or not all(_MIN_SIDE <= side <= _MAX_SIDE for side in sides):
        raise argparse.ArgumentTypeError(
            f"'{text}' is not WIDTHxHEIGHT with sides from {_MIN_SIDE} to {_MAX_SIDE} pixels"
        )
    return sides[0], sides[1]


def _parse_formats(text: str) -> tuple[str, ...]:
    return _parse_choices(text, FORMATS)


def _parse_fixed_properties(text: str) -> tuple[str, ...]:
    return _parse_choices(text, _FIXABLE_PROPERTIES)


def _parse_choices(text: str, choices: tuple[str, ...]) -> tuple[str, ...]:
    names = text.split(",")
    if not set(names) <= set(choices):
        raise argparse.ArgumentTypeError(f"'{text}' is not a comma-separated list of {', '.join(choices)}")
    return tuple(name for name in choices if name in names)


def _parse_fraction(text: str) -> float:
    try:
        fraction = float(text)
    except ValueError:
        fraction = -1.0
    if not 0.0 <= fraction <= 1.0:
        raise argparse.ArgumentTypeError(f"'{text}' is not a number from 0 to 1")
    return fraction


def _parse_splits(text: str) -> tuple[float, float, float]:
    try:
        fractions = [float(word) for word in text.split(",")]
    except ValueError:
        fractions = []
    total = sum(fractions)
    if len(fractions) != 3 or not all(0.0 <= fraction < 1e6 for fraction in fractions) or not total > 0.0:
        raise argparse.ArgumentTypeError(f"'{text}' is not three numbers, such as 0.8,0.1,0.1")
    return fractions[0] / total, fractions[1] / total, fractions[2] / total
