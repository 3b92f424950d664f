"""What the files of a package say: ``package.xml``, ``setup.py``, ``CMakeLists.txt`` and launch files."""
