"""Robots with what ros/xacro and urdfdom make of them.

The corpus of the repository, ``tests/corpus``, is always there. Another one of the same form, for instance of public
robots, whose licenses keep it out of the repository, is tested as well where it lies beside the checkout
(``../shared/corpus``) or where ``LINKWRIGHT_CORPUS`` names it.
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
    """A folder of packages with robots, and of what the programs of ROS make of them."""

    folder: Path

    @cached_property
    def content(self) -> dict[str, Any]:
        """The manifest."""
        content: dict[str, Any] = json.loads((self.folder / "manifest.json").read_text(encoding="utf-8"))
        return content

    @property
    def robots(self) -> Path:
        """The folder that the paths of robots begin with."""
        return self.folder / "robots"

    @property
    def packages(self) -> dict[str, str]:
        """The share folders of the packages by their names."""
        return {name: str(self.folder / place) for name, place in self.content["packages"].items()}

    @property
    def models(self) -> list[Model]:
        """The robots, each with arguments."""
        return [Model(self, data) for data in self.content["models"]]


@dataclass(frozen=True)
class Model:
    """A robot with the arguments it is expanded with."""

    corpus: Corpus
    data: dict[str, Any]

    @property
    def path(self) -> Path:
        """The file to expand."""
        return self.corpus.robots / self.data["entry"]

    @property
    def arguments(self) -> dict[str, str]:
        """The values of its ``xacro:arg``."""
        return dict(self.data["args"])

    @property
    def packages(self) -> dict[str, str]:
        """The packages that it may name."""
        return self.corpus.packages

    @property
    def expected(self) -> str:
        """The expansion that ros/xacro writes, with a mark for the folder of the robots."""
        return (self.corpus.folder / self.data["expected"]).read_text(encoding="utf-8")

    @property
    def diagram(self) -> str:
        """What urdf_to_graphviz writes."""
        return (self.corpus.folder / self.data["gv"]).read_text(encoding="utf-8")

    @property
    def accepted(self) -> bool:
        """Whether check_urdf accepts the expansion."""
        return bool(self.data.get("urdfdom", {}).get("accepts"))

    @property
    def complaints(self) -> list[str]:
        """The errors that check_urdf tells, of an accepted robot too."""
        return list(self.data["urdfdom"]["errors"]) if "urdfdom" in self.data else ["no links"]

    def marked(self, text: str) -> str:
        """A text of this machine with the mark for the folder of the robots."""
        return text.replace(str(self.corpus.robots), FOLDER_MARK)

    def __str__(self) -> str:
        return Path(self.data["expected"]).stem


OWN = Corpus(REPOSITORY / "tests" / "corpus")
BESIDE = Corpus(Path(os.environ.get("LINKWRIGHT_CORPUS", REPOSITORY.parent / "shared" / "corpus")).resolve())
CORPORA = [corpus for corpus in (OWN, BESIDE) if (corpus.folder / "manifest.json").is_file()]
MODELS = [model for corpus in CORPORA for model in corpus.models]
