"""Readers for calls of xacro in launch files, tests and build files, without running these files."""
