"""The global state of the module ``xacro``: the files and macros that are being processed."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping
from pathlib import Path
from types import ModuleType
from typing import Any

from linkwright.standins.xacro_api.macros import Macro
from linkwright.xacro.expander import Directive, Expander, Site
from linkwright.xacro.faults import Fault
from linkwright.xacro.macros import Macro as EngineMacro
from linkwright.xacro.macros import MacroTable
from linkwright.xacro.session import Inputs, Session
from linkwright.xacro.tags.directives import DIRECTIVES
from linkwright.xacro.tags.macro_calls import call_macro
from linkwright.xmltree import Document, Element

_PREFIX = "xacro:"


class State:
    """The module variables of ``xacro``.

    Attributes:
        filestack: the files being processed, innermost last; None for a description given as a string.
        macrostack: the macros being called, innermost last.
        root_dir: the base folder of relative paths.
        verbosity: the amount of output, from 0 to 4.
        all_includes: the files that were included or loaded since the process began.
        arguments: the arguments of the current expansion.
    """

    def __init__(self) -> None:
        self.filestack: list[str | None] | None = None
        self.macrostack: list[Macro] | None = None
        self.root_dir: str | Path = os.curdir
        self.verbosity = 1
        self.all_includes: list[str] = []
        self.arguments: dict[str, Any] = {}


STATE = State()


def _create_state_property(name: str) -> property:
    def set_value(_: ModuleType, value: Any) -> None:
        setattr(STATE, name, value)

    return property(lambda _: getattr(STATE, name), set_value)


class LiveModule(ModuleType):
    """A module whose variables are the attributes of `STATE`.

    Programs can read and set them.
    """

    filestack = _create_state_property("filestack")
    macrostack = _create_state_property("macrostack")
    root_dir = _create_state_property("root_dir")
    verbosity = _create_state_property("verbosity")
    all_includes = _create_state_property("all_includes")


def share_state() -> None:
    """Make the module ``xacro`` expose the variables of `STATE`."""
    sys.modules["xacro"].__class__ = LiveModule


def init_stacks(file: str | Path | None) -> None:
    """Reset the stacks, with `file` as the only file.

    For a description given as a string, `file` is None.
    """
    STATE.filestack = [None if file is None else str(file)]
    STATE.macrostack = []


def abs_filename_spec(filename_spec: str) -> str:
    """Return an absolute file name.

    A relative name is resolved in the folder of the current file.
    """
    if os.path.isabs(filename_spec):  # noqa: PTH117 - as written
        return filename_spec
    current_file = STATE.filestack[-1] if STATE.filestack else None
    folder = os.path.dirname(current_file) if current_file else os.curdir  # noqa: PTH120
    return os.path.join(folder, filename_spec)  # noqa: PTH118


def print_location() -> None:
    """Print the macros and files that are being processed to standard error, innermost first."""
    prefix = "when instantiating macro:"
    for macro in reversed(STATE.macrostack or []):
        file = macro.history[-1][-1] if macro.history and macro.history[-1] else None
        print(f"{prefix} {macro.name} ({file or '???'})", file=sys.stderr)
        prefix = "instantiated from:"
    prefix = "in file:" if STATE.macrostack else "when processing file:"
    for file in reversed(STATE.filestack or []):
        print(prefix, "string" if file is None else file, file=sys.stderr)
        prefix = "included from:"


class StackExpander(Expander):
    """An expander that reports errors to its session."""

    session: StackSession

    def record_fault(self, fault: Fault) -> None:
        """Record an error and its location."""
        self.session.save_stacks()
        super().record_fault(fault)


class StackSession(Session):
    """A session that updates `STATE` during the expansion.

    Attributes:
        directives: the directives of the expansion.
    """

    def __init__(self, inputs: Inputs) -> None:
        super().__init__(inputs.name, inputs.arguments, inputs.packages, inputs.limits, inputs.root_dir)
        self.directives: Mapping[str, Directive] = {
            **DIRECTIVES,
            "xacro:include": self._include,
            "xacro:macro": self._define_macro,
            "xacro:call": self._call_dynamically,
        }
        self._definitions: dict[int, tuple[Element, Macro]] = {}
        self._outer_file_count = 0
        self._stacks_at_error: tuple[list[str | None], list[Macro]] | None = None
        self.globals.values["xacro"].values["print_location"] = self._print_location

    def read(self, path: str) -> Document:
        """Read a file, make it the current file, and return its document."""
        if STATE.filestack is not None and self._outer_file_count:
            del STATE.filestack[self._outer_file_count :]
            STATE.filestack.append(path)
        return super().read(path)

    def call(self, expander: Expander, site: Site) -> None:
        """Expand a macro call, with the macro on the stack."""
        self._run_with_macro(call_macro, expander, site, site.node.tag[len(_PREFIX) :])

    def add_dependency(self, file: str) -> None:
        """Record that a file was read. See `Session.add_dependency`."""
        super().add_dependency(file)
        STATE.all_includes.append(file)

    def save_stacks(self) -> None:
        """Save the stacks at the first error, because the expansion continues and changes them."""
        if self._stacks_at_error is None:
            self._stacks_at_error = (list(STATE.filestack or []), list(STATE.macrostack or []))

    def restore_stacks(self) -> None:
        """Restore the stacks as they were at the first error, after the expansion has failed."""
        if self._stacks_at_error is not None:
            STATE.filestack, STATE.macrostack = self._stacks_at_error

    def _include(self, expander: Expander, site: Site) -> None:
        outer_file_count, stack = self._outer_file_count, STATE.filestack
        self._outer_file_count = len(stack) if stack is not None else 0
        DIRECTIVES["xacro:include"](expander, site)
        if stack is not None:
            del stack[self._outer_file_count :]
        self._outer_file_count = outer_file_count

    def _define_macro(self, expander: Expander, site: Site) -> None:
        DIRECTIVES["xacro:macro"](expander, site)
        name = site.node.attributes["name"].removeprefix(_PREFIX)
        known_definition = self._definitions.get(id(site.node))
        macro = known_definition[1] if known_definition else Macro()
        macro.name = name
        macro.history.append(list(STATE.filestack or [None]))
        self._definitions[id(site.node)] = (site.node, macro)

    def _call_dynamically(self, expander: Expander, site: Site) -> None:
        text = site.node.attributes.get("macro", "")
        name = (
            text
            if "$" not in text or self.may_change_values(text)
            else expander.text_value(site.node, "macro", site.scope)
        )
        self._run_with_macro(DIRECTIVES["xacro:call"], expander, site, name)

    def _run_with_macro(self, directive: Directive, expander: Expander, site: Site, name: str) -> None:
        macro = _find_macro(site.macros, name)
        known_definition = self._definitions.get(id(macro.body)) if macro else None
        stack = STATE.macrostack
        if known_definition is None or stack is None:
            directive(expander, site)
            return
        stack.append(known_definition[1])
        directive(expander, site)
        stack.pop()  # After an error, the stack must keep the location of the error.

    def _print_location(self, *_: Any) -> str:
        print_location()
        return ""


def _find_macro(macros: MacroTable, name: str) -> EngineMacro | None:
    macro = macros.find(name)
    if isinstance(macro, EngineMacro):
        return macro
    table: Any = macros
    for name_part in name.split("."):
        table = table.find(name_part) if isinstance(table, MacroTable) else None
    return table if isinstance(table, EngineMacro) else None
