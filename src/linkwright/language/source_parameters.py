"""The parameters that the sources of a node declare, as parameters of the catalog."""

from __future__ import annotations

from linkwright.language.format import Document
from linkwright.language.node_topics import NodeProgram
from linkwright.language.parameter_catalog import ParameterInfo
from linkwright.language.source_declarations import declared_parameters


def parameters_in_sources(document: Document, program: NodeProgram) -> tuple[ParameterInfo, ...]:
    """Return the parameters that the sources of a program declare.

    The result is empty without a program.

    Args:
        document: the launch file.
        program: the program of a node.

    Raises:
        NotYetKnownError: the sources of the workspace were never read, and the document does not wait.
    """
    parameters: dict[str, ParameterInfo] = {}
    for declaration in declared_parameters(document, program.executable) if program.executable else ():
        default = declaration.default.strip("\"'") or None
        parameter = ParameterInfo(declaration.name, declaration.type, default, f"`{declaration.file.name}`")
        parameters.setdefault(declaration.name, parameter)
    return tuple(parameters.values())
