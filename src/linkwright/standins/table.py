"""The tables of names: which public names the modules of a ROS package have, and where ours of each name is.

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
    absent LaunchThing: why it is not here | the same in Chinese
    differs IfCondition: in what | the same in Chinese
    setup: linkwright.some.module.function
    others: linkwright.some.module.function_of_a_name

A line ``origin: names`` says that ``origin`` has these names, under the name on the right where it reads
``ours=theirs``; the origin may be another module stood in for. ``import`` names modules, submodules of the package
first. What ROS 2 Humble does not have says ``since`` when it came. Names that begin with an underscore and
submodules that no line names are importable and are not among ``__all__``. ``setup`` is called once the module
is made; ``others`` gives the names that the table does not have.

Programs wait for this to be read: it is read without a library, and a table only when its package is imported.
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
    """Where a name of a module comes from: ``from origin import name``, ``import name``, or ``value`` and a literal."""

    origin: str
    name: str
    since: str = ""


@dataclass(frozen=True, slots=True)
class Remark:
    """Why a name is not here, or in what it is other than the real one, in English and in Chinese."""

    english: str
    chinese: str


@dataclass(slots=True)
class Module:
    """What a table says of one module.

    Attributes:
        name: the full name of the module.
        since: the distribution of ROS 2 in which it came, when Humble does not have it.
        names: the names that can be imported from it.
        absent: public names of the real module that ours does not have.
        differs: names of ours that do not do all that the real ones do.
        setup: the full name of a function to be called once the module is made.
        others: the full name of a function that gives any other name, or raises AttributeError.
        submodules: the last parts of the names of the modules below it.
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
        """The names that ``from module import *`` gives."""
        return [name for name in self.names if not name.startswith("_")]


def packages() -> list[str]:
    """The names of all packages that have a table."""
    return sorted(path.stem for path in FOLDER.glob("*.txt"))


@cache
def read(package: str) -> dict[str, Module]:
    """The modules of a package, by their full names; none for a package without a table."""
    try:
        text = (FOLDER / f"{package}.txt").read_text(encoding="utf-8")
    except OSError:
        return {}
    return parse(text)


def find(module: str) -> Module | None:
    """What the tables say of a module, or None when they have no such module."""
    return read(module.partition(".")[0]).get(module)


def homes(name: str) -> list[str]:
    """The modules that a name should be imported from, one of each package that has it: rclpy.node for Node."""
    found: dict[str, str] = {}
    for package in packages():
        having = [
            module.name
            for module in read(package).values()
            if name in module.names and module.names[name].origin.startswith("linkwright.") and "._" not in module.name
        ]
        having = [module for module in having if module.rpartition(".")[0] not in having]
        if having:  # where several have it, the one that is called as it is
            last = {module: module.rpartition(".")[2].replace("_", "") for module in having}
            found[package] = min(having, key=lambda module: (last[module] not in name.lower(), len(module)))
    return sorted(found.values())


def parse(text: str) -> dict[str, Module]:
    """Read a table.

    Raises:
        ValueError: a line that is none of a table, named in the message.
    """
    modules: dict[str, Module] = {}
    for line in _joined(text):
        head, colon, rest = line.partition(":")
        if line.startswith("["):
            name, _, since = line[1:].partition("]")
            module = modules[name] = Module(name, since.removeprefix(" since "))
            parent, _, last = name.rpartition(".")
            if parent:
                modules[parent].submodules.append(last)
            continue
        word, _, what = head.partition(" ")
        if not colon or not modules:
            raise ValueError(f"not a line of a table: {line!r}")
        if word in ("absent", "differs"):
            english, _, chinese = " ".join(rest.split()).partition(" | ")
            remarks = module.absent if word == "absent" else module.differs
            remarks.update(dict.fromkeys(what.split(), Remark(english, chinese)))
        elif word == "setup":
            module.setup = rest.strip()
        elif word == "others":
            module.others = rest.strip()
        elif word == VALUE:
            module.names[what] = Name(VALUE, rest.strip())
        else:
            since = what.removeprefix("since ")
            for each in rest.split():
                ours, _, theirs = each.partition("=")
                module.names[ours] = Name(word, theirs or ours, since)
    return modules


def _joined(text: str) -> list[str]:
    """The lines of a table, each with those that go on with it."""
    lines: list[str] = []
    for line in text.splitlines():
        if line[:1] in ("", "#"):
            continue
        if line[0] == " ":
            lines[-1] += line
        else:
            lines.append(line)
    return lines
