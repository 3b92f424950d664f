"""Create a pack: a folder with wheels, models, worlds, documentation and installers."""

from __future__ import annotations

import os
import shutil
import stat
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from packaging.utils import parse_wheel_filename

from linkwright._version import __version__
from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, display_path, phrase
from linkwright.files.whole_files import write_whole_file
from linkwright.learning.packing.installers import write_installers
from linkwright.learning.packing.locked_files import LockedFile, check_extras, find_needed_files, load_locked_packages
from linkwright.learning.packing.optional_parts import describe_missing_parts
from linkwright.learning.packing.own_wheels import add_own_wheels
from linkwright.learning.packing.pack_folder import PackFolder, PackSettings, compute_sha256
from linkwright.learning.packing.pip_runs import build_wheel, download_wheels, is_for_all_systems
from linkwright.learning.packing.targets import Target
from linkwright.learning.packing.wheel_metadata import read_metadata
from linkwright.model_files import ModelEntry, install, is_installed, models_folder, verify
from linkwright.sdf.resources import list_fuel_caches

_BYTES_PER_MB = 1_000_000


@dataclass(frozen=True)
class PackContents:
    """The contents of a pack in addition to the wheels from a package index.

    Attributes:
        own_wheels: the wheels of Linkwright; if empty, they are built.
        models: the models to include.
        models_source: the source of models that are not downloaded yet: a folder, the address of a mirror, or None
            for the publishers' addresses.
        worlds: the folders with models of worlds, by their names in the pack (see `find_world_folders`).
        docs: the folder with the documentation, or None.
    """

    own_wheels: Sequence[Path] = ()
    models: Sequence[ModelEntry] = ()
    models_source: str | None = None
    worlds: Sequence[tuple[str, Path]] = ()
    docs: Path | None = None


@dataclass
class _PackBuilder:
    """A builder of one pack."""

    folder: PackFolder
    report: Callable[[Phrase], None]
    sums: dict[Path, str] = field(default_factory=dict)
    """The checksums of the wheels that are in the pack, by absolute path."""

    def add_locked(self, targets: Sequence[Target], extras: Sequence[str]) -> dict[Target, dict[str, Path]]:
        """Add the wheels from a package index, and return them by target and ``NAME==VERSION``."""
        packages = load_locked_packages()
        wheels_by_target: dict[Target, dict[str, Path]] = {}
        for target in targets:
            files = list(find_needed_files(target, extras, packages))
            wheels = [file for file in files if file.is_wheel]
            absent = [file for file in wheels if not self._has_file(file)]
            self.report(
                phrase(
                    "{target}: {count} of {total} wheels to download, {megabytes} MB",
                    target=target.label,
                    count=len(absent),
                    total=len(files),
                    megabytes=round(sum(file.size for file in absent) / _BYTES_PER_MB),
                )
            )
            if absent:
                download_wheels(absent, target, self.folder.wheels)
            for file in absent:
                self._verify(file)
            wheels_by_target[target] = {
                f"{file.package}=={file.version}": self.folder.wheels / file.name
                if file.is_wheel
                else self._build_wheel(file)
                for file in files
            }
        return wheels_by_target

    def _has_file(self, file: LockedFile) -> bool:
        path = self.folder.wheels / file.name
        if path in self.sums:
            return True
        if path.is_file() and path.stat().st_size == file.size and compute_sha256(path) == file.sha256:
            self.sums[path] = file.sha256
            return True
        return False

    def _verify(self, file: LockedFile) -> None:
        """Verify the checksum of a written file, because memory sticks fail."""
        if not self._has_file(file):
            message = phrase("'{file}' was not written correctly", file=display_path(self.folder.wheels / file.name))
            raise LinkwrightError(Diagnostic("LEARN304", message, hint=phrase("use another disk or memory stick")))

    def _build_wheel(self, file: LockedFile) -> Path:
        """Return the wheel of a package that is published only as source."""
        for path in self.folder.wheels.glob("*.whl"):
            name, version, _, _ = parse_wheel_filename(path.name)
            if (name, str(version)) == (file.package, file.version) and is_for_all_systems(path.name):
                return path
        self.report(phrase("building the wheel of {name} {version}", name=file.package, version=file.version))
        return build_wheel(file, self.folder.wheels)

    def write_requirements(
        self, target: Target, wheels: Mapping[str, Path], own_wheels: Iterable[Path], extras: str
    ) -> None:
        """Write the list of packages for a target."""
        lines = []
        for path in own_wheels:
            name, version, _, _ = parse_wheel_filename(path.name)
            requested_extras = extras if name == "linkwright" else ""
            lines.append(f"{name}{requested_extras}=={version} --hash=sha256:{self._compute_checksum(path)}\n")
        lines += [f"{name} --hash=sha256:{self._compute_checksum(path)}\n" for name, path in sorted(wheels.items())]
        write_whole_file(self.folder.requirements(target), "".join(lines))

    def _compute_checksum(self, path: Path) -> str:
        if path not in self.sums:
            self.sums[path] = compute_sha256(path)
        return self.sums[path]

    def remove_unneeded_files(self, needed_wheels: set[Path], targets: Sequence[Target]) -> None:
        """Remove wheels and package lists of an earlier pack that this pack does not need."""
        lists = {self.folder.requirements(target) for target in targets}
        for path in (*self.folder.wheels.glob("*.whl"), *lists.copy().pop().parent.glob("*.txt")):
            if path not in needed_wheels and path not in lists:
                path.unlink()


def find_world_folders() -> list[tuple[str, Path]]:
    """Return the folders of models downloaded by gz and Gazebo classic, by name in a pack."""
    folders = [("fuel", folder) for folder in list_fuel_caches(os.environ)]
    return [(name, path) for name, path in (*folders, ("gazebo", Path.home() / ".gazebo" / "models")) if path.is_dir()]


def make_pack(
    folder: PackFolder,
    settings: PackSettings,
    contents: PackContents,
    report: Callable[[Phrase], None],
    progress: Callable[[ModelEntry, int, int | None], None],
) -> list[Diagnostic]:
    """Create a pack, or complete an interrupted one.

    Args:
        folder: the folder, which is created.
        settings: the settings of the pack; the version and the models are filled in.
        contents: the further contents of the pack.
        report: called with a sentence about each step.
        progress: called with the progress of the download of a model.

    Returns:
        The reasons why models are missing in the pack.

    Raises:
        LinkwrightError: LEARN301 if a name is unknown, LEARN302 if the wheels of Linkwright cannot be made, LEARN303 if
            packages cannot be downloaded, LEARN304 if a file cannot be written, or LEARN307 if the folder has other
            files.
    """
    check_extras(settings.extras, load_locked_packages())
    targets = settings.targets
    try:
        folder.open()
        missing = describe_missing_parts(targets, settings.extras, load_locked_packages())
        settings = replace(settings, version=__version__, missing=missing)
        folder.write_settings(settings)
        builder = _PackBuilder(folder, report)
        report(phrase("the wheels of Linkwright"))
        own_wheels = add_own_wheels(contents.own_wheels, folder.wheels)
        wheels_by_target = builder.add_locked(targets, settings.extras)
        builder.remove_unneeded_files(
            {*own_wheels, *(path for wheels in wheels_by_target.values() for path in wheels.values())}, targets
        )
        extras = f"[{','.join(settings.extras)}]" if settings.extras else ""
        for target, wheels in wheels_by_target.items():
            builder.write_requirements(target, wheels, own_wheels, extras)
        problems, models = _add_models(folder, contents, report, progress)
        _add_folders(folder, contents, report)
        version = str(read_metadata(own_wheels[-1])["Version"])
        settings = replace(settings, version=version, models=models)
        folder.write_settings(settings)
        write_installers(folder, settings)
        folder.write_sums(builder.sums)
    except OSError as error:
        raise _write_error(folder, error) from None
    return problems


def _write_error(folder: PackFolder, error: OSError) -> LinkwrightError:
    message = phrase(
        "cannot write '{path}': {reason}",
        path=error.filename or display_path(folder.path),
        reason=error.strerror or str(error),
    )
    hint = phrase("free disk space or choose another folder, then repeat the command to continue")
    return LinkwrightError(Diagnostic("LEARN304", message, hint=hint))


def _add_models(
    folder: PackFolder,
    contents: PackContents,
    report: Callable[[Phrase], None],
    progress: Callable[[ModelEntry, int, int | None], None],
) -> tuple[list[Diagnostic], list[str]]:
    """Add models, and return the reasons why some are missing, and the names of the others."""
    problems: list[Diagnostic] = []
    names = []
    for entry in contents.models:
        if not _has_model(entry, folder.models):
            report(phrase("the model {name}, about {megabytes} MB", name=entry.name, megabytes=entry.megabytes))
            source = str(models_folder()) if _has_model(entry, models_folder()) else contents.models_source
            try:
                install(entry, source, folder.models, lambda done, total, entry=entry: progress(entry, done, total))  # type: ignore[misc]
            except LinkwrightError as error:
                problems += error.diagnostics
                continue
        names.append(entry.name)
    return problems, names


def _has_model(entry: ModelEntry, folder: Path) -> bool:
    if not is_installed(entry, folder):
        return False
    try:
        verify(entry, folder / entry.installed_name)
    except LinkwrightError:
        return False
    return True


def _add_folders(folder: PackFolder, contents: PackContents, report: Callable[[Phrase], None]) -> None:
    """Add the models of worlds and the documentation."""
    for name, source in contents.worlds:
        report(phrase("the models of worlds in '{path}'", path=display_path(source)))
        _copy_tree(source, folder.worlds / name)
    if contents.docs is not None:
        report(phrase("the documentation in '{path}'", path=display_path(contents.docs)))
        _copy_tree(contents.docs, folder.docs)


def _copy_tree(source: Path, target: Path) -> None:
    """Copy the files that differ in size or time.

    Permissions are omitted, because memory sticks lack them.
    """
    for path in sorted(source.rglob("*")):
        copy = target / path.relative_to(source)
        if not path.is_file():
            continue
        source_stat, copy_stat = path.stat(), _get_status(copy)
        if copy_stat is None or (copy_stat.st_size, copy_stat.st_mtime) != (source_stat.st_size, source_stat.st_mtime):
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(path, copy)
            os.utime(copy, (source_stat.st_mtime, source_stat.st_mtime))


def _get_status(path: Path) -> os.stat_result | None:
    try:
        status = path.stat()
    except OSError:
        return None
    return status if stat.S_ISREG(status.st_mode) else None
