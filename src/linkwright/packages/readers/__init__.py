"""Readers of a package's files: ``package.xml``, ``setup.py``, ``CMakeLists.txt`` and launch files."""
