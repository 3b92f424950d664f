"""XML languages as data: tables of elements and attributes.

The tables are used for reading, writing and explaining.

A language is a tree of `ElementRule` objects. This package contains no language itself; URDF's is
`linkwright.urdf.schema`.
"""

from linkwright.schema.describing import describe_attribute, describe_element
from linkwright.schema.reading import UNREADABLE, ElementReader, Report, reader_of
from linkwright.schema.rules import AttributeRule, ElementRule, ValueType, Version
from linkwright.schema.writing import write_element

__all__ = [
    "UNREADABLE",
    "AttributeRule",
    "ElementReader",
    "ElementRule",
    "Report",
    "ValueType",
    "Version",
    "describe_attribute",
    "describe_element",
    "reader_of",
    "write_element",
]
