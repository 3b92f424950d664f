"""Rules that check ``package.xml``, also against the files next to it."""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from collections.abc import Iterator

from linkwright.diagnostics import Diagnostic, Note, Severity, phrase
from linkwright.lint.fix import remove_element
from linkwright.lint.rule import Rule, Scope
from linkwright.lint.subject import Subject
from linkwright.loading.lean_typing import TYPE_CHECKING

if TYPE_CHECKING:
    from linkwright.lint.package import PackageContext
    from linkwright.packages.readers.package_xml import Dependency, Manifest

_REQUIRED = ("name", "version", "description", "maintainer", "license")
_NON_EMPTY_ELEMENTS = frozenset({"name", "version", "description", "license"})
"""Elements that catkin_pkg refuses if they are empty. A maintainer may consist of an e-mail address only."""
_INCLUDED_IN_DEPEND = frozenset({"build_depend", "build_export_depend", "exec_depend"})
_BUILD_FILES = {
    "ament_python": "setup.py",
    "ament_cmake": "CMakeLists.txt",
    "cmake": "CMakeLists.txt",
    "catkin": "CMakeLists.txt",
}


class PackageRule(Rule, ABC):
    """The base class of rules about packages.

    The rules skip descriptions outside a package.
    """

    scope = Scope.PACKAGE

    def check(self, subject: Subject) -> Iterator[Diagnostic]:
        package = subject.package
        if package is not None:
            yield from self.check_package(package)

    @abstractmethod
    def check_package(self, package: PackageContext) -> Iterator[Diagnostic]:
        """Yield the findings of the rule in a package."""


class ManifestRule(PackageRule):
    """The base class of rules about a ``package.xml`` that is well-formed XML."""

    def check_package(self, package: PackageContext) -> Iterator[Diagnostic]:
        """Yield the findings in the manifest of a package, or nothing if the manifest is malformed."""
        if package.manifest is not None:
            yield from self.check_manifest(package.manifest)

    @abstractmethod
    def check_manifest(self, manifest: Manifest) -> Iterator[Diagnostic]:
        """Yield the findings of the rule in a manifest."""


class ManifestMalformed(PackageRule):
    """``package.xml`` is not well-formed XML.

    ## Why

    colcon and rosdep do not recognize the package at all, and report little about the reason.

    ## Example

    ```xml
    <package format="3">
      <name>my_robot_description</nmae>
    ```

    ## Use instead

    ```xml
      <name>my_robot_description</name>
    ```
    """

    code = "LW801"
    name = "manifest-malformed"
    severity = Severity.ERROR

    def check_package(self, package: PackageContext) -> Iterator[Diagnostic]:
        """Yield a finding if the ``package.xml`` of the package is malformed."""
        error = package.manifest_error
        if error is not None:
            diagnostic = error.diagnostics[0]
            yield self.report(
                phrase("package.xml cannot be read: {message}", message=diagnostic.message),
                span=diagnostic.span,
                source=diagnostic.source,
                notes=diagnostic.notes,
                hint=diagnostic.hint,
            )


class ManifestIncomplete(ManifestRule):
    """``package.xml`` lacks an element that every package must have.

    ## Why

    REP 149 requires name, version, description, maintainer and license. colcon ignores a package without a name, and
    release tools refuse a package without the other elements.

    ## Example

    ```xml
    <package format="3">
      <name>my_robot_description</name>
      <version>0.1.0</version>
    </package>
    ```

    ## Use instead

    ```xml
      <description>My robot.</description>
      <maintainer email="me@example.org">Me</maintainer>
      <license>Apache-2.0</license>
    ```
    """

    code = "LW802"
    name = "manifest-incomplete"
    severity = Severity.ERROR

    def check_manifest(self, manifest: Manifest) -> Iterator[Diagnostic]:
        """Yield the findings about missing elements of a manifest."""
        root = manifest.root
        if root.tag != "package":
            yield self.report(phrase("the root of package.xml is <{tag}>, not <package>", tag=root.tag), root)
            return
        missing_tags = [tag for tag in _REQUIRED if root.first(tag) is None]
        if missing_tags:
            tags_text = " and ".join(f"<{tag}>" for tag in missing_tags)
            yield self.report(
                phrase("package.xml lacks {elements}", elements=tags_text),
                root,
                hint=phrase("add {elements}", elements=tags_text),
            )
        for element in root.elements():
            if element.tag not in _NON_EMPTY_ELEMENTS:
                continue
            if not element.text().strip() and next(element.elements(), None) is None:
                tag = element.tag
                yield self.report(phrase("<{tag}> of package.xml is empty", tag=tag), element)


class ManifestVersion(ManifestRule):
    """The version of a package is not three numbers.

    ## Why

    REP 149 requires the form MAJOR.MINOR.PATCH. colcon refuses a package whose version has another form.

    ## Example

    ```xml
    <version>1.0</version>
    ```

    ## Use instead

    ```xml
    <version>1.0.0</version>
    ```
    """

    code = "LW803"
    name = "manifest-version"
    severity = Severity.ERROR

    def check_manifest(self, manifest: Manifest) -> Iterator[Diagnostic]:
        """Yield a finding if the version is not three numbers."""
        version, element = manifest.text("version"), manifest.root.first("version")
        if version and element is not None and not re.fullmatch(r"\d+\.\d+\.\d+", version):
            yield self.report(
                phrase("the version '{version}' is not three numbers separated by dots", version=version),
                element,
                hint=phrase("write a version such as 1.0.0"),
            )


class DependencyRepeated(ManifestRule):
    """A dependency is named twice for the same purpose.

    ## Why

    `<depend>` combines `<build_depend>`, `<build_export_depend>` and `<exec_depend>`. colcon and `ament_package()` read
    the file with catkin_pkg. If one of the three elements also names a package of a `<depend>`, catkin_pkg refuses the
    file, and the package is not built. The same line twice, as in files of MoveIt's Setup Assistant, has no effect, and
    the finding is only informational.

    ## Example

    ```xml
    <depend>xacro</depend>
    <exec_depend>xacro</exec_depend>
    ```

    ## Use instead

    ```xml
    <depend>xacro</depend>
    ```
    """

    code = "LW809"
    name = "dependency-repeated"
    severity = Severity.ERROR

    def check_manifest(self, manifest: Manifest) -> Iterator[Diagnostic]:
        """Yield a finding for each repeated dependency in a manifest."""
        depend_elements = {
            dependency.name: dependency for dependency in reversed(manifest.dependencies) if dependency.tag == "depend"
        }
        first_dependencies: dict[tuple[str, str], Dependency] = {}
        for dependency in manifest.dependencies:
            first_dependency = first_dependencies.setdefault((dependency.name, dependency.tag), dependency)
            if dependency.tag in _INCLUDED_IN_DEPEND and first_dependency is dependency:
                first_dependency = depend_elements.get(dependency.name, dependency)
            if first_dependency is not dependency and _same_condition(
                first_dependency.element.attributes, dependency.element.attributes
            ):
                note = Note(
                    phrase("the first <{tag}> is here", tag=first_dependency.tag), first_dependency.element.span()
                )
                message = phrase("the dependency on '{name}' is listed twice", name=dependency.name)
                fix = remove_element(dependency.element)
                severity = Severity.INFO if first_dependency.tag == dependency.tag else None
                yield self.report(
                    message, dependency.element, notes=[note], hint=phrase("remove it"), fix=fix, severity=severity
                )


class DependencyOnItself(ManifestRule):
    """A package depends on itself.

    ## Why

    colcon cannot determine a build order and refuses to build.

    ## Example

    ```xml
    <name>my_robot_description</name>
    <exec_depend>my_robot_description</exec_depend>
    ```

    ## Use instead

    Remove the dependency.
    """

    code = "LW810"
    name = "dependency-on-itself"
    severity = Severity.ERROR

    def check_manifest(self, manifest: Manifest) -> Iterator[Diagnostic]:
        """Yield a finding for each dependency of a package on itself."""
        for dependency in manifest.dependencies:
            if dependency.name == manifest.name:
                message = phrase("the package '{name}' depends on itself", name=dependency.name)
                yield self.report(
                    message, dependency.element, hint=phrase("remove it"), fix=remove_element(dependency.element)
                )


class BuildTypeDiffers(PackageRule):
    """The build type in ``package.xml`` does not match the build file.

    ## Why

    colcon uses `<build_type>`. For `ament_cmake`, it expects a `CMakeLists.txt`, and for `ament_python`, a `setup.py`.
    Without a build type, it treats the package as a ROS 1 package.

    ## Example

    ```xml
    <export>
      <build_type>ament_cmake</build_type>
    </export>
    ```

    in a package that has a `setup.py` and no `CMakeLists.txt`.

    ## Use instead

    ```xml
      <build_type>ament_python</build_type>
    ```
    """

    code = "LW811"
    name = "build-type-differs"
    severity = Severity.ERROR

    def check_package(self, package: PackageContext) -> Iterator[Diagnostic]:
        """Yield a finding if the build type does not match the build files of a package."""
        manifest = package.manifest
        if manifest is None:
            return
        file_exists = {name: package.has(name) for name in ("setup.py", "CMakeLists.txt")}
        if file_exists["setup.py"] == file_exists["CMakeLists.txt"]:
            return
        build_type = manifest.build_type
        expected_file = _BUILD_FILES.get(build_type or "catkin")
        if expected_file is None or file_exists[expected_file]:
            return
        expected_type = "ament_python" if file_exists["setup.py"] else "ament_cmake"
        existing_file = "setup.py" if file_exists["setup.py"] else "CMakeLists.txt"
        export = manifest.root.first("export")
        element = (export and export.first("build_type")) or export or manifest.root
        if build_type:
            message = phrase(
                "the build type is '{build_type}', but the package has a {file}",
                build_type=build_type,
                file=existing_file,
            )
        else:
            message = phrase(
                "package.xml has no <build_type>, so it is catkin, but the package has a {file}", file=existing_file
            )
        yield self.report(
            message,
            element,
            hint=phrase("write <build_type>{build_type}</build_type> in <export>", build_type=expected_type),
        )


def _same_condition(first: dict[str, str], second: dict[str, str]) -> bool:
    return first.get("condition") == second.get("condition")
