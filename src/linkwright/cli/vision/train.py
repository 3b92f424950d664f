"""``linkwright vision train``: train a network on the images of a dataset."""

from __future__ import annotations

import argparse
import shlex
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.cli.exit_status import FINE
from linkwright.cli.numbers import positive_float, positive_int, unsigned_int
from linkwright.diagnostics import phrase
from linkwright.diagnostics.translation import localized
from linkwright.process.interruption import INTERRUPTED

if TYPE_CHECKING:
    from linkwright.vision.training.learning.training_loop import Epoch

_CELL_SIZE = 32


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``vision train``."""
    parser.add_argument(
        "dataset",
        metavar="DATASET",
        type=Path,
        help="the folder of the dataset, as `linkwright dataset` writes it, or its data.yaml",
    )
    parser.add_argument(
        "-o",
        "--output",
        metavar="FOLDER",
        type=Path,
        default=Path("training"),
        help="the output folder, default training",
    )
    parser.add_argument(
        "--name", default="detector", help="the file name of the network and of its model card, default detector"
    )
    parser.add_argument("--epochs", type=positive_int, default=40, help="the number of epochs, default 40")
    parser.add_argument(
        "--whole-epochs",
        metavar="N",
        type=unsigned_int,
        default=2,
        help="the number of final epochs that use full images instead of crops, default 2",
    )
    parser.add_argument("--batch", type=positive_int, default=16, help="the batch size, default 16")
    parser.add_argument("--rate", type=positive_float, default=0.002, help="the maximum learning rate, default 0.002")
    parser.add_argument(
        "--size",
        metavar="WIDTHxHEIGHT",
        type=_parse_size,
        default=(480, 384),
        help="the input size of the network, default 480x384",
    )
    parser.add_argument(
        "--channels",
        type=positive_int,
        default=8,
        help="the number of channels of the first layer; the other layers have multiples of it, default 8",
    )
    parser.add_argument("--seed", type=unsigned_int, default=0, help="the random seed, default 0")
    parser.add_argument("--threads", type=positive_int, default=2, help="the number of CPU threads, default 2")
    parser.add_argument(
        "--precision",
        choices=("float32", "bfloat16"),
        default="float32",
        help="the number format of training: float32 (default), or bfloat16, faster if the CPU supports it",
    )
    parser.add_argument(
        "--device",
        choices=("auto", "cpu"),
        default="auto",
        help="the device for training: auto (default) uses a CUDA GPU if PyTorch finds one",
    )
    parser.add_argument(
        "--weights",
        metavar="FILE",
        help="start from this network instead of random weights: things, or an ONNX file that this command wrote",
    )
    parser.add_argument("--resume", action="store_true", help="resume after the last epoch saved in the output folder")
    parser.add_argument(
        "--held-out",
        metavar="DATASET",
        type=Path,
        action="append",
        default=[],
        help="also evaluate the result on this dataset; may be repeated",
    )


def run(arguments: argparse.Namespace) -> int:
    """Train a network, evaluate it, and print the results."""
    from linkwright.vision.training.card import format_results_table
    from linkwright.vision.training.options import Options
    from linkwright.vision.training.training_run import train_network

    width, height = arguments.size
    options = Options(
        dataset=arguments.dataset,
        output=arguments.output,
        name=arguments.name,
        epochs=arguments.epochs,
        whole_epochs=arguments.whole_epochs,
        batch=arguments.batch,
        rate=arguments.rate,
        width=width,
        height=height,
        channels=arguments.channels,
        seed=arguments.seed,
        threads=arguments.threads,
        precision=arguments.precision,
        device=arguments.device,
        weights=_choose_weights_path(arguments.weights),
        resume=arguments.resume,
        held_out=tuple(arguments.held_out),
        command=shlex.join(["linkwright", *(word for word in sys.argv[1:] if word != "--resume")]),
    )
    result = train_network(options, lambda epoch: _print_epoch(epoch, options.epochs))
    for report in result.reports:
        print(f"{report.title}: mAP50 {report.evaluation.map50:.3f}, mAP50-95 {report.evaluation.map:.3f}")
        print("\n".join(format_results_table(report.evaluation)))
    print(result.network)
    print(result.card)
    return INTERRUPTED if result.was_interrupted else FINE


def _print_epoch(epoch: Epoch, epoch_count: int) -> None:
    boxes, scores = (f"{loss:.3f}" for loss in epoch.losses)
    line = localized(
        phrase(
            "epoch {number} of {last}: box loss {boxes}, score loss {scores}",
            number=epoch.number,
            last=epoch_count,
            boxes=boxes,
            scores=scores,
        )
    )
    if epoch.evaluation is not None:
        line += f"; mAP50 {epoch.evaluation.map50:.3f}, mAP50-95 {epoch.evaluation.map:.3f}"
    print(line, file=sys.stderr, flush=True)


def _choose_weights_path(text: str | None) -> Path | None:
    from linkwright.vision.models.things import FILE

    return FILE if text == FILE.stem else Path(text) if text else None


def _parse_size(text: str) -> tuple[int, int]:
    width, _, height = text.partition("x")
    sides = [int(side) if side.isascii() and side.isdigit() else 0 for side in (width, height)]
    if any(side == 0 or side % _CELL_SIZE or side > 4096 for side in sides):
        raise argparse.ArgumentTypeError("value must be WIDTHxHEIGHT, both multiples of 32")
    return sides[0], sides[1]
