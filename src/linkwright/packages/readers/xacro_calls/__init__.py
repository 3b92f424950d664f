"""Calls of xacro in launch files, tests and build files, found without running them."""
