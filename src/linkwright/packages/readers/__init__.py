"""Readers of a package's files, such as ``setup.py``, ``CMakeLists.txt``, launch files."""
