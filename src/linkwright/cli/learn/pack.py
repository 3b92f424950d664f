"""``linkwright learn pack``: make a folder for installation without a network."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.cli.exit_status import FINE, print_message
from linkwright.cli.progress import ProgressLine
from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, display_path, joined, phrase
from linkwright.diagnostics.translation import language, localized

if TYPE_CHECKING:
    from linkwright.learning.packing.pack_folder import PackFolder, PackSettings
    from linkwright.model_files import ModelEntry

_BYTES_PER_MB = 1_000_000
_ALL, _NONE = "all", "none"


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``learn pack``."""
    parser.add_argument("folder", metavar="FOLDER", type=Path, help="the folder of the pack, which is created")
    parser.add_argument(
        "--check", action="store_true", help="check a pack: its checksums, and the wheels for each system and Python"
    )
    parser.add_argument(
        "--systems",
        metavar="SYSTEM,...",
        type=_split_names,
        default=[],
        help="only these systems: windows, macos-arm64, macos-x86_64, linux-x86_64, linux-aarch64 (default: all)",
    )
    parser.add_argument(
        "--python",
        metavar="VERSION,...",
        type=_split_names,
        default=[],
        help="only these versions of Python (default: all)",
    )
    parser.add_argument(
        "--extras",
        metavar="EXTRA,...",
        type=_split_names,
        default=["learn"],
        help="the extras (default: learn)",
    )
    parser.add_argument(
        "--wheel",
        metavar="FILE",
        type=Path,
        action="append",
        default=[],
        help="a wheel of linkwright or linkwright-core; give both (default: those of the running program)",
    )
    parser.add_argument(
        "--models",
        metavar="MODEL,...",
        type=_split_names,
        default=[_ALL],
        help="the models, as `linkwright models list` names them, or none (default: all)",
    )
    parser.add_argument(
        "--models-from",
        metavar="SOURCE",
        help="the folder or the address of a mirror with the models that are not downloaded yet",
    )
    parser.add_argument("--no-worlds", action="store_true", help="leave out the models that gz and Gazebo downloaded")
    parser.add_argument("--docs", metavar="FOLDER", type=Path, help="the site of the documentation, from `make docs`")


def _split_names(text: str) -> list[str]:
    return [name.strip() for name in text.split(",") if name.strip()]


def run(arguments: argparse.Namespace) -> int:
    """Make or check a pack, and return 1 if it is incomplete."""
    _require_packaging()
    from linkwright.learning.packing.pack_folder import PackFolder

    folder = PackFolder(arguments.folder.expanduser().absolute())
    problems = [] if arguments.check else _make_pack(folder, arguments)
    problems += _check_pack(folder)
    if not any(problem.code.startswith("LEARN") for problem in problems):
        _print_summary(folder, folder.read_settings())
    if problems:
        raise LinkwrightError(*problems)
    return FINE


def _require_packaging() -> None:
    from importlib.util import find_spec

    if find_spec("packaging") is None:
        from linkwright.diagnostics.installation import find_installation

        hint = phrase("run `{command}`", command=find_installation().command_for_extras("learn"))
        raise LinkwrightError(Diagnostic("LEARN308", phrase("a pack needs the extra 'learn'"), hint=hint))


def _make_pack(folder: PackFolder, arguments: argparse.Namespace) -> list[Diagnostic]:
    from linkwright.learning.packing.pack_builder import PackContents, find_world_folders, make_pack
    from linkwright.learning.packing.pack_folder import PackSettings
    from linkwright.learning.packing.targets import PYTHONS, SYSTEMS

    settings = PackSettings(
        version="",
        systems=arguments.systems or list(SYSTEMS),
        pythons=arguments.python or list(PYTHONS),
        extras=arguments.extras,
    )
    contents = PackContents(
        own_wheels=arguments.wheel,
        models=_select_models(arguments.models),
        models_source=arguments.models_from,
        worlds=[] if arguments.no_worlds else find_world_folders(),
        docs=_check_docs_folder(arguments.docs),
    )
    line = ProgressLine()

    def progress(entry: ModelEntry, received_bytes: int, total: int | None) -> None:
        size = total or entry.megabytes * _BYTES_PER_MB
        line.show(
            phrase(
                "{name}: {done} of {total} MB",
                name=entry.name,
                done=_format_megabytes(received_bytes),
                total=_format_megabytes(size),
            )
        )

    try:
        return make_pack(folder, settings, contents, lambda text: print_message(localized(text)), progress)
    finally:
        line.end()


def _select_models(names: list[str]) -> list[ModelEntry]:
    from linkwright.model_files import model_entry, model_table

    if names == [_ALL]:
        return list(model_table().values())
    return [] if names == [_NONE] else [model_entry(name) for name in names]


def _check_docs_folder(folder: Path | None) -> Path | None:
    """Return the folder of the documentation, or None, after checking that it is a site.

    Raises:
        LinkwrightError: LEARN309, the folder has no index.html.
    """
    if folder is not None and not (folder / "index.html").is_file():
        message = phrase("'{path}' has no index.html", path=display_path(folder))
        hint = phrase("run `make docs` in a checkout of Linkwright, and pass the folder `site` in it")
        raise LinkwrightError(Diagnostic("LEARN309", message, hint=hint))
    return folder


def _check_pack(folder: PackFolder) -> list[Diagnostic]:
    from linkwright.learning.packing.pack_verification import check_pack

    line = ProgressLine()

    def progress(received_bytes: int, total: int) -> None:
        line.show(
            phrase(
                "checked {done} of {total} MB", done=_format_megabytes(received_bytes), total=_format_megabytes(total)
            )
        )

    try:
        return check_pack(folder, progress)
    finally:
        line.end()


def _print_summary(folder: PackFolder, settings: PackSettings) -> None:
    """Print the contents of the pack, and the packages that it lacks for each system."""
    from linkwright.learning.packing.pack_folder import compute_installed_size
    from linkwright.learning.packing.targets import SYSTEMS

    for system in settings.systems:
        targets = [target for target in settings.targets if target.system == system]
        size = compute_installed_size(folder, targets)
        print(
            localized(
                phrase(
                    "{system}: Python {pythons}, {megabytes} MB",
                    system=SYSTEMS[system].label,
                    pythons=joined(target.python for target in targets),
                    megabytes=_format_megabytes(size),
                )
            )
        )
        pythons_by_missing_part: dict[str, list[str]] = {}
        for target in targets:
            for text in settings.missing.get(target.name, {}).get(language(), ()):
                pythons_by_missing_part.setdefault(text, []).append(target.python)
        for text, pythons in pythons_by_missing_part.items():
            print(localized(_missing_part_phrase(text, pythons, len(targets))))
    paths = list(folder.files())
    total = sum((folder.path / path).stat().st_size for path in paths)
    text = phrase(
        "{path}: {count} files, {megabytes} MB",
        path=display_path(folder.path),
        count=len(paths),
        megabytes=_format_megabytes(total),
    )
    print(localized(text))


def _missing_part_phrase(text: str, pythons: list[str], count: int) -> Phrase:
    if len(pythons) == count:
        return phrase("  no package for {part}", part=text)
    return phrase("  no package for {part}: Python {pythons}", part=text, pythons=joined(pythons))


def _format_megabytes(size: int) -> str:
    return f"{size / _BYTES_PER_MB:.0f}"
