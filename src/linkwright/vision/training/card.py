"""The card of a network: its training, its results, and its failures."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from linkwright.vision.evaluation import ClassFigures, Evaluation

_WEAK = 0.8  # the recall below which a class is listed as a failure
_OFTEN = 0.05  # the share of a class confused with another one, above which the confusion is listed


@dataclass(frozen=True, slots=True)
class Examination:
    """The results of a network on a set of images.

    Attributes:
        title: the description of the images.
        figures: the results.
        origin: the worlds and options of their dataset; empty if unknown.
    """

    title: str
    figures: Evaluation
    origin: str = ""


def card(name: str, facts: Mapping[str, str], examinations: Sequence[Examination]) -> str:
    """Return the card as Markdown.

    Args:
        name: the name of the network.
        facts: the facts about the training, in the order of the card.
        examinations: the evaluations, first on the held-back images of the same dataset.
    """
    lines = [f"# {name}", "", "| | |", "| --- | --- |"]
    lines += [f"| {key} | {_cell(value)} |" for key, value in facts.items()]
    for examination in examinations:
        origin = [examination.origin, ""] if examination.origin else []
        lines += ["", f"## {examination.title}", "", *origin, *_figures(examination.figures)]
    lines += ["", "## Where it fails", ""]
    failures = [line for examination in examinations for line in _failures(examination)]
    lines += failures or ["Nothing stands out in these images."]
    return "\n".join(lines) + "\n"


def made_of(folder: Path) -> dict[str, str]:
    """Return the card entries on how a dataset was made; empty for a dataset of another program."""
    making = _making(folder)
    if making is None:
        return {}
    worlds = ", ".join(f"{name} (sha256 {digest[:12]})" for name, digest in sorted(making.worlds))
    made = {"worlds": worlds, "options of linkwright dataset": making.options}
    return {**made, "robots and models put in": ", ".join(sorted(making.added))} if making.added else made


def origin(folder: Path, lesson: Path) -> str:
    """Describe the worlds of a dataset, and whether the network was also trained on them.

    Args:
        folder: the folder of the dataset used for evaluation.
        lesson: the folder of the dataset used for training.
    """
    making, taught = _making(folder), _making(lesson)
    if making is None:
        return ""
    worlds = f"Worlds: {', '.join(sorted(name for name, _ in making.worlds))}. Options: {making.options}."
    if taught is None:
        return worlds
    digests = {digest for _, digest in taught.worlds}
    known = ", ".join(sorted(name for name, digest in making.worlds if digest in digests))
    return f"{worlds} {f'It was trained on other images of {known}.' if known else 'It was trained on none of them.'}"


@dataclass(frozen=True, slots=True)
class _Making:
    """A record of how a dataset was made: worlds as pairs of name and SHA-256, options in words, added files."""

    worlds: frozenset[tuple[str, str]]
    options: str
    added: frozenset[str]


def _making(folder: Path) -> _Making | None:
    """Return the record that `linkwright dataset` wrote; None if there is none."""
    try:
        runs = json.loads((folder / "dataset.json").read_text(encoding="utf-8"))["made"]
        worlds = {(Path(entry["file"]).stem, str(entry["sha256"])) for run in runs for entry in run["worlds"]}
        added = {str(entry) for run in runs for entry in run["added"]}
        options = [", ".join(f"{key} {value}" for key, value in run["options"].items()) for run in runs]
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return None
    return _Making(frozenset(worlds), "; ".join(dict.fromkeys(options)), frozenset(added))


def table(figures: Evaluation) -> list[str]:
    """Return the results of all classes as lines of a Markdown table."""
    lines = ["| class | objects | mAP50 | mAP50-95 | precision | recall |", f"| --- |{' ---: |' * 5}"]
    lines += [_row(row) for row in figures.classes]
    objects = sum(row.objects for row in figures.classes)
    lines.append(f"| all | {objects} | {figures.map50:.3f} | {figures.map:.3f} | | |")
    return lines


def confusion(figures: Evaluation) -> list[str]:
    """Return the confusion matrix as lines of a Markdown table: rows are labels, columns detections."""
    names = [class_figures.name for class_figures in figures.classes]
    lines = [f"| label \\ detection | {' | '.join(names)} | nothing |", "| --- |" + " ---: |" * (len(names) + 1)]
    for name, row in zip([*names, "nothing"], figures.confusion.tolist(), strict=True):
        lines.append(f"| {name} | {' | '.join(str(count) if count else '' for count in row)} |")
    return lines


def _figures(figures: Evaluation) -> list[str]:
    sizes = [
        f"| {name} | {objects} | {recall:.2f} |" for name, objects, recall in figures.recall_by_size if objects
    ]  # fmt: skip
    return [
        f"{figures.images} images. Precision and recall at a score of 0.5.",
        "",
        *table(figures),
        "",
        "| longer side | objects | recall |",
        "| --- | ---: | ---: |",
        *sizes,
    ]


def _row(row: ClassFigures) -> str:
    values = (row.ap50, row.ap, row.precision, row.recall)
    return f"| {row.name} | {row.objects} | {' | '.join(map(_number, values))} |"


def _number(value: float | None) -> str:
    return "" if value is None else f"{value:.3f}"


def _failures(examination: Examination) -> list[str]:
    """Return Markdown list items on sizes and classes that are often missed, and on confused classes."""
    lines = []
    for name, objects, recall in examination.figures.recall_by_size:
        if objects and recall < _WEAK:
            lines.append(f"- {examination.title}: of objects {name} it misses {1 - recall:.0%}.")
    names = [kind.name for kind in examination.figures.classes]
    for place, kind in enumerate(examination.figures.classes):
        if kind.recall is not None and kind.recall < _WEAK:
            lines.append(f"- {examination.title}: it misses {1 - kind.recall:.0%} of {kind.name}.")
        row = examination.figures.confusion[place]
        for other, count in enumerate(row[:-1].tolist()):
            if other != place and kind.objects and count / kind.objects >= _OFTEN:
                lines.append(
                    f"- {examination.title}: it takes {count / kind.objects:.0%} of {kind.name} for {names[other]}."
                )
    return lines


def _cell(text: str) -> str:
    return text.replace("|", "\\|").replace("\n", " ")
