"""The files of a pack, and its settings in ``pack.json``."""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, display_path, foreign, phrase
from linkwright.files.whole_files import write_whole_file
from linkwright.learning.packing.targets import Target, select_targets

_SETTINGS_FILE, _SUMS_FILE = "pack.json", "SHA256SUMS"
_BLOCK_BYTES = 1 << 20
_DIGEST_OPTION = re.compile(r"--hash=sha256:([0-9a-f]{64})")


@dataclass(frozen=True)
class PackSettings:
    """The settings of a pack.

    Attributes:
        version: the version of Linkwright.
        systems: the systems, keys of `SYSTEMS`.
        pythons: the versions of Python.
        extras: the extras of Linkwright.
        models: the names of the models in the pack.
        missing: the features that are missing on a target, by target and language.
    """

    version: str
    systems: Sequence[str]
    pythons: Sequence[str]
    extras: Sequence[str]
    models: Sequence[str] = ()
    missing: Mapping[str, Mapping[str, Sequence[str]]] = field(default_factory=dict)

    @property
    def targets(self) -> list[Target]:
        """The targets of the pack."""
        return select_targets(self.systems, self.pythons)


@dataclass(frozen=True)
class PackFolder:
    """The folder of a pack.

    Attributes:
        path: the path of the folder.
    """

    path: Path

    @property
    def wheels(self) -> Path:
        """The folder of the wheels for all targets."""
        return self.path / "wheels"

    @property
    def models(self) -> Path:
        """The folder of the models, as `linkwright models get --from` reads it."""
        return self.path / "models"

    @property
    def worlds(self) -> Path:
        """The folder of the models for worlds, in the layout of gz's cache."""
        return self.path / "worlds"

    @property
    def docs(self) -> Path:
        """The folder of the documentation."""
        return self.path / "docs"

    def requirements(self, target: Target) -> Path:
        """Return the path of the requirements file of a target, with versions and checksums."""
        return self.path / "requirements" / f"{target.name}.txt"

    def open(self) -> None:
        """Create the folder if it does not exist.

        Raises:
            LinkwrightError: LEARN307 if it has files and is not a pack.
            OSError: it cannot be created.
        """
        self.path.mkdir(parents=True, exist_ok=True)
        if any(self.path.iterdir()) and not (self.path / _SETTINGS_FILE).exists():
            message = phrase("'{path}' is neither empty nor a pack", path=display_path(self.path))
            hint = phrase("pass a new folder, or one that `linkwright learn pack` created")
            raise LinkwrightError(Diagnostic("LEARN307", message, hint=hint))
        self.wheels.mkdir(exist_ok=True)
        self.requirements(select_targets((), ())[0]).parent.mkdir(exist_ok=True)
        (self.path / _SUMS_FILE).unlink(missing_ok=True)

    def write_settings(self, settings: PackSettings) -> None:
        """Write the settings."""
        write_whole_file(self.path / _SETTINGS_FILE, json.dumps(asdict(settings), indent=2, ensure_ascii=False) + "\n")

    def read_settings(self) -> PackSettings:
        """Return the settings.

        Raises:
            LinkwrightError: LEARN307 if the folder is not a pack.
        """
        file = self.path / _SETTINGS_FILE
        try:
            settings = PackSettings(**json.loads(file.read_text(encoding="utf-8")))
        except (OSError, ValueError, TypeError) as error:
            message = phrase(
                "'{path}' is not a pack: {reason}",
                path=display_path(self.path),
                reason=foreign(_describe_reason(error)),
            )
            raise LinkwrightError(Diagnostic("LEARN307", message)) from None
        return settings

    def files(self) -> Iterator[Path]:
        """Yield the files of the pack, except checksums and Python archives added by a teacher."""
        for path in sorted(self.path.rglob("*")):
            relative = path.relative_to(self.path)
            if path.is_file() and relative.parts[0] not in (_SUMS_FILE, "python"):
                yield relative

    def write_sums(self, known: Mapping[Path, str]) -> None:
        """Write the checksums of all files, as ``sha256sum --check`` reads them.

        Args:
            known: the checksums of already verified files, by absolute path.
        """
        lines = []
        for file in self.files():
            path = self.path / file
            lines.append(f"{known.get(path) or compute_sha256(path)}  {file.as_posix()}\n")
        write_whole_file(self.path / _SUMS_FILE, "".join(lines))

    def read_sums(self) -> dict[str, str]:
        """Return the checksums by file.

        Raises:
            LinkwrightError: LEARN305 if the pack is not complete.
        """
        try:
            lines = (self.path / _SUMS_FILE).read_text(encoding="utf-8").splitlines()
            return {name: digest for digest, name in (line.split("  ", 1) for line in lines)}
        except (OSError, ValueError):
            message = phrase("the pack '{path}' is not complete", path=display_path(self.path))
            hint = phrase("run the command that created it again; it continues where it was interrupted")
            raise LinkwrightError(Diagnostic("LEARN305", message, hint=hint)) from None


def _describe_reason(error: Exception) -> str:
    return getattr(error, "strerror", None) or str(error)


def compute_sha256(path: Path) -> str:
    """Return the SHA-256 of a file.

    Raises:
        OSError: it cannot be read.
    """
    digest = hashlib.sha256()
    with path.open("rb") as file:
        while block := file.read(_BLOCK_BYTES):
            digest.update(block)
    return digest.hexdigest()


def compute_installed_size(folder: PackFolder, targets: Iterable[Target]) -> int:
    """Return the total size, in bytes, of the wheels that some targets need."""
    sums = folder.read_sums()
    digests = {
        digest
        for target in targets
        for digest in _DIGEST_OPTION.findall(folder.requirements(target).read_text(encoding="utf-8"))
    }
    return sum((folder.path / file).stat().st_size for file, digest in sums.items() if digest in digests)
