"""Access of checks to the learner's workspace."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from linkwright.diagnostics import LinkwrightError, Phrase, did_you_mean, phrase, quoted_names
from linkwright.diagnostics.lookalikes import to_ascii_text
from linkwright.learning.checks.findings import describe_error
from linkwright.learning.checks.installed_files import expect_valid_setup
from linkwright.learning.checks.not_yet import NotYet
from linkwright.learning.checks.packages import FileFolder, PackageCheck
from linkwright.packages import PackageFinder
from linkwright.packages.manifest import package_name
from linkwright.xmltree import parse_file

SOURCE_FOLDER, SETUP_FILE = "src", "setup.py"
_UNIT_FACTORS = (10.0, 100.0, 1000.0)


class Work(FileFolder):
    """The learner's workspace, passed to each check.

    Files and robots outside of packages are read by their path in the workspace.

    Args:
        folder: the workspace.
        answer: the learner's answer to the step, a number as text; None if there is none.
        lesson: the folder of the lesson, for worlds and other files that a check needs.

    Attributes:
        folder: the workspace.
        lesson: the folder of the lesson.
    """

    def __init__(self, folder: Path, *, lesson: Path, answer: str | None = None) -> None:
        super().__init__(folder, PackageFinder(start=[folder / SOURCE_FOLDER, folder]))
        self.lesson = lesson
        self._answer = answer
        self._packages: dict[str, PackageCheck] = {}

    def package(self, name: str) -> PackageCheck:
        """Return a package of the workspace's sources.

        Raises:
            NotYet: there is no such package below ``src``, or its ``package.xml`` or ``setup.py`` has a syntax error,
                because of which colcon could not build it.
        """
        if name not in self._packages:
            package = PackageCheck(name, self._find_package(name), self.finder, self.folder)
            package.expect_manifest()
            if (package.folder / SETUP_FILE).is_file():
                expect_valid_setup(package.folder)
            self._packages[name] = package
        return self._packages[name]

    def _find_package(self, name: str) -> Path:
        sources = self.folder / SOURCE_FOLDER
        found = {
            package: manifest.parent
            for manifest in sorted(sources.glob("**/package.xml"))
            if (package := package_name(manifest.parent)) is not None
        }
        if name in found:
            return found[name]
        if (sources / name / "package.xml").is_file():
            raise NotYet(_explain_wrong_manifest(sources / name, name))
        if (self.folder / name).is_dir():
            raise NotYet(phrase("the package '{name}' is beside the folder 'src'; move it into 'src'", name=name))
        if (sources / name).is_dir():
            raise NotYet(
                phrase(
                    "the folder 'src/{name}' has no file package.xml; does the package exist in another folder?",
                    name=name,
                )
            )
        suggestion = did_you_mean(name, found)
        if suggestion is not None:
            raise NotYet(
                phrase(
                    "the workspace has no package '{name}'; its packages are {names}",
                    name=name,
                    names=quoted_names(found),
                )
            )
        raise NotYet(phrase("the workspace has no package '{name}' below 'src'", name=name))

    def number(self) -> float:
        """Return the learner's answer as a number.

        Raises:
            NotYet: there is no answer, or it is not a number.
        """
        if self._answer is None or not self._answer.strip():
            raise NotYet(phrase("the step has no answer yet"))
        try:
            return float(to_ascii_text(self._answer.strip()).replace(",", "."))
        except ValueError:
            raise NotYet(
                phrase(
                    "the answer '{answer}' is not a number; write the number alone, without a unit", answer=self._answer
                )
            ) from None

    def expect_number(self, value: float, *, tolerance: float, slips: Mapping[float, object] | None = None) -> None:
        """Require the learner's number to be near a value.

        Args:
            value: the correct number.
            tolerance: the greatest accepted difference.
            slips: the messages for typical wrong answers, as a `NotYet` by the wrong number.

        Raises:
            NotYet: the number is missing or differs.
        """
        number = self.number()
        if abs(number - value) <= tolerance:
            return
        for wrong, message in (slips or {}).items():
            if abs(number - wrong) <= tolerance and isinstance(message, NotYet):
                raise message
        if abs(number + value) <= tolerance:
            raise NotYet(phrase("{number:g} has the wrong sign", number=number))
        for factor in _UNIT_FACTORS:
            if abs(number / factor - value) <= tolerance:
                raise NotYet(
                    phrase(
                        "{number:g} has the correct digits, but not the unit of the question; check the decimal point",
                        number=number,
                    )
                )
        raise NotYet(phrase("{number:g} is not correct; measure again", number=number))


def _explain_wrong_manifest(folder: Path, name: str) -> Phrase:
    """Return the message for a ``package.xml`` that is not XML, or has a wrong name."""
    try:
        parse_file(folder / "package.xml")
    except LinkwrightError as error:
        return describe_error(error)
    actual = package_name(folder)
    if actual is None:
        return phrase("src/{name}/package.xml has no <name>; write <name>{name}</name>", name=name)
    return phrase("src/{name}/package.xml has the name '{actual}'; write <name>{name}</name>", name=name, actual=actual)
