"""Expand a description without the files and packages that are missing.

Includes of missing files are left out. Calls of macros that these files would define stay in the result as elements,
and values that need names of these files stay as they are written.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from linkwright.diagnostics import LinkwrightError
from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_dataclasses import dataclass, field
from linkwright.xacro.expander import Directive, Expander, Site, is_final
from linkwright.xacro.expansion import Expansion
from linkwright.xacro.expressions.scope import Scope
from linkwright.xacro.faults import Fault
from linkwright.xacro.limits import recursion_limit_for
from linkwright.xacro.plan import plan_of
from linkwright.xacro.session import Inputs, Packages, Session, read_main_document
from linkwright.xacro.tags.directives import DIRECTIVES
from linkwright.xacro.tags.macro_calls import call_macro
from linkwright.xmltree import Element

UNEVALUATED = "\0"
"""The name of the attribute with the names of an element's unevaluated attributes. XML does not allow this name."""
PLACEHOLDER_FOLDER = "/.package-not-found"
"""The folder that contains the share folders of missing packages in values. It does not exist."""
_FIXED_SUBSTITUTION = lazy_pattern(r"\$\((?:find|cwd|dirname)\b[^()$]*\)")
_MISSING_FILE = "XML101"
_MISSING_MACRO = "XAC401"
_UNKNOWN_NAMES = frozenset({"XAC201", "XAC211", "XAC406", "XAC506"})
"""Codes of errors that missing definitions cause."""


@dataclass
class Omissions:
    """The parts of a description that were left out.

    Attributes:
        packages: the names of the missing packages.
        files: the paths of the missing files of other packages.
        macros: the number of calls of each macro that is not defined.
        tags: the tags that were left out because they need names that are not defined, each with its attributes.
    """

    packages: set[str] = field(default_factory=set)
    files: set[str] = field(default_factory=set)
    macros: dict[str, int] = field(default_factory=dict)
    tags: set[str] = field(default_factory=set)

    def __bool__(self) -> bool:
        """Return whether a file or package is missing."""
        return bool(self.packages or self.files)


def expand_with_omissions(inputs: Inputs, packages: Packages) -> tuple[Expansion, Omissions]:
    """Expand a description without the files and packages that are missing.

    Args:
        inputs: the inputs of the expansion, whose packages are not used.
        packages: the finder of the packages.

    Returns:
        The expansion and the parts that were left out. Elements with unevaluated attributes have the attribute
        `UNEVALUATED`.

    Raises:
        LinkwrightError: the errors that have other causes.
    """
    omissions = Omissions()
    session = inputs._replace(packages=_PlaceholderPackages(packages, omissions)).create_session()
    document = read_main_document(session, inputs.text)
    with recursion_limit_for(session.limits):
        expanded_document = _OmittingExpander(session, omissions).expand_document(document)
    session.close()
    expansion = Expansion(
        expanded_document, session.dependencies, session.arguments, tuple(session.diagnostics), inputs
    )
    return expansion, omissions


class _PlaceholderPackages:
    """A finder that returns a nonexistent folder for a missing package."""

    def __init__(self, packages: Packages, omissions: Omissions) -> None:
        self._packages = packages
        self._omissions = omissions

    def share(self, name: str) -> Path:
        """Return the share folder of a package."""
        try:
            return self._packages.share(name)
        except LinkwrightError:
            self._omissions.packages.add(name)
            return Path(PLACEHOLDER_FOLDER, name)


class _OmittingExpander(Expander):
    """An expander that leaves out missing files, and tags that need their definitions."""

    def __init__(self, session: Session, omissions: Omissions) -> None:
        directives: Mapping[str, Directive] = {
            tag: self._leave_out_on_failure(directive) for tag, directive in DIRECTIVES.items()
        }
        super().__init__(session, directives, self._leave_out_on_failure(call_macro))
        self._omissions = omissions
        self._unevaluated_count = 0

    def attributes(self, node: Element, scope: Scope) -> dict[str, str]:
        """Return the attributes, with the names of those that could not be evaluated."""
        count_before = self._unevaluated_count
        result = super().attributes(node, scope)
        if self._unevaluated_count > count_before:
            attributes = node.attributes
            names = [
                name for name in plan_of(node).evaluated if "$" in attributes[name] and result[name] == attributes[name]
            ]
            result[UNEVALUATED] = " ".join(names)
        return result

    def record_fault(self, fault: Fault) -> None:
        """Record the error of an attribute or text, unless a missing file may be the cause."""
        if self._omissions and fault.code in _UNKNOWN_NAMES:
            self._unevaluated_count += 1
        else:
            super().record_fault(fault)

    def _leave_out_on_failure(self, directive: Directive) -> Directive:
        """Return a directive that leaves out its tag if the tag needs a missing file or definition."""

        def expand(expander: Expander, site: Site) -> None:
            session, nesting = self.session, self._nesting
            frame, file = session.frame, session.file
            try:
                directive(expander, site)
            except LinkwrightError as error:
                self._nesting, session.frame, session.file = nesting, frame, file
                if any(map(is_final, error.diagnostics)) or not self._leave_out(error.diagnostics[0].code, site):
                    raise

        return expand

    def _leave_out(self, code: str, site: Site) -> bool:
        """Leave out a tag with an error, and return whether this is possible."""
        node = site.node
        if node.tag == "xacro:include" and code == _MISSING_FILE:
            path = self.session.relative_to_current_file(self.text_value(node, "filename", site.scope))
            if path.startswith(PLACEHOLDER_FOLDER):
                return True
            if "$" in _FIXED_SUBSTITUTION.sub("", node.attributes["filename"]):
                return False  # another value of an argument may lead to an existing file
            self._omissions.files.add(path)
            return True
        if not self._omissions:
            return False
        if code == _MISSING_MACRO:
            name = node.attributes.get("macro") or node.tag.partition(":")[2]
            self._omissions.macros[name] = self._omissions.macros.get(name, 0) + 1
            self.expand_element(node, site.parent.children, site.scope, site.macros)
            return True
        if code in _UNKNOWN_NAMES:
            attributes = " ".join(f'{name}="{value}"' for name, value in node.attributes.items())
            self._omissions.tags.add(f"<{node.tag} {attributes}>")
            return True
        return False
