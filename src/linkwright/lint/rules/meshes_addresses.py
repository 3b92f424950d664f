"""Rules about the form of mesh URIs.

Other rules check whether the files exist.
"""

from __future__ import annotations

import os.path
from collections.abc import Iterable, Sequence
from contextlib import suppress
from pathlib import Path

from linkwright.diagnostics import Diagnostic, Phrase, Severity, did_you_mean, display_path, joined, phrase
from linkwright.lint.fix import replace_value
from linkwright.lint.rule import Rule
from linkwright.lint.subject import Subject
from linkwright.loading.deferred import lazy_pattern
from linkwright.packages import enclosing_package
from linkwright.xmltree import Element
from linkwright.xmltree.positions import attribute_value_range

_SCHEME = lazy_pattern(r"([A-Za-z][A-Za-z0-9+.-]+):")
HOME_PATH = lazy_pattern(
    r"(?:file://(?:localhost)?)?(/home/[^/]+|/Users/[^/]+|/root|[A-Za-z]:[\\/]Users[\\/][^\\/]+|/opt/ros/[^/]+)[\\/]"
)
_INSTALLED_FILE = lazy_pattern(r".*?/opt/ros/[^/]+/share/(.+)")
_MUJOCO_TAG, _HEADER_BYTES = b"<mujoco", 4_000
"""The root element of a MuJoCo model, and the number of bytes at the beginning of the file that contain it."""
MESH_SUFFIXES = (".stl", ".stlb", ".dae", ".obj", ".glb", ".gltf", ".ply", ".fbx", ".3ds", ".mesh")
"""The mesh formats that RViz reads."""


def read_source_value(element: Element, attribute: str) -> str:
    """Return an attribute's value as written in the file, with unevaluated expressions."""
    source = element.source
    value_range = attribute_value_range(source.text, element.offset, attribute) if source is not None else None
    return source.text[slice(*value_range)] if source is not None and value_range is not None else ""


def is_portable(uri: str) -> bool:
    """Return whether ROS tools can resolve a URI: it has a scheme or is an absolute path."""
    return bool(_SCHEME.match(uri)) or Path(uri).is_absolute()


class MalformedUri(Rule):
    """A mesh URI that no tool understands.

    ## Why

    RViz and Gazebo accept `package://PACKAGE/PATH` and `file:///PATH`. With any other URI, the part is not shown.

    ## Example

    ```xml
    <mesh filename="package:/my_robot_description/meshes/base.stl"/>
    ```

    ## Use instead

    ```xml
    <mesh filename="package://my_robot_description/meshes/base.stl"/>
    ```
    """

    code = "LW420"
    name = "mesh-uri-malformed"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        for use in subject.meshes.uses:
            uri = use.mesh.filename
            problem, corrected = find_uri_problem(uri)
            if problem:
                yield self.report(
                    phrase("the mesh URI '{uri}' {problem}", uri=uri, problem=problem),
                    use.element,
                    "filename",
                    hint=phrase("write '{text}'", text=corrected)
                    if corrected
                    else phrase("write package://PACKAGE/PATH"),
                    fix=replace_value(use.element, "filename", corrected) if corrected else None,
                )


class RelativePath(Rule):
    """A mesh URI that is a relative path.

    ## Why

    The base of a relative path depends on the tool: some use the folder of the URDF, others the current folder. RViz
    receives the description on a topic, so it has no base folder and shows nothing. In a file outside a ROS package, or
    next to a model for MuJoCo, the finding is only informational, because such files are meant for simulators that do
    not know packages.

    ## Example

    ```xml
    <mesh filename="../meshes/base.stl"/>
    ```

    ## Use instead

    ```xml
    <mesh filename="package://my_robot_description/meshes/base.stl"/>
    ```
    """

    code = "LW421"
    name = "mesh-path-relative"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        relative_uses = [use for use in subject.meshes.uses if _is_relative(use.mesh.filename)]
        is_for_ros = relative_uses and subject.package and not _is_beside_mujoco(subject.path.parent)
        for use in relative_uses:
            uri = use.mesh.filename
            corrected = _to_package_uri(subject.meshes.path(use))
            yield self.report(
                phrase("the mesh path '{uri}' is relative, which RViz cannot resolve", uri=uri),
                use.element,
                "filename",
                hint=phrase("write '{text}'", text=corrected or "package://PACKAGE/PATH"),
                fix=replace_value(use.element, "filename", corrected, safe=False) if corrected else None,
                severity=None if is_for_ros else Severity.INFO,
            )


def _is_relative(uri: str) -> bool:
    return bool(uri.strip()) and not is_portable(uri) and "\\" not in uri


def _is_beside_mujoco(folder: Path) -> bool:
    """Return whether a folder contains MuJoCo models.

    Robot descriptions in such a folder use paths relative to the folder.
    """
    with suppress(OSError):
        return any(_MUJOCO_TAG in file.read_bytes()[:_HEADER_BYTES] for file in folder.glob("*.xml"))
    return False


class MachineSpecificPath(Rule):
    """A mesh URI with an absolute path into a home folder or into one ROS distribution.

    ## Why

    On every other computer, and in every container, this folder does not exist or has other contents. The rule checks
    the unexpanded text, because `file://$(find PACKAGE)/...` works on every computer with the package.

    ## Example

    ```xml
    <mesh filename="file:///home/ada/ros2_ws/src/arm/meshes/base.stl"/>
    ```

    ## Use instead

    ```xml
    <mesh filename="package://arm/meshes/base.stl"/>
    ```
    """

    code = "LW422"
    name = "mesh-path-home"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        for use in subject.meshes.uses:
            machine_folder = HOME_PATH.match(read_source_value(use.element, "filename"))
            if machine_folder is not None:
                path = subject.meshes.path(use)
                installed_match = _INSTALLED_FILE.fullmatch(use.mesh.filename)
                corrected = f"package://{installed_match[1]}" if installed_match else _to_package_uri(path)
                corrected = corrected or _find_in_known_package(subject, path)
                message = (
                    phrase(
                        "the mesh URI contains the folder of one ROS distribution, '{folder}'", folder=machine_folder[1]
                    )
                    if installed_match
                    else phrase("the mesh URI contains a folder of one computer, '{folder}'", folder=machine_folder[1])
                )
                yield self.report(
                    message,
                    use.element,
                    "filename",
                    hint=phrase("write '{text}'", text=corrected or "package://PACKAGE/PATH"),
                    fix=replace_value(use.element, "filename", corrected, safe=False) if corrected else None,
                )


class UnknownEnding(Rule):
    """A mesh file of a format that robot tools do not read.

    ## Why

    RViz and Gazebo read STL, COLLADA, OBJ and glTF. Export files of CAD programs to one of these formats.

    ## Example

    ```xml
    <mesh filename="package://my_robot_description/meshes/base.step"/>
    ```

    ## Use instead

    ```xml
    <mesh filename="package://my_robot_description/meshes/base.stl"/>
    ```
    """

    code = "LW426"
    name = "mesh-format-unknown"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        for use in subject.meshes.uses:
            name = use.mesh.filename.rpartition("/")[2]
            suffix = Path(name).suffix
            if not name or suffix.lower() in MESH_SUFFIXES or find_uri_problem(use.mesh.filename)[0]:
                continue
            yield self.report(
                phrase(
                    "the mesh file '{name}' ends in '{ending}', a format that robot tools do not read",
                    name=name,
                    ending=suffix,
                )
                if suffix
                else phrase("the mesh file '{name}' has no extension that names a format", name=name),
                use.element,
                "filename",
                hint=phrase("export it as STL, COLLADA (.dae), OBJ or glTF (.glb)"),
            )


class UnportableMeshName(Rule):
    """A mesh URI with spaces or non-ASCII letters.

    ## Why

    RViz fetches meshes through a library for web URLs, which does not allow spaces. Non-ASCII letters are compared byte
    by byte, so a name typed on a Mac may not match the same name on Linux. The finding on such letters is only
    informational, because the file is found on the author's computer.

    ## Example

    ```xml
    <mesh filename="package://my_robot_description/meshes/left arm.stl"/>
    ```

    ## Use instead

    ```xml
    <mesh filename="package://my_robot_description/meshes/left_arm.stl"/>
    ```
    """

    code = "LW427"
    name = "mesh-name-awkward"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        for use in subject.meshes.uses:
            uri = use.mesh.filename
            name = uri.partition("://")[2].partition("/")[2] if uri.startswith("package://") else uri.rpartition("/")[2]
            if uri.strip() and (" " in name or not name.isascii()):
                yield self.report(
                    phrase("the mesh URI '{uri}' contains a space", uri=uri)
                    if " " in name
                    else phrase("the mesh URI '{uri}' contains non-ASCII letters", uri=uri),
                    use.element,
                    "filename",
                    hint=phrase("rename the file with letters, digits and underscores"),
                    severity=None if " " in name else Severity.INFO,
                )


def find_uri_problem(uri: str) -> tuple[str | None, str | None]:
    """Return the mistake in a URI and the corrected URI.

    The mistake is the end of a sentence, such as ``is empty``, or None if there is none. The corrected URI is None if
    it is not known.
    """
    if not uri.strip():
        return phrase("is empty"), None
    if "\\" in uri:
        corrected = uri.replace("\\", "/")
        return phrase("contains backslashes"), corrected if find_uri_problem(corrected)[0] is None else None
    if uri != uri.strip():
        return phrase("has spaces around it"), uri.strip()
    match = _SCHEME.match(uri)
    if match is None:
        return None, None
    scheme, remainder = match[1], uri[match.end() :]
    if scheme in ("package", "model") and not remainder.startswith("//"):
        return phrase("lacks a slash"), f"{scheme}://{remainder.lstrip('/')}"
    if scheme == "package":
        package, _, path = remainder[2:].partition("/")
        if not package:
            path = path.lstrip("/")
            return phrase("does not name a package"), f"package://{path}" if path.count("/") > 1 else None
        return (None, None) if path.strip("/") else (phrase("does not name a file"), None)
    if scheme == "file":
        if remainder.startswith(("///", "//localhost/")):
            return None, None
        return phrase("does not have an absolute path"), f"file:///{remainder.lstrip('/')}" if not remainder.startswith(
            "//"
        ) else None
    if scheme.lower() in ("package", "file"):
        return phrase("has its scheme in upper case"), f"{scheme.lower()}:{remainder}"
    if scheme in ("model", "http", "https"):
        return None, None
    return phrase("has the unknown scheme '{scheme}'", scheme=scheme), None


def _to_package_uri(path: Path | None) -> str | None:
    """Return the ``package://`` URI of an existing file in a package, or None."""
    if path is None or not path.is_file():
        return None
    normalized = Path(normalize_path(path))
    package = enclosing_package(normalized.parent)
    return None if package is None else f"package://{package[0]}/{normalized.relative_to(package[1]).as_posix()}"


def _find_in_known_package(subject: Subject, path: Path | None) -> str | None:
    """Return the ``package://`` URI for a path on another computer, or None.

    The path must contain the name of a package that is found on this computer.
    """
    names = path.parts if path is not None else ()
    for index in range(len(names) - 2, 0, -1):
        share = subject.finder.find(names[index])
        remaining_names = names[index + 1 :]
        if share is not None and share.joinpath(*remaining_names).is_file():
            return f"package://{names[index]}/{'/'.join(remaining_names)}"
    return None


def make_file_hint(path: Path, suffixes: Sequence[str]) -> Phrase:
    """Return a hint on a missing file that names existing files with one of the suffixes.

    The suffixes are in lower case.
    """
    try:
        names = sorted(entry.name for entry in path.parent.iterdir() if entry.suffix.lower() in suffixes)
    except OSError:
        return phrase("there is no folder '{folder}'", folder=display_path(path.parent))
    suggestion = did_you_mean(path.name, names)
    if suggestion or not names:
        return suggestion or phrase("put the file there, or correct the URI")
    shown_names = names[:8] if len(names) <= 8 else [*names[:8], "..."]
    return phrase("choose from {names}", names=joined(shown_names))


def normalize_path(path: Path) -> str:
    """Return a path without ``..`` and ``.``, but with unresolved symbolic links."""
    return os.path.normpath(path)
