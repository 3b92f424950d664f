"""The training loop: epochs, a moving average of the weights, and checkpoints."""

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
from linkwright.vision.detectors.suppression import non_maximum_suppression
from linkwright.vision.evaluation import Evaluation, GroundTruth, evaluate, find_best_f1_threshold
from linkwright.vision.training.detector_evaluation import EVALUATION_LIMITS
from linkwright.vision.training.images import LabeledImages, augment, compute_repeat_factors, draw_repeated_indices
from linkwright.vision.training.learning.initial_weights import load_weights
from linkwright.vision.training.learning.losses import compute_loss
from linkwright.vision.training.learning.network import Network, Shape, make_cells
from linkwright.vision.training.learning.optimizer import Optimizer
from linkwright.vision.training.options import Options

_WARM_UP_STEPS = 100  # the number of steps over which the learning rate grows to its maximum
_FINAL_RATE_FRACTION = 0.02  # the final learning rate, as a fraction of the maximum
_MAX_GRADIENT_NORM = 10.0  # the norm that gradients are clipped to
_STATISTICS_IMAGES = 128  # the number of images used to measure layer statistics for weights from a file
_AVERAGE_DECAY = 0.998  # the decay of the moving average per step, after its warm-up


@dataclass(frozen=True, slots=True)
class Epoch:
    """The results of an epoch.

    Attributes:
        number: the number of the epoch, from 1.
        losses: the mean box loss and the mean score loss.
        evaluation: the evaluation of the averaged network on the validation split; None if this epoch has none.
    """

    number: int
    losses: tuple[float, float]
    evaluation: Evaluation | None


class TrainingLoop:
    """The training of a network.

    Args:
        names: the names of the classes.
        options: the options of the training.
        training: the training images.
        validation: the validation images.

    Attributes:
        names: the names of the classes.
        options: the options of the training.
        shape: the shape of the network.
        network: the network that is trained.
        averaged: the network with the moving average of the weights, which is evaluated.
        best: the weights of the moving average with the best evaluation.
        best_map: the mAP50-95 of the best weights; -1 before the first evaluation.
        best_epoch: the epoch of the best weights.
        epoch: the number of finished epochs.
        seconds: the duration of the finished epochs.
    """

    def __init__(
        self, names: Sequence[str], options: Options, training: LabeledImages, validation: LabeledImages
    ) -> None:
        torch.set_num_threads(options.threads)
        torch.manual_seed(options.seed)
        self.names = tuple(names)
        self.options = options
        self._training, self._validation = training, validation
        self._repeats = compute_repeat_factors(training, len(names))
        self.shape = Shape(len(names), options.channels)
        self._device = torch.device("cuda" if options.device == "auto" and torch.cuda.is_available() else "cpu")
        self.network = Network(self.shape).to(self._device, memory_format=torch.channels_last)
        self.averaged = deepcopy(self.network).eval().requires_grad_(requires_grad=False)
        self.best = deepcopy(self.averaged.state_dict())
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
            KeyboardInterrupt: the user interrupted the training; `best` has the best weights so far.
        """
        while self.epoch < self.options.epochs:
            start_time = time.monotonic()
            losses = self._train_epoch(self.epoch)
            self.epoch += 1
            evaluation = self.evaluate_averaged() if self._is_evaluated() else None
            if evaluation is not None and evaluation.map >= self.best_map:
                self.best, self.best_map, self.best_epoch = (
                    deepcopy(self.averaged.state_dict()),
                    evaluation.map,
                    self.epoch,
                )
            self.seconds += time.monotonic() - start_time
            self.save(self.options.output / "last.pt")
            on_epoch(Epoch(self.epoch, losses, evaluation))

    @property
    def device_name(self) -> str:
        """The training device: the name of the GPU, or the processor's architecture."""
        return torch.cuda.get_device_name(self._device) if self._device.type == "cuda" else platform.machine()

    def load_best_network(self) -> Network:
        """Return the network with the best results on the validation split, in evaluation mode."""
        network = deepcopy(self.averaged)
        network.load_state_dict(self.best)
        return network.cpu()

    def _is_evaluated(self) -> bool:
        """Return whether the finished epoch is evaluated: every fifth one, and the last three."""
        epochs = self.options.epochs
        return self.epoch % 5 == 0 or self.epoch > epochs - 3

    def _train_epoch(self, epoch: int) -> tuple[float, float]:
        self.network.train()
        sums = torch.zeros(2)
        batches = list(self._iterate_batches(epoch))
        for indices, seed in batches:
            images, objects = self._load_batch(indices, seed)
            with torch.autocast(self._device.type, torch.bfloat16, enabled=self.options.precision == "bfloat16"):
                boxes, logits = self.network(images)
            centers, _ = make_cells(images.shape[3], images.shape[2], images.device)
            total, losses = compute_loss(boxes, logits, centers, objects)
            self._optimizer.reset_gradients()
            total.backward()
            nn.utils.clip_grad_norm_(self.network.parameters(), _MAX_GRADIENT_NORM)
            self._optimizer.step(self._compute_learning_rate(len(batches)))
            self._step += 1
            self._update_average()
            sums += losses.cpu()
        mean = sums / len(batches)
        return float(mean[0]), float(mean[1])

    def _iterate_batches(self, epoch: int) -> Iterator[tuple[NDArray[np.int64], int]]:
        """Yield the batches of an epoch, in an order that depends only on the seed and the epoch."""
        generator = np.random.default_rng((self.options.seed, epoch))
        order = generator.permutation(draw_repeated_indices(self._repeats, generator))
        size = min(self.options.batch, len(order))
        for start in range(0, len(order) - size + 1, size):
            yield order[start : start + size], start

    def _load_batch(self, indices: NDArray[np.int64], start: int) -> tuple[Tensor, Tensor]:
        generator = np.random.default_rng((self.options.seed, self.epoch, start))
        crop = self.options.choose_crop(self.epoch)
        samples = [augment(self._training, int(index), crop, generator) for index in indices]
        max_objects = max([1, *(len(objects) for _, objects in samples)])
        table: NDArray[np.float32] = np.full((len(samples), max_objects, 5), -1, np.float32)
        for row, (_, objects) in zip(table, samples, strict=True):
            row[: len(objects)] = objects
        images = np.stack([image for image, _ in samples])
        return _to_tensor(images, self._device), torch.from_numpy(table).to(self._device)

    def _compute_learning_rate(self, steps: int) -> float:
        """Return the learning rate: a short warm-up, then half a cosine down to nearly zero."""
        total_steps = self.options.epochs * steps
        progress = min(1.0, self._step / max(1, total_steps))
        decay = _FINAL_RATE_FRACTION + (1 - _FINAL_RATE_FRACTION) * (1 + math.cos(math.pi * progress)) / 2
        return self.options.rate * decay * min(1.0, (self._step + 1) / min(_WARM_UP_STEPS, max(1, total_steps // 4)))

    @torch.no_grad()
    def _update_average(self) -> None:
        """Update the moving average of the weights."""
        decay = min(_AVERAGE_DECAY, (1 + self._step) / (10 + self._step))
        weights = self.network.state_dict()
        for name, value in self.averaged.state_dict().items():
            if value.dtype.is_floating_point:
                value.lerp_(weights[name], 1 - decay)
            else:
                value.copy_(weights[name])

    def evaluate_averaged(self) -> Evaluation:
        """Evaluate the network with averaged weights on the validation split."""
        return evaluate(self.names, *self._detect_validation(self.averaged))

    def find_best_threshold(self, network: Network) -> float:
        """Return the score threshold at which F1 on the validation split is highest."""
        return find_best_f1_threshold(self.names, *self._detect_validation(network))

    @torch.no_grad()
    def _detect_validation(self, network: Network) -> tuple[list[GroundTruth], list[Detections]]:
        """Return the labels of the validation split, and a network's detections."""
        detections: list[Detections] = []
        device = next(network.parameters()).device
        for start in range(0, len(self._validation.objects), self.options.batch):
            images = _to_tensor(self._validation.images[start : start + self.options.batch], device)
            boxes, logits = network(images)
            scores = logits.sigmoid()
            pairs = zip(boxes.cpu().numpy(), scores.cpu().numpy(), strict=True)
            detections += [self._select_detections(prediction, score) for prediction, score in pairs]
        return [_to_ground_truth(objects) for objects in self._validation.objects], detections

    def _select_detections(self, boxes: NDArray[np.float32], scores: NDArray[np.float32]) -> Detections:
        """Return the detections in one image from boxes (cells, 4) and scores (cells, classes)."""
        cell_indices, class_indices = np.nonzero(scores >= EVALUATION_LIMITS.threshold)
        confidences: NDArray[np.float32] = scores[cell_indices, class_indices]
        classes: NDArray[np.int32] = class_indices.astype(np.int32)
        kept_indices = non_maximum_suppression(
            boxes[cell_indices], confidences, classes, EVALUATION_LIMITS.iou, EVALUATION_LIMITS.max_detections
        )
        return Detections(
            boxes[cell_indices[kept_indices]], confidences[kept_indices], classes[kept_indices], self.names
        )

    def save(self, path: Path) -> None:
        """Write a checkpoint atomically."""
        state = {
            "shape": asdict(self.shape),
            "names": list(self.names),
            "seed": self.options.seed,
            "network": self.network.state_dict(),
            "smooth": self.averaged.state_dict(),
            "best": self.best,
            "best_map": self.best_map,
            "best_epoch": self.best_epoch,
            "optimizer": self._optimizer.state_dict(),
            "epoch": self.epoch,
            "step": self._step,
            "seconds": self.seconds,
        }
        temporary = path.with_suffix(".part")
        torch.save(state, temporary)
        temporary.replace(path)

    def load_initial_weights(self, path: Path) -> None:
        """Start from the weights of an ONNX file. See `load_weights`."""
        images, size = self._training.images[:_STATISTICS_IMAGES], self.options.batch
        batches = (_to_tensor(images[start : start + size], self._device) for start in range(0, len(images), size))
        load_weights(self.network, self.names, path, batches)
        self.averaged.load_state_dict(self.network.state_dict())

    def load(self, path: Path) -> None:
        """Restore the training from a checkpoint.

        Raises:
            LinkwrightError: VISION306, the file is not a checkpoint, or belongs to a different network.
        """
        try:
            state: dict[str, Any] = torch.load(path, map_location=self._device, weights_only=True)
            saved_shape = state["shape"], state["names"]
        except (OSError, RuntimeError, pickle.UnpicklingError, KeyError, EOFError, TypeError):
            message = phrase("'{path}' is not a training checkpoint", path=display_path(path))
            hint = phrase("leave out --resume to start from scratch")
            raise LinkwrightError(Diagnostic("VISION306", message, hint=hint)) from None
        if saved_shape != (asdict(self.shape), list(self.names)):
            message = phrase(
                "'{path}' is a checkpoint of a network with other classes or channels", path=display_path(path)
            )
            hint = phrase("leave out --resume to start from scratch")
            raise LinkwrightError(Diagnostic("VISION306", message, hint=hint))
        self.network.load_state_dict(state["network"])
        self.averaged.load_state_dict(state["smooth"])
        self._optimizer.load_state_dict(state["optimizer"])
        self.best, self.best_map, self.best_epoch = state["best"], state["best_map"], state["best_epoch"]
        self.epoch, self._step, self.seconds = state["epoch"], state["step"], state["seconds"]


def _to_tensor(images: NDArray[np.uint8], device: torch.device) -> Tensor:
    """Convert images of shape (batch, height, width, 3) to an input tensor of the network."""
    return torch.from_numpy(images).to(device).permute(0, 3, 1, 2).float().div_(255)


def _to_ground_truth(objects: NDArray[np.float32]) -> GroundTruth:
    signed_classes: NDArray[np.int32] = objects[:, 0].astype(np.int32)
    return GroundTruth(
        objects[:, 1:],
        np.where(signed_classes < 0, -2 - signed_classes, signed_classes).astype(np.int32),
        signed_classes < 0,
    )
