"""The options of a training run."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

_CROP_SCALES = 0.42, 1.1
_FULL_SCALES = 0.8, 1.25


@dataclass(frozen=True, slots=True)
class CropSettings:
    """The size of image crops, and the range of scales.

    Attributes:
        size: width and height, in pixels.
        scales: the minimum and maximum factor by which an image is scaled.
    """

    size: tuple[int, int]
    scales: tuple[float, float]


@dataclass(frozen=True, slots=True)
class Options:
    """The options of a training run.

    Attributes:
        dataset: the folder of the training dataset.
        output: the output folder: ``NAME.onnx``, ``NAME.md`` (the card), ``last.pt`` (to resume from).
        name: the name of the network.
        epochs: the number of epochs; each uses images with rare classes more than once.
        whole_epochs: the number of final epochs that use full images, in the size used for evaluation.
        batch: the number of images per step.
        rate: the maximum learning rate.
        width: the width of the network's input, in pixels, a multiple of 32.
        height: the height of the network's input, in pixels, a multiple of 32.
        channels: the channels of the first convolution; the others have multiples of it.
        seed: the random seed.
        threads: the number of CPU threads.
        precision: the number format in training: ``float32``, or ``bfloat16`` for computations in which 16 bits are
            enough. Weights always have 32 bits.
        device: the training device: ``cpu``, or ``auto`` for the first CUDA GPU that PyTorch finds, or else the CPU.
        weights: the ONNX file of an earlier training to start from; None for random weights.
        resume: whether to resume from ``last.pt`` in the output folder.
        held_out: the folders of datasets used only for evaluation: their split ``test``, or ``val`` if there is none.
        command: the command line for the card, without ``--resume``, which does not change the result.
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

    def choose_crop(self, epoch: int) -> CropSettings:
        """Return the crops for an epoch, counted from 0: small at first, full images at the end.

        Features depend little on the size of an image, so small crops teach nearly as much as full images in a quarter
        of the time. Full images are only needed for objects that fill much of an image.
        """
        if epoch >= self.epochs - self.whole_epochs:
            return CropSettings((self.width, self.height), _FULL_SCALES)
        width, height = (max(32, round(side / 2 / 32) * 32) for side in (self.width, self.height))
        return CropSettings((width, height), _CROP_SCALES)
