"""Train a network: learn, export, evaluate the exported file, and write the card."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.diagnostics import Diagnostic, LinkwrightError, display_path, foreign, phrase
from linkwright.files.whole_files import write_whole_file
from linkwright.vision.evaluation import Evaluation
from linkwright.vision.training.card import EvaluationReport, collect_dataset_facts, describe_origin, make_card
from linkwright.vision.training.detector_evaluation import evaluate_detector
from linkwright.vision.training.library import require_pytorch
from linkwright.vision.training.options import Options
from linkwright.vision.training.yolo_dataset import Dataset, LabeledFile, open_dataset

if TYPE_CHECKING:
    from linkwright.vision.training.learning.network import Network
    from linkwright.vision.training.learning.training_loop import Epoch


@dataclass(frozen=True, slots=True)
class TrainingResult:
    """The result of a training run.

    Attributes:
        network: the ONNX file.
        card: the card of the network.
        reports: the results on the split ``val`` of the training dataset, then on each held-out dataset.
        was_interrupted: whether Ctrl-C ended the training before the last epoch; the network is then the best so far.
    """

    network: Path
    card: Path
    reports: tuple[EvaluationReport, ...]
    was_interrupted: bool


def train_network(options: Options, on_epoch: Callable[[Epoch], None]) -> TrainingResult:
    """Train a network, export it, evaluate the file, and write its card next to it.

    Args:
        options: the options of the training.
        on_epoch: called after each epoch.

    Raises:
        LinkwrightError: VISION301 PyTorch is not installed; VISION302 to VISION305 see `open_dataset` and
            `Dataset.read`; VISION306 there is no checkpoint to resume from; VISION307 the folder cannot be written;
            VISION308 the initial weights cannot be used.
        KeyboardInterrupt: training was interrupted before the first checkpoint.
    """
    require_pytorch()
    from linkwright.vision.training.images import read_labeled_images
    from linkwright.vision.training.learning.export import export_to_onnx
    from linkwright.vision.training.learning.training_loop import TrainingLoop

    dataset = open_dataset(options.dataset)
    training_images, validation_images = dataset.read("train"), dataset.read("val")
    held_out_splits = [
        (open_dataset(folder), _choose_evaluation_split(open_dataset(folder))) for folder in options.held_out
    ]
    held_out = [(held_out_dataset, split, held_out_dataset.read(split)) for held_out_dataset, split in held_out_splits]
    try:
        options.output.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise _write_error(options.output, error) from None
    size = options.width, options.height
    training_loop = TrainingLoop(
        dataset.names,
        options,
        read_labeled_images(training_images, *size),
        read_labeled_images(validation_images, *size),
    )
    if options.resume:
        training_loop.load(options.output / "last.pt")
    elif options.weights is not None:
        training_loop.load_initial_weights(options.weights)
    was_interrupted = False
    try:
        training_loop.run(on_epoch)
    except KeyboardInterrupt:
        if training_loop.epoch == 0:
            raise
        was_interrupted = True
    except OSError as error:
        raise _write_error(options.output, error) from None
    facts = _collect_training_facts(
        options, dataset, training_images, training_loop.epoch, training_loop.best_epoch, training_loop.network
    )
    facts["time"] = (
        f"{training_loop.seconds / 60:.0f} minutes with {options.threads} threads, {training_loop.device_name}"
    )
    network = options.output / f"{options.name}.onnx"
    metadata = {"description": f"{options.name}, trained by linkwright vision train", "seed": str(options.seed)}
    metadata["dataset"] = facts["images' sha256"]
    best = training_loop.load_best_network()
    threshold = training_loop.find_best_threshold(best)
    facts["scores"] = f"{threshold:.2f} of the network is 0.5 in the file, where F1 on the split val is greatest"
    content = export_to_onnx(best, dataset.names, *size, metadata, threshold)
    facts["file"] = f"{network.name}, {len(content) / 1e6:.2f} MB, sha256 {hashlib.sha256(content).hexdigest()}"
    try:
        write_whole_file(network, content)
        title_of_validation = f"Held-back images of {dataset.folder.name}"
        reports = [EvaluationReport(title_of_validation, evaluate_detector(network, dataset.names, validation_images))]
        for other, split, images in held_out:
            title = f"Held out: {other.folder.name} ({split})"
            evaluation = evaluate_detector(network, other.names, images)
            reports.append(EvaluationReport(title, evaluation, describe_origin(other.folder, dataset.folder)))
        card_file = options.output / f"{options.name}.md"
        write_whole_file(card_file, make_card(options.name, facts, reports))
    except OSError as error:
        raise _write_error(options.output, error) from None
    return TrainingResult(network, card_file, tuple(reports), was_interrupted)


def evaluate_on_dataset(model: str, folder: Path, split: str | None) -> Evaluation:
    """Evaluate a detector on a dataset.

    Args:
        model: an ONNX file, or the name of a detector.
        folder: the folder of the dataset.
        split: the split to use; None for ``test``, or else ``val``.

    Raises:
        LinkwrightError: the detector cannot be created; VISION302 to VISION305 see `open_dataset` and `Dataset.read`.
    """
    dataset = open_dataset(folder)
    return evaluate_detector(model, dataset.names, dataset.read(split or _choose_evaluation_split(dataset)))


def _choose_evaluation_split(dataset: Dataset) -> str:
    return next((split for split in ("test", "val") if split in dataset.splits), "val")


def _collect_training_facts(
    options: Options, dataset: Dataset, images: Sequence[LabeledFile], epochs: int, best_epoch: int, network: Network
) -> dict[str, str]:
    """Return the facts about the training for the card."""
    parameters = sum(parameter.numel() for parameter in network.parameters())
    object_count = sum(int((~labeled.ignored).sum()) for labeled in images)
    return {
        "command": f"`{options.command}`",
        "classes": ", ".join(dataset.names),
        "trained on": f"{len(images)} images with {object_count} objects of the dataset {dataset.folder.name}",
        **collect_dataset_facts(dataset.folder),
        "images' sha256": compute_dataset_digest(images),
        **_collect_initial_weights_facts(options.weights),
        "input": f"{options.width} x {options.height}, red, green, blue, 0 to 1",
        "output": "YOLOv8's: [1, 4 + classes, cells], middle, width, height in pixels, scores",
        "weights": f"{parameters}",
        "seed": str(options.seed),
        "epochs": f"{epochs} of {options.epochs}; the weights are those of the best epoch, {best_epoch}",
    }


def _collect_initial_weights_facts(weights: Path | None) -> dict[str, str]:
    if weights is None:
        return {}
    try:
        return {"started from": f"{weights.name}, sha256 {hashlib.sha256(weights.read_bytes()).hexdigest()}"}
    except OSError:  # the file may have been deleted before the training was resumed
        return {"started from": weights.name}


def compute_dataset_digest(images: Sequence[LabeledFile]) -> str:
    """Return the SHA-256 of images and labels in order, to identify a dataset."""
    digest = hashlib.sha256()
    for labeled in images:
        digest.update(hashlib.sha256(labeled.path.read_bytes()).digest())
        digest.update(labeled.classes.tobytes() + labeled.boxes.tobytes())
    return digest.hexdigest()


def _write_error(path: Path, error: OSError) -> LinkwrightError:
    reason = foreign(error.strerror or error)
    message = phrase("cannot write to '{path}': {reason}", path=display_path(path), reason=reason)
    return LinkwrightError(Diagnostic("VISION307", message))
