"""Stands in for ``xacro``, as far as launch files call it."""

from linkwright.launch.xacro_documents import parse, process, process_doc, process_file

__all__ = ["parse", "process", "process_doc", "process_file"]
