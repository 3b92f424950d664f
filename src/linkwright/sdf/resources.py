"""Resolves URIs of models and their files.

These are ``model://``, ``package://`` and ``file://`` URIs, paths, and addresses on Fuel.
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
from linkwright.diagnostics.misspellings import find_misspelt
from linkwright.packages import PackageFinder, enclosing_package
from linkwright.packages.finder import shipped_folder
from linkwright.packages.manifest import MANIFEST
from linkwright.packages.readers.package_xml import Manifest
from linkwright.packages.uri import absolute_path
from linkwright.xmltree.reader import parse_file

SEARCH_VARIABLES = (
    "GZ_SIM_RESOURCE_PATH",
    "IGN_GAZEBO_RESOURCE_PATH",
    "SDF_PATH",
    "GAZEBO_MODEL_PATH",
    "GAZEBO_RESOURCE_PATH",
)
"""The environment variables with folders in which models and their files are looked for, in this order."""

CONFIG = "model.config"
_MODEL_FILE = "model.sdf"
_WORLDS = (".world", ".sdf")
_SHIPPED = Path(__file__).parent / "models"
_NEWEST_MINOR = 12
_HOOK = re.compile(r".+\.(?:dsv|sh)(?:\.in)?").fullmatch
_HOOKED = re.compile(
    rf"(?:{'|'.join(SEARCH_VARIABLES)})"
    r"(?:;|\s+[\"']?\$\{?(?:AMENT|COLCON)_CURRENT_PREFIX\}?/)share(?:/(?P<path>[^\s\"';:]*))?"
)
"""``VARIABLE;share/PATH`` and ``VARIABLE "$AMENT_CURRENT_PREFIX/share/PATH"``."""
_OF_GAZEBO = "media/"
"""The folder of files that Gazebo classic ships, such as the walking people of its actors."""
_BELOW = ("", "models", "media/models", "Media/models")
"""Where in a folder of the search path Gazebo classic looks for ``file://PATH`` (its ``SystemPaths``)."""
_SCHEMES = ("model", "package", "file")
_TEMPLATES = (".jinja", ".jinja2", ".j2", ".em", ".erb", ".in", ".template", ".xacro")
"""The endings behind a file's own of templates that a build makes the file from."""
_SHORTEST = 4
"""Models with shorter names, such as ``suv`` and ``sun``, are never taken for misspellings of each other."""
_SUN_AND_GROUND = {"sun": "sun", "ground plane": "ground_plane"}
"""Fuel models that nearly every world includes, and our own models that replace them."""


class Missing(NamedTuple):
    """The reason why a URI cannot be resolved, and a hint.

    Attributes:
        reason: the reason.
        hint: the hint; None if there is none.
        severity: the severity of a finding about the URI; information if Gazebo can probably find the resource, because
            it downloads models or finds them in folders that this machine does not have.
    """

    reason: Phrase
    hint: Phrase | None
    severity: Severity = Severity.WARNING


class ResourceFinder:
    """Resolves the URIs of worlds.

    ``model://NAME/PATH`` is searched for as ``NAME/PATH`` in these folders, in this order:

    1. the folders of `SEARCH_VARIABLES`,
    2. the folders that packages export for this purpose in their ``package.xml``
       (``<gazebo_ros gazebo_model_path="..."/>``), or add to these variables by an environment hook,
    3. the folders that contain packages, so that ``model://PACKAGE/PATH`` works as in gz,
    4. the folder ``models`` of each package,
    5. our own models: ``ground_plane`` and ``sun``,
    6. the folder of the file that contains the URI and its parents, up to the folder of its package, and ``models`` in
       each: launch files put one of these into the variables.

    ``file://PATH`` without a third slash is relative to one of these folders, or to its parent, as in Gazebo classic,
    or to ``models``, ``media/models`` or ``Media/models`` there.

    Nothing is downloaded: models on Fuel are only found if they are in the cache of gz.

    Args:
        packages: the finder of packages.
        environment: the environment variables; by default the variables of the process.
    """

    def __init__(self, packages: PackageFinder, environment: Mapping[str, str] | None = None) -> None:
        self._packages = packages
        self._environment = os.environ if environment is None else environment
        self._near: dict[Path, tuple[Path, ...]] = {}

    def file(self, address: str, beside: Path) -> Path | Missing:
        """Return the existing file or folder of a URI, or the reason why there is none.

        Args:
            address: the URI as written.
            beside: the folder of the file that contains the URI, to which plain paths are relative.
        """
        address = address.strip()
        scheme, colon, rest = address.partition("://")
        if not colon:
            return self._plain(address, beside)
        if scheme == "model":
            return self._find_model_uri(address, unquote(rest).lstrip("/"), beside)
        if scheme in ("http", "https"):
            return self._cached(address)
        if scheme == "file" and absolute_path(f"//{rest}") is None:
            return self._below(address, unquote(rest), beside)
        try:
            path = self._packages.resolve(address, beside)
        except LinkwrightError as error:
            meant = find_misspelt(scheme, _SCHEMES)
            hint = error.diagnostics[0].hint if meant is None else did_you_mean(scheme, [meant])
            return Missing(error.diagnostics[0].message, hint)
        return path if path.exists() else _no_file(path)

    def model(self, address: str, beside: Path) -> Path | Missing:
        """Return the SDF file of a model's URI, or the reason why there is none.

        The URI names the file itself, or a folder, whose newest readable file is used.
        """
        found = self.file(address, beside)
        if isinstance(found, Missing) or not found.is_dir():
            return found
        return model_file(found)

    def models(self) -> dict[str, Path]:
        """Return the folders of all models on the search path, by name.

        If several folders have the same name, the first is returned.
        """
        found: dict[str, Path] = {}
        for folder in self._folders:
            with suppress(OSError):
                for place in sorted(folder.iterdir()):
                    if _is_model(place):
                        found.setdefault(place.name, place)
        return found

    def worlds(self) -> dict[str, Path]:
        """Return the files of all worlds on the search path, by name without suffix.

        If several files have the same name, the first is returned. The search includes the folders of models, and the
        folders ``worlds`` in these folders and in packages.
        """
        found: dict[str, Path] = {}
        shares = self._packages.packages().values()
        for folder in dict.fromkeys(
            (
                *(path for place in self._folders for path in (place, place / "worlds")),
                *(share / "worlds" for share in shares),
            )
        ):
            with suppress(OSError):
                for file in sorted(folder.iterdir()):
                    if file.suffix in _WORLDS and file.is_file() and _contains_world(file):
                        found.setdefault(file.stem, file)
        return found

    def world(self, name: str) -> Path | None:
        """Return the file of a world, or None if there is none.

        The name is a path, a ``file://`` address or a name on the search path.
        """
        file = name.removeprefix("file://")
        path = Path(file if file == name else absolute_path(f"//{file}") or file).expanduser()
        if path.is_file():
            return path
        known = {} if "/" in name else self.worlds()
        return known.get(name) or known.get(name.partition(".")[0])

    @cached_property
    def _folders(self) -> tuple[Path, ...]:
        """The existing folders of the search path for models, in order."""
        return tuple(dict.fromkeys(path for path in self._places() if path.is_dir()))

    def _places(self) -> Iterator[Path]:
        for variable in SEARCH_VARIABLES:
            for folder in self._environment.get(variable, "").split(os.pathsep):
                if folder:
                    yield Path(folder)
        shares = self._packages.packages()
        for share in shares.values():
            yield from exported_folders(share, "gazebo_model_path")
            yield from exported_folders(share, "gazebo_media_path")
            yield from hooked_folders(share)
        for share in shares.values():
            yield share.parent
        for share in shares.values():
            yield share / "models"
        yield _SHIPPED

    def _plain(self, path: str, beside: Path) -> Path | Missing:
        places = (
            [Path(path)] if Path(path).is_absolute() else [beside / path, *(folder / path for folder in self._folders)]
        )
        return next((place for place in places if place.exists()), None) or _no_file(places[0])

    def _below(self, address: str, path: str, beside: Path) -> Path | Missing:
        around = (folder.parent for folder in self._folders)
        folders = (*self._folders, *around, *(beside.absolute() / "x").parents)
        places = [folder / below / path for folder in folders for below in _BELOW]
        found = next((place for place in places if place.exists()), None)
        if found is not None:
            return found
        cased = next(filter(None, map(_find_in_other_case, places)), None)
        hint = phrase(
            "add the folder that '{path}' starts from to {variable}", path=path, variable=SEARCH_VARIABLES[-1]
        )
        if cased is not None:
            hint = phrase("did you mean {names}?", names=quoted(cased.name))
        severity = Severity.INFO if path.startswith(_OF_GAZEBO) and cased is None else Severity.WARNING
        return Missing(phrase("there is no '{path}' on the search path", path=address), hint, severity)

    def _find_model_uri(self, address: str, path: str, beside: Path) -> Path | Missing:
        if not path:
            return Missing(phrase("'{uri}' does not name a model", uri=address), phrase("write model://MODEL"))
        if beside not in self._near:
            self._near[beside] = _around(beside.absolute())
        near = self._near[beside]
        for folder in (*self._folders, *near[:2], *(path / "models" for path in near), *near[2:]):
            found = folder / path
            if found.exists() and (folder not in near[2:] or "/" in path or _is_model(found)):
                return found
        name, _, rest = path.partition("/")
        for folder in self._folders:
            if (folder / name).is_dir() and (_is_ours(beside) or not _is_ours(folder)):
                return _no_file(folder / path)
        reason = phrase("there is no model '{name}' on the search path", name=name)
        renamed = next((path for path in near[:2] if rest and (path / rest).exists()), None)
        if renamed is not None:
            here = renamed.absolute().name
            return Missing(reason, phrase("the folder that contains '{path}' is named '{name}'", path=rest, name=here))
        meant = find_misspelt(name, self.models()) if len(name) >= _SHORTEST else None
        if meant is not None:
            return Missing(reason, did_you_mean(name, [meant]))
        hint = phrase("add the folder that contains '{name}' to {variable}", name=name, variable=SEARCH_VARIABLES[0])
        return Missing(reason, hint, Severity.INFO)

    def _cached(self, address: str) -> Path | Missing:
        """Return the folder of a Fuel address in gz's cache, or the reason why there is none.

        The folder is ``HOST/OWNER/models/NAME/VERSION``, in lower case. For ``sun`` and ``ground plane``, our own
        models are used if the cache does not have them.
        """
        parts = [unquote(part) for part in urlsplit(address).path.split("/") if part]
        host = urlsplit(address).netloc.lower()
        if parts and re.fullmatch(r"[0-9.]+", parts[0]):
            parts = parts[1:]
        if len(parts) < 3 or parts[1] not in ("models", "worlds"):
            return Missing(phrase("'{uri}' is not the address of a model", uri=address), None)
        owner, kind, name, *rest = parts
        for cache in self._caches():
            place = cache / host / owner.lower() / kind / name.lower()
            found = _version_in(place, rest)
            if found is not None and found.exists():
                return found
        known = _SUN_AND_GROUND.get(name.lower())
        if known is not None and not rest[1:]:
            return _SHIPPED / known
        hint = phrase(
            "models are not fetched from the network: run `gz fuel download -u '{uri}'` to put it into the cache",
            uri=address,
        )
        return Missing(phrase("the Fuel model '{name}' is not in the cache", name=name), hint, Severity.INFO)

    def _caches(self) -> Iterator[Path]:
        given = self._environment.get("GZ_FUEL_CACHE_PATH") or self._environment.get("IGN_FUEL_CACHE_PATH")
        if given:
            yield Path(given)
        home = Path(self._environment.get("HOME") or Path.home())
        yield from (home / ".gz" / "fuel", home / ".ignition" / "fuel")


def _is_model(folder: Path) -> bool:
    return (folder / CONFIG).is_file() or (folder / _MODEL_FILE).is_file()


def _around(folder: Path) -> tuple[Path, ...]:
    """Return a folder and its parents, up to the folder of its package.

    A folder outside of packages is returned with one parent.
    """
    package = enclosing_package(folder)
    around = (folder, *folder.parents)
    last = 1 if package is None else max(1, around.index(package[1]))
    return around[: last + 1]


def model_file(folder: Path) -> Path | Missing:
    """Return the SDF file in a model's folder, or the reason why there is none.

    It is the newest file in ``model.config`` whose version can be read, or else ``model.sdf``.
    """
    newest: tuple[int, Path] | None = None
    with suppress(LinkwrightError):
        for element in parse_file(folder / CONFIG).root.elements("sdf"):
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
    template = next((path for path in sorted(folder.glob("*.sdf.*")) if path.suffix in _TEMPLATES), None)
    return _no_file(path) if template is None else _missing_template_output(template, path)


def _contains_world(file: Path) -> bool:
    """Return whether the bytes of a file contain the tag of a world."""
    return b"<world" in file.read_bytes()


def exported_folders(share: Path, attribute: str) -> Iterator[Path]:
    """Yield the folders that a package exports to Gazebo in its ``package.xml``.

    `attribute` is the attribute of ``<gazebo_ros>`` that lists them. ``${prefix}`` in a folder is the share folder of
    the package.
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


def hooked_folders(share: Path) -> Iterator[Path]:
    """Yield the folders that a package's environment hooks add to `SEARCH_VARIABLES`.

    The templates of hooks in the sources of the package are also read. Source: ``ament_environment_hooks`` and the
    ``.dsv``
    files of ament: ``prepend-non-duplicate;VARIABLE;PATH``.
    """
    for file in sorted((*share.glob("*hook*/*.*"), *share.glob("environment/*.dsv"))):
        if _HOOK(file.name):
            with suppress(OSError):
                text = file.read_text(encoding="utf-8", errors="replace").replace("@PROJECT_NAME@", share.name)
                for found in _HOOKED.finditer(text):
                    yield Path(os.path.normpath(share.parent / (found["path"] or "")))


def _version_in(place: Path, rest: list[str]) -> Path | None:
    """Return the folder or file in a cached model that the rest of a Fuel address names.

    ``tip`` or no version means the newest one. None is returned if no version is cached.
    """
    try:
        versions = sorted((int(path.name), path) for path in place.iterdir() if path.name.isdigit())
    except OSError:
        return None
    if not versions:
        return None
    chosen = versions[-1][1]
    if rest and rest[0].isdigit():
        chosen = place / rest[0]
    inside = rest[2:] if len(rest) > 1 and rest[1] == "files" else []
    return chosen.joinpath(*inside)


def _kind(path: Path) -> str:
    """Return the suffix of a file, in which worlds and models are equal, for suggesting similar files."""
    suffix = path.suffix.lower()
    return ".sdf" if suffix == ".world" else suffix


def _is_ours(folder: Path) -> bool:
    """Return whether a folder belongs to the models that are part of the program.

    These models replace some of Gazebo's models, but have fewer files.
    """
    shipped = shipped_folder()
    return folder.is_relative_to(_SHIPPED) or (shipped is not None and folder.absolute().is_relative_to(shipped))


def _find_in_other_case(path: Path) -> Path | None:
    """Return a file whose name differs from a missing file's name only in case, or None if there is none."""
    with suppress(OSError):
        return next((entry for entry in path.parent.iterdir() if entry.name.casefold() == path.name.casefold()), None)
    return None


def _missing_template_output(template: Path, path: Path) -> Missing:
    hint = phrase("the build creates it from '{name}'", name=template.name)
    return Missing(phrase("there is no '{path}'", path=str(path)), hint, Severity.INFO)


def _no_file(path: Path) -> Missing:
    template = next(
        (entry for entry in (path.with_name(path.name + end) for end in _TEMPLATES) if entry.is_file()), None
    )
    if template is not None:
        return _missing_template_output(template, path)
    hint = None
    with suppress(OSError):
        kind = _kind(path)
        names = sorted(entry.name for entry in path.parent.iterdir() if _kind(entry) == kind)
        hint = did_you_mean(path.name, names)
        if names and hint is None:
            hint = phrase("choose from {names}", names=joined(names[:8]))
    return Missing(phrase("there is no '{path}'", path=str(path)), hint)
