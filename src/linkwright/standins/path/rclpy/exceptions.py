"""Stands in for ``rclpy.exceptions``."""

from linkwright.graph.faults import InterruptedWaitError as ROSInterruptException
from linkwright.graph.faults import InvalidHandleError as InvalidHandle
from linkwright.graph.faults import NotInitializedError as NotInitializedException
from linkwright.graph.names import InvalidNameError as NameValidationException
from linkwright.graph.names import InvalidNamespaceError as InvalidNamespaceException
from linkwright.graph.names import InvalidNodeNameError as InvalidNodeNameException
from linkwright.graph.names import InvalidServiceNameError as InvalidServiceNameException
from linkwright.graph.names import InvalidTopicNameError as InvalidTopicNameException
from linkwright.graph.parameters.errors import (
    InvalidParameterException,
    InvalidParameterTypeException,
    InvalidParameterValueException,
    ParameterAlreadyDeclaredException,
    ParameterException,
    ParameterImmutableException,
    ParameterNotDeclaredException,
    ParameterUninitializedException,
)
from linkwright.standins.rclpy_api.errors import NoTypeSupportImportedException

__all__ = [
    "InvalidHandle",
    "InvalidNamespaceException",
    "InvalidNodeNameException",
    "InvalidParameterException",
    "InvalidParameterTypeException",
    "InvalidParameterValueException",
    "InvalidServiceNameException",
    "InvalidTopicNameException",
    "NameValidationException",
    "NoTypeSupportImportedException",
    "NotInitializedException",
    "ParameterAlreadyDeclaredException",
    "ParameterException",
    "ParameterImmutableException",
    "ParameterNotDeclaredException",
    "ParameterUninitializedException",
    "ROSInterruptException",
]
