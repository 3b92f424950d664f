"""Create new packages with the layout of ``ros2 pkg create`` (ROS 2 Humble).

A request is checked and converted to a list of steps (folders and files with their contents), which are then carried
out.
"""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

from linkwright.diagnostics import (
    Diagnostic,
    LinkwrightError,
    Severity,
    did_you_mean,
    foreign,
    has_errors,
    joined,
    phrase,
    term,
)
from linkwright.files.whole_files import write_whole_file
from linkwright.loading.lean_dataclasses import dataclass
from linkwright.packages.creation import cmake_templates, package_templates
from linkwright.packages.creation.licenses import license_text, list_known_licenses
from linkwright.packages.creation.request import DEFAULT_LICENSE, PackageRequest
from linkwright.packages.naming import check_dependency, check_email, check_member_name, check_package_name


@dataclass(frozen=True)
class Folder:
    """A folder to create, relative to the package's folder."""

    path: Path


@dataclass(frozen=True)
class File:
    """A file to write, relative to the package's folder.

    Attributes:
        is_reported: whether its creation is reported.
    """

    path: Path
    text: str
    is_reported: bool = True


@dataclass(frozen=True)
class ReportLine:
    """A line to report between other steps."""

    text: str


Step = Folder | File | ReportLine


def create_package(request: PackageRequest, report: Callable[[str], None]) -> list[Diagnostic]:
    """Create the folder and the files of a new package.

    Args:
        request: the package to create.
        report: called with each line that ``ros2 pkg create`` prints, in the same order.

    Returns:
        Warnings about the name, the license, and a renamed node.

    Raises:
        LinkwrightError: PKG201 to PKG206, the request is not valid, and nothing is written; PKG207, the folder exists;
            PKG208, a file cannot be written.
    """
    findings = check_request(request)
    if has_errors(findings):
        raise LinkwrightError(*findings)
    for line in summarize(request):
        report(line)
    package_folder = request.destination / request.name
    is_created = False
    try:
        package_folder.mkdir(parents=True)
        is_created = True
        report(f"creating folder {format_path(package_folder)}")
        for step in plan_steps(request):
            _execute_step(step, package_folder, report)
    except OSError as error:
        if is_created:
            shutil.rmtree(package_folder, ignore_errors=True)  # an incomplete package would block the next attempt
        path = format_path(Path(error.filename)) if error.filename else format_path(package_folder)
        message = phrase("cannot create '{folder}': {strerror}", folder=path, strerror=foreign(error.strerror or error))
        hint = phrase("choose a folder that you may write to: --destination-directory FOLDER")
        raise LinkwrightError(Diagnostic("PKG208", message, hint=hint)) from None
    return findings


def check_request(request: PackageRequest) -> list[Diagnostic]:
    """Return all errors and warnings about a request."""
    findings = check_package_name(request.name)
    if request.build_type == "ament_python" and request.name == "test":
        message = phrase(
            "an ament_python package cannot be named 'test': its module and its tests would share a folder"
        )
        findings.append(Diagnostic("PKG206", message, hint=phrase("choose another name")))
    for name, member_kind in ((request.node_name, "node"), (request.library_name, "library")):
        if name is not None:
            findings += check_member_name(name, member_kind)
    for dependency in request.dependencies:
        findings += check_dependency(dependency)
    findings += check_email(request.maintainer.email)
    package_folder = request.destination / request.name
    if not has_errors(findings) and (package_folder.exists() or package_folder.is_symlink()):
        existing_kind = "folder" if package_folder.is_dir() else "file"
        hint = phrase("remove it, or choose another name or another --destination-directory")
        findings.append(
            Diagnostic(
                "PKG207",
                phrase(
                    "the {kind} '{package}' already exists",
                    kind=term(existing_kind),
                    package=format_path(package_folder),
                ),
                hint=hint,
            )
        )
    if request.node != request.node_name:
        message = phrase(
            "node and library cannot both be named '{library_name}', so the node is named '{node}'",
            library_name=request.library_name,
            node=request.node,
        )
        findings.append(Diagnostic("PKG209", message, severity=Severity.WARNING))
    return findings + _check_license(request.license)


def _check_license(identifier: str) -> list[Diagnostic]:
    identifiers = list_known_licenses()
    if identifier in identifiers:
        return []
    if identifier == DEFAULT_LICENSE:
        message = phrase("the package has no license yet, so no LICENSE is written")
        hint = phrase("choose one with --license: {known}", known=joined(identifiers))
    else:
        message = phrase(
            "Linkwright has no text for the license '{identifier}': package.xml names it, but no LICENSE is written",
            identifier=identifier,
        )
        hint = did_you_mean(identifier, identifiers) or phrase(
            "the licenses with a text are {known}", known=joined(identifiers)
        )
    return [Diagnostic("PKG210", message, severity=Severity.WARNING, hint=hint)]


def summarize(request: PackageRequest) -> Iterator[str]:
    """Yield the lines that describe the new package before it is created."""
    yield "going to create a new package"
    yield f"package name: {request.name}"
    yield f"destination directory: {request.destination.resolve()}"
    yield f"package format: {request.package_format}"
    yield f"version: {package_templates.INITIAL_VERSION}"
    yield f"description: {request.description}"
    yield f"maintainer: {[str(request.maintainer)]}"
    yield f"licenses: {[request.license]}"
    yield f"build type: {request.build_type}"
    yield f"dependencies: {list(request.dependencies)}"
    if request.node:
        yield f"node_name: {request.node}"
    if request.library_name:
        yield f"library_name: {request.library_name}"


def plan_steps(request: PackageRequest) -> Iterator[Step]:
    """Yield the files and folders to create in a package, in the order of ``ros2 pkg create``."""
    yield File(Path("package.xml"), package_templates.manifest(request))
    if request.build_type == "ament_python":
        yield from _plan_python_steps(request)
    else:
        yield from _plan_cmake_steps(request)
    text = license_text(request.license, year=request.year, holder=request.maintainer.name)
    if text is not None:
        yield File(Path("LICENSE"), text, is_reported=False)


def format_path(path: Path) -> str:
    """Format a path as ros2 prints it.

    A path below the current folder begins with a dot.
    """
    return str(path) if path.is_absolute() or path.parts[:1] == ("..",) else f"./{path}"


def _plan_python_steps(request: PackageRequest) -> Iterator[Step]:
    module = Path(request.name)
    yield ReportLine("creating source folder")
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


def _plan_cmake_steps(request: PackageRequest) -> Iterator[Step]:
    source, include = Path("src"), Path("include") / request.name
    yield ReportLine("creating source and include folder")
    yield Folder(source)
    yield Folder(include)
    if request.build_type == "ament_cmake":
        yield File(Path("CMakeLists.txt"), cmake_templates.ament_cmake_lists(request))
    else:
        yield File(Path("CMakeLists.txt"), cmake_templates.plain_cmake_lists(request))
        if request.node or request.library_name:
            yield File(Path(f"{request.name}Config.cmake.in"), cmake_templates.config(request))
            yield File(Path(f"{request.name}ConfigVersion.cmake.in"), cmake_templates.config_version_template())
    if request.node:
        yield File(source / f"{request.node}.cpp", cmake_templates.node_cpp(request))
    if request.library_name:
        yield File(include / f"{request.library_name}.hpp", cmake_templates.library_hpp(request))
        yield File(source / f"{request.library_name}.cpp", cmake_templates.library_cpp(request))
        yield File(include / "visibility_control.h", cmake_templates.visibility_control(request))


def _execute_step(step: Step, package_folder: Path, report: Callable[[str], None]) -> None:
    if isinstance(step, ReportLine):
        report(step.text)
        return
    path = package_folder / step.path
    if isinstance(step, Folder):
        report(f"creating folder {format_path(path)}")
        path.mkdir(parents=True, exist_ok=True)
        return
    if step.is_reported:
        report(f"creating {format_path(path)}")
    write_whole_file(path, step.text)
