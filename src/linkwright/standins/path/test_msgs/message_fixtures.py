"""Stands in for ``test_msgs.message_fixtures``; the values are others."""

from linkwright.standins.sample_messages import get_test_msg, of_type

get_msg_arrays = of_type("Arrays")
get_msg_basic_types = of_type("BasicTypes")
get_msg_bounded_sequences = of_type("BoundedSequences")
get_msg_builtins = of_type("Builtins")
get_msg_constants = of_type("Constants")
get_msg_defaults = of_type("Defaults")
get_msg_empty = of_type("Empty")
get_msg_multi_nested = of_type("MultiNested")
get_msg_nested = of_type("Nested")
get_msg_strings = of_type("Strings")
get_msg_unbounded_sequences = of_type("UnboundedSequences")
get_msg_wstrings = of_type("WStrings")

__all__ = [
    "get_msg_arrays",
    "get_msg_basic_types",
    "get_msg_bounded_sequences",
    "get_msg_builtins",
    "get_msg_constants",
    "get_msg_defaults",
    "get_msg_empty",
    "get_msg_multi_nested",
    "get_msg_nested",
    "get_msg_strings",
    "get_msg_unbounded_sequences",
    "get_msg_wstrings",
    "get_test_msg",
]
