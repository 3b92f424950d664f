"""Options of a training."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

_PARTS = 0.42, 1.1
_WHOLE = 0.8, 1.25


@dataclass(frozen=True, slots=True)
class View:
    """The part of a picture that is shown.

    Attributes:
        size: width and height, in pixels.
        scales: the smallest and the largest that a picture is scaled by.
    """

    size: tuple[int, int]
    scales: tuple[float, float]


@dataclass(frozen=True, slots=True)
class Options:
    """Options of a training.

    Attributes:
        dataset: folder of the dataset that teaches.
        output: folder for what comes of it: ``NAME.onnx``, ``NAME.md`` (the card), ``last.pt`` (to resume from).
        name: of the network.
        epochs: how often each picture is seen; those with rare classes more often.
        whole_epochs: so many of them, the last ones, are of whole pictures of the size at which they are judged.
        batch: pictures in a step.
        rate: the highest learning rate.
        width: of the network's pictures, in pixels, a multiple of 32.
        height: likewise.
        channels: of the first convolution; the others have multiples of it.
        seed: of all that is drawn by lot.
        threads: of the processor.
        precision: what it computes with while it learns: ``float32``, or ``bfloat16``, where 16 bits are enough;
            weights have 32.
        device: where it learns: ``auto``, the first GPU that PyTorch sees by CUDA, else the processor; ``cpu``.
        weights: ONNX file of a training, whose network it begins with; None for random weights.
        resume: go on from ``last.pt`` of the folder.
        held_out: folders of datasets that only judge the result, with their split ``test``, or else ``val``.
        command: what the user typed, for the card; without ``--resume``, with which the result is the same.
    """

    dataset: Path
    output: Path
    name: str = "detector"
    epochs: int = 40
    whole_epochs: int = 2
    batch: int = 16
    rate: float = 2e-3
    width: int = 480
    height: int = 384
    channels: int = 8
    seed: int = 0
    threads: int = 2
    precision: str = "float32"
    device: str = "auto"
    weights: Path | None = None
    resume: bool = False
    held_out: tuple[Path, ...] = ()
    command: str = ""

    def view(self, epoch: int) -> View:
        """The view in an epoch, from 0: parts of the pictures at first, whole ones in the end.

        Features know little of how large a picture is, so small parts teach nearly as much as whole pictures in a
        quarter of the time. What is left for whole ones to teach is things that fill much of a picture.
        """
        if epoch >= self.epochs - self.whole_epochs:
            return View((self.width, self.height), _WHOLE)
        width, height = (max(32, round(side / 2 / 32) * 32) for side in (self.width, self.height))
        return View((width, height), _PARTS)
