"""The arguments of a description, and the origin of its elements.

The modules that provide the information are imported on demand.
"""

from __future__ import annotations

from collections.abc import Mapping

from linkwright.diagnostics import Diagnostic, LinkwrightError, did_you_mean, phrase
from linkwright.loading.lean_typing import TYPE_CHECKING
from linkwright.xacro.expansion import expand
from linkwright.xacro.limits import Limits
from linkwright.xacro.session import Inputs, PackageSource

if TYPE_CHECKING:
    from pathlib import Path

    from linkwright.xacro.tracing.arguments import Argument
    from linkwright.xacro.tracing.provenance import Provenance
    from linkwright.xmltree import Element

_MAX_SHOWN_NAMES = 5


def arguments_of(
    path: str | Path,
    arguments: Mapping[str, str] | None = None,
    *,
    packages: PackageSource = None,
    text: str | None = None,
    limits: Limits | None = None,
    root_dir: str | Path | None = None,
) -> tuple[Argument, ...]:
    """Return the arguments of a file and of its included files, declared arguments first.

    The arguments are also found if the file cannot be expanded without them.

    Args:
        path: the file; see `linkwright.xacro.expand`.
        arguments: the values of arguments that may decide which files are included, by name.
        packages: the packages for ``$(find name)``.
        text: the text to use instead of the file's.
        limits: the limits of the expansion.
        root_dir: the base of relative paths.

    Raises:
        LinkwrightError: if the file cannot be read or is not XML.
    """
    from linkwright.xacro.tracing.arguments import examine_arguments

    inputs = Inputs(str(path), arguments or {}, packages, text, limits or Limits(), str(root_dir or ""))
    return examine_arguments(inputs).arguments


def explain(
    path: str | Path,
    name: str,
    arguments: Mapping[str, str] | None = None,
    *,
    packages: PackageSource = None,
    text: str | None = None,
    limits: Limits | None = None,
    root_dir: str | Path | None = None,
) -> tuple[Provenance, ...]:
    """Return the provenance of the elements of an expansion that have a given name.

    Args:
        path: the file; see `linkwright.xacro.expand`.
        name: the value of the attribute ``name``.
        arguments: the values of the arguments, by name.
        packages: the packages for ``$(find name)``.
        text: the text to use instead of the file's.
        limits: the limits of the expansion.
        root_dir: the base of relative paths.

    Returns:
        The provenance of at least one element. If children of the root have the name, deeper elements are left out.

    Raises:
        LinkwrightError: the errors of the file, or XAC801 if no element has the name.
    """
    inputs = Inputs(str(path), arguments or {}, packages, text, limits or Limits(), str(root_dir or ""))
    return provenance_of_named(inputs, name)


def provenance_of_named(inputs: Inputs, name: str) -> tuple[Provenance, ...]:
    """Return the provenance of the elements with a name in an expansion; see `explain`."""
    from linkwright.xacro.tracing.provenance import Tracer

    path, arguments, packages, text, limits, root_dir, overlay = inputs
    expansion = expand(path, arguments, packages=packages, text=text, limits=limits, root_dir=root_dir, overlay=overlay)
    root = expansion.document.root
    matches = [element for element in root.elements() if element.attributes.get("name") == name]
    if not matches:
        matches = [element for element in root.walk() if element.attributes.get("name") == name]
    if not matches:
        raise LinkwrightError(_missing_element_diagnostic(name, path, root))
    tracer = Tracer(inputs, root)
    return tuple(tracer.trace(element) for element in matches)


def _missing_element_diagnostic(name: str, file: str, root: Element) -> Diagnostic:
    element_names = {
        element.attributes["name"]: None
        for element in root.elements()
        if element.tag in ("link", "joint") and "name" in element.attributes
    }
    hint = did_you_mean(name, element_names)
    if hint is None and element_names:
        hint = phrase(
            "there are {count} links and joints, such as {known}",
            count=len(element_names),
            known=", ".join(list(element_names)[:_MAX_SHOWN_NAMES]),
        )
    elif hint is None:
        hint = phrase("the file has neither links nor joints")
    return Diagnostic(
        "XAC801",
        phrase("the expansion of '{file}' has no link or joint named '{name}'", file=file, name=name),
        hint=hint,
    )
