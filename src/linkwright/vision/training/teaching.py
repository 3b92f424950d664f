"""Turn a dataset into a network with its card: train, export, and evaluate the exported file."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.diagnostics import Diagnostic, LinkwrightError, display_path, foreign, phrase
from linkwright.files.whole_files import write_whole_file
from linkwright.vision.evaluation import Evaluation
from linkwright.vision.training.card import Examination, card, made_of, origin
from linkwright.vision.training.library import need_pytorch
from linkwright.vision.training.measuring import measure
from linkwright.vision.training.options import Options
from linkwright.vision.training.reading import Dataset, Labelled, open_dataset

if TYPE_CHECKING:
    from linkwright.vision.training.learning.course import Epoch
    from linkwright.vision.training.learning.network import Network


@dataclass(frozen=True, slots=True)
class TrainingResult:
    """The result of a training.

    Attributes:
        network: the ONNX file.
        card: the card of the network.
        examinations: the evaluations on the split ``val`` of the training dataset, then on each held-out dataset.
        interrupted: whether the training ended before its last epoch; the network is then the best so far.
    """

    network: Path
    card: Path
    examinations: tuple[Examination, ...]
    interrupted: bool


def teach(options: Options, on_epoch: Callable[[Epoch], None]) -> TrainingResult:
    """Train a network, export it, evaluate the file, and write its card next to it.

    Args:
        options: the options.
        on_epoch: called after each epoch.

    Raises:
        LinkwrightError: VISION301 PyTorch is not installed; VISION302 to VISION305 see `open_dataset` and
            `Dataset.read`; VISION306 there is no checkpoint to resume from; VISION307 the folder cannot be written;
            VISION308 the initial weights cannot be used.
        KeyboardInterrupt: training was interrupted before the first checkpoint.
    """
    need_pytorch()
    from linkwright.vision.training.images import read_lesson
    from linkwright.vision.training.learning.course import Course
    from linkwright.vision.training.learning.export import to_onnx

    dataset = open_dataset(options.dataset)
    lesson, exam = dataset.read("train"), dataset.read("val")
    others = [(open_dataset(folder), _judging_split(open_dataset(folder))) for folder in options.held_out]
    held_out = [(other, split, other.read(split)) for other, split in others]
    try:
        options.output.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise _cannot_write(options.output, error) from None
    size = options.width, options.height
    course = Course(dataset.names, options, read_lesson(lesson, *size), read_lesson(exam, *size))
    if options.resume:
        course.load(options.output / "last.pt")
    elif options.weights is not None:
        course.begin_with(options.weights)
    interrupted = False
    try:
        course.run(on_epoch)
    except KeyboardInterrupt:
        if course.epoch == 0:
            raise
        interrupted = True
    except OSError as error:
        raise _cannot_write(options.output, error) from None
    facts = _facts(options, dataset, lesson, course.epoch, course.best_epoch, course.network)
    facts["time"] = f"{course.seconds / 60:.0f} minutes with {options.threads} threads, {course.place}"
    network = options.output / f"{options.name}.onnx"
    described = {"description": f"{options.name}, trained by linkwright vision train", "seed": str(options.seed)}
    described["dataset"] = facts["images' sha256"]
    best = course.best_network()
    balance = course.balance(best)
    facts["scores"] = f"{balance:.2f} of the network is 0.5 in the file, where F1 on the split val is greatest"
    content = to_onnx(best, dataset.names, *size, described, balance)
    facts["file"] = f"{network.name}, {len(content) / 1e6:.2f} MB, sha256 {hashlib.sha256(content).hexdigest()}"
    try:
        write_whole_file(network, content)
        held_back = f"Held-back images of {dataset.folder.name}"
        examinations = [Examination(held_back, measure(network, dataset.names, exam))]
        for other, split, images in held_out:
            title = f"Held out: {other.folder.name} ({split})"
            judged = measure(network, other.names, images)
            examinations.append(Examination(title, judged, origin(other.folder, dataset.folder)))
        text = options.output / f"{options.name}.md"
        write_whole_file(text, card(options.name, facts, examinations))
    except OSError as error:
        raise _cannot_write(options.output, error) from None
    return TrainingResult(network, text, tuple(examinations), interrupted)


def judge(model: str, folder: Path, split: str | None) -> Evaluation:
    """Evaluate a detector on a dataset.

    Args:
        model: an ONNX file, or the name of a detector.
        folder: the folder of the dataset.
        split: the split to use; None for ``test``, or else ``val``.

    Raises:
        LinkwrightError: the detector cannot be created; VISION302 to VISION305 see `open_dataset` and `Dataset.read`.
    """
    dataset = open_dataset(folder)
    return measure(model, dataset.names, dataset.read(split or _judging_split(dataset)))


def _judging_split(dataset: Dataset) -> str:
    return next((split for split in ("test", "val") if split in dataset.splits), "val")


def _facts(
    options: Options, dataset: Dataset, lesson: Sequence[Labelled], epochs: int, best: int, network: Network
) -> dict[str, str]:
    """Return the facts about the training for the card."""
    parameters = sum(parameter.numel() for parameter in network.parameters())
    asked = sum(int((~labelled.ignored).sum()) for labelled in lesson)
    return {
        "command": f"`{options.command}`",
        "classes": ", ".join(dataset.names),
        "trained on": f"{len(lesson)} images with {asked} objects of the dataset {dataset.folder.name}",
        **made_of(dataset.folder),
        "images' sha256": sum_of(lesson),
        **_beginning(options.weights),
        "input": f"{options.width} x {options.height}, red, green, blue, 0 to 1",
        "output": "YOLOv8's: [1, 4 + classes, cells], middle, width, height in pixels, scores",
        "weights": f"{parameters}",
        "seed": str(options.seed),
        "epochs": f"{epochs} of {options.epochs}; the best, which this is, was {best}",
    }


def _beginning(weights: Path | None) -> dict[str, str]:
    if weights is None:
        return {}
    try:
        return {"started from": f"{weights.name}, sha256 {hashlib.sha256(weights.read_bytes()).hexdigest()}"}
    except OSError:  # the file was deleted before the training was resumed
        return {"started from": weights.name}


def sum_of(lesson: Sequence[Labelled]) -> str:
    """Return the SHA-256 of images and labels, in order, to identify a dataset."""
    whole = hashlib.sha256()
    for labelled in lesson:
        whole.update(hashlib.sha256(labelled.path.read_bytes()).digest())
        whole.update(labelled.classes.tobytes() + labelled.boxes.tobytes())
    return whole.hexdigest()


def _cannot_write(path: Path, error: OSError) -> LinkwrightError:
    reason = foreign(error.strerror or error)
    message = phrase("cannot write to '{path}': {reason}", path=display_path(path), reason=reason)
    return LinkwrightError(Diagnostic("VISION307", message))
