"""Create a dataset in one or several processes."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator, Sequence
from contextlib import closing
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from linkwright._version import __version__
from linkwright.files.whole_files import write_whole_file
from linkwright.process.processors import usable_processors
from linkwright.vision.datasets.contact_sheet import MAX_SHEET_IMAGES, make_contact_sheet
from linkwright.vision.datasets.folder import SHEET_FILE, DatasetFolder, write_error
from linkwright.vision.datasets.options import FORMATS, Options
from linkwright.vision.datasets.rendering import IMAGES_PER_PATTERN_SET, DatasetInput, DatasetRenderer, LabeledImage
from linkwright.vision.datasets.workers import make_in_processes


@dataclass(frozen=True, slots=True)
class DatasetResult:
    """The result of creating a dataset.

    Attributes:
        folder: the finished dataset on disk.
        added: the number of images added in this run.
        was_interrupted: whether Ctrl-C stopped it early.
    """

    folder: DatasetFolder
    added: int
    was_interrupted: bool


def make_dataset(
    worlds: str | Path | Sequence[str | Path],
    path: str | Path,
    images: int = 1000,
    *,
    models: Sequence[str | Path] = (),
    classes: str | Path | None = None,
    options: Options | None = None,
    formats: Sequence[str] = FORMATS,
    workers: int | None = None,
    force: bool = False,
    append: bool = False,
    progress: Callable[[int], object] = lambda _: None,
    on_start: Callable[[DatasetRenderer], object] = lambda _: None,
) -> DatasetResult:
    """Make a dataset of labeled images.

    Args:
        worlds: one world or several, by file or name.
        path: the folder of the dataset.
        images: the number of images to make.
        models: the files of robots or models to add to each world.
        classes: the YAML file of classes; None for one class per model.
        options: how images are made, such as their size and the random seed; None for the defaults.
        formats: the formats of the labels, ``coco`` and ``yolo``.
        workers: the number of processes; None for one per usable processor.
        force: replace the dataset in the folder.
        append: add to the dataset in the folder.
        progress: called with the number of finished images after each image.
        on_start: called with the renderer before the first image.

    Raises:
        LinkwrightError: VISION201 to VISION208, or an error in a world. The images finished before the error form a
            complete dataset.
    """
    path = Path(path)
    options = options or Options()
    world_names = (worlds,) if isinstance(worlds, (str, Path)) else worlds
    source = DatasetInput(
        tuple(map(str, world_names)), tuple(map(str, models)), str(classes) if classes else None, options
    )
    workers = workers or usable_processors()
    with closing(DatasetRenderer(source)) as renderer:
        on_start(renderer)
        folder = DatasetFolder(
            path, renderer.classes, (options.width, options.height), tuple(formats), options.image_format
        )
        folder.open(force=force, append=append)
        card = _make_run_card(source, renderer)
        numbers = range(folder.first_number, folder.first_number + images)
        in_this_process = workers == 1 or images <= IMAGES_PER_PATTERN_SET
        samples = (
            map(renderer.render_image, numbers) if in_this_process else make_in_processes(source, numbers, workers)
        )
        sheet_samples: list[LabeledImage] = []
        added, was_interrupted, image_error = 0, False, None
        try:
            for sample in _yield_and_close(samples):
                folder.add(sample)
                added += 1
                if sample.index < folder.first_number + MAX_SHEET_IMAGES:
                    sheet_samples.append(sample)
                progress(added)
        except KeyboardInterrupt:
            was_interrupted = True
        except OSError as error:
            image_error = write_error(path, error)
        finally:
            folder.finish(card)
    if image_error is not None:
        raise image_error
    try:
        write_whole_file(path / SHEET_FILE, make_contact_sheet(sheet_samples, renderer.classes))
    except OSError as error:
        raise write_error(path, error) from None
    return DatasetResult(folder, added, was_interrupted)


def _yield_and_close(samples: Iterator[LabeledImage]) -> Iterator[LabeledImage]:
    """Yield the images of an iterator, and close the iterator at the end or on an error."""
    try:
        yield from samples
    finally:
        close = getattr(samples, "close", None)
        if close is not None:
            close()


def _make_run_card(source: DatasetInput, renderer: DatasetRenderer) -> dict[str, Any]:
    worlds = [
        {"name": name, "file": path.name, "sha256": hashlib.sha256(path.read_bytes()).hexdigest()}
        for name, path in zip(source.worlds, renderer.worlds, strict=True)
    ]
    return {
        "version": __version__,
        "worlds": worlds,
        "added": list(source.added_models),
        "renderer": str(renderer.render_method),
        "options": asdict(source.options),
    }
