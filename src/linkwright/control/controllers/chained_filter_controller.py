"""``chained_filter_controller/ChainedFilter``: filtered state interfaces for other controllers.

Source: ros2_controllers (parameters, the names of exported states). The types of filters are in
`linkwright.control.controllers.value_filters`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import count
from math import isfinite, nan

from linkwright.control.controllers.controller import Controller, ControllerError, InterfaceNames
from linkwright.control.controllers.value_filters import FILTERS, FilterParameters, ValueFilter
from linkwright.diagnostics import did_you_mean, joined, phrase
from linkwright.nodes.parameter_tables import declare_table, not_empty, parameter

_SHARED_CHAIN = "filter_chain"


@dataclass(frozen=True, kw_only=True)
class ChainedFilterParameters:
    """Parameters of the controller, besides the chains."""

    input_interfaces: tuple[str, ...] = parameter(
        (), read_only=True, description="the states to filter", check=not_empty
    )
    output_interfaces: tuple[str, ...] = parameter(
        (), read_only=True, description="the names of the filtered states, in the same order", check=not_empty
    )


@dataclass(frozen=True, kw_only=True)
class FilterEntry:
    """A filter of a chain, such as ``filter_chain.filter1``."""

    name: str = parameter("", description="the name of the filter")
    type: str = parameter("", description="the type of the filter")


class ChainedFilterController(Controller[ChainedFilterParameters]):
    """A controller that passes each state through a chain of filters, and exports the results.

    ``filter_chain`` applies to all states, or ``STATE.filter_chain`` to one of them.
    """

    PARAMETERS = ChainedFilterParameters

    def declare_parameters(self) -> None:
        """Declare the parameters of the chains.

        Raises:
            ControllerError: a filter has an unknown type.
        """
        shared_chain = list(self._read_chain(_SHARED_CHAIN))
        self._chains = {
            name: shared_chain or list(self._read_chain(f"{name}.{_SHARED_CHAIN}"))
            for name in self.parameters.input_interfaces
        }

    def _read_chain(self, prefix: str) -> Iterator[FilterParameters]:
        """Yield the parameters of a chain's filters: ``filter1``, ``filter2`` and so on."""
        node = self.node.graph_node
        for number in count(1):
            name = f"{prefix}.filter{number}"
            if f"{name}.type" not in node.undeclared_overrides():
                return
            entry = declare_table(node, FilterEntry, name)
            if entry.type not in FILTERS:
                message = phrase("there is no filter '{kind}' ({name})", kind=entry.type, name=f"{name}.type")
                hint = did_you_mean(entry.type, FILTERS)
                raise ControllerError(message if hint is None else joined((message, hint), "; "))
            yield declare_table(node, FILTERS[entry.type], f"{name}.params")

    def state_interfaces(self) -> InterfaceNames:
        """Return the names of the filtered states."""
        return self.parameters.input_interfaces

    def exported_states(self) -> Sequence[str]:
        """Return the names of the results."""
        return self.parameters.output_interfaces

    def on_configure(self) -> None:
        """Check the parameters.

        Raises:
            ControllerError: the numbers of inputs and outputs differ, a state has no chain, or a minimum is above its
                maximum.
        """
        parameters = self.parameters
        if len(parameters.input_interfaces) != len(parameters.output_interfaces):
            raise ControllerError("Input and output interfaces have to have the same size.")
        for name, chain in self._chains.items():
            if not chain:
                message = phrase(
                    "Failed to configure filter chain for interfaces {name}. Check the parameters for filters setup.",
                    name=name,
                )
                raise ControllerError(message)
        self._create_filters()

    def _create_filters(self) -> None:
        self._filters: list[list[ValueFilter]] = [
            [entry.create() for entry in self._chains[name]] for name in self.parameters.input_interfaces
        ]

    def on_activate(self) -> None:
        """Start the filters from their initial state. The results are NaN until the first update."""
        self._create_filters()
        for state in self.exported:
            state.value = nan

    def update(self, time_ns: int, period_s: float) -> None:
        """Filter each state that is a finite number."""
        for state, filters, result in zip(self.states, self._filters, self.exported, strict=True):
            value = state.value
            if isfinite(value):
                for value_filter in filters:
                    value = value_filter(value)
                result.value = value
