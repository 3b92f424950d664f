"""``linkwright vision detect``: run a detector on image files."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.cli.numbers import fraction
from linkwright.cli.output import write_output
from linkwright.diagnostics import Diagnostic, LinkwrightError, did_you_mean, foreign, phrase, print_diagnostics

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from linkwright.vision.detections import Detections
    from linkwright.vision.detector import Detector

_MAX_FILE_SIZE = 200_000_000


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``vision detect``."""
    parser.add_argument("images", metavar="IMAGE", nargs="+", help="PNG and JPEG files")
    parser.add_argument(
        "-m",
        "--model",
        metavar="FILE|NAME",
        help="an ONNX file, or the name of a detector: things (default), colors, aruco, apriltag, qr, line",
    )
    parser.add_argument(
        "--labels", metavar="FILE", type=Path, help="a file with the names of the network's classes, one per line"
    )
    parser.add_argument(
        "--dictionary", metavar="NAME", help="the dictionary of the markers for aruco and apriltag, such as 6X6_250"
    )
    parser.add_argument(
        "--threshold", metavar="SCORE", type=fraction, default=0.5, help="the minimum score (default: 0.5)"
    )
    parser.add_argument(
        "--iou",
        metavar="FRACTION",
        type=fraction,
        default=0.5,
        help="the maximum overlap of boxes of one class, as intersection over union (default: 0.5)",
    )
    parser.add_argument("--classes", metavar="NAME", action="append", help="report only this class; may be repeated")
    parser.add_argument(
        "--device", default="cpu", help="the device on which a network runs: cpu (the default), or cuda:0"
    )
    parser.add_argument(
        "-o", "--output", metavar="FOLDER", type=Path, help="write the images with boxes to this folder"
    )
    parser.add_argument(
        "--format", choices=("text", "json"), default="text", help="the format of the printed detections"
    )


def run(arguments: argparse.Namespace) -> int:
    """Print the detections in each image.

    An image that cannot be read is reported and skipped.
    """
    from linkwright.vision.detector import Limits
    from linkwright.vision.detectors.markers import MarkerDetector
    from linkwright.vision.detectors.options import DetectorOptions
    from linkwright.vision.detectors.registry import DEFAULT_DETECTOR, make_detector
    from linkwright.vision.detectors.settings import setting_error

    settings = {} if arguments.dictionary is None else {"dictionary": arguments.dictionary}
    options = DetectorOptions(labels=arguments.labels, device=arguments.device, settings=settings)
    detector = make_detector(arguments.model or DEFAULT_DETECTOR, options)
    if settings and not isinstance(detector, MarkerDetector):
        hint = phrase("only 'aruco' and 'apriltag' have this option: leave it out")
        raise setting_error("dictionary", arguments.dictionary, hint)
    for note in detector.notes:
        print(note, file=sys.stderr)
    classes = _check_classes(detector, arguments.classes) if arguments.classes else None
    limits = Limits(arguments.threshold, arguments.iou, classes=classes)
    problems: list[Diagnostic] = []
    rows: list[dict[str, object]] = []
    used_names: set[str] = set()
    for name in arguments.images:
        try:
            image = _read_image(name)
        except LinkwrightError as error:
            problems += error.diagnostics
            continue
        detections = detector.detect(image, limits)
        rows.append(
            {
                "image": name,
                "width": image.shape[1],
                "height": image.shape[0],
                "detections": _to_rows(detections),
            }
        )
        if arguments.format == "text":
            _print_detections(name, detections)
        if arguments.output is not None:
            _write_drawing(image, detections, arguments.output, _choose_unique_name(Path(name).stem, used_names))
    if arguments.format == "json":
        print(json.dumps(rows, indent=2, ensure_ascii=False))
    print_diagnostics(problems, sys.stderr)
    return 1 if problems else 0


def _check_classes(detector: Detector, class_names: list[str]) -> frozenset[str]:
    for name in class_names:
        if detector.names and name not in detector.names:
            message = phrase("the detector has no class '{name}'", name=name)
            hint = did_you_mean(name, detector.names) or phrase(
                "its classes are {names}", names=", ".join(detector.names)
            )
            raise LinkwrightError(Diagnostic("VISION111", message, hint=hint))
    return frozenset(class_names)


def _read_image(name: str) -> NDArray[np.uint8]:
    """Return the pixels of an image file, shape (height, width, 3)."""
    import numpy as np

    from linkwright.files.input_files import read_file
    from linkwright.images import BadImageError, DecodedImage
    from linkwright.images.image_files import decode_file

    try:
        pixels = decode_file(np.frombuffer(read_file(name, _MAX_FILE_SIZE), np.uint8))
    except (OSError, BadImageError) as error:
        reason = foreign(error.strerror if isinstance(error, OSError) else error)
        message = phrase("cannot read the image '{path}': {reason}", path=name, reason=reason)
        raise LinkwrightError(Diagnostic("VISION110", message)) from None
    return DecodedImage((pixels >> 8).astype(np.uint8) if pixels.dtype == np.uint16 else pixels).rgb()


def _to_rows(detections: Detections) -> list[dict[str, object]]:
    rows: list[dict[str, object]] = []
    for index in range(len(detections)):
        box = [round(float(value), 2) for value in detections.boxes[index]]
        row: dict[str, object] = {
            "class": detections.name(index),
            "score": round(float(detections.scores[index]), 4),
            "box": box,
        }
        if detections.corners is not None:
            row["corners"] = [[round(float(value), 2) for value in point] for point in detections.corners[index]]
        rows.append(row)
    return rows


def _print_detections(name: str, detections: Detections) -> None:
    if not len(detections):
        print(f"{name}: nothing found")
    for index in range(len(detections)):
        left, top, right, bottom = detections.boxes[index]
        box = f"{left:.1f} {top:.1f} {right:.1f} {bottom:.1f}"
        print(f"{name}: {detections.name(index)} {detections.scores[index]:.2f} [{box}]")


def _write_drawing(image: NDArray[np.uint8], detections: Detections, folder: Path, stem: str) -> None:
    from io import BytesIO

    from PIL import Image

    from linkwright.vision.detectors.drawing import draw_detections

    file = BytesIO()
    Image.fromarray(draw_detections(image, detections)).save(file, "PNG")
    write_output(folder / f"{stem}_detections.png", file.getvalue())


def _choose_unique_name(stem: str, used_names: set[str]) -> str:
    """Return a unique name for a result file, and add it to `used_names`.

    If the name `stem` is already in use, a number is appended.
    """
    name, number = stem, 2
    while name in used_names:
        name, number = f"{stem}-{number}", number + 1
    used_names.add(name)
    return name
