"""The identity of a node: name, namespace and enclave."""

from __future__ import annotations

from dataclasses import dataclass

from linkwright.graph.names.rules import join


@dataclass(frozen=True, slots=True)
class NodeIdentity:
    """A node's name in the graph.

    Attributes:
        name: without namespace.
        namespace: absolute.
        enclave: the security enclave, ``/`` where there is none.
    """

    name: str
    namespace: str
    enclave: str = "/"

    @property
    def full_name(self) -> str:
        """Namespace and name."""
        return join(self.namespace, self.name)
