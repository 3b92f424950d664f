"""The table of models, ``models.toml``, as data."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, did_you_mean, joined, phrase

tomllib: Any = import_module("tomllib" if sys.version_info >= (3, 11) else "tomli")

_TABLE = Path(__file__).with_name("models.toml")


@dataclass(frozen=True, slots=True)
class ModelEntry:
    """A model that can be fetched.

    Attributes:
        name: as `linkwright models` calls it.
        kind: ``speech`` or ``vision``.
        address: where its makers offer it.
        megabytes: about so much to fetch.
        licence: SPDX's name of it.
        purpose: what it is for, in English.
        folder: of an archive: the folder in it that is the model; empty for a model that is one file.
        sha256: of what is fetched; None where only the sums of `files` are known.
        files: of an archive: path of each file below `folder`, with its SHA-256.
    """

    name: str
    kind: str
    address: str
    megabytes: int
    licence: str
    purpose: str
    folder: str = ""
    sha256: str | None = None
    files: Mapping[str, str] = field(default_factory=dict)

    @property
    def file_name(self) -> str:
        """The name of what is fetched."""
        return self.address.rpartition("/")[2]

    @property
    def place(self) -> str:
        """The name of the folder or file that it is when it is installed."""
        return self.folder or self.file_name

    @property
    def most_bytes(self) -> int:
        """More than this is not the model."""
        return 2 * self.megabytes * 1_000_000


@cache
def model_table() -> Mapping[str, ModelEntry]:
    """The models by name, in the table's order."""
    tables = tomllib.loads(_TABLE.read_text(encoding="utf-8"))
    return {name: ModelEntry(name=name, **table) for name, table in tables.items()}


def model_entry(name: str) -> ModelEntry:
    """A model by its name.

    Raises:
        LinkwrightError: MODEL101 there is none of this name.
    """
    entry = model_table().get(name)
    if entry is None:
        hint = did_you_mean(name, model_table()) or phrase("there are: {names}", names=joined(model_table()))
        raise LinkwrightError(Diagnostic("MODEL101", phrase("there is no model '{name}'", name=name), hint=hint))
    return entry
