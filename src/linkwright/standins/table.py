"""The tables of the public names in ROS modules, with the module that implements each name.

A table is a text file ``tables/<package>.txt``, in the order of the package's modules::

    # A comment.
    [launch.conditions]
    linkwright.launch.model.conditions: IfCondition UnlessCondition
        evaluate_condition_expression
    launch.condition: Condition
    typing: Text
    import: os
    linkwright.launch.model.conditions since jazzy: ...
    value DEFAULT: 'a literal'
    absent LaunchThing: the reason | the same in Chinese
    differs IfCondition: the difference | the same in Chinese
    setup: linkwright.some.module.function
    others: linkwright.some.module.function_of_a_name

A line ``origin: names`` means that the module ``origin`` defines these names. In ``ours=theirs``, the right name is
the name in the origin. The origin can be another stand-in module. ``import`` lists modules; a submodule of the package
takes precedence. ``since`` gives the distribution for names that ROS 2 Humble lacks. Names with a leading underscore,
and submodules that no line names, are importable but not in ``__all__``. The function ``setup`` is called after the
module is created. The function ``others`` returns the values of names that are not in the table.

A table is read without a parsing library and only when its package is imported, because programs wait for it.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

FOLDER = Path(__file__).parent / "tables"
IMPORT = "import"
VALUE = "value"


@dataclass(frozen=True, slots=True)
class Name:
    """The origin of a name in a module.

    The forms are ``from origin import name``, ``import name``, and ``value`` with a literal.
    """

    origin: str
    name: str
    since: str = ""


@dataclass(frozen=True, slots=True)
class Remark:
    """The reason why a name is missing, or its difference from ROS, in English and Chinese."""

    english: str
    chinese: str


@dataclass(slots=True)
class Module:
    """The entries of a table for one module.

    Attributes:
        name: the full name of the module.
        since: the ROS 2 distribution that introduced the module, if later than Humble.
        names: the names that can be imported from the module.
        absent: public names of the ROS module that the stand-in does not have.
        differs: names of the stand-in that behave differently in ROS.
        setup: the full name of a function to call after the module is created.
        others: the full name of a function that returns the value of any other name, or raises AttributeError.
        submodules: the names of the submodules, without the name of the module.
    """

    name: str
    since: str = ""
    names: dict[str, Name] = field(default_factory=dict)
    absent: dict[str, Remark] = field(default_factory=dict)
    differs: dict[str, Remark] = field(default_factory=dict)
    setup: str = ""
    others: str = ""
    submodules: list[str] = field(default_factory=list)

    @property
    def public(self) -> list[str]:
        """The names that ``from module import *`` imports."""
        return [name for name in self.names if not name.startswith("_")]


def list_packages() -> list[str]:
    """Return the names of all packages that have a table."""
    return sorted(path.stem for path in FOLDER.glob("*.txt"))


@cache
def read(package: str) -> dict[str, Module]:
    """Return the modules of a package by full name.

    For a package without a table, the result is empty.
    """
    try:
        text = (FOLDER / f"{package}.txt").read_text(encoding="utf-8")
    except OSError:
        return {}
    return parse(text)


def find(module: str) -> Module | None:
    """Return the table entries of a module, or None if there are none."""
    return read(module.partition(".")[0]).get(module)


def find_modules_providing(name: str) -> list[str]:
    """Return the modules that provide a name, one per package.

    For ``Node``, one of them is ``rclpy.node``.
    """
    modules_by_package: dict[str, str] = {}
    for package in list_packages():
        providers = [
            module.name
            for module in read(package).values()
            if name in module.names and module.names[name].origin.startswith("linkwright.") and "._" not in module.name
        ]
        providers = [module for module in providers if module.rpartition(".")[0] not in providers]
        if providers:  # of several modules in a package, prefer one whose name is part of the imported name
            base_names = {module: module.rpartition(".")[2].replace("_", "") for module in providers}
            modules_by_package[package] = min(
                providers, key=lambda module: (base_names[module] not in name.lower(), len(module))
            )
    return sorted(modules_by_package.values())


def parse(text: str) -> dict[str, Module]:
    """Parse the text of a table.

    Raises:
        ValueError: a line is invalid; the message quotes the line.
    """
    modules: dict[str, Module] = {}
    for line in _join_lines(text):
        key, colon, value_text = line.partition(":")
        if line.startswith("["):
            name, _, since = line[1:].partition("]")
            module = modules[name] = Module(name, since.removeprefix(" since "))
            parent, _, base_name = name.rpartition(".")
            if parent:
                modules[parent].submodules.append(base_name)
            continue
        keyword, _, subject = key.partition(" ")
        if not colon or not modules:
            raise ValueError(f"not a line of a table: {line!r}")
        if keyword in ("absent", "differs"):
            english, _, chinese = " ".join(value_text.split()).partition(" | ")
            remarks = module.absent if keyword == "absent" else module.differs
            remarks.update(dict.fromkeys(subject.split(), Remark(english, chinese)))
        elif keyword == "setup":
            module.setup = value_text.strip()
        elif keyword == "others":
            module.others = value_text.strip()
        elif keyword == VALUE:
            module.names[subject] = Name(VALUE, value_text.strip())
        else:
            since = subject.removeprefix("since ")
            for pair in value_text.split():
                exported_name, _, origin_name = pair.partition("=")
                module.names[exported_name] = Name(keyword, origin_name or exported_name, since)
    return modules


def _join_lines(text: str) -> list[str]:
    """Return the lines of a table, with continuation lines joined."""
    lines: list[str] = []
    for line in text.splitlines():
        if line[:1] in ("", "#"):
            continue
        if line[0] == " ":
            lines[-1] += line
        else:
            lines.append(line)
    return lines
