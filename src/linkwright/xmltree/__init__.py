"""XML with source positions: parsing, traversal and writing."""

from linkwright.xmltree.nodes import Comment, Document, Element, Node, ProcessingInstruction, Text
from linkwright.xmltree.reader import Overlay, parse, parse_file
from linkwright.xmltree.writer import write, write_element

__all__ = [
    "Comment",
    "Document",
    "Element",
    "Node",
    "Overlay",
    "ProcessingInstruction",
    "Text",
    "parse",
    "parse_file",
    "write",
    "write_element",
]
