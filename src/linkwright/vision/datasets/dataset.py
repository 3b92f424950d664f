"""Create a dataset in one or several processes, and write it."""

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
from linkwright.vision.datasets.contact_sheet import MOST, contact_sheet
from linkwright.vision.datasets.folder import SHEET, DatasetFolder, cannot_write
from linkwright.vision.datasets.making import CHAPTER, LabelledImage, Source, Studio
from linkwright.vision.datasets.options import FORMATS, Options
from linkwright.vision.datasets.workers import make_in_processes


@dataclass(frozen=True, slots=True)
class DatasetResult:
    """The result of creating a dataset.

    Attributes:
        folder: the folder of the dataset.
        added: the number of images made.
        interrupted: whether Ctrl-C ended it early.
    """

    folder: DatasetFolder
    added: int
    interrupted: bool


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
    begin: Callable[[Studio], object] = lambda _: None,
) -> DatasetResult:
    """Make a dataset of labelled images.

    Args:
        worlds: the world, or the worlds, by file or name.
        path: the folder of the dataset.
        images: the number of images to make.
        models: the files of robots or models to add to each world.
        classes: the YAML file of classes; None for a class for each model.
        options: the options of making images, such as their size and the random seed; None for the defaults.
        formats: the formats of the labels, ``coco`` and ``yolo``.
        workers: the number of processes; None for one on each usable processor.
        force: remove the dataset that is in the folder.
        append: add to the dataset that is in the folder.
        progress: called with the number of finished images.
        begin: called before the first image.

    Raises:
        LinkwrightError: VISION201 to VISION208, or an error in a world. The dataset written so far is complete.
    """
    path = Path(path)
    options = options or Options()
    names = (worlds,) if isinstance(worlds, (str, Path)) else worlds
    source = Source(tuple(map(str, names)), tuple(map(str, models)), str(classes) if classes else None, options)
    workers = workers or usable_processors()
    with closing(Studio(source)) as studio:
        begin(studio)
        folder = DatasetFolder(path, studio.classes, (options.width, options.height), tuple(formats), options.form)
        folder.open(force=force, append=append)
        card = _card(source, studio)
        numbers = range(folder.first, folder.first + images)
        alone = workers == 1 or images <= CHAPTER
        taking = map(studio.make, numbers) if alone else make_in_processes(source, numbers, workers)
        shown: list[LabelledImage] = []
        added, interrupted, wrong = 0, False, None
        try:
            for taken in _each(taking):
                folder.add(taken)
                added += 1
                if taken.index < folder.first + MOST:
                    shown.append(taken)
                progress(added)
        except KeyboardInterrupt:
            interrupted = True
        except OSError as error:
            wrong = cannot_write(path, error)
        finally:
            folder.finish(card)
    if wrong is not None:
        raise wrong
    try:
        write_whole_file(path / SHEET, contact_sheet(shown, studio.classes))
    except OSError as error:
        raise cannot_write(path, error) from None
    return DatasetResult(folder, added, interrupted)


def _each(taking: Iterator[LabelledImage]) -> Iterator[LabelledImage]:
    """Yield images from an iterator, and close the iterator at the end."""
    try:
        yield from taking
    finally:
        close = getattr(taking, "close", None)
        if close is not None:
            close()


def _card(source: Source, studio: Studio) -> dict[str, Any]:
    worlds = [
        {"name": name, "file": path.name, "sha256": hashlib.sha256(path.read_bytes()).hexdigest()}
        for name, path in zip(source.worlds, studio.worlds, strict=True)
    ]
    return {
        "version": __version__,
        "worlds": worlds,
        "added": list(source.added),
        "renderer": str(studio.way),
        "options": asdict(source.options),
    }
