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

_TABLE_PATH = Path(__file__).with_name("models.toml")


@dataclass(frozen=True, slots=True)
class ModelEntry:
    """A model that can be downloaded.

    Attributes:
        name: the model's name in `linkwright models`.
        kind: ``speech`` or ``vision``.
        address: the publisher's URL.
        megabytes: the approximate download size.
        license: the SPDX identifier.
        purpose: the purpose, in English.
        folder: the folder of the model in an archive; empty for a single file.
        sha256: the checksum of the download; None if only the checksums of `files` are known.
        files: the paths in an archive, relative to `folder`, with their SHA-256.
    """

    name: str
    kind: str
    address: str
    megabytes: int
    license: str
    purpose: str
    folder: str = ""
    sha256: str | None = None
    files: Mapping[str, str] = field(default_factory=dict)

    @property
    def file_name(self) -> str:
        """The file name of the download."""
        return self.address.rpartition("/")[2]

    @property
    def installed_name(self) -> str:
        """The name of the installed folder or file."""
        return self.folder or self.file_name

    @property
    def max_bytes(self) -> int:
        """The maximum size of the download in bytes."""
        return 2 * self.megabytes * 1_000_000


@cache
def model_table() -> Mapping[str, ModelEntry]:
    """Return the models by name, in the table's order."""
    tables = tomllib.loads(_TABLE_PATH.read_text(encoding="utf-8"))
    return {name: ModelEntry(name=name, **table) for name, table in tables.items()}


def model_entry(name: str) -> ModelEntry:
    """Return the model with a name.

    Raises:
        LinkwrightError: MODEL101 if there is no such model.
    """
    entry = model_table().get(name)
    if entry is None:
        hint = did_you_mean(name, model_table()) or phrase("choose from {names}", names=joined(model_table()))
        raise LinkwrightError(Diagnostic("MODEL101", phrase("there is no model '{name}'", name=name), hint=hint))
    return entry
