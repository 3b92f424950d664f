"""The API of ``launch_pytest``.

Launches are pytest fixtures, and tests run during and after them.
"""
