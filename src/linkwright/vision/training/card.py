"""The card of a network: how it was trained, its results, and its failures."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from linkwright.vision.evaluation import ClassResults, Evaluation

_MIN_RECALL = 0.8  # the recall below which a class is listed as a failure
_MIN_CONFUSION = 0.05  # the share of a class confused with another one, above which the confusion is listed


@dataclass(frozen=True, slots=True)
class EvaluationReport:
    """The results of a network on a set of images.

    Attributes:
        title: the description of the images, used as the heading.
        evaluation: the results.
        origin: the worlds and options of the images' dataset; empty if unknown.
    """

    title: str
    evaluation: Evaluation
    origin: str = ""


def make_card(name: str, facts: Mapping[str, str], reports: Sequence[EvaluationReport]) -> str:
    """Return the card as Markdown.

    Args:
        name: the name of the network.
        facts: the facts about the training, in the order of the card.
        reports: the results, first on the held-back images of the training dataset.
    """
    lines = [f"# {name}", "", "| | |", "| --- | --- |"]
    lines += [f"| {key} | {_escape_cell(value)} |" for key, value in facts.items()]
    for report in reports:
        origin_lines = [report.origin, ""] if report.origin else []
        lines += ["", f"## {report.title}", "", *origin_lines, *_format_results(report.evaluation)]
    lines += ["", "## Where it fails", ""]
    failures = [line for report in reports for line in _list_failures(report)]
    lines += failures or ["Nothing stands out in these images."]
    return "\n".join(lines) + "\n"


def collect_dataset_facts(folder: Path) -> dict[str, str]:
    """Return the card's entries on how a dataset was made, or an empty dict if unknown."""
    record = _read_record(folder)
    if record is None:
        return {}
    worlds = ", ".join(f"{name} (sha256 {digest[:12]})" for name, digest in sorted(record.worlds))
    facts = {"worlds": worlds, "options of linkwright dataset": record.options}
    return {**facts, "robots and models put in": ", ".join(sorted(record.added))} if record.added else facts


def describe_origin(folder: Path, training_folder: Path) -> str:
    """Describe the worlds of a dataset, and whether the network was also trained on them.

    Args:
        folder: the folder of the dataset used for evaluation.
        training_folder: the folder of the dataset used for training.
    """
    record, training_record = _read_record(folder), _read_record(training_folder)
    if record is None:
        return ""
    worlds = f"Worlds: {', '.join(sorted(name for name, _ in record.worlds))}. Options: {record.options}."
    if training_record is None:
        return worlds
    digests = {digest for _, digest in training_record.worlds}
    shared_worlds = ", ".join(sorted(name for name, digest in record.worlds if digest in digests))
    sentence = (
        f"It was trained on other images of {shared_worlds}." if shared_worlds else "It was trained on none of them."
    )
    return f"{worlds} {sentence}"


@dataclass(frozen=True, slots=True)
class _DatasetRecord:
    """The record of how a dataset was made.

    Attributes:
        worlds: pairs of name and SHA-256.
        options: the options, in words.
        added: the added files.
    """

    worlds: frozenset[tuple[str, str]]
    options: str
    added: frozenset[str]


def _read_record(folder: Path) -> _DatasetRecord | None:
    """Return the record of how `linkwright dataset` made a dataset, or None if there is none."""
    try:
        runs = json.loads((folder / "dataset.json").read_text(encoding="utf-8"))["made"]
        worlds = {(Path(entry["file"]).stem, str(entry["sha256"])) for run in runs for entry in run["worlds"]}
        added = {str(entry) for run in runs for entry in run["added"]}
        options = [", ".join(f"{key} {value}" for key, value in run["options"].items()) for run in runs]
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return None
    return _DatasetRecord(frozenset(worlds), "; ".join(dict.fromkeys(options)), frozenset(added))


def format_results_table(evaluation: Evaluation) -> list[str]:
    """Return the results of all classes as lines of a Markdown table."""
    lines = ["| class | objects | mAP50 | mAP50-95 | precision | recall |", f"| --- |{' ---: |' * 5}"]
    lines += [_format_table_row(class_results) for class_results in evaluation.classes]
    objects = sum(row.objects for row in evaluation.classes)
    lines.append(f"| all | {objects} | {evaluation.map50:.3f} | {evaluation.map:.3f} | | |")
    return lines


def format_confusion_table(evaluation: Evaluation) -> list[str]:
    """Return the confusion matrix as a Markdown table, with rows of labels.

    The columns are the detected classes.
    """
    names = [class_results.name for class_results in evaluation.classes]
    lines = [f"| label \\ detection | {' | '.join(names)} | nothing |", "| --- |" + " ---: |" * (len(names) + 1)]
    for name, row in zip([*names, "nothing"], evaluation.confusion.tolist(), strict=True):
        lines.append(f"| {name} | {' | '.join(str(count) if count else '' for count in row)} |")
    return lines


def _format_results(evaluation: Evaluation) -> list[str]:
    sizes = [
        f"| {name} | {objects} | {recall:.2f} |" for name, objects, recall in evaluation.recall_by_size if objects
    ]  # fmt: skip
    return [
        f"{evaluation.images} images. Precision and recall at a score of 0.5.",
        "",
        *format_results_table(evaluation),
        "",
        "| longer side | objects | recall |",
        "| --- | ---: | ---: |",
        *sizes,
    ]


def _format_table_row(results: ClassResults) -> str:
    values = (results.ap50, results.ap, results.precision, results.recall)
    return f"| {results.name} | {results.objects} | {' | '.join(map(_format_number, values))} |"


def _format_number(value: float | None) -> str:
    return "" if value is None else f"{value:.3f}"


def _list_failures(report: EvaluationReport) -> list[str]:
    """Return Markdown list items about sizes and classes that are often missed or confused."""
    lines = []
    for name, objects, recall in report.evaluation.recall_by_size:
        if objects and recall < _MIN_RECALL:
            lines.append(f"- {report.title}: of objects {name} it misses {1 - recall:.0%}.")
    names = [class_results.name for class_results in report.evaluation.classes]
    for index, kind in enumerate(report.evaluation.classes):
        if kind.recall is not None and kind.recall < _MIN_RECALL:
            lines.append(f"- {report.title}: it misses {1 - kind.recall:.0%} of {kind.name}.")
        row = report.evaluation.confusion[index]
        for other_index, count in enumerate(row[:-1].tolist()):
            if other_index != index and kind.objects and count / kind.objects >= _MIN_CONFUSION:
                lines.append(
                    f"- {report.title}: it takes {count / kind.objects:.0%} of {kind.name} for {names[other_index]}."
                )
    return lines


def _escape_cell(text: str) -> str:
    return text.replace("|", "\\|").replace("\n", " ")
