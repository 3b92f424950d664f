"""The elements of launch descriptions.

This package reads no files and starts no processes.
"""
