"""Compare what packages build and install: CMakeLists.txt, setup.py, package.xml and their dependencies."""
