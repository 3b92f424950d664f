"""Resolve the URIs of models and their files.

The URIs are ``model://``, ``package://`` and ``file://`` URIs, paths, and addresses on Fuel.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping
from contextlib import suppress
from functools import cached_property
from pathlib import Path
from typing import NamedTuple
from urllib.parse import unquote, urlsplit

from linkwright.diagnostics import LinkwrightError, Phrase, Severity, did_you_mean, joined, phrase, quoted
from linkwright.diagnostics.misspellings import find_misspelled
from linkwright.packages import PackageFinder, enclosing_package
from linkwright.packages.finder import find_shipped_folder
from linkwright.packages.manifest import MANIFEST
from linkwright.packages.readers.package_xml import Manifest
from linkwright.packages.share_layout import iterate_substitutes
from linkwright.packages.uri import parse_absolute_path
from linkwright.xmltree.reader import parse_file

SEARCH_VARIABLES = (
    "GZ_SIM_RESOURCE_PATH",
    "IGN_GAZEBO_RESOURCE_PATH",
    "SDF_PATH",
    "GAZEBO_MODEL_PATH",
    "GAZEBO_RESOURCE_PATH",
)
"""The environment variables that list folders with models and their files, in the order of the search."""

MODEL_CONFIG = "model.config"
_MODEL_FILE = "model.sdf"
_WORLD_SUFFIXES = (".world", ".sdf")
_OWN_MODELS_FOLDER = Path(__file__).parent / "models"
_NEWEST_MINOR = 12
_MATCH_HOOK_NAME = re.compile(r".+\.(?:dsv|sh)(?:\.in)?").fullmatch
_HOOKED_PATH = re.compile(
    rf"(?:{'|'.join(SEARCH_VARIABLES)})"
    r"(?:;|\s+[\"']?\$\{?(?:AMENT|COLCON)_CURRENT_PREFIX\}?/)share(?:/(?P<path>[^\s\"';:]*))?"
)
"""The pattern of ``VARIABLE;share/PATH`` and ``VARIABLE "$AMENT_CURRENT_PREFIX/share/PATH"`` in environment hooks."""
_GAZEBO_MEDIA_PREFIX = "media/"
"""The path prefix of files that Gazebo classic ships, such as the meshes of actors."""
_MEDIA_SUBFOLDERS = ("", "models", "media/models", "Media/models")
"""Subfolders of the search path in which Gazebo classic looks for ``file://PATH`` (its ``SystemPaths``)."""
_SCHEMES = ("model", "package", "file")
_TEMPLATE_SUFFIXES = (".jinja", ".jinja2", ".j2", ".em", ".erb", ".in", ".template", ".xacro")
"""Suffixes of templates from which a build creates a file, such as ``model.sdf.jinja``."""
_MIN_NAME_LENGTH = 4
"""The minimum length of a name for which similar names are suggested. ``suv`` is not a misspelling of ``sun``."""
_SUN_AND_GROUND = {"sun": "sun", "ground plane": "ground_plane"}
"""Fuel models that most worlds include, and the models of this program that replace them."""


class Missing(NamedTuple):
    """The reason why a URI cannot be resolved.

    Attributes:
        reason: the reason, as a message for users.
        hint: what the user can do; None if there is no suggestion.
        severity: the severity of a finding about the URI; information if Gazebo can probably find the resource, because
            it downloads models or finds them in folders that this machine does not have.
    """

    reason: Phrase
    hint: Phrase | None
    severity: Severity = Severity.WARNING


class ResourceFinder:
    """A finder of the files that the URIs in worlds refer to.

    ``model://NAME/PATH`` is searched for as ``NAME/PATH`` in these folders, in this order:

    1. the folders of `SEARCH_VARIABLES`,
    2. the folders that packages export for this purpose in their ``package.xml``
       (``<gazebo_ros gazebo_model_path="..."/>``), or add to these variables by an environment hook,
    3. the folders that contain packages, so that ``model://PACKAGE/PATH`` works as in gz,
    4. the folder ``models`` of each package,
    5. the models of this program: ``ground_plane`` and ``sun``,
    6. the folder of the file that contains the URI and its parents, up to the folder of its package, and ``models`` in
       each: launch files put one of these into the variables.

    ``file://PATH`` without a third slash is relative to one of these folders, or to its parent, as in Gazebo classic,
    or to ``models``, ``media/models`` or ``Media/models`` there.

    Nothing is downloaded: Fuel models are only found in the cache of gz.

    Args:
        packages: finds the packages and resolves their URIs.
        environment: the environment variables; by default the variables of the process.
    """

    def __init__(self, packages: PackageFinder, environment: Mapping[str, str] | None = None) -> None:
        self._packages = packages
        self._environment = os.environ if environment is None else environment
        self._nearby_folders: dict[Path, tuple[Path, ...]] = {}

    def packages(self) -> dict[str, Path]:
        """Return all packages, as a mapping from name to share folder or source folder."""
        return self._packages.packages()

    def file(self, address: str, nearby_file: Path) -> Path | Missing:
        """Return the existing file or folder of a URI, or the reason why there is none.

        Args:
            address: the URI or path as written.
            nearby_file: the folder of the file that contains the URI; plain paths are relative to it.
        """
        address = address.strip()
        scheme, colon, path_after_scheme = address.partition("://")
        if not colon:
            return self._find_plain_path(address, nearby_file)
        if scheme == "model":
            return self._find_model_uri(address, unquote(path_after_scheme).lstrip("/"), nearby_file)
        if scheme in ("http", "https"):
            return self._find_in_cache(address)
        if scheme == "file" and parse_absolute_path(f"//{path_after_scheme}") is None:
            return self._find_file_uri(address, unquote(path_after_scheme), nearby_file)
        try:
            path = self._packages.resolve(address, nearby_file)
        except LinkwrightError as error:
            suggested_scheme = find_misspelled(scheme, _SCHEMES)
            hint = error.diagnostics[0].hint if suggested_scheme is None else did_you_mean(scheme, [suggested_scheme])
            return Missing(error.diagnostics[0].message, hint)
        return path if path.exists() else _explain_missing_file(path)

    def model(self, address: str, nearby_file: Path) -> Path | Missing:
        """Return the SDF file for a model's URI, or the reason why there is none.

        The URI names the file, or the folder of a model. In a folder, the newest supported SDF version is used.
        """
        path = self.file(address, nearby_file)
        if isinstance(path, Missing) or not path.is_dir():
            return path
        return find_model_file(path)

    def models(self) -> dict[str, Path]:
        """Return the folders of all models on the search path, by name.

        If several folders have the same name, the first is returned.
        """
        folders: dict[str, Path] = {}
        for folder in self._folders:
            with suppress(OSError):
                for subfolder in sorted(folder.iterdir()):
                    if _is_model(subfolder):
                        folders.setdefault(subfolder.name, subfolder)
        return folders

    @cached_property
    def _suggested_models(self) -> tuple[str, ...]:
        """The names of the models when the first one was not found."""
        return tuple(self.models())

    def worlds(self) -> dict[str, Path]:
        """Return the files of all worlds on the search path, by name without suffix.

        If several files have the same name, the first is returned. The search includes the folders of models, and the
        folders ``worlds`` in these folders and in packages.
        """
        files: dict[str, Path] = {}
        for file in self._world_files():
            files.setdefault(file.stem, file)
        return files

    def world(self, name: str) -> Path | None:
        """Return the file of a world, or None if there is none.

        The name is a path, a ``file://`` address or a name on the search path. For a name with a suffix, such as
        ``empty.sdf``, a file of this name is preferred to one with another suffix, and Gazebo's own file to that of a
        package, because Gazebo does not look for worlds in packages.
        """
        file = name.removeprefix("file://")
        path = Path(file if file == name else parse_absolute_path(f"//{file}") or file).expanduser()
        if path.is_file():
            return path
        if "/" in name:
            return None
        files = tuple(self._world_files(prefer_gazebo=name.endswith(_WORLD_SUFFIXES)))
        stem = name.partition(".")[0]
        matches = (file for known in (name, stem) for file in files if known in (file.name, file.stem))
        return next(matches, None)

    def _world_files(self, prefer_gazebo: bool = False) -> Iterator[Path]:
        """Yield the files of worlds on the search path, in the order of the search.

        The worlds that Gazebo installs are in the substitutes for its packages.
        """
        shares = list(self._packages.packages().values())
        gazebo_shares = [share for _, share in iterate_substitutes()]
        shares = [*gazebo_shares, *shares] if prefer_gazebo else [*shares, *gazebo_shares]
        for folder in dict.fromkeys(
            (
                *(path for model_folder in self._folders for path in (model_folder, model_folder / "worlds")),
                *(share / "worlds" for share in shares),
            )
        ):
            with suppress(OSError):
                for file in sorted(folder.iterdir()):
                    if file.suffix in _WORLD_SUFFIXES and file.is_file() and _contains_world(file):
                        yield file

    @cached_property
    def _folders(self) -> tuple[Path, ...]:
        """The existing folders of the search path for models, in order."""
        return tuple(dict.fromkeys(path for path in self._search_folders() if path.is_dir()))

    def _search_folders(self) -> Iterator[Path]:
        for variable in SEARCH_VARIABLES:
            for folder in self._environment.get(variable, "").split(os.pathsep):
                if folder:
                    yield Path(folder)
        shares = self._packages.packages()
        for share in shares.values():
            yield from find_exported_folders(share, "gazebo_model_path")
            yield from find_exported_folders(share, "gazebo_media_path")
            yield from find_hooked_folders(share)
        for share in shares.values():
            yield share.parent
        for share in shares.values():
            yield share / "models"
        yield _OWN_MODELS_FOLDER

    def _find_plain_path(self, path: str, nearby_file: Path) -> Path | Missing:
        candidates = (
            [Path(path)]
            if Path(path).is_absolute()
            else [nearby_file / path, *(folder / path for folder in self._folders)]
        )
        return next((candidate for candidate in candidates if candidate.exists()), None) or _explain_missing_file(
            candidates[0]
        )

    def _find_file_uri(self, address: str, path: str, nearby_file: Path) -> Path | Missing:
        parent_folders = (folder.parent for folder in self._folders)
        folders = (*self._folders, *parent_folders, *(nearby_file.absolute() / "x").parents)
        candidates = [folder / subfolder / path for folder in folders for subfolder in _MEDIA_SUBFOLDERS]
        existing_path = next((candidate for candidate in candidates if candidate.exists()), None)
        if existing_path is not None:
            return existing_path
        other_case_path = next(filter(None, map(_find_in_other_case, candidates)), None)
        hint = phrase("add the folder that contains '{path}' to {variable}", path=path, variable=SEARCH_VARIABLES[-1])
        if other_case_path is not None:
            hint = phrase("did you mean {names}?", names=quoted(other_case_path.name))
        severity = (
            Severity.INFO if path.startswith(_GAZEBO_MEDIA_PREFIX) and other_case_path is None else Severity.WARNING
        )
        return Missing(phrase("there is no '{path}' on the search path", path=address), hint, severity)

    def _find_model_uri(self, address: str, path: str, nearby_file: Path) -> Path | Missing:
        if not path:
            return Missing(phrase("'{uri}' does not name a model", uri=address), phrase("write model://MODEL"))
        if nearby_file not in self._nearby_folders:
            self._nearby_folders[nearby_file] = _list_folders_around(nearby_file.absolute())
        nearby_folders = self._nearby_folders[nearby_file]
        for folder in (
            *self._folders,
            *nearby_folders[:2],
            *(path / "models" for path in nearby_folders),
            *nearby_folders[2:],
        ):
            candidate = folder / path
            if candidate.exists() and (folder not in nearby_folders[2:] or "/" in path or _is_model(candidate)):
                return candidate
        name, _, path_in_model = path.partition("/")
        for folder in self._folders:
            if (folder / name).is_dir() and (_is_own_model(nearby_file) or not _is_own_model(folder)):
                return _explain_missing_file(folder / path)
        reason = phrase("there is no model '{name}' on the search path", name=name)
        renamed_folder = next(
            (path for path in nearby_folders[:2] if path_in_model and (path / path_in_model).exists()), None
        )
        if renamed_folder is not None:
            folder_name = renamed_folder.absolute().name
            return Missing(
                reason,
                phrase("the folder that contains '{path}' is named '{name}'", path=path_in_model, name=folder_name),
            )
        suggested_name = find_misspelled(name, self._suggested_models) if len(name) >= _MIN_NAME_LENGTH else None
        if suggested_name is not None:
            return Missing(reason, did_you_mean(name, [suggested_name]))
        hint = phrase("add the folder that contains '{path}' to {variable}", path=name, variable=SEARCH_VARIABLES[0])
        return Missing(reason, hint, Severity.INFO)

    def _find_in_cache(self, address: str) -> Path | Missing:
        """Return the folder of a Fuel address in gz's cache, or the reason why there is none.

        The folder is ``HOST/OWNER/models/NAME/VERSION``, in lower case. If ``sun`` or ``ground plane`` is not in the
        cache, the model of this program is used.
        """
        parts = [unquote(part) for part in urlsplit(address).path.split("/") if part]
        host = urlsplit(address).netloc.lower()
        if parts and re.fullmatch(r"[0-9.]+", parts[0]):
            parts = parts[1:]
        if len(parts) < 3 or parts[1] not in ("models", "worlds"):
            return Missing(phrase("'{uri}' is not the address of a model", uri=address), None)
        owner, kind, name, *version_and_file = parts
        for cache in list_fuel_caches(self._environment):
            model_folder = cache / host / owner.lower() / kind / name.lower()
            cached_path = _find_version(model_folder, version_and_file)
            if cached_path is not None and cached_path.exists():
                return cached_path
        own_model = _SUN_AND_GROUND.get(name.lower())
        if own_model is not None and not version_and_file[1:]:
            return _OWN_MODELS_FOLDER / own_model
        hint = phrase(
            "models are not downloaded automatically: run `gz fuel download -u '{uri}'` to add this model to the cache",
            uri=address,
        )
        return Missing(phrase("the Fuel model '{name}' is not in the cache", name=name), hint, Severity.INFO)


def list_fuel_caches(environment: Mapping[str, str]) -> Iterator[Path]:
    """Yield gz's folders of downloaded models, which may not exist."""
    cache_path = environment.get("GZ_FUEL_CACHE_PATH") or environment.get("IGN_FUEL_CACHE_PATH")
    if cache_path:
        yield Path(cache_path)
    home = Path(environment.get("HOME") or Path.home())
    yield from (home / ".gz" / "fuel", home / ".ignition" / "fuel")


def _is_model(folder: Path) -> bool:
    return (folder / MODEL_CONFIG).is_file() or (folder / _MODEL_FILE).is_file()


def _list_folders_around(folder: Path) -> tuple[Path, ...]:
    """Return a folder and its parents, up to the folder of its package.

    Outside of a package, return the folder and one parent.
    """
    package = enclosing_package(folder)
    folders = (folder, *folder.parents)
    last_index = 1 if package is None else max(1, folders.index(package[1]))
    return folders[: last_index + 1]


def find_model_file(folder: Path) -> Path | Missing:
    """Return the SDF file in a model's folder, or the reason why there is none.

    The file is the one with the newest supported version in ``model.config``, or else ``model.sdf``.
    """
    newest: tuple[int, Path] | None = None
    with suppress(LinkwrightError):
        for element in parse_file(folder / MODEL_CONFIG).root.elements("sdf"):
            version = re.fullmatch(r"1\.([0-9]+)", element.attributes.get("version", "1.0").strip())
            minor = int(version[1]) if version else 0
            path = folder / element.text().strip()
            if minor <= _NEWEST_MINOR and path.is_file() and (newest is None or minor > newest[0]):
                newest = minor, path
    if newest is not None:
        return newest[1]
    path = folder / _MODEL_FILE
    if path.is_file():
        return path
    template = next((path for path in sorted(folder.glob("*.sdf.*")) if path.suffix in _TEMPLATE_SUFFIXES), None)
    return _explain_missing_file(path) if template is None else _explain_template_output(template, path)


def _contains_world(file: Path) -> bool:
    """Return whether the bytes of a file contain the tag of a world."""
    return b"<world" in file.read_bytes()


def find_exported_folders(share: Path, attribute: str) -> Iterator[Path]:
    """Yield the folders that a package exports to Gazebo in its ``package.xml``.

    `attribute` is the attribute of ``<gazebo_ros>`` that lists these folders. ``${prefix}`` in a folder is replaced
    by the share folder of the package.
    """
    text = ""
    with suppress(OSError):
        text = (share / MANIFEST).read_text(encoding="utf-8", errors="replace")
    if "gazebo_ros" not in text:
        return
    with suppress(LinkwrightError):
        export = Manifest(parse_file(share / MANIFEST)).root.first("export")
        for element in export.elements("gazebo_ros") if export is not None else ():
            for folder in element.attributes.get(attribute, "").split(":"):
                if folder:
                    yield Path(os.path.normpath(folder.replace("${prefix}", str(share))))


def find_hooked_folders(share: Path) -> Iterator[Path]:
    """Yield the folders that a package's environment hooks add to `SEARCH_VARIABLES`.

    The templates of hooks in the sources of the package are also read. Source: ``ament_environment_hooks`` and the
    ``.dsv`` files of ament: ``prepend-non-duplicate;VARIABLE;PATH``.
    """
    for file in sorted((*share.glob("*hook*/*.*"), *share.glob("environment/*.dsv"))):
        if _MATCH_HOOK_NAME(file.name):
            with suppress(OSError):
                text = file.read_text(encoding="utf-8", errors="replace").replace("@PROJECT_NAME@", share.name)
                for path_match in _HOOKED_PATH.finditer(text):
                    yield Path(os.path.normpath(share.parent / (path_match["path"] or "")))


def _find_version(model_folder: Path, version_and_file: list[str]) -> Path | None:
    """Return the folder or file in a cached model that the rest of a Fuel address names.

    Without a version, or with ``tip``, the newest version is used. Return None if no version is cached.
    """
    try:
        versions = sorted((int(path.name), path) for path in model_folder.iterdir() if path.name.isdigit())
    except OSError:
        return None
    if not versions:
        return None
    version_path = versions[-1][1]
    if version_and_file and version_and_file[0].isdigit():
        version_path = model_folder / version_and_file[0]
    file_parts = version_and_file[2:] if len(version_and_file) > 1 and version_and_file[1] == "files" else []
    return version_path.joinpath(*file_parts)


def _normalized_suffix(path: Path) -> str:
    """Return the suffix of a file in lower case, with ``.sdf`` for ``.world``.

    The suffix serves to suggest similar files.
    """
    suffix = path.suffix.lower()
    return ".sdf" if suffix == ".world" else suffix


def _is_own_model(folder: Path) -> bool:
    """Return whether a folder belongs to the models of this program.

    These models replace models of Gazebo, but have fewer files.
    """
    shipped = find_shipped_folder()
    return folder.is_relative_to(_OWN_MODELS_FOLDER) or (
        shipped is not None and folder.absolute().is_relative_to(shipped)
    )


def _find_in_other_case(path: Path) -> Path | None:
    """Return a file whose name differs from a missing file's name only in case, or None."""
    with suppress(OSError):
        return next((entry for entry in path.parent.iterdir() if entry.name.casefold() == path.name.casefold()), None)
    return None


def _explain_template_output(template: Path, path: Path) -> Missing:
    hint = phrase("the build creates it from '{name}'", name=template.name)
    return Missing(phrase("'{path}' does not exist", path=str(path)), hint, Severity.INFO)


def _explain_missing_file(path: Path) -> Missing:
    template = next(
        (entry for entry in (path.with_name(path.name + suffix) for suffix in _TEMPLATE_SUFFIXES) if entry.is_file()),
        None,
    )
    if template is not None:
        return _explain_template_output(template, path)
    hint = None
    with suppress(OSError):
        kind = _normalized_suffix(path)
        names = sorted(entry.name for entry in path.parent.iterdir() if _normalized_suffix(entry) == kind)
        hint = did_you_mean(path.name, names)
        if names and hint is None:
            hint = phrase("choose from {names}", names=joined(names[:8]))
    return Missing(phrase("'{path}' does not exist", path=str(path)), hint)
