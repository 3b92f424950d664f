"""The training loop: epochs, a moving average of the weights for evaluation, and checkpoints."""

from __future__ import annotations

import math
import pickle
import platform
import time
from collections.abc import Callable, Iterator, Sequence
from copy import deepcopy
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor, nn

from linkwright.diagnostics import Diagnostic, LinkwrightError, display_path, phrase
from linkwright.vision.detections import Detections
from linkwright.vision.detectors.suppression import suppressed
from linkwright.vision.evaluation import Evaluation, GroundTruth, balanced_score, evaluate
from linkwright.vision.training.images import Lesson, changed, repeated, repeats
from linkwright.vision.training.learning.losses import loss
from linkwright.vision.training.learning.network import Network, Shape, cells
from linkwright.vision.training.learning.optimizer import Optimizer
from linkwright.vision.training.learning.starting import load_weights
from linkwright.vision.training.measuring import LIMITS
from linkwright.vision.training.options import Options

_WARM_UP = 100  # the number of steps over which the learning rate grows to its maximum
_LEAST_RATE = 0.02  # the final learning rate, as a share of the maximum
_STEEPEST = 10.0  # the norm that gradients are clipped to
_MEASURED = 128  # the number of images used to measure layer statistics for weights from a file
_SMOOTHING = 0.998  # the decay of the moving average per step, after its warm-up


@dataclass(frozen=True, slots=True)
class Epoch:
    """The results of an epoch.

    Attributes:
        number: the number of the epoch, from 1.
        losses: the mean box loss and the mean score loss.
        judged: the evaluation of the averaged network on the validation split; None if it was skipped.
    """

    number: int
    losses: tuple[float, float]
    judged: Evaluation | None


class Course:
    """The training of a network.

    Args:
        names: the names of the classes.
        options: the options.
        lesson: the training images.
        exam: the validation images.

    Attributes:
        names: the names of the classes.
        options: the options.
        shape: the shape of the network.
        network: the network that is trained.
        smooth: the moving average of the network, which is evaluated.
        best: the best weights of the moving average.
        best_map: the mAP50-95 of the best weights; -1 before the first evaluation.
        best_epoch: the epoch of the best weights.
        epoch: the number of finished epochs.
        seconds: the duration of the finished epochs.
    """

    def __init__(self, names: Sequence[str], options: Options, lesson: Lesson, exam: Lesson) -> None:
        torch.set_num_threads(options.threads)
        torch.manual_seed(options.seed)
        self.names = tuple(names)
        self.options = options
        self._lesson, self._exam = lesson, exam
        self._repeats = repeats(lesson, len(names))
        self.shape = Shape(len(names), options.channels)
        self._device = torch.device("cuda" if options.device == "auto" and torch.cuda.is_available() else "cpu")
        self.network = Network(self.shape).to(self._device, memory_format=torch.channels_last)
        self.smooth = deepcopy(self.network).eval().requires_grad_(requires_grad=False)
        self.best = deepcopy(self.smooth.state_dict())
        self.best_map = -1.0
        self.best_epoch = 0
        self.epoch = 0
        self.seconds = 0.0
        self._step = 0
        self._optimizer = Optimizer(self.network, options.rate)

    def run(self, on_epoch: Callable[[Epoch], None]) -> None:
        """Train until the last epoch, and write a checkpoint after each epoch.

        Args:
            on_epoch: called after each epoch.

        Raises:
            KeyboardInterrupt: training was interrupted; `best` has the best weights so far.
        """
        while self.epoch < self.options.epochs:
            began = time.monotonic()
            losses = self._learn(self.epoch)
            self.epoch += 1
            judged = self.judge() if self._is_evaluated() else None
            if judged is not None and judged.map >= self.best_map:
                self.best, self.best_map, self.best_epoch = deepcopy(self.smooth.state_dict()), judged.map, self.epoch
            self.seconds += time.monotonic() - began
            self.save(self.options.output / "last.pt")
            on_epoch(Epoch(self.epoch, losses, judged))

    @property
    def place(self) -> str:
        """The training device: the name of the GPU, or the processor's architecture."""
        return torch.cuda.get_device_name(self._device) if self._device.type == "cuda" else platform.machine()

    def best_network(self) -> Network:
        """Return the network with the best results on the validation split, in evaluation mode."""
        network = deepcopy(self.smooth)
        network.load_state_dict(self.best)
        return network.cpu()

    def _is_evaluated(self) -> bool:
        """Return whether this epoch ends with an evaluation: every fifth one does, and the last ones."""
        last = self.options.epochs
        return self.epoch % 5 == 0 or self.epoch > last - 3

    def _learn(self, epoch: int) -> tuple[float, float]:
        self.network.train()
        sums = torch.zeros(2)
        batches = list(self._batches(epoch))
        for chosen, seed in batches:
            images, objects = self._batch(chosen, seed)
            with torch.autocast(self._device.type, torch.bfloat16, enabled=self.options.precision == "bfloat16"):
                boxes, logits = self.network(images)
            middles, _ = cells(images.shape[3], images.shape[2], images.device)
            total, parts = loss(boxes, logits, middles, objects)
            self._optimizer.forget_gradients()
            total.backward()
            nn.utils.clip_grad_norm_(self.network.parameters(), _STEEPEST)
            self._optimizer.step(self._rate(len(batches)))
            self._step += 1
            self._follow()
            sums += parts.cpu()
        mean = sums / len(batches)
        return float(mean[0]), float(mean[1])

    def _batches(self, epoch: int) -> Iterator[tuple[NDArray[np.int64], int]]:
        """Yield the batches of an epoch, in an order that depends only on the seed and the epoch."""
        chance = np.random.default_rng((self.options.seed, epoch))
        order = chance.permutation(repeated(self._repeats, chance))
        size = min(self.options.batch, len(order))
        for start in range(0, len(order) - size + 1, size):
            yield order[start : start + size], start

    def _batch(self, chosen: NDArray[np.int64], start: int) -> tuple[Tensor, Tensor]:
        chance = np.random.default_rng((self.options.seed, self.epoch, start))
        view = self.options.view(self.epoch)
        both = [changed(self._lesson, int(place), view, chance) for place in chosen]
        most = max([1, *(len(objects) for _, objects in both)])
        table: NDArray[np.float32] = np.full((len(both), most, 5), -1, np.float32)
        for row, (_, objects) in zip(table, both, strict=True):
            row[: len(objects)] = objects
        images = np.stack([image for image, _ in both])
        return _tensor(images, self._device), torch.from_numpy(table).to(self._device)

    def _rate(self, steps: int) -> float:
        """Return the learning rate: a short warm-up, then half a cosine down to nearly zero."""
        whole = self.options.epochs * steps
        done = min(1.0, self._step / max(1, whole))
        low = _LEAST_RATE + (1 - _LEAST_RATE) * (1 + math.cos(math.pi * done)) / 2
        return self.options.rate * low * min(1.0, (self._step + 1) / min(_WARM_UP, max(1, whole // 4)))

    @torch.no_grad()
    def _follow(self) -> None:
        """Update the moving average of the weights."""
        keep = min(_SMOOTHING, (1 + self._step) / (10 + self._step))
        here = self.network.state_dict()
        for name, value in self.smooth.state_dict().items():
            if value.dtype.is_floating_point:
                value.lerp_(here[name], 1 - keep)
            else:
                value.copy_(here[name])

    def judge(self) -> Evaluation:
        """Evaluate the moving average on the validation split."""
        return evaluate(self.names, *self._examine(self.smooth))

    def balance(self, network: Network) -> float:
        """Return the score threshold with the greatest F1, see `balanced_score`."""
        return balanced_score(self.names, *self._examine(network))

    @torch.no_grad()
    def _examine(self, network: Network) -> tuple[list[GroundTruth], list[Detections]]:
        """Return the labels of the validation split and the network's detections."""
        found: list[Detections] = []
        device = next(network.parameters()).device
        for start in range(0, len(self._exam.objects), self.options.batch):
            images = _tensor(self._exam.images[start : start + self.options.batch], device)
            boxes, logits = network(images)
            scores = logits.sigmoid()
            pairs = zip(boxes.cpu().numpy(), scores.cpu().numpy(), strict=True)
            found += [self._found(prediction, score) for prediction, score in pairs]
        return [_truth(objects) for objects in self._exam.objects], found

    def _found(self, boxes: NDArray[np.float32], scores: NDArray[np.float32]) -> Detections:
        """Return the detections in one image from boxes (cells, 4) and scores (cells, classes)."""
        cells, kinds = np.nonzero(scores >= LIMITS.threshold)
        confidences: NDArray[np.float32] = scores[cells, kinds]
        classes: NDArray[np.int32] = kinds.astype(np.int32)
        kept = suppressed(boxes[cells], confidences, classes, LIMITS.iou, LIMITS.most)
        return Detections(boxes[cells[kept]], confidences[kept], classes[kept], self.names)

    def save(self, path: Path) -> None:
        """Write a checkpoint."""
        state = {
            "shape": asdict(self.shape),
            "names": list(self.names),
            "seed": self.options.seed,
            "network": self.network.state_dict(),
            "smooth": self.smooth.state_dict(),
            "best": self.best,
            "best_map": self.best_map,
            "best_epoch": self.best_epoch,
            "optimizer": self._optimizer.state_dict(),
            "epoch": self.epoch,
            "step": self._step,
            "seconds": self.seconds,
        }
        draft = path.with_suffix(".part")
        torch.save(state, draft)
        draft.replace(path)

    def begin_with(self, path: Path) -> None:
        """Start from the weights of an ONNX file, see `load_weights`."""
        chosen, size = self._lesson.images[:_MEASURED], self.options.batch
        batches = (_tensor(chosen[start : start + size], self._device) for start in range(0, len(chosen), size))
        load_weights(self.network, self.names, path, batches)
        self.smooth.load_state_dict(self.network.state_dict())

    def load(self, path: Path) -> None:
        """Restore the training from a checkpoint.

        Raises:
            LinkwrightError: VISION306, the file is not a checkpoint, or belongs to a different network.
        """
        try:
            state: dict[str, Any] = torch.load(path, map_location=self._device, weights_only=True)
            saved = state["shape"], state["names"]
        except (OSError, RuntimeError, pickle.UnpicklingError, KeyError, EOFError, TypeError):
            message = phrase("'{path}' is not a training checkpoint", path=display_path(path))
            hint = phrase("leave out --resume to start from scratch")
            raise LinkwrightError(Diagnostic("VISION306", message, hint=hint)) from None
        if saved != (asdict(self.shape), list(self.names)):
            message = phrase(
                "'{path}' is a checkpoint of a training with different classes or sizes", path=display_path(path)
            )
            hint = phrase("leave out --resume to start from scratch")
            raise LinkwrightError(Diagnostic("VISION306", message, hint=hint))
        self.network.load_state_dict(state["network"])
        self.smooth.load_state_dict(state["smooth"])
        self._optimizer.load_state_dict(state["optimizer"])
        self.best, self.best_map, self.best_epoch = state["best"], state["best_map"], state["best_epoch"]
        self.epoch, self._step, self.seconds = state["epoch"], state["step"], state["seconds"]


def _tensor(images: NDArray[np.uint8], device: torch.device) -> Tensor:
    """Convert images of shape (batch, height, width, 3) to an input tensor for the network."""
    return torch.from_numpy(images).to(device).permute(0, 3, 1, 2).float().div_(255)


def _truth(objects: NDArray[np.float32]) -> GroundTruth:
    kinds: NDArray[np.int32] = objects[:, 0].astype(np.int32)
    return GroundTruth(objects[:, 1:], np.where(kinds < 0, -2 - kinds, kinds).astype(np.int32), kinds < 0)
