"""Generated calls of uncalled macros, to check edits in these macros."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from xml.sax.saxutils import quoteattr

from linkwright.language.includes import real_path
from linkwright.language.occurrences import Occurrence
from linkwright.language.proof import ExpansionProof
from linkwright.language.source_elements import SourceElement, find_innermost_element, source_elements
from linkwright.language.workspace import Workspace
from linkwright.xacro.faults import Fault
from linkwright.xacro.macros import Parameter, parse_parameters

_XACRO = "http://www.ros.org/wiki/xacro"
_PROBE_VALUES = ("probe", "1", "0")
"""The values of the parameters in the calls: a name, the number for true, and the number for false."""


def is_reached(proof: ExpansionProof, text: str, name: Occurrence) -> bool:
    """Return whether an expansion contains the element with a name.

    If the element belongs to xacro, any element of its macro counts. Outside macros, the result is then True.

    Args:
        proof: the expansions.
        text: the text of the file that contains the name.
        name: an occurrence of a name in the macro.
    """
    innermost = find_innermost_element(source_elements(text), name.start)
    if innermost is None:
        return True
    macro = innermost.macro if not innermost.name.startswith("xacro:macro") else innermost
    if innermost.name.startswith("xacro:"):
        if macro is None:
            return True
        innermost = macro
    files = proof.names_of(name.file)
    return any(
        element.source is not None
        and element.source.name in files
        and innermost.start <= element.offset < innermost.end
        for trial in proof.trials
        for element in trial.expansion.document.root.walk()
    )


def generate_probes(workspace: Workspace, texts: Mapping[Path, str], name: Occurrence) -> dict[Path, str]:
    """Return generated texts that call the macro around a name, by their path.

    Returns an empty dictionary outside macros.

    Args:
        workspace: the folders that the editor has opened.
        texts: the texts of the open files.
        name: an occurrence of a name in the macro.
    """
    text = workspace.text(name.file, texts) or ""
    element = find_innermost_element(source_elements(text), name.start)
    macro = None if element is None else element if element.name == "xacro:macro" else element.macro
    if macro is None or macro.macro is not None or not workspace.contains(real_path(name.file)):
        return {}
    calls = [*dict.fromkeys(_generate_calls(macro))]
    return {
        name.file.parent / f".linkwright-probe-{index}.urdf.xacro": (
            f'<robot name="probe" xmlns:xacro="{_XACRO}">\n'
            f"  <xacro:include filename={quoteattr(name.file.name)}/>\n{call}\n</robot>\n"
        )
        for index, call in enumerate(calls)
    }


def _generate_calls(macro: SourceElement) -> Iterator[str]:
    called = macro.value("name").removeprefix("xacro:")
    try:
        parameters = parse_parameters(macro.value("params"))
    except Fault:
        return
    if not called or "$" in called:
        return
    blocks = "".join(map(_generate_block, parameters))
    for value in _PROBE_VALUES:
        arguments = "".join(
            f" {parameter.name}={quoteattr(value)}"
            for parameter in parameters
            if not parameter.is_block and (parameter.default is None or value != _PROBE_VALUES[0])
        )
        yield f"  <xacro:{called}{arguments}>{blocks}</xacro:{called}>"


def _generate_block(parameter: Parameter) -> str:
    """Return an element for a block parameter.

    The macro inserts only the children of an element for ``**name``.
    """
    if not parameter.is_block or parameter.default is not None:
        return ""
    if parameter.name.startswith("**"):
        return f"<{parameter.name.lstrip('*')}/>"
    return '<origin xyz="0 0 0" rpy="0 0 0"/>'
