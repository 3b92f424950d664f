"""Rules about the name and the maintainers of a package."""

from __future__ import annotations

import re
from collections.abc import Iterator
from keyword import iskeyword

from linkwright.diagnostics import Diagnostic, Note, Phrase, Severity, phrase
from linkwright.lint.rules.package_manifest import ManifestRule, PackageRule
from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_typing import TYPE_CHECKING
from linkwright.packages.naming import check_package_name, is_accepted_name, is_email, make_rep_144_warning

if TYPE_CHECKING:
    from linkwright.lint.package import PackageContext
    from linkwright.packages.readers.package_xml import Manifest

_PLACEHOLDER = lazy_pattern(
    r"\btodo\b|\bfixme\b|\bchangeme\b|your[ _-]?(name|package|description)|package description here", re.IGNORECASE
)
_PLACEHOLDER_EMAIL = lazy_pattern(
    r"@(todo\.todo|example\.(com|org|net)|todo\.com|email\.com|domain\.(com|tld))$|^(you|user|your\.?(name|email)|me)@",
    re.IGNORECASE,
)


class PackageNameDiffers(PackageRule):
    """``setup.py`` or ``CMakeLists.txt`` gives the package a different name than ``package.xml``.

    ## Why

    With two names, the build stops, or the files are installed under one name and looked up under the other. The names
    often differ after a package was copied and renamed.

    ## Example

    ```xml
    <name>my_robot_description</name>
    ```

    and in `setup.py`

    ```python
    package_name = 'robot_description'
    ```

    ## Use instead

    ```python
    package_name = 'my_robot_description'
    ```
    """

    code = "LW804"
    name = "package-name-differs"
    severity = Severity.ERROR

    def check_package(self, package: PackageContext) -> Iterator[Diagnostic]:
        """Yield a finding for each build file that gives the package another name."""
        manifest = package.manifest
        if manifest is None:
            return
        name = manifest.name
        element = manifest.root.first("name")
        if name is None or element is None:
            return
        note = Note(phrase("the name in package.xml is '{name}'", name=name), element.span())
        setup, cmake = package.setup, package.cmake
        if setup is not None and setup.name is not None and setup.name[0].replace("-", "_") != name.replace("-", "_"):
            message = phrase(
                "setup.py names the package '{name}', but package.xml names it '{other_name}'",
                name=setup.name[0],
                other_name=name,
            )
            yield self.report(
                message, span=setup.name[1], source=setup.source, notes=[note], hint=phrase("write '{text}'", text=name)
            )
        if cmake is not None and cmake.project is not None and cmake.is_ament:
            project = cmake.project
            if "$" not in project.text and project.text != name:
                message = phrase(
                    "CMakeLists.txt names the project '{text}', but package.xml names the package '{name}'",
                    text=project.text,
                    name=name,
                )
                span = cmake.span(project)
                yield self.report(
                    message,
                    span=span,
                    source=cmake.source,
                    notes=[note],
                    hint=phrase("write project({name})", name=name),
                )


class PackageName(ManifestRule):
    """A package name that colcon rejects or that does not follow REP 144.

    ## Why

    colcon reads `package.xml` through catkin_pkg, which rejects a name with spaces or dots, so such a name is an error.
    REP 144 requires lower case letters, digits and underscores. Python cannot import a package whose name has a dash,
    and `ros2 pkg create` does not create such a package. A name that only violates REP 144 is informational, because a
    published package cannot easily be renamed.

    ## Example

    ```xml
    <name>My-Robot</name>
    ```

    ## Use instead

    ```xml
    <name>my_robot</name>
    ```
    """

    code = "LW805"
    name = "package-name"

    def check_manifest(self, manifest: Manifest) -> Iterator[Diagnostic]:
        """Yield a finding if the name of the package is not valid."""
        name, element = manifest.name, manifest.root.first("name")
        if name is None or element is None:
            return
        if not name:
            return  # LW802 reports a missing name
        for finding in check_package_name(name):
            if is_accepted_name(name):
                warning = finding if iskeyword(name) else make_rep_144_warning(name)
                yield self.report(warning.message, element, hint=warning.hint, severity=Severity.INFO)
            else:
                yield self.report(finding.message, element, hint=finding.hint, severity=Severity.ERROR)


class FolderNameDiffers(PackageRule):
    """The folder of a package has a different name than the package.

    ## Why

    A user who reads `package://my_robot_description/...` looks for a folder with this name. Pedantic: no program
    depends on it.

    ## Example

    A package `my_robot_description` in the folder `description`.

    ## Use instead

    Rename the folder. If the repository consists of one package, the folder may keep its name.
    """

    code = "LW806"
    name = "folder-name-differs"
    default = False
    severity = Severity.INFO

    def check_package(self, package: PackageContext) -> Iterator[Diagnostic]:
        """Yield a finding if the folder and the package have different names."""
        manifest = package.manifest
        if manifest is None:
            return
        element = manifest.root.first("name")
        if manifest.name is not None and element is not None and manifest.name != package.folder.name:
            message = phrase(
                "the package '{name}' is in a folder named '{folder_name}'",
                name=manifest.name,
                folder_name=package.folder.name,
            )
            yield self.report(message, element)


class MaintainerEmail(ManifestRule):
    """A maintainer's e-mail address that colcon rejects.

    ## Why

    colcon reads `package.xml` through catkin_pkg, which refuses addresses such as `me@localhost` or `a@b.c`. The
    package is still built, but without its environment hooks, so ROS does not find the package after `source
    install/setup.bash`.

    ## Example

    ```xml
    <maintainer email="lee@b.c">Lee</maintainer>
    ```

    ## Use instead

    ```xml
    <maintainer email="lee@example.org">Lee</maintainer>
    ```
    """

    code = "LW807"
    name = "maintainer-email"
    severity = Severity.ERROR

    def check_manifest(self, manifest: Manifest) -> Iterator[Diagnostic]:
        """Yield findings about missing and invalid e-mail addresses.

        Every maintainer needs an address. An author's address is optional.
        """
        for element in manifest.root.elements():
            if element.tag not in ("maintainer", "author"):
                continue
            email = element.attributes.get("email")
            maintainer_name = " ".join(element.text().split())
            if not email:
                if element.tag == "maintainer":
                    yield self.report(
                        phrase("the maintainer '{maintainer}' has no e-mail address", maintainer=maintainer_name),
                        element,
                        hint=phrase('add email="..."'),
                    )
            elif not is_email(email):
                message = phrase("'{address}' is not an e-mail address that colcon accepts", address=email)
                hint = phrase("write it as name@example.org, in ASCII letters")
                yield self.report(message, element, "email", hint=hint)


class ManifestPlaceholder(ManifestRule):
    """``package.xml`` still has the placeholders of ``ros2 pkg create``.

    ## Why

    The description, license and maintainer of a published package are visible to its users. Without a license, other
    users are not allowed to use the package.

    ## Example

    ```xml
    <description>TODO: Package description</description>
    <maintainer email="lee@todo.todo">lee</maintainer>
    <license>TODO: License declaration</license>
    ```

    ## Use instead

    ```xml
    <description>The four models of my robot, and launch files that show them.</description>
    <maintainer email="lee@my-lab.org">Lee</maintainer>
    <license>Apache-2.0</license>
    ```
    """

    code = "LW808"
    name = "manifest-placeholder"
    severity = Severity.INFO

    def check_manifest(self, manifest: Manifest) -> Iterator[Diagnostic]:
        """Yield a finding for each placeholder that ``ros2 pkg create`` left in the manifest."""
        for tag in ("description", "license", "maintainer", "author"):
            for element in manifest.root.elements(tag):
                text = " ".join(element.text().split())
                email = element.attributes.get("email", "")
                if tag in ("maintainer", "author") and _PLACEHOLDER_EMAIL.search(email):
                    yield self.report(
                        phrase("the e-mail address '{email}' is a placeholder", email=email), element, "email"
                    )
                elif _PLACEHOLDER.search(text):
                    yield self.report(
                        phrase("<{tag}> is a placeholder: '{text}'", tag=tag, text=text),
                        element,
                        hint=_make_placeholder_hint(tag),
                    )


def _make_placeholder_hint(tag: str) -> Phrase:
    if tag == "license":
        return phrase("write its SPDX identifier, such as Apache-2.0, MIT or BSD-3-Clause")
    return (
        phrase("describe the purpose of the package in a sentence")
        if tag == "description"
        else phrase("write your name")
    )
