"""Logging: records, levels, formats, files, ``/rosout``."""
