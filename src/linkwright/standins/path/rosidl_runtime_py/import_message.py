"""Classes of messages, by their rosidl types."""

from rosidl_runtime_py.utilities import import_message_from_namespaced_type

__all__ = ["import_message_from_namespaced_type"]

__all__ = ["import_message_from_namespaced_type"]
