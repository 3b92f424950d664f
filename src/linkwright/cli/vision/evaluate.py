"""``linkwright vision evaluate``: evaluate a detector on a dataset."""

from __future__ import annotations

import argparse
import json
from dataclasses import asdict
from pathlib import Path

from linkwright.cli.exit_status import FINE


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``vision evaluate``."""
    parser.add_argument("model", metavar="MODEL", help="an ONNX file, or the name of a detector")
    parser.add_argument(
        "dataset",
        metavar="DATASET",
        type=Path,
        help="the folder of the dataset, as `linkwright dataset` writes it, or its data.yaml",
    )
    parser.add_argument(
        "--split", metavar="NAME", help="train, val or test; default test, or val if there is no test split"
    )
    parser.add_argument("--confusion", action="store_true", help="also print the confusion matrix")
    parser.add_argument("--format", choices=("text", "json"), default="text", help="the output format")


def run(arguments: argparse.Namespace) -> int:
    """Evaluate a detector, and print the results."""
    from linkwright.vision.training.card import format_confusion_table, format_results_table
    from linkwright.vision.training.training_run import evaluate_on_dataset

    figures = evaluate_on_dataset(arguments.model, arguments.dataset, arguments.split)
    if arguments.format == "json":
        data = {**asdict(figures), "confusion": figures.confusion.tolist()}
        print(json.dumps(data, indent=2, ensure_ascii=False))
        return FINE
    print(f"{figures.images} images: mAP50 {figures.map50:.3f}, mAP50-95 {figures.map:.3f}")
    print("\n".join(format_results_table(figures)))
    if arguments.confusion:
        print("\n".join(["", *format_confusion_table(figures)]))
    return FINE
