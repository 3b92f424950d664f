"""Readers for calls of xacro in launch files, tests and build files that are not run."""
