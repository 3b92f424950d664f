"""The finder for packages in the environment, workspaces, sources and Linkwright."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterator, Mapping, MutableMapping, Sequence
from pathlib import Path

from linkwright.diagnostics import (
    Diagnostic,
    LinkwrightError,
    Note,
    Phrase,
    did_you_mean,
    display_path,
    is_misspelled,
    joined,
    phrase,
)
from linkwright.packages import ament, uri
from linkwright.packages.ament import install_prefix
from linkwright.packages.manifest import SourceScan, enclosing_package
from linkwright.packages.share_layout import (
    find_share_of_sources,
    find_substituted_share,
    iterate_substitutes,
    leave_prefix,
)

START_VARIABLE = "LINKWRIGHT_START"
"""The environment variable with the start folders of a launcher. Its processes also search them for packages."""


class PackageNotFoundError(LinkwrightError, KeyError):
    """Raised when no package with a name is found (PKG101).

    This class is also a KeyError, like the exception with the same name in ``ament_index_python``, so that launch files
    that catch that exception continue to work.

    Args:
        name: the name that was searched for.
        locations: the descriptions of the locations that were searched.
        suggestion: the hint that names a similar package, or None.
        is_misspelling: see the attribute.

    Attributes:
        name: the name that was searched for.
        is_misspelling: whether the name is a misspelling of an existing package's name.
    """

    def __init__(self, name: str, locations: Sequence[str], suggestion: Phrase | None, *, is_misspelling: bool) -> None:
        notes = tuple(Note(phrase("searched {location}", location=location)) for location in locations)
        hint = suggestion or phrase("change to the workspace that contains it, or source its install/setup.bash")
        super().__init__(Diagnostic("PKG101", phrase("package '{name}' not found", name=name), notes=notes, hint=hint))
        self.name = name
        self.is_misspelling = is_misspelling


class PackageFinder:
    """A finder for ROS packages in the usual layouts of ROS workspaces.

    The locations are searched in this order:

    1. `extra`, given by the caller;
    2. the prefixes of ``AMENT_PREFIX_PATH`` (a sourced ROS or workspace);
    3. colcon's ``install`` folders in the start folders and in the folders above them, merged or isolated, and the
       prefix that contains a start folder, such as ``/opt/ros/humble`` if it is not sourced;
    4. source trees: the package that contains a start folder and its sibling packages, the packages below a start
       folder, and the packages below ``src`` in the folders above it;
    5. the packages shipped with Linkwright;
    6. Linkwright's substitutes for ROS packages that launch files include; see `linkwright.packages.share_layout`.

    Folders are read only when a search reaches them. The search through a source tree does not descend into packages.

    Args:
        start: the user's folder, or several folders in order of preference; by default, the current folder, followed by
            the folders in `START_VARIABLE`.
        environment: the environment variables, with ``AMENT_PREFIX_PATH``; by default, those of the process.
        extra: package name -> share folder; these packages take precedence.
        sources_first: whether sources take precedence over the files that an earlier build installed from them.
        hidden: the names of packages that are not searched for in workspaces and source trees.
    """

    def __init__(
        self,
        *,
        start: Path | Sequence[Path] | None = None,
        environment: Mapping[str, str] | None = None,
        extra: Mapping[str, str | Path] | None = None,
        sources_first: bool = False,
        hidden: Collection[str] = (),
    ) -> None:
        self._environment = os.environ if environment is None else environment
        if start is None:
            folders = self._environment.get(START_VARIABLE, "").split(os.pathsep)
            start = [Path.cwd(), *(Path(folder) for folder in folders if folder)]
        starts = [start] if isinstance(start, Path) else start
        self._starts = tuple(dict.fromkeys(_to_absolute(start) for start in starts))
        self._extra = {name: Path(share) for name, share in (extra or {}).items()}
        self._sources_first = sources_first
        self._hidden = frozenset(hidden)
        self._scans: dict[Path, SourceScan] = {}
        self._enclosing: dict[Path, tuple[str, Path] | None] = {}
        self._shares: dict[str, Path] = {}
        self._suggestions: dict[str, tuple[Phrase | None, bool]] = {}
        self._locations: list[Phrase] = []
        self._own_prefix_path: str | None = None

    def starting_at(self, start: Sequence[Path]) -> PackageFinder:
        """Return a finder that starts in other folders.

        Both finders share the results of searches through source trees.
        """
        finder = PackageFinder(
            start=start,
            environment=self._environment,
            extra=self._extra,
            sources_first=self._sources_first,
            hidden=self._hidden,
        )
        finder._scans = self._scans
        finder._enclosing = self._enclosing
        return finder

    @property
    def starts(self) -> tuple[Path, ...]:
        """The folders where the search starts."""
        return self._starts

    def find(self, name: str) -> Path | None:
        """Return the share folder of a package, or None if there is no such package.

        For packages that are not installed, see `find_share_of_sources`.
        """
        share = self._shares.get(name)
        if share is None:
            share = next(
                (share_folder for share_folder in self._candidate_shares(name) if share_folder is not None), None
            )
            if share is not None:
                self._shares[name] = share
        return share

    def find_in_sources(self, name: str) -> Path | None:
        """Return the share folder of a package in the source trees, or None.

        The files of an earlier build are ignored.
        """
        shares = (_find_share_of_sources(name, self._scan(root).find(name)) for root in self._source_roots())
        return next(filter(None, shares), None)

    def share(self, name: str) -> Path:
        """Return the share folder of a package.

        For packages that are not installed, see `find_share_of_sources`.

        Raises:
            PackageNotFoundError: PKG101, with the locations that were searched and the nearest names.
        """
        share = self.find(name)
        if share is None:
            if name not in self._suggestions:
                self._suggestions[name] = self._suggest_similar(name)
                self._locations = self._searched_locations()
            suggestion, is_misspelling = self._suggestions[name]
            raise PackageNotFoundError(name, self._locations, suggestion, is_misspelling=is_misspelling)
        return share

    def packages(self) -> dict[str, Path]:
        """Return all packages, as a mapping from name to share folder or source folder.

        If several packages have the same name, the first in the order of the search is included.
        """
        packages = dict(self._extra)
        for name, share in self._all_packages():
            if name not in self._hidden:
                packages.setdefault(name, share)
        return packages

    def resolve(self, address: str, relative_to: Path | None = None) -> Path:
        """Return the path for a URI or path in a description or launch file.

        The path need not exist.

        Args:
            address: ``package://NAME/PATH``, ``file:///PATH`` or a plain path.
            relative_to: the folder that a relative path starts from; by default, the current folder.

        Raises:
            LinkwrightError: PKG101, there is no such package; PKG102, the URI has another form.
        """
        return uri.resolve(address, self.share, relative_to)

    def set_prefix_path(self, environment: MutableMapping[str, str]) -> None:
        """Set ``AMENT_PREFIX_PATH`` for programs that read this variable, unless it is set already.

        The value contains the prefixes that sourcing the workspaces would set or, before a build, the folder into which
        a build would install. This finder ignores the value that it set itself.
        """
        if environment.get(ament.PREFIX_PATH_VARIABLE):
            return
        shares = (
            share for install in self._install_folders() for _, share in ament.iterate_packages_in_install(install)
        )
        prefixes = dict.fromkeys(str(install_prefix(share)) for share in shares) or [str(self._starts[0] / "install")]
        self._own_prefix_path = environment[ament.PREFIX_PATH_VARIABLE] = os.pathsep.join(prefixes)

    def _prefixes(self) -> list[Path]:
        if self._environment.get(ament.PREFIX_PATH_VARIABLE) == self._own_prefix_path:
            return []
        return ament.list_environment_prefixes(self._environment)

    def clear_cache(self) -> None:
        """Clear all cached results, so that the next search reads the disk again."""
        self._shares.clear()
        self._suggestions.clear()
        self._scans.clear()
        self._enclosing.clear()

    # --- locations ------------------------------------------------------------------------------------------

    def _candidate_shares(self, name: str) -> Iterator[Path | None]:
        yield self._extra.get(name)
        for prefix in self._prefixes():
            yield ament.find_share_in_prefix(prefix, name)
        searches = (
            (self._search_sources, self._search_installs)
            if self._sources_first
            else (self._search_installs, self._search_sources)
        )
        for search in searches:
            if name not in self._hidden:
                yield from search(name)
        yield find_shipped_packages().get(name)
        yield find_substituted_share(name)

    def _search_installs(self, name: str) -> Iterator[Path | None]:
        for install in self._install_folders():
            yield ament.find_share_in_install(install, name)
        for prefix in self._enclosing_prefixes():
            yield ament.find_share_in_prefix(prefix, name)

    def _search_sources(self, name: str) -> Iterator[Path | None]:
        yield _find_share_of_sources(name, dict(self._enclosing_packages()).get(name))
        for root in self._source_roots():
            yield _find_share_of_sources(name, self._scan(root).find(name))

    def _all_packages(self) -> Iterator[tuple[str, Path]]:
        for prefix in self._prefixes():
            yield from ament.iterate_packages_in_prefix(prefix)
        for install in self._install_folders():
            yield from ament.iterate_packages_in_install(install)
        for prefix in self._enclosing_prefixes():
            yield from ament.iterate_packages_in_prefix(prefix)
        yield from self._enclosing_packages()
        for root in self._source_roots():
            yield from self._scan(root).packages().items()
        yield from find_shipped_packages().items()
        yield from iterate_substitutes()

    def _start_folders_and_parents(self) -> Iterator[Path]:
        visited: set[Path] = set()
        for start in self._starts:
            for folder in (start, *start.parents):
                if folder not in visited:
                    visited.add(folder)
                    yield folder

    def _install_folders(self) -> Iterator[Path]:
        for folder in self._start_folders_and_parents():
            install = folder / "install"
            if ament.is_colcon_install(install):
                yield install

    def _enclosing_prefixes(self) -> Iterator[Path]:
        return (folder.parent for folder in self._start_folders_and_parents() if ament.is_share_of_prefix(folder))

    def _enclosing_packages(self) -> Iterator[tuple[str, Path]]:
        return (package for package in map(self._find_enclosing, self._starts) if package)

    def _find_enclosing(self, start: Path) -> tuple[str, Path] | None:
        if start not in self._enclosing:
            self._enclosing[start] = enclosing_package(start)
        return self._enclosing[start]

    def _source_roots(self) -> Iterator[Path]:
        roots: dict[Path, None] = {}
        for start in self._starts:
            package = self._find_enclosing(start)
            if package:
                roots[package[1].parent] = None
            else:
                roots[start] = None
            for folder in (start, *start.parents):
                source = folder / "src"
                if source.is_dir():
                    roots[source] = None
        yield from roots

    def _scan(self, root: Path) -> SourceScan:
        scan = self._scans.get(root)
        if scan is None:
            scan = self._scans[root] = SourceScan(root)
        return scan

    # --- the text of the error -------------------------------------------------------------------------------

    def _suggest_similar(self, name: str) -> tuple[Phrase | None, bool]:
        """Return a hint on a similar package name, or None, and whether the name is a misspelling."""
        shipped = find_shipped_packages()
        candidates = [
            package for package in self.packages() if package not in shipped or is_misspelled(name, [package])
        ]
        return did_you_mean(name, candidates), is_misspelled(name, candidates)

    def _searched_locations(self) -> list[Phrase]:
        prefixes = self._prefixes()
        if prefixes:
            locations = [phrase("AMENT_PREFIX_PATH: {prefixes}", prefixes=os.pathsep.join(map(str, prefixes)))]
        else:
            locations = [phrase("AMENT_PREFIX_PATH: not set")]
        locations += [
            phrase("colcon install folder {install}", install=display_path(install))
            for install in self._install_folders()
        ]
        locations += [
            phrase("the packages installed in {prefix}", prefix=display_path(path))
            for path in self._enclosing_prefixes()
        ]
        for root in self._source_roots():
            scan = self._scan(root)
            if scan.truncated:
                location = phrase(
                    "package.xml files below {root} (incomplete: there are too many folders)", root=display_path(root)
                )
            else:
                location = phrase("package.xml files below {root}", root=display_path(root))
            locations.append(location)
            locations += [
                phrase("{folder}, which does not contain a package name", folder=display_path(folder / "package.xml"))
                for folder in scan.unnamed
            ]
        shipped = joined(find_shipped_packages()) or phrase("none")
        locations.append(phrase("the packages shipped with Linkwright: {shipped}", shipped=shipped))
        return locations


def find_shipped_folder() -> Path | None:
    """Return the folder of the shipped packages, or None if there is none.

    The folder is in the wheel, or in the repository of an editable install.
    """
    package = Path(__file__).parents[1]
    for folder in (package / "robots", package.parents[1] / "robots"):
        if folder.is_dir():
            return folder
    return None


def find_shipped_packages() -> dict[str, Path]:
    """Return the packages shipped with Linkwright, as a mapping from name to folder."""
    folder = find_shipped_folder()
    return {} if folder is None else SourceScan(folder).packages()


def _find_share_of_sources(name: str, folder: Path | None) -> Path | None:
    return None if folder is None else find_share_of_sources(name, folder)


def _to_absolute(path: str | Path) -> Path:
    """Return an absolute path without resolving links.

    Share folders often contain links.
    """
    return leave_prefix(Path(os.path.abspath(path)))  # noqa: PTH100 - Path.resolve would follow the links
