"""Robots, and the results of ros/xacro and urdfdom for them.

The corpus of the repository is ``tests/corpus``. A second corpus of the same form is tested too if it is beside the
checkout (``../shared/corpus``) or if ``LINKWRIGHT_CORPUS`` names it: for instance public robots, whose licenses keep
them out of the repository.
"""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from tests.places import REPOSITORY

FOLDER_MARK = "@CORPUS@"
"""Stands for the folder of the robots in expected texts."""


@dataclass(frozen=True)
class Corpus:
    """A folder of packages with robots, and with the results of ROS's programs for them."""

    folder: Path

    @cached_property
    def content(self) -> dict[str, Any]:
        """The manifest."""
        content: dict[str, Any] = json.loads((self.folder / "manifest.json").read_text(encoding="utf-8"))
        return content

    @property
    def robots(self) -> Path:
        """Return the folder of the robots' paths."""
        return self.folder / "robots"

    @property
    def packages(self) -> dict[str, str]:
        """Return the share folders of the packages by name."""
        return {name: str(self.folder / place) for name, place in self.content["packages"].items()}

    @property
    def models(self) -> list[Model]:
        """Return the robots, each with arguments."""
        return [Model(self, data) for data in self.content["models"]]


@dataclass(frozen=True)
class Model:
    """A robot, and the arguments for its expansion."""

    corpus: Corpus
    data: dict[str, Any]

    @property
    def path(self) -> Path:
        """Return the file to expand."""
        return self.corpus.robots / self.data["entry"]

    @property
    def arguments(self) -> dict[str, str]:
        """Return the values of its ``xacro:arg``."""
        return dict(self.data["args"])

    @property
    def packages(self) -> dict[str, str]:
        """Return the packages that it may name."""
        return self.corpus.packages

    @property
    def expected(self) -> str:
        """Return the expansion by ros/xacro, with a placeholder for the robots' folder."""
        return (self.corpus.folder / self.data["expected"]).read_text(encoding="utf-8")

    @property
    def diagram(self) -> str:
        """Return the output of urdf_to_graphviz."""
        return (self.corpus.folder / self.data["gv"]).read_text(encoding="utf-8")

    @property
    def accepted(self) -> bool:
        """Return whether check_urdf accepts the expansion."""
        return bool(self.data.get("urdfdom", {}).get("accepts"))

    @property
    def complaints(self) -> list[str]:
        """Return the errors of check_urdf, which accepted robots can have too."""
        return list(self.data["urdfdom"]["errors"]) if "urdfdom" in self.data else ["no links"]

    def marked(self, text: str) -> str:
        """Replace the robots' folder in a text by the placeholder."""
        return text.replace(str(self.corpus.robots), FOLDER_MARK)

    def __str__(self) -> str:
        return Path(self.data["expected"]).stem


OWN = Corpus(REPOSITORY / "tests" / "corpus")
BESIDE = Corpus(Path(os.environ.get("LINKWRIGHT_CORPUS", REPOSITORY.parent / "shared" / "corpus")).resolve())
CORPORA = [corpus for corpus in (OWN, BESIDE) if (corpus.folder / "manifest.json").is_file()]
MODELS = [model for corpus in CORPORA for model in corpus.models]
