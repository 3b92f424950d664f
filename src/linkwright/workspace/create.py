"""New packages, laid out as ``ros2 pkg create`` (ROS 2 Humble) lays them out.

A request is checked, turned into a list of steps (folders and files with their texts), and the steps are carried out.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from linkwright.diagnostics import Diagnostic, LinkwrightError, Severity, did_you_mean, has_errors
from linkwright.workspace import cmake_templates, package_templates
from linkwright.workspace.licenses import known_licenses, license_text
from linkwright.workspace.naming import check_dependency, check_email, check_member_name, check_package_name

BuildType = Literal["cmake", "ament_cmake", "ament_python"]
BUILD_TYPES: tuple[BuildType, ...] = ("cmake", "ament_cmake", "ament_python")

DEFAULT_DESCRIPTION = "TODO: Package description"
DEFAULT_LICENSE = "TODO: License declaration"


@dataclass(frozen=True)
class Maintainer:
    """Who answers for a package."""

    name: str
    email: str

    def __str__(self) -> str:
        return f"{self.name} <{self.email}>"


@dataclass(frozen=True)
class PackageRequest:
    """The package that somebody wants.

    Attributes:
        destination: the folder in which the package's own folder is made, as the user wrote it.
        license: an SPDX identifier, or any other words; only for a known identifier is a ``LICENSE`` written.
        dependencies: names for ``<depend>``.
        node_name: an executable to begin with, or None.
        library_name: a library to begin with, or None.
        year: for the copyright line of the ``LICENSE``.
    """

    name: str
    maintainer: Maintainer
    year: int
    destination: Path = Path()
    package_format: int = 3
    build_type: BuildType = "ament_cmake"
    description: str = DEFAULT_DESCRIPTION
    license: str = DEFAULT_LICENSE
    dependencies: tuple[str, ...] = ()
    node_name: str | None = None
    library_name: str | None = None

    @property
    def node(self) -> str | None:
        """The executable's name; it gives way when the library has the same one, since both become a target."""
        if self.node_name is not None and self.node_name == self.library_name:
            return f"{self.node_name}_node"
        return self.node_name


@dataclass(frozen=True)
class Folder:
    """A folder to make, relative to the package's folder."""

    path: Path


@dataclass(frozen=True)
class File:
    """A file to write, relative to the package's folder; one that is not announced is written silently."""

    path: Path
    text: str
    announced: bool = True


@dataclass(frozen=True)
class Remark:
    """A line of the report between the steps."""

    text: str


Step = Folder | File | Remark


def create_package(request: PackageRequest, report: Callable[[str], None]) -> list[Diagnostic]:
    """Make the package's folder and files.

    Args:
        request: what to make.
        report: called with each line that ``ros2 pkg create`` prints, in its order.

    Returns:
        Warnings: about the name, the licence, and a node that was renamed.

    Raises:
        LinkwrightError: PKG201 to PKG206 when the request cannot be met (nothing is written then), PKG207 when the
            folder exists, PKG208 when the disk refuses.
    """
    findings = check_request(request)
    if has_errors(findings):
        raise LinkwrightError(*findings)
    for line in summary(request):
        report(line)
    package = request.destination / request.name
    try:
        package.mkdir(parents=True)
        report(f"creating folder {shown(package)}")
        for step in steps(request):
            _carry_out(step, package, report)
    except OSError as error:
        where = shown(Path(error.filename)) if error.filename else shown(package)
        message = f"cannot create '{where}': {error.strerror or error}"
        hint = "choose a folder that you may write to: --destination-directory FOLDER"
        raise LinkwrightError(Diagnostic("PKG208", message, hint=hint)) from None
    return findings


def check_request(request: PackageRequest) -> list[Diagnostic]:
    """Everything that is wrong with a request, and advice."""
    findings = check_package_name(request.name)
    if request.build_type == "ament_python" and request.name == "test":
        message = "an ament_python package cannot be named 'test': its module and its tests would share a folder"
        findings.append(Diagnostic("PKG206", message, hint="choose another name"))
    for name, what in ((request.node_name, "node"), (request.library_name, "library")):
        if name is not None:
            findings += check_member_name(name, what)
    for dependency in request.dependencies:
        findings += check_dependency(dependency)
    findings += check_email(request.maintainer.email)
    package = request.destination / request.name
    if not has_errors(findings) and (package.exists() or package.is_symlink()):
        what = "folder" if package.is_dir() else "file"
        hint = "remove it, or choose another name or another --destination-directory"
        findings.append(Diagnostic("PKG207", f"the {what} '{shown(package)}' exists already", hint=hint))
    if request.node != request.node_name:
        message = f"the node cannot have the library's name '{request.library_name}': it is called '{request.node}'"
        findings.append(Diagnostic("PKG209", message, severity=Severity.WARNING))
    return findings + _check_license(request.license)


def _check_license(identifier: str) -> list[Diagnostic]:
    known = known_licenses()
    if identifier in known:
        return []
    if identifier == DEFAULT_LICENSE:
        message = "the package has no license yet, so no LICENSE is written"
        hint = f"give --license with one of {', '.join(known)}"
    else:
        message = f"no text is known for the license '{identifier}': package.xml names it, but no LICENSE is written"
        hint = did_you_mean(identifier, known) or f"texts are known for {', '.join(known)}"
    return [Diagnostic("PKG210", message, severity=Severity.WARNING, hint=hint)]


def summary(request: PackageRequest) -> Iterator[str]:
    """The lines that say what is about to be made."""
    yield "going to create a new package"
    yield f"package name: {request.name}"
    yield f"destination directory: {request.destination.resolve()}"
    yield f"package format: {request.package_format}"
    yield f"version: {package_templates.VERSION}"
    yield f"description: {request.description}"
    yield f"maintainer: {[str(request.maintainer)]}"
    yield f"licenses: {[request.license]}"
    yield f"build type: {request.build_type}"
    yield f"dependencies: {list(request.dependencies)}"
    if request.node:
        yield f"node_name: {request.node}"
    if request.library_name:
        yield f"library_name: {request.library_name}"


def steps(request: PackageRequest) -> Iterator[Step]:
    """What to do inside the package's folder, in the order of ``ros2 pkg create``."""
    yield File(Path("package.xml"), package_templates.manifest(request))
    if request.build_type == "ament_python":
        yield from _python_steps(request)
    else:
        yield from _cmake_steps(request)
    text = license_text(request.license, year=request.year, holder=request.maintainer.name)
    if text is not None:
        yield File(Path("LICENSE"), text, announced=False)


def shown(path: Path) -> str:
    """A path as ros2 prints it: below the current folder it begins with a dot."""
    return str(path) if path.is_absolute() or path.parts[:1] == ("..",) else f"./{path}"


def _python_steps(request: PackageRequest) -> Iterator[Step]:
    module = Path(request.name)
    yield Remark("creating source folder")
    yield Folder(module)
    yield File(Path("setup.py"), package_templates.setup_py(request))
    yield File(Path("setup.cfg"), package_templates.setup_cfg(request))
    yield Folder(Path("resource"))
    yield File(Path("resource") / request.name, "")
    yield File(module / "__init__.py", "")
    yield Folder(Path("test"))
    for linter in package_templates.LINTERS:
        yield File(Path("test") / f"test_{linter}.py", package_templates.linter_test(linter))
    if request.node:
        yield File(module / f"{request.node}.py", package_templates.node_py(request))
    if request.library_name:
        yield Folder(module / request.library_name)
        yield File(module / request.library_name / "__init__.py", "")


def _cmake_steps(request: PackageRequest) -> Iterator[Step]:
    source, include = Path("src"), Path("include") / request.name
    yield Remark("creating source and include folder")
    yield Folder(source)
    yield Folder(include)
    if request.build_type == "ament_cmake":
        yield File(Path("CMakeLists.txt"), cmake_templates.ament_cmake_lists(request))
    else:
        yield File(Path("CMakeLists.txt"), cmake_templates.plain_cmake_lists(request))
        if request.node or request.library_name:
            yield File(Path(f"{request.name}Config.cmake.in"), cmake_templates.config(request))
            yield File(Path(f"{request.name}ConfigVersion.cmake.in"), cmake_templates.config_version())
    if request.node:
        yield File(source / f"{request.node}.cpp", cmake_templates.node_cpp(request))
    if request.library_name:
        yield File(include / f"{request.library_name}.hpp", cmake_templates.library_hpp(request))
        yield File(source / f"{request.library_name}.cpp", cmake_templates.library_cpp(request))
        yield File(include / "visibility_control.h", cmake_templates.visibility_control(request))


def _carry_out(step: Step, package: Path, report: Callable[[str], None]) -> None:
    if isinstance(step, Remark):
        report(step.text)
        return
    path = package / step.path
    if isinstance(step, Folder):
        report(f"creating folder {shown(path)}")
        path.mkdir(parents=True, exist_ok=True)
        return
    if step.announced:
        report(f"creating {shown(path)}")
    path.write_text(step.text, encoding="utf-8", newline="\n")
