"""Rules about mesh files: whether the file of a URI exists, and whether it is readable."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, Note, Phrase, Severity, counted, display_path, phrase
from linkwright.diagnostics.diagnostic import is_pointer_file
from linkwright.lint.fix import replace_value
from linkwright.lint.generated_files import is_ignored_by_git
from linkwright.lint.meshes import MeshUse
from linkwright.lint.missing_packages import is_declared
from linkwright.lint.rule import Rule
from linkwright.lint.rules.meshes_addresses import (
    HOME_PATH,
    MESH_SUFFIXES,
    find_uri_problem,
    make_file_hint,
    normalize_path,
    read_source_value,
)
from linkwright.lint.subject import Subject
from linkwright.packages import PackageNotFoundError, enclosing_package


def find_file_with_other_case(path: Path) -> Path | None:
    """Return an existing file whose path differs only in upper and lower case, or None."""
    current = Path(path.anchor)
    is_different = False
    for name in path.relative_to(path.anchor).parts:
        if not (current / name).exists() or not _is_listed(current, name):
            try:
                existing_path = next(
                    (path for path in current.iterdir() if path.name.casefold() == name.casefold()), None
                )
            except OSError:
                return None
            if existing_path is None:
                return None
            is_different = is_different or existing_path.name != name
            name = existing_path.name
        current /= name
    return current if is_different else None


def _is_listed(folder: Path, name: str) -> bool:
    """Return whether a folder has an entry with this name in the same case.

    A case-insensitive disk finds names in any case.
    """
    if (folder / name.swapcase()).exists() and name.swapcase() != name:
        try:
            return any(path.name == name for path in folder.iterdir())
        except OSError:
            return True
    return True


def _make_folder_hint(use: MeshUse, name: str) -> Phrase | None:
    """Return a hint about a folder whose name was written as a package, or None.

    The folder must be near the description.
    """
    source = use.element.source
    if source is None or not name:
        return None
    file = Path(source.name).absolute()
    for folder in file.parents[:2]:
        if not (folder / name).is_dir():
            continue
        package = enclosing_package(folder)
        if package is None:
            return phrase(
                "'{name}' is a folder: write the package before it, 'package://PACKAGE/{name}/...'", name=name
            )
        path = (folder / name).relative_to(package[1]).as_posix()
        return phrase(
            "'{name}' is a folder of package '{package}': write 'package://{package}/{path}/...'",
            name=name,
            package=package[0],
            path=path,
        )
    return None


class UnknownPackage(Rule):
    """A mesh URI with a package that is not found.

    ## Why

    Without the package, the mesh is missing. Either the name of the package is misspelled, or its workspace is missing
    or not sourced, or a folder such as `meshes` is written in place of the package's name. If the `package.xml` of
    this or a neighboring package declares the package, it is only missing on this machine, and the finding is
    informational.

    ## Example

    ```xml
    <mesh filename="package://my_robot_descripton/meshes/base.stl"/>
    ```

    ## Use instead

    ```xml
    <mesh filename="package://my_robot_description/meshes/base.stl"/>
    ```
    """

    code = "LW423"
    name = "mesh-package-unknown"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        uses_by_package: dict[str, list[MeshUse]] = {}
        hints: dict[str, Phrase | None] = {}
        for use in subject.meshes.uses:
            if not use.mesh.filename.startswith("package://") or find_uri_problem(use.mesh.filename)[0]:
                continue
            package = use.mesh.filename[len("package://") :].partition("/")[0]
            if package in uses_by_package:
                uses_by_package[package].append(use)
                continue
            try:
                subject.finder.resolve(use.mesh.filename)
            except PackageNotFoundError as error:
                uses_by_package[package] = [use]
                hints[package] = _make_folder_hint(use, package) or error.diagnostics[0].hint
            except LinkwrightError:
                continue
        for package, uses in uses_by_package.items():
            message = counted(
                "package '{package}' is not found",
                "package '{package}', which {count} mesh URIs name, is not found",
                len(uses),
                package=package,
            )
            is_declared_dependency = subject.package is not None and is_declared(subject.package, package)
            severity = Severity.INFO if is_declared_dependency else None
            yield self.report(message, uses[0].element, "filename", hint=hints[package], severity=severity)


class MissingFile(Rule):
    """A mesh URI whose file does not exist.

    ## Why

    The part is not shown and does not collide. If a whole folder of meshes is missing, one finding reports all of them.

    ## Example

    ```xml
    <mesh filename="package://my_robot_description/meshes/bsae.stl"/>
    ```

    ## Use instead

    ```xml
    <mesh filename="package://my_robot_description/meshes/base.stl"/>
    ```
    """

    code = "LW424"
    name = "mesh-missing"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        missing_files: dict[Path, list[tuple[MeshUse, Path]]] = {}
        for use, path in subject.meshes.files:
            if find_uri_problem(use.mesh.filename)[0] or HOME_PATH.match(read_source_value(use.element, "filename")):
                continue  # another rule already reports this mesh
            if path.is_file() or find_file_with_other_case(path) is not None or is_ignored_by_git(path):
                continue
            missing_files.setdefault(_find_last_folder(path), []).append((use, path))
        for folder, uses in missing_files.items():
            files = dict.fromkeys(path for _, path in uses)
            first_use, path = uses[0]
            if len(files) > 1 and not path.parent.exists():
                missing_folder = path.relative_to(folder).parts[0]
                yield self.report(
                    phrase(
                        "{count} mesh files are missing: there is no folder '{folder}'",
                        count=len(files),
                        folder=display_path(folder / missing_folder),
                    ),
                    first_use.element,
                    "filename",
                    notes=[Note(phrase("the first is '{filename}'", filename=first_use.mesh.filename))],
                    hint=phrase("check whether they are in another repository, or fetched by the build"),
                )
                continue
            reported_paths = set()
            for use, path in uses:
                if path in reported_paths:
                    continue
                reported_paths.add(path)
                yield self.report(
                    phrase("there is no mesh file '{path}'", path=use.mesh.filename),
                    use.element,
                    "filename",
                    notes=[Note(phrase("its path would be {path}", path=display_path(path)))],
                    hint=make_file_hint(path, MESH_SUFFIXES),
                )


class WrongCase(Rule):
    """A mesh URI that differs from the file's name in upper and lower case.

    ## Why

    macOS and Windows still find the file, but Linux does not. The description then works on the author's computer and
    fails on the robot.

    ## Example

    ```xml
    <mesh filename="package://my_robot_description/meshes/Base.STL"/>
    ```

    for the file `meshes/base.stl`.

    ## Use instead

    ```xml
    <mesh filename="package://my_robot_description/meshes/base.stl"/>
    ```
    """

    code = "LW425"
    name = "mesh-case-differs"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        for use, path in subject.meshes.files:
            existing_file = find_file_with_other_case(path)
            if existing_file is None or not existing_file.is_file():
                continue
            corrected = _match_case(use.mesh.filename, existing_file)
            yield self.report(
                phrase(
                    "the mesh file is named '{name}', not '{path_name}': upper and lower case differ",
                    name=existing_file.name,
                    path_name=path.name,
                )
                if existing_file.name != path.name
                else phrase(
                    "a folder in the path of the mesh file '{name}' differs in upper and lower case", name=path.name
                ),
                use.element,
                "filename",
                hint=phrase("write '{text}'", text=corrected),
                fix=replace_value(use.element, "filename", corrected),
            )


class OutsidePackage(Rule):
    """A mesh outside every package, although the description is in one.

    ## Why

    A file outside a package is not installed, so the mesh is missing after `colcon build` and on other computers.

    ## Example

    ```xml
    <mesh filename="package://my_robot_description/../meshes/base.stl"/>
    ```

    ## Use instead

    Move the file to an installed folder of the package, and write

    ```xml
    <mesh filename="package://my_robot_description/meshes/base.stl"/>
    ```
    """

    code = "LW428"
    name = "mesh-outside-package"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        files = subject.meshes.files
        if not files or enclosing_package(subject.path.absolute().parent) is None:
            return
        for use, path in files:
            uri = use.mesh.filename
            if HOME_PATH.match(read_source_value(use.element, "filename")):
                continue  # another rule already reports this mesh
            normalized = Path(normalize_path(path))
            message = None
            if uri.startswith("package://"):
                package = uri[len("package://") :].partition("/")[0]
                share = subject.finder.find(package)
                if share is not None and not normalized.is_relative_to(normalize_path(share)):
                    message = phrase(
                        "the path of the mesh '{uri}' leaves the package '{package}'", uri=uri, package=package
                    )
            elif normalized.is_file() and enclosing_package(normalized.parent) is None:
                message = phrase("the mesh '{uri}' is not in a package", uri=uri)
            if message is not None:
                yield self.report(
                    message,
                    use.element,
                    "filename",
                    notes=[Note(phrase("its path is {resolved}", resolved=display_path(normalized)))],
                    hint=phrase("move it into a folder of the package that is installed"),
                )


class UnreadableMesh(Rule):
    """A mesh file that cannot be read.

    ## Why

    The file is empty, truncated, or in a format that does not match its extension. If the repository stores meshes with
    Git LFS, the file may be a pointer to the mesh, which is a text of three lines.

    ## Example

    A `base.stl` that begins with `version https://git-lfs.github.com/spec/v1`.

    ## Use instead

    Fetch the mesh with `git lfs pull`, or export it again.
    """

    code = "LW429"
    name = "mesh-unreadable"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        reported_paths = set()
        for use, path in subject.meshes.files:
            if path in reported_paths or not path.is_file():
                continue
            reported_paths.add(path)
            error = subject.meshes.problem(use)
            if error is None or error.diagnostics[0].code != "INR103":
                continue
            diagnostic = error.diagnostics[0]
            hint = phrase("it is a Git LFS pointer: run `git lfs pull`") if is_pointer_file(path) else diagnostic.hint
            yield self.report(diagnostic.message, use.element, "filename", hint=hint)


def _match_case(uri: str, existing_file: Path) -> str:
    """Return a URI with the upper and lower case of an existing file at the end of its path."""
    parts = uri.split("/")
    for index, name in enumerate(reversed(existing_file.parts), start=1):
        if index >= len(parts) or parts[-index].casefold() != name.casefold():
            break
        parts[-index] = name
    return "/".join(parts)


def _find_last_folder(path: Path) -> Path:
    """Return the deepest existing folder on the path of a file."""
    return next((folder for folder in path.parents if folder.is_dir()), Path(path.anchor))
