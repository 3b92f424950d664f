"""What a training is told."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True, slots=True)
class Options:
    """What a training is told.

    Attributes:
        dataset: folder of the dataset that teaches.
        output: folder for what comes of it: ``NAME.onnx``, ``NAME.md`` (the card), ``last.pt`` (to resume from).
        name: of the network.
        epochs: how often each picture is seen.
        batch: pictures in a step.
        rate: the highest learning rate.
        width: of the network's pictures, in pixels, a multiple of 32.
        height: likewise.
        channels: of the first convolution; the others have multiples of it.
        seed: of all that is drawn by lot.
        threads: of the processor.
        device: where it learns: ``auto``, the first GPU that PyTorch sees by CUDA, else the processor; ``cpu``.
        resume: go on from ``last.pt`` of the folder.
        held_out: folders of datasets that only judge the result, with their split ``test``, or else ``val``.
        command: what the user typed, for the card; without ``--resume``, with which the result is the same.
    """

    dataset: Path
    output: Path
    name: str = "detector"
    epochs: int = 40
    batch: int = 16
    rate: float = 2e-3
    width: int = 480
    height: int = 384
    channels: int = 8
    seed: int = 0
    threads: int = 2
    device: str = "auto"
    resume: bool = False
    held_out: tuple[Path, ...] = ()
    command: str = ""

    @property
    def view(self) -> tuple[int, int]:
        """Width and height of what it learns from: parts of the pictures, half of them wide and high.

        Features do not know how large a picture is, so small parts teach as much as whole pictures in less time.
        """
        width, height = (max(32, round(side / 2 / 32) * 32) for side in (self.width, self.height))
        return width, height
