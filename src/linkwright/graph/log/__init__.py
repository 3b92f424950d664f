"""Logging: records, levels, formats, files and ``/rosout``."""
